// Rays that go on from what they meet, surface by surface: through clear ones, or from mirror to mirror.
#pragma once

#include <cstdint>
#include <string>

#include "renderer/gl/buffer.h"
#include "renderer/gl/counter.h"
#include "renderer/passes/bindings.glsl"
#include "renderer/tracing/tracer.h"

namespace lightwell {

class OnwardRays {
 public:
  /// `what`: for the debugger. `buffers`: host-visible for a native tracer.
  OnwardRays(const std::string& what, gl::BufferUse buffers);

  /// Room for so many; nothing is held before.
  void reserve(std::uint32_t count);

  /// `look(surface)` dispatches a shader over `count` hits: for surface 0 of whatever rays, from then on of those that
  /// went on, which are bound as UNIT_RAYS and UNIT_HITS. The shader writes for each the ray that goes on into
  /// `rays()`, one whose t_max is below its t_min where none does, and counts those that do in BINDING_OUTPUT. Ends
  /// when none is left. Returns how many were traced.
  template <class Look>
  std::uint64_t follow(Tracer& tracer, std::uint32_t count, const Look& look) {
    std::uint64_t traced = 0;
    for (std::uint32_t surface = 0;; ++surface) {
      onward_.begin(BINDING_OUTPUT);
      look(surface);
      const std::uint32_t onward = onward_.value();
      if (onward == 0) return traced;
      tracer.closest_hit(rays_, count, hits_);
      traced += onward;
      bind();
    }
  }

  const gl::Buffer& rays() const { return rays_; }
  /// As UNIT_RAYS and UNIT_HITS.
  void bind() const;

 private:
  gl::Buffer rays_, hits_;
  gl::Counter onward_;
  gl::BufferTexture ray_texels_, hit_texels_;
};

}  // namespace lightwell
