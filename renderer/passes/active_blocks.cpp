#include "renderer/passes/active_blocks.h"

#include <cstring>
#include <vector>

#include "renderer/passes/bindings.glsl"

namespace lightwell {

ActiveBlocksPass::ActiveBlocksPass(gl::ShaderLibrary& shaders)
    : program_(shaders.compute("passes/active_blocks.comp")),
      grid_(program_),
      seen_("blocks seen", 0, gl::BufferUse::kHostVisible),
      ranks_("active blocks", 0) {}

void ActiveBlocksPass::resize(const IndirectMapGrid& grid) {
  seen_.reserve(std::uint64_t{grid.most_slots()} / 256 * sizeof(std::uint32_t));
  ranks_.reserve(std::uint64_t{grid.most_slots()} / 256 * sizeof(glm::uvec2));
  active_.texels.attach(ranks_);
}

const ActiveBlocks& ActiveBlocksPass::run(const GBuffer& g_buffer, const IndirectMapGrid& grid) {
  const std::uint32_t blocks = grid.most_slots() / 256;
  g_buffer.depth.bind(UNIT_G_DEPTH);
  seen_.bind_storage(BINDING_OUTPUT);
  grid_.set(grid, 0);
  program_->dispatch(grid.map_size_px, {16, 16});
  glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
  gl::wait_for_device();
  std::vector<glm::uvec2> ranks(blocks);
  active_.count = 0;
  for (std::uint32_t block = 0; block < blocks; ++block) {
    std::uint32_t seen = 0;
    std::memcpy(&seen, seen_.host() + block * sizeof seen, sizeof seen);
    ranks[block].y = seen != 0 ? active_.count : ~0u;
    if (seen != 0) ranks[active_.count++].x = block;
  }
  ranks_.upload(std::span<const glm::uvec2>(ranks));
  return active_;
}

}  // namespace lightwell
