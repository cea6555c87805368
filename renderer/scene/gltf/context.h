// What every reader of the loader works with.
#pragma once

#include <cstdint>
#include <string>

#include "renderer/scene/gltf/asset_files.h"
#include "renderer/scene/gltf/diagnostics.h"
#include "renderer/scene/gltf/document.h"
#include "renderer/scene/gltf/load_gltf.h"

namespace lightwell::gltf {

/// Counts something that a file may have only so much of, before memory is taken for it.
class Budget {
 public:
  Budget(const char* things, std::uint64_t most) : things_(things), most_(most) {}

  /// Throws Failure with kTooLarge if more than the limit have been claimed in all.
  void claim(std::uint64_t count, const std::string& where) {
    if (count > most_ - claimed_)
      fail(where, "the file has more than " + std::to_string(most_) + " " + things_, ErrorKind::kTooLarge);
    claimed_ += count;
  }
  std::uint64_t left() const { return most_ - claimed_; }

 private:
  const char* things_;
  std::uint64_t most_, claimed_ = 0;
};

struct Context {
  const Document& document;
  AssetFiles& files;
  const LoadLimits& limits;
  Warnings& warnings;
  Budget vertices{"vertices (morph targets count too)", limits.max_vertices};
  Budget triangles{"triangles", limits.max_triangles};
  Budget animation_values{"numbers in animations and skins", limits.max_animation_values};
  Budget encoded_image_bytes{"bytes of encoded images", limits.max_file_bytes};
  Budget decoded_image_bytes{"bytes of decoded images", limits.max_texture_bytes};
};

}  // namespace lightwell::gltf
