#include "renderer/passes/view_choice.h"

#include <algorithm>

namespace lightwell {

namespace {

// From here on the processor is quicker, measured with llvmpipe on four cores and 512x512 pixels: a view of 0.09
// triangles a pixel is drawn in the same time either way. Fewer triangles than the second number are drawn in 2 ms,
// which leaves nothing to win.
constexpr double kTrianglesPerPixel = 0.1, kFewestTriangles = 10'000.0;

constexpr double kMostPixels = 1 << 24;  // hits of more would take over 320 MiB

constexpr float kFarthest = 1e30f;

}  // namespace

ViewRasterizer* ViewChoice::for_view(const DeviceScene& scene, glm::ivec2 size_px) const {
  if (!rasterizer || scene.has_coverage() || scene.has_clear()) return nullptr;
  const double pixels = static_cast<double>(size_px.x) * static_cast<double>(size_px.y);
  if (pixels > kMostPixels) return nullptr;
  const double most_drawn = std::max(kFewestTriangles, kTrianglesPerPixel * pixels);
  return always || static_cast<double>(scene.triangles()) > most_drawn ? rasterizer : nullptr;
}

ViewRays camera_rays(const CameraBlock& camera) {
  ViewRays rays;
  rays.size_px = glm::ivec2(camera.size_px);
  const glm::vec2 ndc_step = 2.0f / glm::vec2(rays.size_px), first_ndc = 0.5f * ndc_step - 1.0f;
  const glm::vec3 right(camera.right_ws), down(camera.down_ws), forward(camera.forward_ws);
  const glm::vec3 first = first_ndc.x * right + first_ndc.y * down;
  const bool perspective = camera.eye_ws.w > 0.5f;
  rays.origin_ws = glm::vec3(camera.eye_ws);
  rays.direction_ws = forward;
  (perspective ? rays.direction_ws : rays.origin_ws) += first;
  (perspective ? rays.direction_across_ws : rays.origin_across_ws) = ndc_step.x * right;
  (perspective ? rays.direction_down_ws : rays.origin_down_ws) = ndc_step.y * down;
  rays.t_min = camera.right_ws.w;
  rays.t_max = perspective ? kFarthest : camera.down_ws.w;
  return rays;
}

ViewRays light_rays(const glm::mat4& clip_from_world, bool placed, glm::vec3 position_ws, int size_px) {
  const glm::mat4 world_from_clip = glm::inverse(clip_from_world);
  const auto in_world = [&](float x, float y, float depth) {
    const glm::vec4 p = world_from_clip * glm::vec4(x, y, depth, 1.0f);
    return glm::vec3(p) / p.w;
  };
  const float step = 2.0f / static_cast<float>(size_px), first = 0.5f * step - 1.0f;
  const float depth = placed ? 1.0f : 0.0f;
  const glm::vec3 corner = in_world(first, first, depth);
  const glm::vec3 across = in_world(first + step, first, depth) - corner;
  const glm::vec3 down = in_world(first, first + step, depth) - corner;
  ViewRays rays;
  rays.size_px = glm::ivec2(size_px);
  rays.t_max = 1.0f;
  if (placed) {
    rays.origin_ws = position_ws;
    rays.direction_ws = corner - position_ws;
    rays.direction_across_ws = across;
    rays.direction_down_ws = down;
  } else {
    rays.origin_ws = corner;
    rays.origin_across_ws = across;
    rays.origin_down_ws = down;
    rays.direction_ws = in_world(first, first, 1.0f) - corner;
  }
  return rays;
}

}  // namespace lightwell
