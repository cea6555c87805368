#include "renderer/methods/thesis.h"

#include <algorithm>
#include <utility>

namespace lightwell {

namespace {

// Records of the occlusion map at once, and candidates of patches: 32 to 96 MiB on the device, whatever the settings.
constexpr std::uint32_t kMostRecords = 1u << 21, kMostCandidates = 1u << 22;

// Candidates at once where there are no records: how many patches there are is known by then.
std::uint32_t directions_per_host_batch(std::uint32_t patches, const Settings& settings) {
  const std::uint32_t most =
      kMostCandidates / 4 / std::max(patches * static_cast<std::uint32_t>(settings.triangle_groups), 1u);
  return std::clamp(most, 1u, static_cast<std::uint32_t>(settings.samples));
}

bool needs_guide(const Settings& settings) {
  return settings.denoise || settings.view == ViewKind::kOcclusionDistance;
}

// Whether the processor scales up and gathers: views of records need records, and so do further bounces.
bool gathers_on_host(const FrameContext& frame) {
  const Settings& settings = frame.settings;
  return frame.tracer.host() != nullptr && have_candidates(settings) && settings.bounces == 1 &&
         settings.estimator == Estimator::kCorrected && HostGatherPass::knows(frame.scene) &&
         !MapViewPass::shows(settings.view);
}

// Clear surfaces take four times as much for each record.
std::uint32_t directions_per_batch(const IndirectMapGrid& grid, const Settings& settings, bool clear_surfaces) {
  const std::uint32_t by_records = (clear_surfaces ? kMostRecords / 4 : kMostRecords) / grid.most_slots();
  const std::uint32_t by_candidates =
      kMostCandidates / (most_patches(grid, settings) * static_cast<std::uint32_t>(settings.triangle_groups));
  return std::clamp(std::min(by_records, by_candidates), 1u, static_cast<std::uint32_t>(settings.samples));
}

// The van der Corput and Halton points: where in its block the representative pixel lies in the n-th frame.
float radical_inverse(std::uint32_t n, std::uint32_t base) {
  float value = 0.0f, scale = 1.0f / static_cast<float>(base);
  for (; n > 0; n /= base, scale /= static_cast<float>(base)) value += static_cast<float>(n % base) * scale;
  return value;
}

IndirectMapGrid make_grid(const FrameContext& frame) {
  IndirectMapGrid grid = IndirectMapGrid::over(frame.size_px, frame.settings.indirect_size);
  grid.patch_side = frame.settings.patch;
  if (frame.frame_number > 0)
    grid.jitter = {radical_inverse(frame.frame_number, 2), radical_inverse(frame.frame_number, 3)};
  return grid;
}

}  // namespace

ThesisMethod::ThesisMethod(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : g_buffer_pass_(shaders),
      shadow_maps_pass_(shaders),
      active_blocks_pass_(shaders),
      patches_pass_(shaders, buffers),
      directions_pass_(shaders, buffers),
      clear_hits_pass_(shaders, buffers),
      hit_light_pass_(shaders),
      gather_pass_(shaders),
      filter_pass_(shaders),
      add_maps_pass_(shaders),
      map_view_pass_(shaders),
      compose_pass_(shaders),
      occlusion_(buffers),
      candidates_("candidates", 0, buffers),
      candidates_of_group_("candidates of a group", 0, buffers),
      clear_g_buffer_pass_(shaders),
      clear_layers_pass_(shaders),
      clear_compose_pass_(shaders) {}

const Picture& ThesisMethod::render(FrameContext& frame) {
  const bool traces_anew = have_candidates(frame.settings) && frame.settings.trace_missed;
  if (traces_anew) occlusion_.list.forget_traced();
  const Picture& picture = render_layers(frame);
  if (traces_anew) frame.rays += occlusion_.list.traced_anew();
  return picture;
}

const Picture& ThesisMethod::render_layers(FrameContext& frame) {
  const IndirectMapGrid grid = make_grid(frame);
  resize(frame, grid);
  const bool clear = frame.scene.has_clear();
  const GBuffer& g_buffer = g_buffer_pass_.run(frame.scene, frame.camera, frame.settings.seed + frame.frame_number,
                                               nullptr, clear ? GBufferLayer::kBehindClear : GBufferLayer::kAll);
  frame.timer.mark("g-buffer");
  const ShadowMaps& shadows = shadow_maps_pass_.run(frame.scene, frame.pose, frame.camera.choice);
  frame.timer.mark("shadow maps");
  const IndirectMap& indirect = indirect_light(frame, g_buffer, shadows, grid);
  const bool layered = clear && shows_clear_surfaces(frame.settings.view);
  const Picture& picture = compose_pass_.run(frame.scene, g_buffer, shadows, indirect, gather_pass_, map_view_pass_,
                                             frame.settings, frame.accumulate && !layered);
  frame.timer.mark("compose");
  return layered ? clear_surfaces_over(picture, frame, g_buffer, shadows, grid) : picture;
}

// The nearest clear surface of each pixel, with the light it reflects, over what is behind it.
const Picture& ThesisMethod::clear_surfaces_over(const Picture& behind, FrameContext& frame, const GBuffer& g_buffer,
                                                 const ShadowMaps& shadows, const IndirectMapGrid& grid) {
  clear_layers_pass_.resize(frame.size_px);
  clear_g_buffer_pass_.resize(frame.size_px);
  const gl::Texture& layers = clear_layers_pass_.run(frame.scene, g_buffer);
  const GBuffer& front = clear_g_buffer_pass_.run(frame.scene, frame.camera, frame.settings.seed + frame.frame_number,
                                                  nullptr, GBufferLayer::kClearAlone);
  frame.timer.mark("g-buffer");
  const IndirectMap& indirect = reflected_by_clear(frame, front, g_buffer, shadows, grid);
  clear_compose_pass_.resize(front.depth);
  const Picture& picture = clear_compose_pass_.run_over({behind, layers}, frame.scene, front, shadows, indirect,
                                                        gather_pass_, frame.settings, frame.accumulate);
  frame.timer.mark("compose");
  return picture;
}

// The first bounce as elsewhere, all further ones at once from what the camera sees behind the clear surfaces.
const IndirectMap& ThesisMethod::reflected_by_clear(FrameContext& frame, const GBuffer& front, const GBuffer& g_buffer,
                                                    const ShadowMaps& shadows, const IndirectMapGrid& grid) {
  const bool alone = frame.settings.view == ViewKind::kBounce;
  all_bounces_.image.clear(glm::vec4(0.0f));
  if (frame.settings.bounces == 0) return all_bounces_;
  traced_ = nullptr;
  find_patches(frame, front, grid);
  const auto add = [&](const ScreenLight* screen, bool first) {
    gather_bounce(frame, front, shadows, grid, screen);
    if (frame.settings.denoise) filter_pass_.run(gather_pass_.guide(), bounce_);
    add_maps_pass_.run(bounce_, all_bounces_, first);
  };
  const ScreenLight screen{g_buffer, seen_light_.image};
  const int bounces = alone ? frame.settings.view_index : frame.settings.bounces;
  if (!alone || bounces == 1) add(nullptr, true);
  if (bounces > 1) add(&screen, alone);
  frame.timer.mark("gather");
  return all_bounces_;
}

void ThesisMethod::resize(const FrameContext& frame, const IndirectMapGrid& grid) {
  g_buffer_pass_.resize(frame.size_px);
  shadow_maps_pass_.resize(frame.settings.shadow_size, frame.settings.shadow_filter,
                           ShadowMapsPass::layers_for(frame.pose));
  compose_pass_.resize(g_buffer_pass_.g_buffer().depth);
  active_blocks_pass_.resize(grid);
  patches_pass_.resize(grid, frame.settings);
  resize_maps(grid);
  if (gathers_on_host(frame)) return;
  const std::uint32_t batch = directions_per_batch(grid, frame.settings, frame.scene.has_clear());
  if (frame.scene.has_clear()) clear_hits_pass_.resize(grid.most_slots() * batch);
  const std::uint32_t most_rays = most_patches(grid, frame.settings) * batch;
  directions_pass_.resize(most_rays);
  occlusion_.resize(grid.most_slots() * batch);
  const auto groups = static_cast<std::uint32_t>(frame.settings.triangle_groups);
  if (have_candidates(frame.settings)) candidates_.reserve(std::uint64_t{most_rays} * groups * sizeof(Hit));
  if (groups > 1) candidates_of_group_.reserve(std::uint64_t{most_rays} * sizeof(Hit));
}

void ThesisMethod::resize_maps(const IndirectMapGrid& grid) {
  map_view_pass_.resize(grid.map_size_px);
  gather_pass_.resize(grid.map_size_px);
  filter_pass_.resize(grid.map_size_px);
  if (all_bounces_.image && all_bounces_.image.size_px() == grid.map_size_px) return;
  bounce_ = make_indirect_map(grid.map_size_px);
  previous_bounce_ = make_indirect_map(grid.map_size_px);
  seen_light_ = make_indirect_map(grid.map_size_px);
  all_bounces_ = make_indirect_map(grid.map_size_px);
}

const IndirectMap& ThesisMethod::indirect_light(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                                const IndirectMapGrid& grid) {
  if (frame.settings.bounces == 0) {
    all_bounces_.image.clear(glm::vec4(0.0f));
    return all_bounces_;
  }
  traced_ = nullptr;
  find_patches(frame, g_buffer, grid);
  if (gathers_on_host(frame)) {
    gather_on_host(frame, g_buffer, shadows, grid);
    return all_bounces_;
  }
  for (int bounce = 1; bounce <= frame.settings.bounces; ++bounce) {
    const ScreenLight screen{g_buffer, previous_bounce_.image};
    gather_bounce(frame, g_buffer, shadows, grid, bounce == 1 ? nullptr : &screen);
    if (frame.settings.denoise) {
      filter_pass_.run(gather_pass_.guide(), bounce_);
      frame.timer.mark("filter");
    }
    const bool alone = frame.settings.view == ViewKind::kBounce;
    if (!alone || bounce == frame.settings.view_index) add_maps_pass_.run(bounce_, all_bounces_, alone || bounce == 1);
    // What clear surfaces reflect of it is one bounce more.
    if (frame.scene.has_clear() && (alone ? bounce + 1 == frame.settings.view_index : bounce < frame.settings.bounces))
      add_maps_pass_.run(bounce_, seen_light_, alone || bounce == 1);
    std::swap(bounce_, previous_bounce_);
    frame.timer.mark("gather");
  }
  return all_bounces_;
}

// Scaling down (5.1), and which patch each pixel refers to (5.2).
void ThesisMethod::find_patches(FrameContext& frame, const GBuffer& g_buffer, const IndirectMapGrid& grid) {
  active_blocks_ = &active_blocks_pass_.run(g_buffer, grid);
  patches_ = &patches_pass_.run(g_buffer, grid, *active_blocks_, frame.settings, gathers_on_host(frame));
  if (frame.settings.triangle_groups > 1)
    frame.triangle_groups.update(frame.trace_scene, static_cast<std::uint32_t>(frame.settings.triangle_groups));
  if (patches_->have_candidates) frame.timer.mark("patches");
}

// The directions [first, first + batch) and their hits. A single batch is made and traced once for all bounces.
Directions& ThesisMethod::trace_batch(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                      const IndirectMapGrid& grid, std::uint32_t first, std::uint32_t batch) {
  if (traced_ != nullptr && traced_->first == first) return *traced_;
  const auto samples = static_cast<std::uint32_t>(frame.settings.samples);
  const std::uint32_t seed = frame.settings.seed * 0x9e3779b9u + frame.frame_number;
  traced_ = &directions_pass_.run(frame.scene, g_buffer, grid, *active_blocks_, *patches_, first,
                                  std::min(batch, samples - first), seed);
  frame.timer.mark("directions");
  trace(frame, *traced_);
  occlusion_.cleared_texels = nullptr;
  if (frame.scene.has_clear()) {
    const OcclusionRays rays{*traced_, *patches_, active_blocks_->slots()};
    frame.rays += clear_hits_pass_.run(frame.scene, frame.tracer, shadows, rays, occlusion_);
    frame.timer.mark("clear surfaces");
  }
  return *traced_;
}

void ThesisMethod::trace_candidates(FrameContext& frame, const Directions& directions) {
  const auto groups = static_cast<std::uint32_t>(frame.settings.triangle_groups);
  frame.rays += std::uint64_t{directions.ray_count} * groups;
  if (groups > 1)
    frame.triangle_groups.closest_hits(directions.rays, directions.ray_count, candidates_, candidates_of_group_);
  else
    frame.tracer.closest_hit(directions.rays, directions.ray_count, candidates_);
  frame.timer.mark("trace");
}

// The nearest hits of the patches' rays are the pixels' own where a patch is one pixel, else their candidates.
void ThesisMethod::trace(FrameContext& frame, const Directions& directions) {
  const auto groups = static_cast<std::uint32_t>(frame.settings.triangle_groups);
  if (!patches_->have_candidates) {
    frame.rays += directions.ray_count;
    frame.tracer.closest_hit(directions.rays, directions.ray_count, occlusion_.hits, &occlusion_.list);
    frame.timer.mark("trace");
    return;
  }
  trace_candidates(frame, directions);
  frame.tracer.test_candidates({patches_->pixel_origins, directions.directions, candidates_, active_blocks_->slots(),
                                patches_->count, directions.count, groups, frame.settings.trace_missed},
                               occlusion_.hits, occlusion_.list);
  frame.timer.mark("candidates");
}

// The only bounce, batch by batch.
void ThesisMethod::gather_on_host(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                  const IndirectMapGrid& grid) {
  const auto samples = static_cast<std::uint32_t>(frame.settings.samples);
  const auto groups = static_cast<std::uint32_t>(frame.settings.triangle_groups);
  constexpr std::uint32_t kPatchStep = 4096;  // so that buffers do not grow with every frame
  const std::uint32_t most_patches = (patches_->count / kPatchStep + 1) * kPatchStep;
  const std::uint32_t batch = directions_per_host_batch(most_patches, frame.settings);
  directions_pass_.resize(most_patches * batch);
  candidates_.reserve(std::uint64_t{most_patches} * batch * groups * sizeof(Hit));
  if (groups > 1) candidates_of_group_.reserve(std::uint64_t{most_patches} * batch * sizeof(Hit));
  host_gather_pass_.begin(frame.scene, shadows);
  for (std::uint32_t first = 0; first < samples; first += batch) {
    const std::uint32_t seed = frame.settings.seed * 0x9e3779b9u + frame.frame_number;
    const Directions& directions = directions_pass_.run(frame.scene, g_buffer, grid, *active_blocks_, *patches_, first,
                                                        std::min(batch, samples - first), seed);
    frame.timer.mark("directions");
    trace_candidates(frame, directions);
    const OcclusionRays rays{directions, *patches_, active_blocks_->slots()};
    frame.rays += host_gather_pass_.run(frame.scene, *frame.tracer.host(),
                                        {rays, candidates_, groups, frame.settings.trace_missed});
    frame.timer.mark("gather");
  }
  gather_pass_.run_summed(g_buffer, grid, *active_blocks_, host_gather_pass_.sums(), samples,
                          needs_guide(frame.settings), all_bounces_);
  if (frame.settings.denoise) filter_pass_.run(gather_pass_.guide(), all_bounces_);
  frame.timer.mark("gather");
}

void ThesisMethod::gather_bounce(FrameContext& frame, const GBuffer& g_buffer, const ShadowMaps& shadows,
                                 const IndirectMapGrid& grid, const ScreenLight* screen) {
  const bool first_bounce = screen == nullptr;
  const auto samples = static_cast<std::uint32_t>(frame.settings.samples);
  const std::uint32_t batch = directions_per_batch(grid, frame.settings, frame.scene.has_clear());
  const bool literal = frame.settings.estimator == Estimator::kLiteral;
  for (std::uint32_t first = 0; first < samples; first += batch) {
    const OcclusionRays rays{trace_batch(frame, g_buffer, shadows, grid, first, batch), *patches_,
                             active_blocks_->slots()};
    if (first_bounce && MapViewPass::is_of_batch(frame.settings, first, rays.directions.count))
      map_view_pass_.run(grid, *active_blocks_, rays, occlusion_, candidates_, frame.settings);
    if (first_bounce)
      hit_light_pass_.run(frame.scene, rays, occlusion_, shadows, literal);
    else
      hit_light_pass_.run_from_screen(screen->g_buffer, rays, occlusion_, screen->map);
    frame.timer.mark(first_bounce ? "light of hits" : "light from screen");
    gather_pass_.run(frame.scene, g_buffer, grid, *active_blocks_, rays, occlusion_,
                     {samples, literal, first_bounce && !literal, needs_guide(frame.settings)}, bounce_);
    frame.timer.mark("gather");
  }
}

}  // namespace lightwell
