#include "renderer/passes/map_view.h"

#include <algorithm>
#include <iterator>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

MapViewPass::Variant::Variant(const gl::ProgramPtr& p)
    : program(p),
      grid(p),
      view(p, "view"),
      direction(p, "direction"),
      direction_count(p, "direction_count"),
      patch_count(p, "patch_count"),
      first_unmatched(p, "first_unmatched"),
      group_count(p, "group_count") {}

MapViewPass::MapViewPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) { return shaders.compute("passes/map_view.comp", defines); }) {}

void MapViewPass::resize(glm::ivec2 map_size_px) {
  if (image_ && image_.size_px() == map_size_px) return;
  image_ = gl::Texture("view of the indirect map", GL_RGBA32F, map_size_px);
  image_.clear(glm::vec4(0.0f));
}

bool MapViewPass::shows(ViewKind view) {
  constexpr ViewKind kViews[] = {ViewKind::kDirection, ViewKind::kHitDistance, ViewKind::kCandidates,
                                 ViewKind::kPatch,     ViewKind::kReference,   ViewKind::kUnmatched};
  return std::find(std::begin(kViews), std::end(kViews), view) != std::end(kViews);
}

bool MapViewPass::is_of_batch(const Settings& settings, std::uint32_t first, std::uint32_t count) {
  switch (settings.view) {
    case ViewKind::kDirection:
    case ViewKind::kHitDistance:
    case ViewKind::kCandidates: {
      const auto index = static_cast<std::uint32_t>(settings.view_index);
      return index >= first && index < first + count;
    }
    case ViewKind::kPatch:
    case ViewKind::kReference:
    case ViewKind::kUnmatched:
      return first == 0;
    default:
      return false;
  }
}

void MapViewPass::run(const IndirectMapGrid& grid, const ActiveBlocks& blocks, const OcclusionRays& rays,
                      const OcclusionMap& occlusion, const gl::Buffer& candidates, const Settings& settings) {
  blocks.texels.bind(UNIT_ACTIVE_BLOCKS);
  rays.directions.direction_texels.bind(UNIT_DIRECTIONS);
  rays.patches.point_texels.bind(UNIT_PATCH_POINTS);
  rays.patches.origin_texels.bind(UNIT_PIXEL_ORIGINS);
  occlusion.hits.bind_storage(BINDING_HITS);
  candidates.bind_storage(BINDING_CANDIDATES);
  image_.bind_image(0, GL_WRITE_ONLY);
  Variant& variant = variants_.with(rays.patches.defines());
  variant.grid.set(grid, blocks.slots());
  variant.view = static_cast<int>(settings.view);
  variant.direction = static_cast<std::uint32_t>(settings.view_index) - rays.directions.first;
  variant.direction_count = rays.directions.count;
  variant.patch_count = rays.patches.count;
  variant.first_unmatched = rays.patches.first_unmatched;
  variant.group_count = static_cast<std::uint32_t>(settings.triangle_groups);
  variant.program->dispatch(grid.map_size_px);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace lightwell
