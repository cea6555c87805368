// What the camera sees, rasterised: the first stage of a frame.
#pragma once

#include "renderer/gl/program.h"
#include "renderer/gl/texture.h"
#include "renderer/passes/device_scene.h"

namespace lightwell {

/// Nearest surfaces per pixel; packed as shaders/g_buffer.glsl unpacks it.
struct GBuffer {
  gl::Texture surface;   // RGBA32UI: normal, geometric normal, base colour, metallic
  gl::Texture material;  // RG32UI: material, roughness, dielectric reflectance
  gl::Texture emission;  // RGBA16F: nit; a = 1 where unlit
  gl::Texture lobes;     // RGBA32UI, of scenes whose materials have lobes beyond the plain BRDF: see shaders/lobes.glsl
  gl::Texture depth;     // 32-bit float, reversed; 0 where there is nothing

  glm::ivec2 size_px() const { return depth.size_px(); }
  void bind() const;
};

class GBufferPass {
 public:
  explicit GBufferPass(gl::ShaderLibrary& shaders);
  void resize(glm::ivec2 size_px);
  const GBuffer& g_buffer() const { return buffer_; }
  /// The camera block must be bound. `seed` decides the coverage of blended surfaces.
  const GBuffer& run(const DeviceScene& scene, std::uint32_t seed);

 private:
  struct Variant {
    explicit Variant(const gl::ProgramPtr& p) : program(p), frame_seed(p, "frame_seed") {}
    gl::ProgramPtr program;
    gl::Uniform<std::uint32_t> frame_seed;
  };
  gl::Variants<Variant> variants_;
  GBuffer buffer_;
  gl::Framebuffer framebuffer_, framebuffer_with_lobes_;
};

}  // namespace lightwell
