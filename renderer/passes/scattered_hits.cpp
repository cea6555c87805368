#include "renderer/passes/scattered_hits.h"

#include <cstring>
#include <limits>

namespace lightwell {

namespace {

// Adds a lane's sum to its pixel's, and starts it anew.
void take(lanes::PixelFloats& to, lanes::PixelFloats& from, std::uint32_t pixel, std::uint32_t lane) {
  to[pixel] += from[lane];
  from[lane] = 0.0f;
}

}  // namespace

ScatteredHits::ScatteredHits(lanes::PatchPixels& pixels, TriangleCache& triangles,
                             const lanes::LightEnvironment& environment)
    : pixels_(pixels), triangles_(triangles), environment_(environment) {
  std::memset(&lane_pixels_, 0, sizeof lane_pixels_);  // lanes without a ray are computed with, too
  std::memset(&rays_, 0, sizeof rays_);
}

void ScatteredHits::add(std::uint32_t pixel, const lanes::PatchDirection& direction, const Hit& hit) {
  const std::uint32_t lane = count_++;
  pixel_of_lane_[lane] = pixel;
  const auto* rows = reinterpret_cast<const lanes::PixelFloats*>(&pixels_);
  auto* lane_rows = reinterpret_cast<lanes::PixelFloats*>(&lane_pixels_);
  for (std::size_t row = lanes::kFirstReceiverRow; row < lanes::kReceiverRowsEnd; ++row)
    lane_rows[row][lane] = rows[row][pixel];
  for (int axis = 0; axis < 3; ++axis) {
    lane_pixels_.from[axis][lane] = pixels_.from[axis][pixel];
    rays_.direction_ws[axis][lane] = direction.direction_ws[axis];
  }
  rays_.pdf[lane] = direction.pdf;
  lane_pixels_.t[lane] = hit.t >= 0.0f ? hit.t : std::numeric_limits<float>::infinity();
  lane_pixels_.u[lane] = hit.u;
  lane_pixels_.v[lane] = hit.v;
  if (hit.t >= 0.0f) add_surface(lane, triangles_.at(hit.instance, hit.triangle).surface, lanes::along(direction));
  if (count_ == lanes::kMostLanes) finish();
}

void ScatteredHits::add_surface(std::uint32_t lane, const lanes::HitSurface& surface, glm::vec3 direction) {
  const float side = side_of(surface, direction);
  for (int axis = 0; axis < 3; ++axis) {
    for (int corner = 0; corner < 3; ++corner) rays_.normals[corner][axis][lane] = side * surface.normals[corner][axis];
    rays_.geometric_normal[axis][lane] = side * surface.geometric_normal[axis];
    rays_.base_color[axis][lane] = surface.base_color[axis];
    rays_.emission[axis][lane] = surface.emission[axis];
  }
  rays_.metallic[lane] = surface.metallic;
  rays_.roughness[lane] = surface.roughness;
  rays_.f0_dielectric[lane] = surface.f0_dielectric;
  rays_.specular_factor[lane] = surface.specular_factor;
  rays_.lit[lane] = surface.unlit ? 0.0f : 1.0f;
}

void ScatteredHits::finish() {
  if (count_ == 0) return;
  lanes::patch_kernels().gather_scattered(lane_pixels_, rays_, count_, environment_);
  for (std::uint32_t lane = 0; lane < count_; ++lane) {
    const std::uint32_t pixel = pixel_of_lane_[lane];
    for (int channel = 0; channel < 3; ++channel) take(pixels_.sum[channel], lane_pixels_.sum[channel], pixel, lane);
    take(pixels_.distance, lane_pixels_.distance, pixel, lane);
    take(pixels_.hit_count, lane_pixels_.hit_count, pixel, lane);
  }
  count_ = 0;
}

}  // namespace lightwell
