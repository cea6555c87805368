// Feeds the glTF loader. An input that begins with "glTF" is a container as it stands; any other is JSON up to the
// first zero byte and binary data after it, so that changes need not first find their way past the container's lengths.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "renderer/scene/gltf/load_gltf.h"
#include "tests/unit/gltf_builder.h"

namespace {

using lightwell::ByteVector;

/// Small, so that an input is slow only where it should not be.
constexpr lightwell::LoadLimits kLimits{.max_file_bytes = 1 << 20,
                                        .max_triangles = 20'000,
                                        .max_vertices = 50'000,
                                        .max_nodes = 1'000,
                                        .max_animation_values = 100'000,
                                        .max_image_pixels = 256 * 256,
                                        .max_texture_bytes = 1 << 20};

ByteVector container_of(std::span<const std::byte> input) {
  const auto end = std::find(input.begin(), input.end(), std::byte{0});
  std::string json;
  for (auto byte = input.begin(); byte != end; ++byte) json += std::to_integer<char>(*byte);
  return lightwell::make_glb(std::move(json), ByteVector(end == input.end() ? end : end + 1, input.end()));
}

/// What Scene promises to those who come after the loader.
void check(const lightwell::Scene& scene) {
  const auto require = [](bool holds) {
    if (!holds) std::abort();
  };
  for (const auto& mesh : scene.meshes)
    for (const lightwell::Primitive& primitive : mesh->primitives) {
      const std::size_t count = primitive.positions.size();
      require(primitive.normals.size() == count && primitive.tangents.size() == count);
      require(primitive.joints.size() == primitive.weights.size());
      require(!primitive.indices.empty() && primitive.indices.size() % 3 == 0);
      require(*std::max_element(primitive.indices.begin(), primitive.indices.end()) < count);
      for (const glm::vec3& normal : primitive.normals) require(std::abs(glm::length(normal) - 1.0f) < 1e-3f);
      for (const glm::vec4& tangent : primitive.tangents)
        require(std::abs(glm::length(glm::vec3(tangent)) - 1.0f) < 1e-3f && std::abs(tangent.w) == 1.0f);
    }
  for (const lightwell::Node& node : scene.nodes) {
    require(node.mesh < static_cast<int>(scene.meshes.size()) && node.parent < static_cast<int>(scene.nodes.size()));
    for (const int child : node.children) require(child >= 0 && child < static_cast<int>(scene.nodes.size()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> input(reinterpret_cast<const std::byte*>(data), size);
  constexpr char kMagic[] = {'g', 'l', 'T', 'F'};
  const bool is_container = size >= 4 && std::equal(kMagic, kMagic + 4, data);
  const ByteVector glb = is_container ? ByteVector(input.begin(), input.end()) : container_of(input);
  if (const lightwell::Result<lightwell::Scene> scene = lightwell::load_glb(glb, kLimits)) check(*scene);
  return 0;
}
