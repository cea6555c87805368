#include "renderer/passes/history_view.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

HistoryViewPass::HistoryViewPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/full_screen_camera.vert", "passes/history_view.frag", defines);
      }) {}

bool HistoryViewPass::shows(ViewKind view) {
  switch (view) {
    case ViewKind::kHistory:
    case ViewKind::kVariance:
    case ViewKind::kGradient:
    case ViewKind::kMotion:
    case ViewKind::kCacheCells:
    case ViewKind::kUnmatched:
      return true;
    default:
      return false;
  }
}

const gl::Texture& HistoryViewPass::run(const GBuffer& g_buffer, const DeviceScene& scene, const ReconstructedMap& map,
                                        const RadianceCache& cache, const glm::mat4& previous_clip_from_world,
                                        ViewKind view) {
  if (!image_ || image_.size_px() != g_buffer.size_px()) {
    image_ = gl::Texture("view of the history", GL_RGBA32F, g_buffer.size_px());
    framebuffer_ = gl::Framebuffer("view of the history", {&image_}, nullptr);
  }
  gl::Defines defines = scene.brdf_defines();
  if (g_buffer.has_motion) defines.emplace_back("MOTION 1");
  Variant& variant = variants_.with(defines);
  g_buffer.bind();
  map.unfiltered->bind(UNIT_IMAGE_A);
  map.moments->bind(UNIT_IMAGE_B);
  map.guide->bind(UNIT_IMAGE_C);
  cache.bind_for_lookups(variant.cache);
  variant.view = static_cast<int>(view);
  variant.previous_clip_from_world = previous_clip_from_world;
  framebuffer_.bind();
  variant.program->use();
  full_screen_.draw_full_screen();
  return image_;
}

}  // namespace lightwell
