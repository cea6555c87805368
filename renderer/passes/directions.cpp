#include "renderer/passes/directions.h"

#include "renderer/passes/bindings.glsl"
#include "renderer/tracing/tracer.h"

namespace lightwell {

DirectionsPass::DirectionsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : points_program_(shaders.compute("passes/sample_points.comp")),
      points_first_(points_program_, "first_direction"),
      points_count_(points_program_, "direction_count"),
      points_seed_(points_program_, "seed"),
      points_("sample points", 0),
      point_texels_("sample points", GL_RGBA32F),
      variants_([&shaders](const gl::Defines& defines) { return shaders.compute("passes/directions.comp", defines); }) {
  directions_.rays = gl::Buffer("rays", 0, buffers);
  directions_.directions = gl::Buffer("directions", 0, buffers);
}

// The table of random numbers that all tiles of the indirect map share.
void DirectionsPass::make_sample_points(std::uint32_t first, std::uint32_t count, std::uint32_t seed) {
  constexpr std::uint32_t kPlaces = 16;
  if (points_.reserve(std::uint64_t{kPlaces} * count * sizeof(glm::vec4)) || first == 0) point_texels_.attach(points_);
  points_.bind_storage(BINDING_OUTPUT);
  points_first_ = first;
  points_count_ = count;
  points_seed_ = seed;
  points_program_->dispatch(kPlaces * count);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void DirectionsPass::resize(std::uint32_t most_rays) {
  if (directions_.rays.reserve(std::uint64_t{most_rays} * sizeof(Ray))) directions_.rays.clear();
  directions_.ray_texels.attach(directions_.rays);
  directions_.directions.reserve(std::uint64_t{most_rays} * sizeof(glm::vec4));
  directions_.direction_texels.attach(directions_.directions);
}

Directions& DirectionsPass::run(const DeviceScene& scene, const GBuffer& g_buffer, const IndirectMapGrid& grid,
                                const ActiveBlocks& blocks, const Patches& patches, std::uint32_t first,
                                std::uint32_t count, std::uint32_t seed) {
  directions_.first = first;
  directions_.count = count;
  directions_.ray_count = patches.count * count;
  make_sample_points(first, count, seed);
  g_buffer.bind();
  point_texels_.bind(UNIT_SAMPLE_POINTS);
  directions_.rays.bind_storage(BINDING_RAYS);
  blocks.texels.bind(UNIT_ACTIVE_BLOCKS);
  patches.point_texels.bind(UNIT_PATCH_POINTS);
  directions_.directions.bind_storage(BINDING_DIRECTIONS);
  Variant& variant = variants_.with(gl::joined(scene.brdf_defines(), patches.defines()));
  variant.grid.set(grid, blocks.slots());
  variant.count = count;
  variant.patch_count = patches.count;
  variant.first_unmatched = patches.first_unmatched;
  constexpr std::uint32_t kDirectionsPerInvocation = 8;  // as in directions.comp
  variant.program->dispatch(patches.count * ((count + kDirectionsPerInvocation - 1) / kDirectionsPerInvocation));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  return directions_;
}

}  // namespace lightwell
