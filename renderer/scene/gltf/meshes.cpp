#include "renderer/scene/gltf/meshes.h"

#include <algorithm>
#include <optional>

#include "renderer/scene/bounds.h"
#include "renderer/scene/gltf/accessors.h"
#include "renderer/scene/gltf/numbers.h"
#include "renderer/scene/gltf/shading_frames.h"
#include "renderer/scene/gltf/triangles.h"
#include "renderer/scene/gltf/vertex_attributes.h"

namespace lightwell::gltf {
namespace {

const Material& material_of(const Scene& scene, int index, const std::string& where) {
  static const Material kDefault;
  return index == kNone ? kDefault : at(scene.materials, index, join(where, "material"));
}

/// Nothing if the primitive shows nothing.
std::optional<Primitive> read_primitive(Context& context, const tinygltf::Primitive& source, const Scene& scene,
                                        const std::string& where) {
  const Material& material = material_of(scene, source.material, where);
  const int positions = find_attribute(source.attributes, "POSITION");
  if (positions == kNone) {
    context.warnings.add(where, "has no positions and is left out");
    return std::nullopt;
  }
  const std::size_t vertex_count = find_accessor(context, positions, join(where, "attributes/POSITION")).count;
  context.vertices.claim(vertex_count, where);
  Primitive primitive;
  primitive.indices = read_triangles(context, source, vertex_count, where);
  if (primitive.indices.empty()) return std::nullopt;
  primitive.material = source.material;
  read_vertices(context, source, vertex_count, where, primitive);
  complete_normals(context, where, primitive);
  complete_tangents(context, material, where, primitive);
  fill_bounds(primitive);
  return primitive;
}

/// Every primitive of a mesh must have as many morph targets as there are weights.
void match_morph_targets(Context& context, const tinygltf::Mesh& source, const std::string& where, Mesh& mesh) {
  std::size_t count = 0;
  for (const Primitive& primitive : mesh.primitives) count = std::max(count, primitive.morph_targets.size());
  for (Primitive& primitive : mesh.primitives) {
    if (primitive.morph_targets.size() < count)
      context.warnings.add(where, "has primitives with different numbers of morph targets");
    primitive.morph_targets.resize(count);
  }
  if (!source.weights.empty() && source.weights.size() != count)
    context.warnings.add(where, "has " + std::to_string(source.weights.size()) + " weights for " +
                                    std::to_string(count) + " morph targets");
  for (std::size_t i = 0; i < count; ++i)
    mesh.weights.push_back(i < source.weights.size() ? to_float(source.weights[i]) : 0.0f);
}

Mesh read_mesh(Context& context, const tinygltf::Mesh& source, const Scene& scene, const std::string& where) {
  Mesh mesh;
  mesh.name = source.name;
  for (std::size_t i = 0; i < source.primitives.size(); ++i)
    if (std::optional<Primitive> primitive =
            read_primitive(context, source.primitives[i], scene, join(join(where, "primitives"), i)))
      mesh.primitives.push_back(std::move(*primitive));
  match_morph_targets(context, source, where, mesh);
  return mesh;
}

}  // namespace

void read_meshes(Context& context, Scene& scene) {
  const std::vector<tinygltf::Mesh>& meshes = context.document.model.meshes;
  bool any_triangle = false;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    auto mesh = std::make_shared<const Mesh>(read_mesh(context, meshes[i], scene, join("meshes", i)));
    any_triangle |= !mesh->primitives.empty();
    scene.meshes.push_back(std::move(mesh));
  }
  if (meshes.empty())
    context.warnings.add("meshes", "the file has no mesh");
  else if (!any_triangle)
    fail("meshes", "none of the file's meshes has a triangle");
}

}  // namespace lightwell::gltf
