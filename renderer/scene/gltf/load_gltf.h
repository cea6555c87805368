// .glb and .gltf files, and bytes of a .glb, into a Scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Limits on outside data. A file over one of them is refused with kTooLarge, before memory is taken for the excess.
struct LoadLimits {
  std::uint64_t max_file_bytes = 512ull << 20;      // of the file, of all it refers to, of all encoded images
  std::uint64_t max_triangles = 8'000'000;          // over all meshes, and over all instances
  std::uint64_t max_vertices = 16'000'000;          // over all meshes; a morph target counts its vertices again
  std::uint64_t max_nodes = 100'000;                // with the instances of EXT_mesh_gpu_instancing
  std::uint64_t max_animation_values = 64'000'000;  // numbers in all animations and skins
  std::uint64_t max_image_pixels = 8192ull * 8192;  // of one image
  std::uint64_t max_texture_bytes = 2048ull << 20;  // all decoded images
};

/// Loads a .glb or .gltf, told apart by content. External buffers and images must lie in the file's own folder.
/// Objects keep the numbers they have in the file, save for images, of which only those in use are kept; nodes that
/// EXT_mesh_gpu_instancing makes come last. Nodes outside the shown scene keep their place but show nothing.
/// What cannot be honoured is told in Scene::warnings. Errors name the glTF object and the reason: `where` is a path
/// through the document ("meshes/2/primitives/0/indices"), "glb" for the container, "json" for its syntax, or the
/// file's name if the file itself cannot be read. An unknown required extension is kUnsupported. A file with meshes but
/// without a single triangle is refused; one without any mesh is not.
Result<Scene> load_gltf(const std::filesystem::path& path, const LoadLimits& limits = {});

/// Loads a .glb from memory; nothing outside the bytes is read.
Result<Scene> load_glb(std::span<const std::byte> bytes, const LoadLimits& limits = {});

}  // namespace lightwell
