// Keyframes into values, as glTF 2.0 (appendix C) defines step, linear, spherical linear and cubic-spline
// interpolation.
#pragma once

#include <span>

#include "renderer/scene/scene.h"

namespace lightwell {

/// Seconds into an animation of `duration_s` after `time_s` seconds of playback. It repeats after its duration;
/// a negative or non-finite time counts as 0, as does every time of an animation without duration.
float local_time_s(double time_s, float duration_s);

/// The value at `time_s` of keyframes with `out.size()` floats per key (three times as many in `values` for cubic
/// splines). Times before the first or after the last key clamp to it. False, and `out` untouched, when there are no
/// keys or `values` is too short for them.
bool sample_keyframes(std::span<const float> times_s, std::span<const float> values, Interpolation interpolation,
                      float time_s, std::span<float> out);

/// The same for unit quaternions (x, y, z, w): spherical along the shorter way for linear keys, and always normalised.
bool sample_rotation(std::span<const float> times_s, std::span<const float> values, Interpolation interpolation,
                     float time_s, glm::quat& out);

}  // namespace lightwell
