// The meter: how far one picture is from another, by every measure at once.
#pragma once

#include <optional>

#include "renderer/image_metrics/error_measures.h"
#include "renderer/image_metrics/flip.h"

namespace lightwell::metrics {

/// A picture against a reference. Linear errors are of the light itself. PSNR, SSIM and LDR-FLIP are of the pictures as
/// a display shows them: scene-referred ones are exposed alike, so that the reference's mean luminance is 0.18, and
/// tone-mapped with Khronos PBR Neutral; display-referred ones are taken as they are.
struct Comparison {
  LinearErrors linear;
  double psnr_db = 0.0;            // of the sRGB-encoded pictures, peak 1; infinite if they are equal
  std::optional<double> ssim;      // none if a side is below 11 pixels
  double flip = 0.0;               // mean LDR-FLIP
  std::optional<double> hdr_flip;  // mean HDR-FLIP; none for display-referred pictures
  ExposureRange hdr_exposures;     // where HDR-FLIP looked
  Plane error_map;                 // FLIP of each pixel: HDR where there is one, else LDR
};

/// kInvalidInput where check_comparable says so.
Result<Comparison> compare(const Picture& test, const Picture& reference,
                           double pixels_per_degree = kDefaultPixelsPerDegree);

}  // namespace lightwell::metrics
