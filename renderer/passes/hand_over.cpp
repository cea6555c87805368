#include "renderer/passes/hand_over.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

// By the table of errors in the README.
float worth_in_paths(Method method) {
  constexpr float kThesis = 16.0f, kRealtime = 256.0f;
  return method == Method::kRealtime ? kRealtime : kThesis;
}

float share_of_paths(std::uint32_t paths, std::uint32_t frames, float worth) {
  if (paths >= frames) return 1.0f;
  const auto n = static_cast<float>(paths);
  return n / (n + worth * (1.0f - n / static_cast<float>(frames)));
}

HandOverPass::HandOverPass(gl::ShaderLibrary& shaders)
    : program_(shaders.raster("passes/full_screen.vert", "passes/hand_over.frag")), share_(program_, "share") {}

const Picture& HandOverPass::run(const Picture& paths, const Picture& shown_before, Method before,
                                 std::uint32_t frames) {
  const glm::ivec2 size_px = paths.image.size_px();
  if (!picture_.image || picture_.image.size_px() != size_px) {
    picture_.image = gl::Texture("picture handed over", GL_RGBA32F, size_px);
    framebuffer_ = gl::Framebuffer("picture handed over", {&picture_.image}, nullptr);
  }
  paths.image.bind(UNIT_IMAGE_A);
  shown_before.image.bind(UNIT_IMAGE_B);
  share_ = share_of_paths(paths.accumulated, frames, worth_in_paths(before));
  framebuffer_.bind();
  program_->use();
  full_screen_.draw_full_screen();
  picture_.accumulated = paths.accumulated;
  return picture_;
}

}  // namespace lightwell
