#include "renderer/tracing/tracer.h"

namespace lightwell {

HitList::HitList(gl::BufferUse buffers)
    : rays("hit list", 0, buffers), dispatch("hit list dispatch", 5 * sizeof(std::uint32_t), buffers) {
  forget_traced();
}

std::uint32_t HitList::traced_anew() const {
  std::uint32_t words[5];
  dispatch.download(std::as_writable_bytes(std::span(words)));
  return words[4];
}

void HitList::forget_traced() {
  constexpr std::uint32_t kNone = 0;
  dispatch.upload(std::span<const std::uint32_t>(&kNone, 1), 4 * sizeof kNone);
}

void HitList::resize(std::uint32_t most_rays) {
  rays.reserve(std::uint64_t{most_rays} * sizeof(std::uint32_t));
  texels.attach(rays);
}

}  // namespace lightwell
