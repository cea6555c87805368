#include "renderer/passes/reconstruction.h"

#include <utility>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

constexpr float kLuminanceTolerance = 6.0f;  // standard deviations

gl::ProgramPtr filter_step(gl::ShaderLibrary& shaders, const gl::Defines& defines) {
  return shaders.raster("passes/full_screen_camera.vert", "passes/patch_filter.frag", defines);
}

}  // namespace

ReconstructionPass::Light::Light(const gl::ProgramPtr& p)
    : program(p),
      sums(p),
      has_history(p, "has_history"),
      previous_clip_from_world(p, "previous_clip_from_world"),
      kept_frames(p, "kept_frames") {}

ReconstructionPass::ReconstructionPass(gl::ShaderLibrary& shaders)
    : light_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/full_screen_camera.vert", "passes/patch_light.frag", defines);
      }),
      filter_(filter_step(shaders, {})),
      filter_last_(filter_step(shaders, {"LAST 1"})) {}

void ReconstructionPass::resize(glm::ivec2 map_size_px) {
  if (now_.map && now_.map.size_px() == map_size_px) return;
  has_history_ = false;
  gl::TextureOptions options;
  options.min_filter = options.mag_filter = GL_LINEAR;
  for (Scratch& scratch : scratch_) {
    scratch.map = gl::Texture("filtered indirect map", GL_RGBA32F, map_size_px, options);
    scratch.framebuffer = gl::Framebuffer("filtered indirect map", {&scratch.map}, nullptr);
  }
  for (History* history : {&now_, &before_}) {
    history->map = gl::Texture("indirect map", GL_RGBA32F, map_size_px);
    history->moments = gl::Texture("moments of the indirect map", GL_RGBA32F, map_size_px);
    history->guide = gl::Texture("guide of the indirect map", GL_RGBA32UI, map_size_px);
    history->framebuffer =
        gl::Framebuffer("indirect map", {&history->map, &history->moments, &history->guide, &scratch_[0].map}, nullptr);
  }
}

ReconstructedMap ReconstructionPass::run(const GBuffer& g_buffer, const DeviceScene& scene, const PatchSamples& samples,
                                         const PatchGrid& grid, const glm::mat4& previous_clip_from_world,
                                         float kept_frames) {
  std::swap(now_, before_);
  g_buffer.bind();
  before_.map.bind(UNIT_IMAGE_A);
  before_.moments.bind(UNIT_IMAGE_B);
  before_.guide.bind(UNIT_IMAGE_C);
  gl::Defines defines = scene.brdf_defines();
  if (g_buffer.has_motion) defines.emplace_back("MOTION 1");
  Light& light = light_.with(defines);
  light.sums.set(grid, samples);
  light.has_history = has_history_ ? 1 : 0;
  light.previous_clip_from_world = previous_clip_from_world;
  light.kept_frames = kept_frames;
  now_.framebuffer.bind();
  light.program->use();
  full_screen_.draw_full_screen();
  has_history_ = true;
  return filter();
}

ReconstructedMap ReconstructionPass::nothing() const {
  scratch_[0].map.clear(glm::vec4(0.0f));
  return {&scratch_[0].map, &now_.guide, &now_.map, &now_.moments};
}

ReconstructedMap ReconstructionPass::filter() {
  now_.guide.bind(UNIT_IMAGE_C);
  const gl::Texture* from = &scratch_[0].map;
  Scratch* to = &scratch_[1];
  const std::pair<Filter*, int> steps[] = {{&filter_, 1}, {&filter_, 2}, {&filter_last_, 4}};
  for (const auto& [filter, stride] : steps) {
    from->bind(UNIT_IMAGE_A);
    to->framebuffer.bind();
    filter->stride = stride;
    filter->tolerance = kLuminanceTolerance;
    filter->program->use();
    full_screen_.draw_full_screen();
    from = &to->map;
    to = to == &scratch_[0] ? &scratch_[1] : &scratch_[0];
  }
  return {from, &now_.guide, &now_.map, &now_.moments};
}

}  // namespace lightwell
