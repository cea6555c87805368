// Scaling up and gathering on the processor (thesis 5.2, 4.2), where the tracer runs there too: the candidates of
// patches are tried again for each pixel, the hits lit and summed in one go, without a record of each. What
// hit_light.comp and gather.comp do one after the other, by the same source: see renderer/lanes/glsl.h.
#pragma once

#include <memory>
#include <vector>

#include "renderer/gl/buffer.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/hit_light.h"
#include "renderer/passes/shadow_maps.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

class HostGatherPass {
 public:
  HostGatherPass();
  ~HostGatherPass();

  /// Whether the scene has nothing that only the device's passes know: textures, vertex colours, lobes of extensions,
  /// multiple scattering, masked, clear or blended surfaces, a picture around it.
  static bool knows(const DeviceScene& scene);

  /// Takes the lights of this frame. Waits for the device.
  void begin(const DeviceScene& scene, const ShadowMaps& shadows);

  /// A batch of directions and their patches' candidates (Hit, as CandidateTest has them). `trace_missed` as there.
  struct Batch {
    const OcclusionRays& rays;
    const gl::Buffer& candidates;
    std::uint32_t group_count;
    bool trace_missed;
  };
  /// Adds it to the sums, which the batch with direction 0 starts anew; returns the rays traced.
  std::uint64_t run(const DeviceScene& scene, HostTracer& tracer, const Batch& batch);

  /// A vec4 a slot: see GatherPass::run_summed.
  const gl::BufferTexture& sums() const { return sum_texels_; }

 private:
  struct Lights;
  std::unique_ptr<Lights> lights_;
  gl::Buffer sums_{"sums of light", 0, gl::BufferUse::kHostVisible};
  gl::BufferTexture sum_texels_{"sums of light", GL_RGBA32F};
};

}  // namespace lightwell
