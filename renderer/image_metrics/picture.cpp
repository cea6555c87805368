#include "renderer/image_metrics/picture.h"

#include <cmath>
#include <numeric>
#include <string>

namespace lightwell::metrics {

namespace {

std::string size_text(const Picture& picture) {
  return std::to_string(picture.width) + "x" + std::to_string(picture.height);
}

Status check_values(const Picture& picture, const char* which) {
  if (picture.width <= 0 || picture.height <= 0)
    return invalid_input(which, "has no pixels (" + size_text(picture) + ")");
  if (picture.rgb.size() != picture.pixel_count() * 3)
    return invalid_input(which, "is " + size_text(picture) + " but holds " + std::to_string(picture.rgb.size()) +
                                    " values instead of 3 a pixel");
  for (std::size_t i = 0; i < picture.rgb.size(); ++i) {
    if (std::isfinite(picture.rgb[i])) continue;
    const std::size_t pixel = i / 3;
    const std::size_t width = static_cast<std::size_t>(picture.width);
    return invalid_input(which, "has a value that is not finite at pixel (" + std::to_string(pixel % width) + ", " +
                                    std::to_string(pixel / width) + "), channel " + std::string(1, "RGB"[i % 3]));
  }
  return Done{};
}

}  // namespace

double mean_of(const Plane& plane) {
  if (plane.values.empty()) return 0.0;
  return std::accumulate(plane.values.begin(), plane.values.end(), 0.0) / static_cast<double>(plane.values.size());
}

Status check_comparable(const Picture& test, const Picture& reference) {
  if (Status status = check_values(test, "the picture"); !status) return status;
  if (Status status = check_values(reference, "the reference"); !status) return status;
  if (test.width != reference.width || test.height != reference.height)
    return invalid_input("size", "the picture is " + size_text(test) + " and the reference " + size_text(reference));
  if (test.display_referred != reference.display_referred)
    return invalid_input("kind", std::string("one is scene-referred and the other display-referred: the picture is ") +
                                     (test.display_referred ? "display" : "scene") + "-referred");
  return Done{};
}

}  // namespace lightwell::metrics
