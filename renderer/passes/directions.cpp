#include "renderer/passes/directions.h"

#include "renderer/passes/bindings.glsl"
#include "renderer/tracing/tracer.h"

namespace lightwell {

DirectionsPass::DirectionsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : program_(shaders.compute("passes/directions.comp")),
      grid_(program_),
      first_(program_, "first_direction"),
      count_(program_, "direction_count"),
      seed_(program_, "seed") {
  directions_.rays = gl::Buffer("rays", 0, buffers);
  directions_.weights = gl::Buffer("direction weights", 0);
}

void DirectionsPass::resize(std::uint32_t most_rays) {
  directions_.rays.reserve(std::uint64_t{most_rays} * sizeof(Ray));
  directions_.ray_texels.attach(directions_.rays);
  directions_.weights.reserve(std::uint64_t{most_rays} * 8);
}

const Directions& DirectionsPass::run(const GBuffer& g_buffer, const IndirectMapGrid& grid, std::uint32_t first,
                                      std::uint32_t count, std::uint32_t seed) {
  directions_.first = first;
  directions_.count = count;
  directions_.ray_count = grid.slots() * count;
  g_buffer.bind();
  directions_.rays.bind_storage(BINDING_RAYS);
  directions_.weights.bind_storage(BINDING_WEIGHTS);
  grid_.set(grid);
  first_ = first;
  count_ = count;
  seed_ = seed;
  constexpr std::uint32_t kDirectionsPerInvocation = 8;  // as in directions.comp
  program_->dispatch(grid.slots() * ((count + kDirectionsPerInvocation - 1) / kDirectionsPerInvocation));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  return directions_;
}

}  // namespace lightwell
