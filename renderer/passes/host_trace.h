// Rays by the processor's vectors.
#pragma once

#include <cstdint>

#include "renderer/gl/buffer.h"
#include "renderer/tracing/tracer.h"

namespace lightwell {

/// As Tracer::closest_hit, where the tracer runs on the processor and there are few triangles, all of them opaque (see
/// HostTracer::wide_hierarchy): up to a tenth faster there. False, with nothing done, elsewhere.
bool trace_few_triangles(Tracer& tracer, const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits);

}  // namespace lightwell
