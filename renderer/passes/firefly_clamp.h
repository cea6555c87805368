// Settings::firefly_clamp: what one sample brings of light that has bounced is held under a multiple of what samples
// bring in the mean, and what that takes away is added up.
#pragma once

#include "renderer/gl/variants.h"
#include "renderer/methods/frame_context.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/patch_grid.h"
#include "renderer/passes/patch_samples.h"
#include "renderer/passes/sample_sums.h"

namespace lightwell {

class FireflyClampPass {
 public:
  explicit FireflyClampPass(gl::ShaderLibrary& shaders);

  /// Over the samples of the indirect map, which say what the mean is; first in every frame. Mean and sums of earlier
  /// frames count for `kept_frames` at most.
  void run_over_map(FrameContext& frame, const GBuffer& g_buffer, const PatchSamples& samples, const PatchGrid& grid,
                    float kept_frames);

  /// Over those of single pixels, `light` with room behind first_direct(). Bound are the G-buffer, the list of pixels
  /// and what shaders/sum_samples.glsl declares; `defines` are those of the pass that the samples are of.
  void run_over_pixels(const FrameContext& frame, const gl::Buffer& light, const PatchGrid& grid, bool lamps_sampled,
                       const gl::Defines& defines);

  /// Of all light that samples have brought to the picture, the share taken away, 0 to 1; as the device knows it by
  /// now.
  float share() const;

  /// Mean and sums begin anew.
  void forget();

 private:
  struct Clamp {
    explicit Clamp(const gl::ProgramPtr& p);
    gl::ProgramPtr program;
    SampleSumUniforms sums;
    gl::Uniform<std::uint32_t> first_direct, part_count;
    gl::Uniform<float> firefly_clamp;
  };
  struct Sums {
    explicit Sums(const gl::ProgramPtr& p) : program(p), part_count(p, "part_count"), kept_frames(p, "kept_frames") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> part_count;
    gl::Uniform<float> kept_frames;
  };
  void dispatch(Clamp& clamp, Sums& sums, const gl::Buffer& light, const PatchGrid& grid);

  gl::Variants<Clamp> clamp_;
  gl::Variants<Sums> sums_;
  gl::Buffer parts_, totals_;
  bool is_new_ = true;
};

}  // namespace lightwell
