// Rays of the occlusion map through clear surfaces.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/hit_light.h"
#include "renderer/passes/onward_rays.h"

namespace lightwell {

class ClearHitsPass {
 public:
  /// `buffers`: host-visible for a native tracer.
  ClearHitsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// Room for so many records; nothing is held before.
  void resize(std::uint32_t most_records);

  /// Each hit on a clear surface gives way to the one behind it, along the same ray, through MOST_CLEAR_SURFACES of
  /// them. What they pass and send is in `occlusion.cleared_texels` from then on.
  /// Returns how many rays were traced.
  std::uint64_t run(const DeviceScene& scene, Tracer& tracer, const ShadowMaps& shadows, const OcclusionRays& rays,
                    OcclusionMap& occlusion);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p),
          slot_count(p, "slot_count"),
          patch_count(p, "patch_count"),
          record_count(p, "record_count"),
          goes_on(p, "goes_on") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> slot_count, patch_count, record_count;
    gl::Uniform<int> goes_on;
  };
  void look(Variant& variant, const OcclusionRays& rays, const OcclusionMap& occlusion, bool goes_on);

  gl::Variants<Variant> variants_;
  OnwardRays onward_;
  gl::Buffer cleared_;
  gl::BufferTexture cleared_texels_{"clear surfaces before hits", GL_RGBA32F};
};

}  // namespace lightwell
