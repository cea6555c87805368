#include "renderer/passes/onward_rays.h"

namespace lightwell {

OnwardRays::OnwardRays(const std::string& what, gl::BufferUse buffers)
    : rays_(what, 0, buffers),
      hits_("hits of " + what, 0, buffers),
      onward_("count of " + what),
      ray_texels_(what, GL_RGBA32F),
      hit_texels_("hits of " + what, GL_RGBA32UI) {}

void OnwardRays::reserve(std::uint32_t count) {
  rays_.reserve(std::uint64_t{count} * sizeof(Ray));
  hits_.reserve(std::uint64_t{count} * sizeof(Hit) + 16);  // the last record is read as two wide texels
  ray_texels_.attach(rays_);
  hit_texels_.attach(hits_);
}

void OnwardRays::bind() const {
  ray_texels_.bind(UNIT_RAYS);
  hit_texels_.bind(UNIT_HITS);
}

}  // namespace lightwell
