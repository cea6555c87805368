// Rays of single pixels by way of mirrors and through glass.
#pragma once

#include "renderer/gl/variants.h"
#include "renderer/methods/frame_context.h"
#include "renderer/passes/onward_rays.h"
#include "renderer/passes/sample_wave.h"

namespace lightwell {

class SmoothPathsPass {
 public:
  /// `buffers`: host-visible for a native tracer.
  SmoothPathsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);

  /// kMirrors: of the indirect map, by way of smooth metals alone, and not to the lamps.
  enum class Kind { kImages, kMirrors };

  /// Whether there is anything that rays go on from.
  static bool is_needed(const DeviceScene& scene, Kind kind) {
    return kind == Kind::kMirrors ? scene.has_mirrors() : scene.has_smooth() || scene.has_clear_volumes();
  }

  /// Of passes/sample_hits.comp.
  static gl::Defines defines(const DeviceScene& scene, Kind kind);

  /// The wave's rays and hits give way to those by which each path ends, as if they had come straight on; their weights
  /// become the paths'. Slots from `pixels` on, of `count`, have passed their pixel's surface. What passes glass has
  /// not bounced.
  void run(FrameContext& frame, Kind kind, const SampleWave& wave, std::uint32_t count, std::uint32_t pixels,
           std::uint32_t frame_number);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p),
          sample_count(p, "sample_count"),
          pixel_count(p, "pixel_count"),
          most_bounces(p, "most_bounces"),
          surface(p, "surface"),
          frame_number(p, "frame_number"),
          goes_on(p, "goes_on") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> sample_count, pixel_count, most_bounces, surface, frame_number;
    gl::Uniform<int> goes_on;
  };
  void look(Variant& variant, const SampleWave& wave, std::uint32_t count, std::uint32_t surface);

  gl::Variants<Variant> variants_;
  OnwardRays onward_;
};

}  // namespace lightwell
