#include "renderer/scene/scene.h"

namespace lightwell {

std::uint64_t count_triangles(const Scene& scene) {
  std::uint64_t triangles = 0;
  for (const Node& node : scene.nodes) {
    if (node.mesh < 0) continue;
    for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)]->primitives)
      triangles += primitive.indices.size() / 3;
  }
  return triangles;
}

}  // namespace lightwell
