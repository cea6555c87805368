// An environment map from a picture file, as the operator of the program names it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// The most pixels an environment map may have, and the brightest texel, in nit.
inline constexpr std::uint64_t kMaxEnvironmentPixels = 8192ull * 4096;
inline constexpr float kMaxEnvironmentRadiance = 1e9f;

/// Reads a latitude-longitude picture (.exr, .hdr; others are decoded from sRGB), row 0 the zenith, its middle column
/// towards -Z. Negative values, which filters leave behind in such files, become 0; anything that is not finite or
/// above kMaxEnvironmentRadiance is kInvalidInput and named by its pixel. More than `max_pixels` is kTooLarge.
Result<std::shared_ptr<const ImageHdr>> read_environment(const std::filesystem::path& path,
                                                         std::uint64_t max_pixels = kMaxEnvironmentPixels);

/// What is given for a scene's environment; empty members leave the scene's own.
struct EnvironmentChoice {
  std::string file;
  std::optional<float> rotation;  // radians about +Y
  std::optional<float> strength;  // 0 or more

  /// Whether all but the scene's own light is asked away: then it gets no default light either.
  bool is_dark() const { return strength == 0.0f; }
};

/// Changes the scene's environment; the scene stays as it is where the file is refused.
Status apply_environment(const EnvironmentChoice& choice, Environment& environment);

}  // namespace lightwell
