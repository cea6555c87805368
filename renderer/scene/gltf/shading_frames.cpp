#include "renderer/scene/gltf/shading_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "renderer/scene/tangents.h"

namespace lightwell::gltf {
namespace {

bool has_direction(const glm::vec3& v) {
  const float squared = glm::dot(v, v);
  return squared > std::numeric_limits<float>::min() && std::isfinite(squared);
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
  return has_direction(v) ? v / glm::length(v) : fallback;
}

constexpr glm::vec3 kUp{0.0f, 1.0f, 0.0f};

template <class Element>
void gather(std::vector<Element>& values, std::span<const std::uint32_t> sources) {
  if (values.empty()) return;
  std::vector<Element> gathered(sources.size());
  for (std::size_t i = 0; i < sources.size(); ++i) gathered[i] = values[sources[i]];
  values = std::move(gathered);
}

/// Vertex i becomes a copy of vertex `sources[i]`, in every array but the indices.
void gather_vertices(Primitive& primitive, std::span<const std::uint32_t> sources) {
  gather(primitive.positions, sources);
  gather(primitive.normals, sources);
  gather(primitive.tangents, sources);
  gather(primitive.uv0, sources);
  gather(primitive.uv1, sources);
  gather(primitive.colors, sources);
  gather(primitive.joints, sources);
  gather(primitive.weights, sources);
  for (MorphTarget& target : primitive.morph_targets) {
    gather(target.positions, sources);
    gather(target.normals, sources);
    gather(target.tangents, sources);
  }
}

/// As many more vertices, morph targets and all.
void claim_added(Context& context, const Primitive& primitive, std::size_t new_count, const std::string& where) {
  const std::size_t old_count = primitive.positions.size();
  if (new_count > old_count)
    context.vertices.claim((new_count - old_count) * (1 + primitive.morph_targets.size()), where);
}

glm::vec3 face_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  return unit_or(glm::cross(b - a, c - a), kUp);
}

/// The change of flat normals under a morph target, so that they are right at weights 0 and 1.
std::vector<glm::vec3> morphed_normals(const Primitive& primitive, const std::vector<glm::vec3>& displacements) {
  const auto moved = [&](std::size_t i) { return primitive.positions[i] + displacements[i]; };
  std::vector<glm::vec3> changes(primitive.positions.size());
  for (std::size_t i = 0; i < changes.size(); i += 3) {
    const glm::vec3 normal = face_normal(moved(i), moved(i + 1), moved(i + 2));
    for (std::size_t corner = i; corner < i + 3; ++corner) changes[corner] = normal - primitive.normals[corner];
  }
  return changes;
}

void shade_flat(Context& context, const std::string& where, Primitive& primitive) {
  primitive.tangents.clear();  // glTF: without normals, tangents are to be ignored
  claim_added(context, primitive, primitive.indices.size(), where);
  gather_vertices(primitive, primitive.indices);
  std::iota(primitive.indices.begin(), primitive.indices.end(), 0u);
  primitive.normals.resize(primitive.positions.size());
  for (std::size_t i = 0; i < primitive.positions.size(); i += 3) {
    const glm::vec3* p = &primitive.positions[i];
    std::fill_n(&primitive.normals[i], 3, face_normal(p[0], p[1], p[2]));
  }
  for (MorphTarget& target : primitive.morph_targets)
    if (!target.positions.empty()) target.normals = morphed_normals(primitive, target.positions);
}

/// Normals of vertices by the area of the triangles around them.
std::vector<glm::vec3> smooth_normals(const Primitive& primitive) {
  std::vector<glm::vec3> sums(primitive.positions.size(), glm::vec3(0.0f));
  for (std::size_t i = 0; i + 2 < primitive.indices.size(); i += 3) {
    const std::uint32_t* v = &primitive.indices[i];
    const glm::vec3 a = primitive.positions[v[0]];
    const glm::vec3 area = glm::cross(primitive.positions[v[1]] - a, primitive.positions[v[2]] - a);
    for (int corner = 0; corner < 3; ++corner) sums[v[corner]] += area;
  }
  return sums;
}

/// The linear part of KHR_texture_transform: how a step in the mesh's texture coordinates moves in the texture.
glm::mat2 texture_from_uv(const TextureUse& use) {
  const float cosine = std::cos(use.rotation), sine = std::sin(use.rotation);
  return glm::mat2(cosine, -sine, sine, cosine) * glm::mat2(use.scale.x, 0.0f, 0.0f, use.scale.y);
}

void make_from_texture(Context& context, const TextureUse& use, const std::string& where, Primitive& primitive) {
  std::vector<glm::vec2> uvs = use.uv_set == 0 ? primitive.uv0 : primitive.uv1;
  const glm::mat2 transform = texture_from_uv(use);
  for (glm::vec2& uv : uvs) uv = transform * uv;
  TangentMesh made = make_tangents(primitive.positions, primitive.normals, uvs, primitive.indices);
  claim_added(context, primitive, made.tangents.size(), where);
  if (made.tangents.size() > primitive.positions.size()) gather_vertices(primitive, made.source_vertices);
  primitive.indices = std::move(made.indices);
  primitive.tangents = std::move(made.tangents);
}

}  // namespace

void complete_normals(Context& context, const std::string& where, Primitive& primitive) {
  if (primitive.normals.empty()) return shade_flat(context, where, primitive);
  std::vector<glm::vec3> made;
  for (std::size_t i = 0; i < primitive.normals.size(); ++i) {
    glm::vec3& normal = primitive.normals[i];
    if (!has_direction(normal)) {
      if (made.empty()) {
        made = smooth_normals(primitive);
        context.warnings.add(where, "normals without a direction are made anew");
      }
      normal = unit_or(made[i], kUp);
    }
    normal = glm::normalize(normal);
  }
}

void complete_tangents(Context& context, const Material& material, const std::string& where, Primitive& primitive) {
  const TextureUse& use = material.normal_texture;
  if (primitive.tangents.empty()) {
    const std::vector<glm::vec2>& uvs = use.uv_set == 0 ? primitive.uv0 : primitive.uv1;
    if (use.texture != kNone && !uvs.empty()) return make_from_texture(context, use, where, primitive);
    primitive.tangents.resize(primitive.normals.size(), glm::vec4(0.0f));
  }
  for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
    glm::vec4& tangent = primitive.tangents[i];
    const glm::vec3 direction(tangent), normal = primitive.normals[i];
    // One along the normal spans no plane with it.
    if (has_direction(direction) && has_direction(glm::cross(direction / glm::length(direction), normal)))
      tangent = glm::vec4(direction / glm::length(direction), tangent.w < 0.0f ? -1.0f : 1.0f);
    else
      tangent = any_tangent(normal);
  }
}

}  // namespace lightwell::gltf
