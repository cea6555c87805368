#include "renderer/scene/gltf/triangles.h"

#include <algorithm>
#include <numeric>

#include "renderer/scene/gltf/accessors.h"

namespace lightwell::gltf {
namespace {

using Indices = std::vector<std::uint32_t>;

Indices counting_up(std::size_t count) {
  Indices indices(count);
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

Indices read_indices(const Context& context, int accessor, std::size_t count, std::size_t vertex_count,
                     const std::string& where) {
  Indices indices = read_integers(context, accessor, 1, count, where);
  const auto bad = std::find_if(indices.begin(), indices.end(), [=](std::uint32_t i) { return i >= vertex_count; });
  if (bad != indices.end())
    fail(where, "index " + std::to_string(*bad) + " (element " + std::to_string(bad - indices.begin()) +
                    ") is beyond the " + std::to_string(vertex_count) + " vertices");
  return indices;
}

/// A strip repeats indices to begin anew elsewhere; what has no extent by its indices alone is left out.
void append_triangle(Indices& triangles, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
}

Indices from_strip(const Indices& strip) {
  Indices triangles;
  triangles.reserve(3 * (strip.size() - 2));
  for (std::size_t i = 0; i + 2 < strip.size(); ++i)
    append_triangle(triangles, strip[i], strip[i + 1 + i % 2], strip[i + 2 - i % 2]);
  return triangles;
}

Indices from_fan(const Indices& fan) {
  Indices triangles;
  triangles.reserve(3 * (fan.size() - 2));
  for (std::size_t i = 0; i + 2 < fan.size(); ++i) append_triangle(triangles, fan[i + 1], fan[i + 2], fan[0]);
  return triangles;
}

}  // namespace

Indices read_triangles(Context& context, const tinygltf::Primitive& primitive, std::size_t vertex_count,
                       const std::string& where) {
  if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    fail(join(where, "mode"), std::to_string(primitive.mode) + " is not a mode of glTF");
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
    context.warnings.add(where, "points and lines are left out");
    return {};
  }
  const std::string path = join(where, "indices");
  const bool indexed = primitive.indices != kNone;
  const std::size_t count = indexed ? find_accessor(context, primitive.indices, path).count : vertex_count;
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  const std::size_t triangle_count = count < 3 ? 0 : list ? count / 3 : count - 2;
  if (triangle_count == 0) {
    context.warnings.add(where, "has no triangle and is left out");
    return {};
  }
  context.triangles.claim(triangle_count, where);
  Indices indices =
      indexed ? read_indices(context, primitive.indices, count, vertex_count, path) : counting_up(vertex_count);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) return from_strip(indices);
  if (primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN) return from_fan(indices);
  if (count % 3 != 0) context.warnings.add(where, std::to_string(count) + " indices are not whole triangles");
  indices.resize(3 * triangle_count);
  return indices;
}

}  // namespace lightwell::gltf
