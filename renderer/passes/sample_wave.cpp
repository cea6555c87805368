#include "renderer/passes/sample_wave.h"

namespace lightwell {

SampleWave::SampleWave(gl::BufferUse use)
    : rays("sample rays", 0, use),
      shadow_rays("sample shadow rays", 0, use),
      hits("sample hits", 0, use),
      visible("visible lights", 0, use),
      states("sample states", 0),
      light("light of samples", 0) {}

void SampleWave::resize(std::uint64_t paths, std::uint64_t shadow_paths, std::uint64_t state_words, bool tells_direct) {
  rays.reserve(paths * sizeof(Ray));
  shadow_rays.reserve(shadow_paths * sizeof(Ray));
  hits.reserve((paths + 2) * sizeof(Hit));  // read four words at a time
  visible.reserve((shadow_paths + 31) / 32 * sizeof(std::uint32_t));
  states.reserve(paths * state_words * sizeof(glm::vec4));
  light.reserve((paths + shadow_paths + (tells_direct ? paths : 0)) * sizeof(glm::vec4));
  ray_texels.attach(rays);
  hit_texels.attach(hits);
}

SampleHitsProgram::SampleHitsProgram(const gl::ProgramPtr& p)
    : program(p),
      grid(p),
      lights(p),
      cache(p),
      path_count(p, "path_count"),
      path_stride(p, "path_stride"),
      path_phase(p, "path_phase"),
      first_next(p, "first_next"),
      most_next(p, "most_next"),
      most_bounces(p, "most_bounces"),
      first_direct(p, "first_direct"),
      lamps_light_hits(p, "lamps_light_hits"),
      cache_lights_hits(p, "cache_lights_hits") {}

}  // namespace lightwell
