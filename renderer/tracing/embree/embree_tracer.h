// The native SIMD tracer for software devices: reads and writes the seam's persistently mapped buffers.
#pragma once

#include <memory>

#include "renderer/tracing/tracer.h"

namespace lightwell {

/// `threads` 0: one per core. The ray and hit buffers must be host-visible (gl::Buffer::host() not null).
std::unique_ptr<Tracer> make_embree_tracer(unsigned threads = 0);

}  // namespace lightwell
