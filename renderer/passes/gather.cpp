#include "renderer/passes/gather.h"

#include <utility>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

gl::Defines guide_defines(bool with_guide) {
  return with_guide ? gl::Defines{"GUIDE 1"} : gl::Defines{};
}

}  // namespace

IndirectMap make_indirect_map(glm::ivec2 size_px) {
  gl::TextureOptions options;
  options.min_filter = options.mag_filter = GL_LINEAR;
  return {gl::Texture("indirect map", GL_RGBA32F, size_px, options)};
}

GatherPass::GatherPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) { return shaders.compute("passes/gather.comp", defines); }) {}

GatherPass::Variant::Variant(const gl::ProgramPtr& p)
    : program(p),
      grid(p),
      direction_count(p, "direction_count"),
      total_directions(p, "total_directions"),
      patch_count(p, "patch_count"),
      first_batch(p, "first_batch"),
      environment_share(p, "environment_share") {}

void GatherPass::resize(glm::ivec2 map_size_px) {
  if (occlusion_distance_ && occlusion_distance_.size_px() == map_size_px) return;
  gl::TextureOptions options;
  options.min_filter = options.mag_filter = GL_LINEAR;
  occlusion_distance_ = gl::Texture("occlusion distance", GL_R32F, map_size_px, options);
  guide_ = gl::Texture("filter guide", GL_RGBA32UI, map_size_px);
}

void GatherPass::bind(const GBuffer& g_buffer, const ActiveBlocks& blocks, const IndirectMap& map) const {
  g_buffer.bind();
  blocks.texels.bind(UNIT_ACTIVE_BLOCKS);
  map.image.bind_image(0, GL_READ_WRITE);
  occlusion_distance_.bind_image(1, GL_WRITE_ONLY);
  guide_.bind_image(2, GL_WRITE_ONLY);
}

void GatherPass::dispatch(const Variant& variant, const IndirectMap& map) {
  variant.program->dispatch(map.image.size_px());
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void GatherPass::run_summed(const GBuffer& g_buffer, const IndirectMapGrid& grid, const ActiveBlocks& blocks,
                            const gl::BufferTexture& sums, std::uint32_t total_directions, bool with_guide,
                            IndirectMap& map) {
  bind(g_buffer, blocks, map);
  sums.bind(UNIT_ARRIVING);
  Variant& variant = variants_.with(gl::joined({"SUMMED 1"}, guide_defines(with_guide)));
  variant.grid.set(grid, blocks.slots());
  variant.total_directions = total_directions;
  variant.first_batch = 1;
  dispatch(variant, map);
}

void GatherPass::run(const DeviceScene& scene, const GBuffer& g_buffer, const IndirectMapGrid& grid,
                     const ActiveBlocks& blocks, const OcclusionRays& rays, const OcclusionMap& occlusion,
                     const Gathering& gathering, IndirectMap& map) {
  bind(g_buffer, blocks, map);
  rays.directions.direction_texels.bind(UNIT_DIRECTIONS);
  rays.patches.origin_texels.bind(UNIT_PIXEL_ORIGINS);
  occlusion.arriving_texels.bind(UNIT_ARRIVING);
  occlusion.hit_texels.bind(UNIT_HITS);
  occlusion.bind_cleared();
  gl::Defines kind =
      gathering.literal ? gl::Defines{"LITERAL 1"} : gl::joined(scene.environment_defines(), scene.brdf_defines());
  kind = gl::joined(kind, guide_defines(gathering.with_guide));
  Variant& variant = variants_.with(gl::joined(gl::joined(kind, rays.patches.defines()),
                                               gathering.literal ? gl::Defines{} : occlusion.clear_defines()));
  variant.grid.set(grid, blocks.slots());
  variant.direction_count = rays.directions.count;
  variant.patch_count = rays.patches.count;
  variant.total_directions = gathering.total_directions;
  variant.first_batch = rays.directions.first == 0 ? 1 : 0;
  variant.environment_share = gathering.misses_see_environment ? 1.0f : 0.0f;
  dispatch(variant, map);
}

IndirectFilterPass::IndirectFilterPass(gl::ShaderLibrary& shaders)
    : program_(shaders.compute("passes/indirect_filter.comp")), stride_(program_, "stride") {}

void IndirectFilterPass::resize(glm::ivec2 map_size_px) {
  if (scratch_.image && scratch_.image.size_px() == map_size_px) return;
  scratch_ = make_indirect_map(map_size_px);
}

void IndirectFilterPass::run(const gl::Texture& guide, IndirectMap& map) {
  guide.bind(UNIT_IMAGE_B);
  for (const int stride : {1, 2, 4}) {
    map.image.bind(UNIT_IMAGE_A);
    scratch_.image.bind_image(0, GL_WRITE_ONLY);
    stride_ = stride;
    program_->dispatch(map.image.size_px());
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    std::swap(map, scratch_);
  }
}

AddMapsPass::AddMapsPass(gl::ShaderLibrary& shaders)
    : program_(shaders.compute("passes/add_maps.comp")), first_(program_, "first") {}

void AddMapsPass::run(const IndirectMap& bounce, IndirectMap& sum, bool first) {
  bounce.image.bind_image(0, GL_READ_ONLY);
  sum.image.bind_image(1, GL_READ_WRITE);
  first_ = first ? 1 : 0;
  program_->dispatch(sum.image.size_px());
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace lightwell
