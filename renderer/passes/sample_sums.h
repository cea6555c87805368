// The uniforms of shaders/sum_samples.glsl, for whoever adds up the light of samples.
#pragma once

#include "renderer/gl/program.h"
#include "renderer/passes/patch_grid.h"
#include "renderer/passes/patch_samples.h"

namespace lightwell {

struct SampleSumUniforms {
  explicit SampleSumUniforms(const gl::ProgramPtr& program)
      : grid(program),
        sample_count(program, "sample_count"),
        path_stride(program, "path_stride"),
        path_phase(program, "path_phase"),
        first_next(program, "first_next"),
        lamps_sampled(program, "lamps_sampled") {}
  /// Of a list of pixels, whose paths do not go on. `samples_lamps`: that light lies behind the rays'.
  void set(const PatchGrid& of_grid, bool samples_lamps) const {
    grid.set(of_grid);
    sample_count = of_grid.samples();
    lamps_sampled = samples_lamps ? 1 : 0;
  }
  /// Of the indirect map, which is bound as well.
  void set(const PatchGrid& of_grid, const PatchSamples& samples) const {
    set(of_grid, samples.lamps_sampled);
    path_stride = samples.path_stride;
    path_phase = samples.path_phase;
    first_next = samples.first_next;
    samples.bind();
  }
  PatchGridUniforms grid;
  gl::Uniform<std::uint32_t> sample_count, path_stride, path_phase, first_next;
  gl::Uniform<int> lamps_sampled;
};

}  // namespace lightwell
