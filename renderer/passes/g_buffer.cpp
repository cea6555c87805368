#include "renderer/passes/g_buffer.h"

#include "renderer/passes/bindings.glsl"
#include "renderer/tracing/tracer.h"

namespace lightwell {

namespace {

gl::Defines layer_defines(GBufferLayer layer) {
  switch (layer) {
    case GBufferLayer::kBehindClear:
      return {"BEHIND_CLEAR 1"};
    case GBufferLayer::kClearAlone:
      return {"CLEAR_ALONE 1"};
    default:
      return {};
  }
}

}  // namespace

void GBuffer::bind() const {
  surface.bind(UNIT_G_SURFACE);
  material.bind(UNIT_G_MATERIAL);
  emission.bind(UNIT_G_EMISSION);
  depth.bind(UNIT_G_DEPTH);
  if (lobes) lobes.bind(UNIT_G_LOBES);
  if (has_motion) motion.bind(UNIT_G_MOTION);
}

GBufferPass::GBufferPass(gl::ShaderLibrary& shaders)
    : variants_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/g_buffer.vert", "passes/g_buffer.frag", defines);
      }),
      hit_variants_([&shaders](const gl::Defines& defines) {
        return shaders.raster("passes/full_screen_camera.vert", "passes/g_buffer.frag", defines);
      }) {}

void GBufferPass::resize(glm::ivec2 size_px) {
  if (buffer_.depth && buffer_.size_px() == size_px) return;
  buffer_.surface = gl::Texture("g-buffer surface", GL_RGBA32UI, size_px);
  buffer_.material = gl::Texture("g-buffer material", GL_RG32UI, size_px);
  buffer_.emission = gl::Texture("g-buffer emission", GL_RGBA16F, size_px);
  buffer_.depth = gl::Texture("g-buffer depth", GL_DEPTH_COMPONENT32F, size_px);
  buffer_.lobes = {};
  buffer_.motion = {};
  for (auto& framebuffers : framebuffers_)
    for (gl::Framebuffer& framebuffer : framebuffers) framebuffer = {};
}

const gl::Framebuffer& GBufferPass::framebuffer_of(bool lobes, bool motion) {
  GBuffer& b = buffer_;
  if (lobes && !b.lobes) b.lobes = gl::Texture("g-buffer lobes", GL_RGBA32UI, b.size_px());
  if (motion && !b.motion) b.motion = gl::Texture("g-buffer motion", GL_RGBA16F, b.size_px());
  gl::Framebuffer& framebuffer = framebuffers_[lobes][motion];
  if (framebuffer) return framebuffer;
  const gl::Texture* const always[] = {&b.surface, &b.material, &b.emission};
  const auto make = [&](auto... more) {
    return gl::Framebuffer("g-buffer", {always[0], always[1], always[2], more...}, &b.depth);
  };
  framebuffer = lobes && motion ? make(&b.lobes, &b.motion)
                : lobes         ? make(&b.lobes)
                : motion        ? make(&b.motion)
                                : make();
  return framebuffer;
}

const GBuffer& GBufferPass::run(const DeviceScene& scene, const CameraView& camera, std::uint32_t seed,
                                const InstanceMotion* motion, GBufferLayer layer) {
  buffer_.has_motion = motion && motion->moving();
  gl::Defines defines = gl::joined(gl::joined(scene.texture_defines(), scene.lobe_defines()), layer_defines(layer));
  if (motion) defines.emplace_back("FILTER_SPECULAR 1");
  if (buffer_.has_motion) {
    scene.feed_instances_before(motion->instances());
    motion->bind();
    defines.emplace_back("MOTION 1");
    if (motion->deforming()) defines.emplace_back("DEFORMED_MOTION 1");
  }
  ViewRasterizer* rasterizer = layer == GBufferLayer::kAll ? camera.choice.for_view(scene, buffer_.size_px()) : nullptr;
  if (rasterizer) find_hits(*rasterizer, camera.block);
  const gl::Framebuffer& framebuffer = framebuffer_of(scene.has_lobes(), buffer_.has_motion);
  framebuffer.bind();
  const GLfloat nothing_there = 0.0f;  // where it stays, nobody looks at the other textures
  glClearNamedFramebufferfv(framebuffer.id(), GL_DEPTH, 0, &nothing_there);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  if (rasterizer)
    draw_hits(std::move(defines));
  else
    rasterize(scene, defines, seed);
  glDisable(GL_DEPTH_TEST);
  return buffer_;
}

void GBufferPass::rasterize(const DeviceScene& scene, const gl::Defines& defines, std::uint32_t seed) {
  Variant& variant = variants_.with(defines);
  variant.program->use();
  variant.frame_seed = seed;
  glCullFace(GL_BACK);
  scene.draw([](DrawGroup group) {
    if (group == DrawGroup::kDoubleSided)
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    // The picture's rows run downwards, which turns every winding around.
    glFrontFace(group == DrawGroup::kCulledMirrored ? GL_CCW : GL_CW);
  });
  glDisable(GL_CULL_FACE);
}

void GBufferPass::find_hits(ViewRasterizer& rasterizer, const CameraBlock& camera) {
  const glm::ivec2 size_px = buffer_.size_px();
  const std::uint64_t bytes =
      static_cast<std::uint64_t>(size_px.x) * static_cast<std::uint64_t>(size_px.y) * sizeof(Hit);
  constexpr std::uint64_t kTexelBytes = 16;  // the last hit's second texel may begin behind it
  if (hits_.reserve(bytes + kTexelBytes)) hit_texels_.attach(hits_);
  rasterizer.camera_hits(camera_rays(camera), hits_);
}

void GBufferPass::draw_hits(gl::Defines defines) {
  defines.emplace_back("FROM_HITS 1");
  hit_texels_.bind(UNIT_HITS);
  hit_variants_.with(defines)->use();
  full_screen_.draw_full_screen();
}

}  // namespace lightwell
