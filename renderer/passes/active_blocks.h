// The blocks of the indirect map that see a surface.
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/indirect_map_grid.h"

namespace lightwell {

/// For each n: the block with rank n (below `count`), and the rank of block n or ~0; blocks row by row.
struct ActiveBlocks {
  gl::BufferTexture texels{"active blocks", GL_RG32UI};
  std::uint32_t count = 0;
  std::uint32_t slots() const { return count * 256; }
};

class ActiveBlocksPass {
 public:
  explicit ActiveBlocksPass(gl::ShaderLibrary& shaders);
  void resize(const IndirectMapGrid& grid);
  /// Waits for the device: how many blocks there are decides how many rays are made.
  const ActiveBlocks& run(const GBuffer& g_buffer, const IndirectMapGrid& grid);

 private:
  gl::ProgramPtr program_;
  IndirectMapUniforms grid_;
  gl::Buffer seen_, ranks_;
  ActiveBlocks active_;
};

}  // namespace lightwell
