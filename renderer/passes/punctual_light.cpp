#include "renderer/passes/punctual_light.h"

#include "renderer/passes/bindings.glsl"

namespace lightwell {

namespace {

// A GiB of them: no device is sure to take more in one buffer.
constexpr std::uint64_t kMostRays = std::uint64_t{1} << 25;

// Of a pixel.
struct ShadowRays {
  std::uint32_t own = 0;  // to as many of the strongest lights
  std::uint32_t other = 0;
  std::uint32_t other_choices = 0;  // where the lights begin that the other goes to one of
};

// All lights have rays of their own, if they are few; else the strongest of them, and one ray is for the others. In
// pictures over 4K there is one ray for all.
ShadowRays rays_for(const LightCounts& counts, std::uint64_t pixels) {
  const bool is_huge = pixels * (kStrongestLights + 1) > kMostRays;
  if (counts.punctual <= (is_huge ? 1 : kStrongestLights + 1)) return {counts.punctual};
  if (is_huge) return {0, 1, counts.lights};
  return {kStrongestLights, counts.others > 0 ? 1u : 0u, counts.others_first};
}

}  // namespace

PunctualLightPass::PunctualLightPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/punctual_light.comp", defines); }),
      buffers_(buffers),
      clear_shadows_(shaders, buffers),
      rays_("punctual shadow rays", 0, buffers) {
  traced_.light = gl::Buffer("punctual light", 0);
  traced_.visible = gl::Buffer("visible punctual lights", 0, buffers);
}

void PunctualLightPass::reserve(std::uint64_t rays) {
  rays_.reserve(rays * sizeof(Ray));
  traced_.light.reserve(rays * sizeof(glm::vec4));
  traced_.visible.reserve((rays + 31) / 32 * sizeof(std::uint32_t));
  traced_.light_texels.attach(traced_.light);
  traced_.visible_texels.attach(traced_.visible);
}

const TracedLight& PunctualLightPass::run(FrameContext& frame, const GBuffer& g_buffer, const LightTable& lights,
                                          std::uint32_t frame_number) {
  const auto pixels = static_cast<std::uint64_t>(frame.size_px.x) * static_cast<std::uint64_t>(frame.size_px.y);
  const ShadowRays of_pixel = rays_for(lights.counts(), pixels);
  traced_.rays_of_pixel = of_pixel.own + of_pixel.other;
  const auto rays = static_cast<std::uint32_t>(pixels * traced_.rays_of_pixel);
  reserve(rays);
  if (rays == 0) return traced_;
  gl::Defines defines = frame.scene.brdf_defines();
  defines.emplace_back("LIGHTS_PUNCTUAL 1");
  defines.emplace_back("OWN_RAYS " + std::to_string(of_pixel.own));
  if (of_pixel.other > 0) defines.emplace_back("OTHER_LIGHTS 1");
  Variant& variant = variants_.with(defines);
  variant.lights.set(lights.counts());
  variant.other_choices = of_pixel.other_choices;
  variant.frame_number = frame_number;
  variant.seed = frame.settings.seed;
  g_buffer.bind();
  rays_.bind_storage(BINDING_SAMPLE_SHADOW_RAYS);
  traced_.light.bind_storage(BINDING_SAMPLE_LIGHT);
  variant.program->dispatch(frame.size_px, {16, 4});
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  frame.timer.mark("direct light");
  clear_shadows_.run(frame, rays_, rays, traced_.visible, {traced_.light}, false);
  frame.rays += rays;
  frame.timer.mark("shadows");
  return traced_;
}

}  // namespace lightwell
