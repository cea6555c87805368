#include "renderer/passes/clear_shadows.h"

#include "renderer/passes/bindings.glsl"
#include "renderer/passes/device_types.h"

namespace lightwell {

ClearShadowsPass::ClearShadowsPass(gl::ShaderLibrary& shaders, gl::BufferUse buffers)
    : variants_(
          [&shaders](const gl::Defines& defines) { return shaders.compute("passes/clear_shadows.comp", defines); }),
      hits_("hits of shadow rays", 0, buffers),
      onward_("count of shadow rays through clear surfaces") {}

void ClearShadowsPass::run(FrameContext& frame, gl::Buffer& rays, std::uint32_t count, gl::Buffer& visible,
                           const WaitingLight& light, bool walls_only) {
  if (!(walls_only ? frame.scene.has_clear_walls() : frame.scene.has_clear())) {
    frame.tracer.any_hit(rays, count, visible);
    return;
  }
  hits_.reserve(std::uint64_t{count} * sizeof(Hit) + 16);  // the last record is read as two wide texels
  hit_texels_.attach(hits_);
  ray_texels_.attach(rays);
  visible.clear(~0u);
  const Variant& variant = variants_.with(gl::joined(frame.scene.texture_defines(), frame.scene.brdf_defines()));
  variant.clear_flags = walls_only ? kDeviceMaterialClearWall : kDeviceMaterialClear;
  variant.light_places = glm::uvec4(light.first, light.stride, light.split, light.first_of_rest);
  std::uint32_t onward = count;
  for (int surface = 0; onward > 0; ++surface) {
    if (surface > 0) frame.rays += onward;
    frame.tracer.closest_hit(rays, count, hits_);
    rays.bind_storage(BINDING_RAYS);
    light.buffer.bind_storage(BINDING_ARRIVING);
    onward = step(variant, count, surface < MOST_CLEAR_SURFACES);
  }
}

// The number of rays that go on.
std::uint32_t ClearShadowsPass::step(const Variant& variant, std::uint32_t count, bool goes_on) {
  onward_.begin(BINDING_OUTPUT);
  ray_texels_.bind(UNIT_RAYS);
  hit_texels_.bind(UNIT_HITS);
  variant.ray_count = count;
  variant.goes_on = goes_on ? 1 : 0;
  variant.program->dispatch(count);
  return onward_.value();
}

}  // namespace lightwell
