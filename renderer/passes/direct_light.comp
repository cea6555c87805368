// Direct light at every pixel (thesis 4.1): emission, and punctual lights through their variance shadow maps.
layout(local_size_x = 8, local_size_y = 8) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/lights.glsl"

layout(rgba32f, binding = 0) writeonly uniform image2D direct_radiance;

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, camera.size_px.xy))) return;
  const GBufferPoint point = g_buffer_point(pixel);
  vec3 radiance = vec3(0.0);
  if (point.valid) {
    radiance = texelFetch(g_emission, pixel, 0).rgb +
               reflected_punctual_light(point.brdf, point.position_ws, point.normal_ws, point.geometric_normal_ws,
                                        point.to_camera_ws);
  }
  imageStore(direct_radiance, pixel, vec4(radiance, point.valid ? 1.0 : 0.0));
}
