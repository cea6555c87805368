// BEHIND_CLEAR: without clear surfaces, as if they were not there. CLEAR_ALONE: these alone, where they are before the rest;
// what they let through is in the other layer. FROM_HITS: of the nearest hits of the pixels' rays, which the processor has found.
#ifdef FROM_HITS
#define FLAT_CAMERA
#endif
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/scene_data.glsl"
#ifdef HAS_TEXTURES
#include "shaders/textures.glsl"
#endif
#include "shaders/surface.glsl"
#ifdef HAS_LOBES
#include "shaders/lobes.glsl"
#endif
#ifdef FROM_HITS
#include "shaders/ray.glsl"
#include "shaders/fetch_hit.glsl"
#endif
#include "shaders/seen_point.glsl"

layout(location = 0) out uvec4 out_surface;
layout(location = 1) out uvec2 out_material;
layout(location = 2) out vec4 out_emission;
#ifdef HAS_LOBES
layout(location = 3) out uvec4 out_lobes;
#endif

#ifdef MOTION
#ifdef HAS_LOBES
layout(location = 4) out vec4 out_motion;
#else
layout(location = 3) out vec4 out_motion;
#endif
#endif

uniform uint frame_seed;

#ifdef CLEAR_ALONE
layout(binding = UNIT_G_DEPTH) uniform sampler2D depth_behind;
#endif

#ifdef FILTER_SPECULAR
// A roughness that holds the normals of the whole pixel, so that a glint smaller than a pixel is not as bright as if it
// filled it (Tokuyoshi and Kaplanyan 2019). Less where a metal is seen at a grazing angle: half of a wide lobe there lies
// below the surface, and its outlines would be dark.
float filtered_roughness(float roughness, float metallic, float cos_viewer, vec3 across, vec3 down) {
  const float kPixelVariance = 0.25, kMost = 0.18;
  const float spread = min(2.0 * kPixelVariance * (dot(across, across) + dot(down, down)), kMost) *
                       mix(1.0, min(4.0 * cos_viewer * cos_viewer, 1.0), metallic);
  const float alpha = roughness * roughness;
  return sqrt(sqrt(min(alpha * alpha + spread, 1.0)));
}
#endif

// Coverage as a threshold that changes from pixel to pixel and frame to frame: the mean of many frames is the blend.
float coverage_threshold() { return unit_interval(hash(uvec3(gl_FragCoord.xy, frame_seed))); }

void main() {
  const SeenPoint seen = seen_point();
  const Attributes at = seen.at;
  const Material material = fetch_material(seen.material);
#ifdef BEHIND_CLEAR
  if ((material.flags & kMaterialClear) != 0u) discard;
#endif
#ifdef CLEAR_ALONE
  if ((material.flags & kMaterialClear) == 0u) discard;
  if (gl_FragCoord.z <= texelFetch(depth_behind, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
  Surface surface = shade_surface(material, at, seen.footprint);
  if ((material.flags & kMaterialAlphaMask) != 0u && surface.base_color.a < material.alpha_cutoff) discard;
  if ((material.flags & kMaterialAlphaBlend) != 0u) {
    if (surface.base_color.a <= coverage_threshold()) discard;
  }

  const vec3 to_camera = direction_to_camera(seen.position_ws);
  vec3 geometric_normal = seen.geometric_normal_ws;
  geometric_normal = dot(geometric_normal, geometric_normal) > 0.0 ? normalize(geometric_normal) : at.normal_ws;
  if (dot(geometric_normal, to_camera) < 0.0) geometric_normal = -geometric_normal;
  // A double-sided surface seen from behind shows its normal turned around; so does one whose winding disagrees.
  if (dot(at.normal_ws, geometric_normal) < 0.0) surface.normal_ws = -surface.normal_ws;
  surface.normal_ws = visible_shading_normal(surface.normal_ws, geometric_normal, to_camera);

  const bool unlit = (material.flags & kMaterialUnlit) != 0u;
  const vec3 base_color = unlit ? vec3(0.0) : clamp(surface.base_color.rgb, 0.0, 1.0);
  out_surface = pack_g_surface(surface.normal_ws, geometric_normal, base_color, clamp(surface.metallic, 0.0, 1.0));
#ifdef FILTER_SPECULAR
  surface.roughness = filtered_roughness(surface.roughness, clamp(surface.metallic, 0.0, 1.0),
                                         max(dot(surface.normal_ws, to_camera), 0.0), seen.normal_across,
                                         seen.normal_down);
#endif
  const uint roughness = uint(clamp(surface.roughness, 0.0, 1.0) * 65535.0 + 0.5);
  out_material = uvec2(seen.material | (roughness << 16), packUnorm2x16(vec2(material.f0_dielectric, material.specular_factor)));
#ifdef HAS_LOBES
  Lobes lobes = shade_lobes(seen.material, material, at, seen.footprint);
  const bool behind = dot(at.normal_ws, geometric_normal) < 0.0;
  if (behind) lobes.clearcoat_normal_ws = -lobes.clearcoat_normal_ws;
  lobes.clearcoat_normal_ws = visible_shading_normal(lobes.clearcoat_normal_ws, geometric_normal, to_camera);
  const float f0 = max(lobes.f0_dielectric.r, max(lobes.f0_dielectric.g, lobes.f0_dielectric.b));
  out_material.y = packUnorm2x16(vec2(f0, lobes.specular_factor));
  out_lobes = unlit ? uvec4(0u) : pack_g_lobes(lobes, behind);
#ifdef CLEAR_ALONE
  out_lobes.w |= kNothingPasses;
#endif
  surface.emission *= 1.0 - lobes.clearcoat * mix(kClearcoatF0, 1.0, schlick_weight(dot(lobes.clearcoat_normal_ws, to_camera)));
#endif
#ifdef MOTION
  out_motion = vec4(seen.displacement_ws, 0.0);
#endif
#ifdef FROM_HITS
  gl_FragDepth = depth_of_view(seen.view_depth_m);
#endif
  const float kLargestHalf = 65504.0;
  out_emission = vec4(min(unlit ? surface.base_color.rgb : surface.emission, kLargestHalf), unlit ? 1.0 : 0.0);
}
