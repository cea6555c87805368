// Patches of similar pixels (thesis 5.1) and the reference map (5.2).
#pragma once

#include "renderer/gl/buffer.h"
#include "renderer/gl/program.h"
#include "renderer/gl/variants.h"
#include "renderer/passes/active_blocks.h"
#include "renderer/passes/g_buffer.h"
#include "renderer/passes/indirect_map_grid.h"
#include "renderer/renderer.h"

namespace lightwell {

/// What a pixel gathers light with, for code on the processor: texels of the G-buffer. std430, 32 bytes.
struct PackedReceiver {
  std::uint32_t normal, geometric_normal, base_color_rg, base_color_b_metallic;
  std::uint32_t material_roughness, dielectric;
  std::uint32_t to_camera;  // octahedral, 2 x snorm16
  std::uint32_t padding;
};
static_assert(sizeof(PackedReceiver) == 32);

/// What the pixels of the indirect map trace their rays by. With patches of one pixel and triangles in one group, every
/// pixel's slot is a patch and the buffers are not filled.
struct Patches {
  bool have_candidates = false;          // patches have candidates, not hits
  std::uint32_t count = 0;               // of patches: those of the map, then pixels that are similar to none of them
  std::uint32_t first_unmatched = 0;     // from this number on a patch is such a pixel, and may be others like it
  gl::Buffer points{"patch points", 0};  // 2 uvec4 a patch: shaders/patches.glsl
  gl::Buffer references{"reference map", 0};  // uint32 a slot: its patch, or none, or a mark that it is unmatched
  gl::Buffer pixel_origins;                   // 2 vec4 a slot: see PixelOrigin in renderer/tracing/tracer.h
  gl::Buffer receivers{"receivers", 0, gl::BufferUse::kHostVisible};  // PackedReceiver a slot, where asked for
  gl::BufferTexture point_texels{"patch points", GL_RGBA32UI};
  gl::BufferTexture reference_texels{"reference map", GL_R32UI};
  gl::BufferTexture origin_texels{"pixel origins", GL_RGBA32UI};
  /// Programs over patches or their pixels are made with these.
  gl::Defines defines() const { return have_candidates ? gl::Defines{"PATCHES 1"} : gl::Defines{}; }
};

/// Whether patches have candidates, not hits: they have several pixels, or triangles are in groups.
inline bool have_candidates(const Settings& settings) {
  return settings.patch > 1 || settings.triangle_groups > 1;
}

/// Patches::count at most: every pixel may turn out to be like no patch of the map.
std::uint32_t most_patches(const IndirectMapGrid& grid, const Settings& settings);

class PatchesPass {
 public:
  /// `buffers`: host-visible where a native tracer reads the pixels' origins.
  PatchesPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers);
  void resize(const IndirectMapGrid& grid, const Settings& settings);
  /// Waits for the device where patches are shared: how many pixels are unmatched decides how many rays are made.
  /// `with_receivers`: fills Patches::receivers as well.
  const Patches& run(const GBuffer& g_buffer, const IndirectMapGrid& grid, const ActiveBlocks& blocks,
                     const Settings& settings, bool with_receivers);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p)
        : program(p), grid(p), normal_threshold(p, "normal_threshold"), depth_threshold(p, "depth_threshold") {}
    gl::ProgramPtr program;
    IndirectMapUniforms grid;
    gl::Uniform<float> normal_threshold, depth_threshold;
  };
  void dispatch(Variant& variant, const IndirectMapGrid& grid, const ActiveBlocks& blocks, const Settings& settings,
                std::uint32_t invocations);
  std::uint32_t number_unmatched();

  gl::Variants<Variant> scale_down_, reference_map_, share_unmatched_, number_unmatched_;
  gl::Buffer owners_, first_of_patch_;
  Patches patches_;
};

}  // namespace lightwell
