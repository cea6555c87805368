#include "renderer/image_metrics/compare.h"

#include <cmath>
#include <limits>

#include "renderer/image_metrics/display.h"
#include "renderer/image_metrics/structural_similarity.h"

namespace lightwell::metrics {

namespace {

double peak_signal_to_noise_db(const Picture& test, const Picture& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.rgb.size(); ++i) {
    const double difference = srgb_from_linear(test.rgb[i]) - srgb_from_linear(reference.rgb[i]);
    sum += difference * difference;
  }
  if (sum == 0.0) return std::numeric_limits<double>::infinity();
  return -10.0 * std::log10(sum / static_cast<double>(reference.rgb.size()));
}

}  // namespace

Result<Comparison> compare(const Picture& test, const Picture& reference, double pixels_per_degree) {
  if (Status status = check_comparable(test, reference); !status) return status.error();
  Comparison result;
  result.linear = linear_errors(test, reference);
  const double exposure = exposure_of(reference);
  const Picture shown_test = displayed(test, exposure), shown_reference = displayed(reference, exposure);
  result.psnr_db = peak_signal_to_noise_db(shown_test, shown_reference);
  result.ssim = structural_similarity(shown_test, shown_reference);
  result.error_map = ldr_flip(shown_test, shown_reference, pixels_per_degree);
  result.flip = mean_of(result.error_map);
  if (reference.display_referred) return result;
  result.hdr_exposures = exposure_range(reference);
  result.error_map = hdr_flip(test, reference, result.hdr_exposures, pixels_per_degree);
  result.hdr_flip = mean_of(result.error_map);
  return result;
}

}  // namespace lightwell::metrics
