#include "renderer/passes/host_trace.h"

#include "renderer/check.h"
#include "renderer/lanes/choose.h"
#include "renderer/tracing/host_tracer.h"

namespace lightwell {

static_assert(sizeof(lanes::SingleRay) == sizeof(Ray) && sizeof(lanes::SingleHit) == sizeof(Hit));

bool trace_few_triangles(Tracer& tracer, const gl::Buffer& rays, std::uint32_t count, gl::Buffer& hits) {
  HostTracer* const host = tracer.host();
  const WideHierarchy* const hierarchy = host ? host->wide_hierarchy() : nullptr;
  if (!hierarchy) return false;
  LIGHTWELL_CHECK(rays.host() != nullptr && hits.host() != nullptr);
  LIGHTWELL_CHECK_OP(std::uint64_t{count} * sizeof(Hit), <=, hits.size_bytes());
  const auto* in = reinterpret_cast<const lanes::SingleRay*>(rays.host());
  auto* out = reinterpret_cast<lanes::SingleHit*>(hits.host());
  gl::wait_for_device();
  constexpr std::uint32_t kRaysAtOnce = 512;
  host->parallel_for(count, kRaysAtOnce, [&](std::uint32_t begin, std::uint32_t end) {
    lanes::patch_kernels().nearest_hits_of_single_rays(*hierarchy, in + begin, out + begin, end - begin);
  });
  return true;
}

}  // namespace lightwell
