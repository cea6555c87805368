#include "renderer/passes/scattered_hits.h"

#include <cstring>
#include <limits>

namespace lightwell {

ScatteredHits::ScatteredHits(lanes::PatchPixels& pixels, TriangleCache& triangles,
                             const lanes::LightEnvironment& environment)
    : pixels_(pixels), triangles_(triangles), environment_(environment) {
  std::memset(&rays_, 0, sizeof rays_);  // lanes without a ray are computed with, too
}

void ScatteredHits::add(std::uint32_t pixel, glm::vec3 from_ws, const lanes::PatchDirection& direction,
                        const Hit& hit) {
  const std::uint32_t lane = count_++;
  rays_.pixel[lane] = pixel;
  for (int axis = 0; axis < 3; ++axis) {
    rays_.from[axis][lane] = from_ws[axis];
    rays_.direction_ws[axis][lane] = direction.direction_ws[axis];
  }
  rays_.pdf[lane] = direction.pdf;
  rays_.t[lane] = hit.t >= 0.0f ? hit.t : std::numeric_limits<float>::infinity();
  rays_.u[lane] = hit.u;
  rays_.v[lane] = hit.v;
  if (hit.t >= 0.0f) {
    rays_.surfaces[lane] = triangles_.at_hit(hit.instance, hit.triangle).surface;
    rays_.side[lane] = side_of(rays_.surfaces[lane], lanes::along(direction));
  }
  if (count_ == lanes::kMostLanes) finish();
}

void ScatteredHits::finish() {
  if (count_ == 0) return;
  lanes::patch_kernels().gather_scattered(pixels_, rays_, count_, environment_);
  for (std::uint32_t lane = 0; lane < count_; ++lane) {
    const std::uint32_t pixel = rays_.pixel[lane];
    for (int channel = 0; channel < 3; ++channel) pixels_.sum[channel][pixel] += rays_.sum[channel][lane];
    pixels_.distance[pixel] += rays_.distance[lane];
    pixels_.hit_count[pixel] += rays_.t[lane] < std::numeric_limits<float>::infinity() ? 1.0f : 0.0f;
  }
  count_ = 0;
}

}  // namespace lightwell
