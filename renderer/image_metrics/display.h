// From linear light to what a display shows: the picture that the perceptual measures look at.
#pragma once

#include <array>

#include "renderer/image_metrics/picture.h"

namespace lightwell::metrics {

/// The sRGB transfer curve (IEC 61966-2-1), both ways; 0..1 to 0..1.
double srgb_from_linear(double linear);
double linear_from_srgb(double encoded);

/// The Khronos PBR Neutral tone mapper: linear to linear 0..1, hue kept, true to base colours below 0.8.
/// Specification: Khronos glTF PBR Neutral Tone Mapper.
std::array<double, 3> neutral_tone_map(std::array<double, 3> linear);

/// The factor that exposes both pictures of a comparison: it brings the reference's mean luminance to 0.18.
/// 1 for display-referred pictures and for a reference without light.
double exposure_of(const Picture& reference);

/// As a display shows it, still linear: exposed and tone-mapped if scene-referred; all values 0..1.
Picture displayed(const Picture& picture, double exposure);

}  // namespace lightwell::metrics
