#include "renderer/passes/temporal_antialiasing.h"

#include <algorithm>
#include <utility>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

// What earlier pictures count for. In motion few, for they lag behind; when all has long been at rest, many.
constexpr std::uint32_t kFramesInMotion = 6, kFramesAtRest = 16;
// Light goes on settling for a while after the last change.
constexpr std::uint32_t kSettlingFrames = 32;

}  // namespace

TemporalAntialiasingPass::TemporalAntialiasingPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/full_screen_camera.vert", "passes/temporal_antialiasing.frag", defines);
      }) {}

void TemporalAntialiasingPass::resize(glm::ivec2 size_px) {
  if (now_.frames && now_.frames.size_px() == size_px) return;
  frames_ = unchanged_ = 0;
  gl::TextureOptions options;
  options.min_filter = options.mag_filter = GL_LINEAR;
  for (Kept* kept : {&now_, &before_}) {
    kept->picture = {gl::Texture("picture over time", GL_RGBA32F, size_px, options), 0};
    kept->frames = gl::Texture("frames in the picture", GL_R8, size_px);
    kept->framebuffer = gl::Framebuffer("picture over time", {&kept->picture.image, &kept->frames}, nullptr);
  }
}

const Picture& TemporalAntialiasingPass::blend(const Picture& current, const GBuffer& g_buffer,
                                               const glm::mat4& previous_clip_from_world, bool unchanged) {
  unchanged_ = unchanged || frames_ == 0 ? unchanged_ + 1 : 0;
  if (unchanged_ > frames_ || unchanged_ > kSettlingFrames) {
    const std::uint32_t most = unchanged_ > kSettlingFrames ? kFramesAtRest : kFramesInMotion;
    const Picture& picture = refine(current, std::min(frames_, most));
    now_.picture.accumulated = 1;
    return picture;
  }
  g_buffer.depth.bind(UNIT_G_DEPTH);
  if (g_buffer.has_motion) g_buffer.motion.bind(UNIT_G_MOTION);
  Variant& variant = variants_.with(g_buffer.has_motion ? gl::Defines{"MOTION 1"} : gl::Defines{});
  variant.previous_clip_from_world = previous_clip_from_world;
  return draw(variant, current, kFramesInMotion);
}

const Picture& TemporalAntialiasingPass::refine(const Picture& current, std::uint32_t frames) {
  frames = frames_ > 0 ? frames : 0;
  const Picture& picture = draw(variants_.with({"REFINE 1"}), current, frames);
  now_.picture.accumulated = frames + 1;
  return picture;
}

const Picture& TemporalAntialiasingPass::draw(Variant& variant, const Picture& current, std::uint32_t most_frames) {
  std::swap(now_, before_);
  current.image.bind(UNIT_IMAGE_A);
  before_.picture.image.bind(UNIT_IMAGE_B);
  before_.frames.bind(UNIT_IMAGE_C);
  variant.most_frames = static_cast<float>(most_frames);
  now_.framebuffer.bind();
  variant.program->use();
  full_screen_.draw_full_screen();
  ++frames_;
  now_.picture.accumulated = 1;
  return now_.picture;
}

}  // namespace lightwell
