// What the camera sees, rasterised or traced: the first stage of a frame.
#pragma once

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/device_scene.h"
#include "renderer/passes/instance_motion.h"
#include "renderer/passes/view_choice.h"

namespace lightwell {

/// Nearest surfaces per pixel; packed as shaders/g_buffer.glsl unpacks it.
struct GBuffer {
  gl::Texture surface;   // RGBA32UI: normal, geometric normal, base colour, metallic
  gl::Texture material;  // RG32UI: material, roughness, dielectric reflectance
  gl::Texture emission;  // RGBA16F: nit; a = 1 where unlit
  gl::Texture lobes;     // RGBA32UI, of scenes whose materials have lobes beyond the plain BRDF: see shaders/lobes.glsl
  gl::Texture motion;    // RGBA16F, metres in the world since the frame before; where `has_motion` alone
  gl::Texture depth;     // 32-bit float, reversed; 0 where there is nothing

  bool has_motion = false;  // something has moved since the frame before, and its motion was asked for

  glm::ivec2 size_px() const { return depth.size_px(); }
  void bind() const;
};

/// Which surfaces: all; all but clear ones (DeviceScene::has_clear); or these alone, where they are before the others.
enum class GBufferLayer { kAll, kBehindClear, kClearAlone };

class GBufferPass {
 public:
  explicit GBufferPass(gl::ShaderLibrary& shaders);
  void resize(glm::ivec2 size_px);
  const GBuffer& g_buffer() const { return buffer_; }
  /// The camera block, which is `camera`, must be bound. `seed` decides the coverage of blended surfaces. With `motion`
  /// the displacements are drawn as well when something moves, and roughness holds the normals of the whole pixel. For
  /// kClearAlone the depth of the layer behind must be bound as a GBuffer's.
  const GBuffer& run(const DeviceScene& scene, const CameraView& camera, std::uint32_t seed,
                     const InstanceMotion* motion = nullptr, GBufferLayer layer = GBufferLayer::kAll);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p) : program(p), frame_seed(p, "frame_seed") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> frame_seed;
  };
  const gl::Framebuffer& framebuffer_of(bool lobes, bool motion);
  void rasterize(const DeviceScene& scene, const gl::Defines& defines, std::uint32_t seed);
  void find_hits(ViewRasterizer& rasterizer, const CameraBlock& camera);
  void draw_hits(gl::Defines defines);
  gl::Variants<Variant> variants_;
  gl::Variants<gl::ProgramPtr> hit_variants_;
  gl::Buffer hits_{"hits of the camera's rays", 0, gl::BufferUse::kHostVisible};
  gl::BufferTexture hit_texels_{"hits of the camera's rays", GL_RGBA32UI};
  gl::EmptyVertexArray full_screen_;
  GBuffer buffer_;
  gl::Framebuffer framebuffers_[2][2];  // [lobes][motion], made when first drawn to
};

}  // namespace lightwell
