// What the passes share that trace samples from surfaces seen and light their hits.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/light_table.h"
#include "renderer/passes/patch_grid.h"
#include "renderer/passes/radiance_cache.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

/// Rays and what they hit.
struct SampleWave {
  /// `use`: host-visible for a native tracer.
  explicit SampleWave(gl::BufferUse use);
  /// Room for `paths` rays with `state_words` vec4 of state each, and for `shadow_paths` shadow rays.
  /// `tells_direct`: and for what of each ray's light has not bounced, behind the rest of its light.
  void resize(std::uint64_t paths, std::uint64_t shadow_paths, std::uint64_t state_words, bool tells_direct = false);

  gl::Buffer rays, shadow_rays, hits, visible, states, light;
  gl::BufferTexture ray_texels{"sample rays", GL_RGBA32F}, hit_texels{"sample hits", GL_RGBA32UI};
};

/// passes/surface_samples.comp
struct SurfaceSamplesProgram {
  explicit SurfaceSamplesProgram(const gl::ProgramPtr& p)
      : program(p), grid(p), lights(p), sample_count(p, "sample_count") {}
  gl::ProgramPtr program;
  PatchGridUniforms grid;
  LightTableUniforms lights;
  gl::Uniform<std::uint32_t> sample_count;
};

/// passes/sample_hits.comp
struct SampleHitsProgram {
  explicit SampleHitsProgram(const gl::ProgramPtr& p);
  gl::ProgramPtr program;
  PatchGridUniforms grid;
  LightTableUniforms lights;
  RadianceCacheUniforms cache;
  gl::Uniform<std::uint32_t> path_count, path_stride, path_phase, first_next, most_next, most_bounces, first_direct;
  gl::Uniform<int> lamps_light_hits, cache_lights_hits;
};

/// Between stages that hand buffers on.
inline constexpr GLbitfield kBetweenSampleStages = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT;

}  // namespace lightwell
