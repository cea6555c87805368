// The indirect map's pixels within the picture; the uniforms of shaders/indirect_map.glsl.
#pragma once

#include <algorithm>
#include <bit>
#include <glm/glm.hpp>

#include "renderer/gl/program.h"

namespace lightwell {

/// The size of an indirect map whose longer side has `size` pixels, never more than the picture, and the picture's
/// shape.
inline glm::ivec2 indirect_map_size(glm::ivec2 picture_size_px, int size) {
  const float scale =
      std::min(1.0f, static_cast<float>(size) / static_cast<float>(std::max(picture_size_px.x, picture_size_px.y)));
  return glm::max(glm::ivec2(glm::vec2(picture_size_px) * scale + 0.5f), glm::ivec2(1));
}

struct IndirectMapGrid {
  glm::ivec2 map_size_px{1};
  glm::ivec2 picture_size_px{1};
  glm::vec2 jitter{0.5f};  // where in its block the representative pixel lies, [0, 1)
  int patch_side = 1;      // pixels of the map: 1, 2, 4, 8 or 16

  /// Places for rays of one direction: whole blocks of 16 x 16 pixels, as shaders/indirect_map.glsl orders them.
  std::uint32_t most_slots() const {
    const glm::ivec2 blocks = (map_size_px + 15) / 16;
    return static_cast<std::uint32_t>(blocks.x * blocks.y * 256);
  }

  /// A map whose longer side has `size` pixels (never more than the picture) and the picture's shape.
  static IndirectMapGrid over(glm::ivec2 picture_size_px, int size) {
    IndirectMapGrid grid;
    grid.map_size_px = indirect_map_size(picture_size_px, size);
    grid.picture_size_px = picture_size_px;
    return grid;
  }
};

struct IndirectMapUniforms {
  explicit IndirectMapUniforms(const gl::ProgramPtr& program)
      : size_px(program, "indirect_size_px"),
        scale(program, "indirect_scale"),
        jitter(program, "indirect_jitter"),
        slot_count(program, "slot_count"),
        log2_patch_side(program, "log2_patch_side") {}
  void set(const IndirectMapGrid& grid, std::uint32_t slots) {
    size_px = grid.map_size_px;
    scale = glm::vec2(grid.picture_size_px) / glm::vec2(grid.map_size_px);
    jitter = grid.jitter;
    slot_count = slots;
    log2_patch_side = std::countr_zero(static_cast<unsigned>(grid.patch_side));
  }
  gl::Uniform<glm::ivec2> size_px;
  gl::Uniform<glm::vec2> scale;
  gl::Uniform<glm::vec2> jitter;
  gl::Uniform<std::uint32_t> slot_count;
  gl::Uniform<int> log2_patch_side;
};

}  // namespace lightwell
