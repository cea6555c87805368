#include "renderer/passes/patches.h"

#include <cstring>
#include <numeric>
#include <vector>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

std::uint32_t most_patches(const IndirectMapGrid& grid, const Settings& settings) {
  const auto side = static_cast<std::uint32_t>(grid.patch_side);
  return grid.most_slots() / (side * side) + (have_candidates(settings) ? grid.most_slots() : 0);
}

PatchesPass::PatchesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : scale_down_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/scale_down.comp", defines); }),
      reference_map_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/reference_map.comp", defines); }),
      share_unmatched_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/share_unmatched.comp", defines); }),
      number_unmatched_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/number_unmatched.comp", defines); }),
      owners_("unmatched pixels that trace", 0, gl::BufferUse::kHostVisible),
      first_of_patch_("first of them", 0) {
  patches_.pixel_origins = gl::Buffer("pixel origins", 0, buffers);
}

void PatchesPass::resize(const IndirectMapGrid& grid, const Settings& settings) {
  if (!have_candidates(settings)) return;
  const std::uint64_t slots = grid.most_slots();
  const std::uint64_t patches = slots / static_cast<std::uint64_t>(grid.patch_side * grid.patch_side);
  owners_.reserve(patches * sizeof(std::uint32_t));
  first_of_patch_.reserve(patches * sizeof(std::uint32_t));
  patches_.points.reserve(std::uint64_t{most_patches(grid, settings)} * 2 * sizeof(glm::uvec4));
  patches_.point_texels.attach(patches_.points);
  patches_.references.reserve(slots * sizeof(std::uint32_t));
  patches_.reference_texels.attach(patches_.references);
  patches_.pixel_origins.reserve(slots * 2 * sizeof(glm::uvec4));
  patches_.origin_texels.attach(patches_.pixel_origins);
}

void PatchesPass::dispatch(Variant& variant, const IndirectMapGrid& grid, const ActiveBlocks& blocks,
                           const Settings& settings, std::uint32_t invocations) {
  variant.grid.set(grid, blocks.slots());
  variant.normal_threshold = settings.normal_threshold;
  variant.depth_threshold = settings.depth_threshold;
  variant.program->dispatch(invocations);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
}

// Numbers the unmatched pixels that trace one after the other, after the patches of the map; gives the number after the
// last.
std::uint32_t PatchesPass::number_unmatched() {
  gl::wait_for_device();
  std::vector<std::uint32_t> counts(patches_.first_unmatched);
  std::memcpy(counts.data(), owners_.host(), counts.size() * sizeof counts[0]);
  std::exclusive_scan(counts.begin(), counts.end(), counts.begin(), patches_.first_unmatched);
  std::uint32_t last = 0;
  std::memcpy(&last, owners_.host() + (counts.size() - 1) * sizeof last, sizeof last);
  first_of_patch_.upload(std::span<const std::uint32_t>(counts));
  return counts.back() + last;
}

const Patches& PatchesPass::run(const GBuffer& g_buffer, const IndirectMapGrid& grid, const ActiveBlocks& blocks,
                                const Settings& settings, bool with_receivers) {
  const auto pixels_of_patch = static_cast<std::uint32_t>(grid.patch_side * grid.patch_side);
  patches_.have_candidates = have_candidates(settings);
  patches_.count = patches_.first_unmatched = blocks.slots() / pixels_of_patch;
  if (!patches_.have_candidates || blocks.count == 0) return patches_;
  g_buffer.bind();
  blocks.texels.bind(UNIT_ACTIVE_BLOCKS);
  patches_.points.bind_storage(BINDING_PATCH_POINTS);
  patches_.point_texels.bind(UNIT_PATCH_POINTS);
  patches_.references.bind_storage(BINDING_REFERENCES);
  patches_.pixel_origins.bind_storage(BINDING_PIXEL_ORIGINS);
  patches_.reference_texels.bind(UNIT_REFERENCES);
  owners_.bind_storage(BINDING_OUTPUT);
  const gl::Defines similarity =
      settings.similarity == Similarity::kLiteral ? gl::Defines{"LITERAL_SIMILARITY 1"} : gl::Defines{};
  dispatch(scale_down_.with(similarity), grid, blocks, settings, patches_.count);
  dispatch(reference_map_.with(similarity), grid, blocks, settings, blocks.slots());
  dispatch(share_unmatched_.with(similarity), grid, blocks, settings, patches_.count);
  patches_.count = number_unmatched();
  first_of_patch_.bind_storage(BINDING_OUTPUT);
  if (with_receivers) {
    patches_.receivers.reserve(std::uint64_t{blocks.slots()} * sizeof(PackedReceiver));
    patches_.receivers.bind_storage(BINDING_RECEIVERS);
  }
  dispatch(number_unmatched_.with(with_receivers ? gl::Defines{"RECEIVERS 1"} : gl::Defines{}), grid, blocks, settings,
           blocks.slots());
  return patches_;
}

}  // namespace lightwell
