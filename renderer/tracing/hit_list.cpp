#include "renderer/tracing/tracer.h"

namespace lightwell {

HitList::HitList(gl::BufferUse buffers)
    : rays("hit list", 0, buffers), dispatch("hit list dispatch", 4 * sizeof(std::uint32_t), buffers) {}

void HitList::resize(std::uint32_t most_rays) {
  rays.reserve(std::uint64_t{most_rays} * sizeof(std::uint32_t));
  texels.attach(rays);
}

}  // namespace lightwell
