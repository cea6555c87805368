// .glb and .gltf files, and bytes of a .glb, into a Scene.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Limits on outside data. A file over one of them is refused with kTooLarge.
struct LoadLimits {
  std::uint64_t max_file_bytes = 512ull << 20;
  std::uint64_t max_triangles = 8'000'000;    // over all instances
  std::uint64_t max_vertices = 16'000'000;
  std::uint64_t max_nodes = 100'000;
  std::uint64_t max_image_pixels = 8192ull * 8192;    // of one image
  std::uint64_t max_texture_bytes = 2048ull << 20;  // all decoded images
};

/// Loads a .glb or .gltf. External buffers and images must lie in the file's own folder.
/// Errors name the glTF object and the reason; an unknown required extension is kUnsupported.
Result<Scene> load_gltf(const std::filesystem::path& path, const LoadLimits& limits = {});

/// Loads a .glb from memory; nothing outside the bytes is read.
Result<Scene> load_glb(std::span<const std::byte> bytes, const LoadLimits& limits = {});

}  // namespace lightwell
