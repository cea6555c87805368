// Rays of samples through clear surfaces.
#pragma once

#include "renderer/gl/variants.h"
#include "renderer/methods/frame_context.h"
#include "renderer/passes/onward_rays.h"
#include "renderer/passes/sample_wave.h"

namespace lightwell {

class ClearSamplesPass {
 public:
  /// `buffers`: host-visible for a native tracer.
  ClearSamplesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// Where the scene has clear surfaces: `count` hits of the wave's rays give way to those behind them, through
  /// MOST_CLEAR_SURFACES of them, and what the light along each ray is to be multiplied by is bound for
  /// passes/sample_hits.comp. Where it has none, nothing.
  void run(FrameContext& frame, const SampleWave& wave, std::uint32_t count, std::uint32_t frame_number);

  /// Of passes/sample_hits.comp.
  static gl::Defines defines(const DeviceScene& scene);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p),
          sample_count(p, "sample_count"),
          surface(p, "surface"),
          frame_number(p, "frame_number"),
          goes_on(p, "goes_on") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> sample_count, surface, frame_number;
    gl::Uniform<int> goes_on;
  };
  void look(Variant& variant, const SampleWave& wave, std::uint32_t count, std::uint32_t surface);

  gl::Variants<Variant> variants_;
  OnwardRays onward_;
  gl::Buffer tints_;
  gl::BufferTexture tint_texels_{"tints of samples", GL_RGBA32F};
};

}  // namespace lightwell
