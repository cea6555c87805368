// Pictures of a jittered camera averaged over time: smooth edges in motion, without a sample more a frame.
#pragma once

#include "renderer/gl/program.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/compose.h"
#include "renderer/passes/g_buffer.h"

namespace lightwell {

class TemporalAntialiasingPass {
 public:
  explicit TemporalAntialiasingPass(gl::ShaderLibrary& shaders);

  /// A new size forgets what was seen.
  void resize(glm::ivec2 size_px);
  void forget() { frames_ = 0; }

  /// `current`: the frame's own picture. `previous_clip_from_world`: the camera of the frame before with this frame's
  /// shift of the picture. `unchanged`: camera, scene and light are those of the frame before.
  const Picture& blend(const Picture& current, const GBuffer& g_buffer, const glm::mat4& previous_clip_from_world,
                       bool unchanged);

  /// The mean of this picture and what was made last, which counts for `frames`; 0: this picture alone.
  const Picture& refine(const Picture& current, std::uint32_t frames);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p), most_frames(p, "most_frames"), previous_clip_from_world(p, "previous_clip_from_world") {}
    gl::ProgramPtr program;
    gl::Uniform<float> most_frames;
    gl::Uniform<glm::mat4> previous_clip_from_world;
  };
  struct Kept {
    Picture picture;
    gl::Texture frames;  // R8, over 255
    gl::Framebuffer framebuffer;
  };
  const Picture& draw(Variant& variant, const Picture& current, std::uint32_t most_frames);

  gl::Variants<Variant> variants_;
  Kept now_, before_;
  std::uint32_t frames_ = 0;     // since the start
  std::uint32_t unchanged_ = 0;  // frames without a change
  gl::EmptyVertexArray full_screen_;
};

}  // namespace lightwell
