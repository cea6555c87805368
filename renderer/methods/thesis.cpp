#include "renderer/methods/thesis.h"

#include <algorithm>
#include <utility>

namespace lightwell {

namespace {

// Rays in flight at once: 32 MiB of rays on the device, whatever the settings.
constexpr std::uint32_t kMostRays = 1u << 20;

std::uint32_t directions_per_batch(const IndirectMapGrid& grid, int samples) {
  return std::clamp(kMostRays / grid.most_slots(), 1u, static_cast<std::uint32_t>(samples));
}

// The van der Corput and Halton points: where in its block the representative pixel lies in the n-th frame.
float radical_inverse(std::uint32_t n, std::uint32_t base) {
  float value = 0.0f, scale = 1.0f / static_cast<float>(base);
  for (; n > 0; n /= base, scale /= static_cast<float>(base)) value += static_cast<float>(n % base) * scale;
  return value;
}

IndirectMapGrid make_grid(const FrameContext& frame) {
  IndirectMapGrid grid = IndirectMapGrid::over(frame.size_px, frame.settings.indirect_size);
  if (frame.frame_number > 0)
    grid.jitter = {radical_inverse(frame.frame_number, 2), radical_inverse(frame.frame_number, 3)};
  return grid;
}

}  // namespace

ThesisMethod::ThesisMethod(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : g_buffer_pass_(shaders),
      shadow_maps_pass_(shaders),
      active_blocks_pass_(shaders),
      directions_pass_(shaders, buffers),
      hit_light_pass_(shaders),
      gather_pass_(shaders),
      filter_pass_(shaders),
      add_maps_pass_(shaders),
      compose_pass_(shaders),
      occlusion_(buffers) {}

const Picture& ThesisMethod::render(FrameContext& frame) {
  const IndirectMapGrid grid = make_grid(frame);
  resize(frame, grid);
  const GBuffer& g_buffer = g_buffer_pass_.run(frame.scene, frame.settings.seed + frame.frame_number);
  frame.timer.mark("g-buffer");
  const ShadowMaps& shadows = shadow_maps_pass_.run(frame.scene, frame.pose);
  frame.timer.mark("shadow maps");
  const IndirectMap& indirect = indirect_light(frame, g_buffer, shadows, grid);
  const Picture& picture =
      compose_pass_.run(frame.scene, g_buffer, shadows, indirect, gather_pass_, frame.settings, frame.accumulate);
  frame.timer.mark("compose");
  return picture;
}

void ThesisMethod::resize(const FrameContext& frame, const IndirectMapGrid& grid) {
  g_buffer_pass_.resize(frame.size_px);
  shadow_maps_pass_.resize(frame.settings.shadow_size, frame.settings.shadow_filter,
                           ShadowMapsPass::layers_for(frame.pose));
  compose_pass_.resize(g_buffer_pass_.g_buffer().depth);
  const std::uint32_t most_rays = grid.most_slots() * directions_per_batch(grid, frame.settings.samples);
  active_blocks_pass_.resize(grid);
  directions_pass_.resize(most_rays);
  occlusion_.resize(most_rays);
  gather_pass_.resize(grid.map_size_px);
  filter_pass_.resize(grid.map_size_px);
  if (all_bounces_.image && all_bounces_.image.size_px() == grid.map_size_px) return;
  bounce_ = make_indirect_map(grid.map_size_px);
  previous_bounce_ = make_indirect_map(grid.map_size_px);
  all_bounces_ = make_indirect_map(grid.map_size_px);
}

const IndirectMap& ThesisMethod::indirect_light(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                                const IndirectMapGrid& grid) {
  if (frame.settings.bounces == 0) {
    all_bounces_.image.clear(glm::vec4(0.0f));
    return all_bounces_;
  }
  traced_ = nullptr;
  active_blocks_ = &active_blocks_pass_.run(g_buffer, grid);
  for (int bounce = 1; bounce <= frame.settings.bounces; ++bounce) {
    gather_bounce(frame, g_buffer, shadows, grid, bounce);
    if (frame.settings.denoise) {
      filter_pass_.run(gather_pass_.guide(), bounce_);
      frame.timer.mark("filter");
    }
    add_maps_pass_.run(bounce_, all_bounces_, bounce == 1);
    std::swap(bounce_, previous_bounce_);
    frame.timer.mark("gather");
  }
  return all_bounces_;
}

// The directions [first, first + batch) and their hits. A single batch is made and traced once for all bounces.
Directions& ThesisMethod::trace_batch(FrameContext& frame, const GBuffer& g_buffer, const IndirectMapGrid& grid,
                                      std::uint32_t first, std::uint32_t batch) {
  if (traced_ != nullptr && traced_->first == first) return *traced_;
  const auto samples = static_cast<std::uint32_t>(frame.settings.samples);
  const std::uint32_t seed = frame.settings.seed * 0x9e3779b9u + frame.frame_number;
  traced_ = &directions_pass_.run(frame.scene, g_buffer, grid, *active_blocks_, first, std::min(batch, samples - first),
                                  seed);
  frame.timer.mark("directions");
  frame.tracer.closest_hit(traced_->rays, traced_->ray_count, occlusion_.hits, &occlusion_.list);
  frame.rays += traced_->ray_count;
  frame.timer.mark("trace");
  return *traced_;
}

void ThesisMethod::gather_bounce(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                 const IndirectMapGrid& grid, int bounce) {
  const auto samples = static_cast<std::uint32_t>(frame.settings.samples);
  const std::uint32_t batch = directions_per_batch(grid, frame.settings.samples);
  const bool literal = frame.settings.estimator == Estimator::kLiteral;
  for (std::uint32_t first = 0; first < samples; first += batch) {
    Directions& directions = trace_batch(frame, g_buffer, grid, first, batch);
    if (bounce == 1)
      hit_light_pass_.run(frame.scene, occlusion_, shadows, literal, directions);
    else
      hit_light_pass_.run_from_screen(g_buffer, occlusion_, previous_bounce_.image, literal, directions);
    frame.timer.mark(bounce == 1 ? "light of hits" : "light from screen");
    gather_pass_.run(frame.scene, g_buffer, grid, *active_blocks_, directions, occlusion_,
                     {samples, literal, bounce == 1 && !literal}, bounce_);
    frame.timer.mark("gather");
  }
}

}  // namespace lightwell
