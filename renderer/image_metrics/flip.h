// FLIP, the difference a viewer sees when alternating between two pictures.
// LDR: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020. HDR: Andersson, Nilsson, Shirley, Akenine-Moeller, "Visualizing Errors in Rendered High Dynamic
// Range Images", Eurographics 2021.
#pragma once

#include "renderer/image_metrics/picture.h"

namespace lightwell::metrics {

/// Pixels of the display per degree of the viewer's field of view: the papers' 0.7 m wide 4K display at 0.7 m.
constexpr double kDefaultPixelsPerDegree = 67.0206432765823;

/// The LDR error of each pixel, 0 (no difference) to 1. Pictures are displayed ones: linear, 0..1, of one size.
Plane ldr_flip(const Picture& test, const Picture& reference, double pixels_per_degree = kDefaultPixelsPerDegree);

/// The exposures (stops: light is scaled by 2^stop) at which HDR-FLIP looks, chosen from the reference.
struct ExposureRange {
  double start = 0.0;
  double stop = 0.0;
  int count = 1;
};

/// The paper's automatic range under the ACES tone curve: from where the brightest pixel comes out at 0.85 to where the
/// median does. At most 24 stops above the start (a median of 0 has no exposure); one exposure of 0 if all is black.
ExposureRange exposure_range(const Picture& reference);

/// The HDR error of each pixel: the greatest LDR error over the exposures. Pictures are scene-referred, of one size.
Plane hdr_flip(const Picture& test, const Picture& reference, const ExposureRange& range,
               double pixels_per_degree = kDefaultPixelsPerDegree);

}  // namespace lightwell::metrics
