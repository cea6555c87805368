// What all surfaces that let light straight through, blended ones among them, take from it before the nearest opaque
// surface: the sum of their optical depths, whatever their order. Volumes absorb between the surfaces they begin and end
// with, or the opaque one that stands within. LIGHT_VIEW: as a light sees them, for its shadows; else as the camera does.
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
#include "shaders/clear_surface.glsl"

in vec3 world_position;
in vec3 world_normal;
#ifdef HAS_TEXTURES
in vec4 world_tangent;
in vec4 texture_uv;
in vec4 vertex_color_factor;
#endif
flat in uint material_index;

// Blending adds the colours and keeps the least alpha: where the nearest of these surfaces is, as LIGHT_VIEW counts depth.
layout(location = 0) out vec4 optical_depth;

// Where along the way a fragment and the nearest opaque surface lie.
struct Way {
  vec3 to_viewer_ws;
  float distance_m;
  float opaque_m;
  float depth;
};

#ifdef LIGHT_VIEW
uniform vec4 light_position_far;    // as in shadow_map.frag
uniform vec4 light_direction_range; // the way a directional light shines; metres between depth 0 and 1
layout(binding = UNIT_IMAGE_A) uniform sampler2D opaque_moments;  // of depth

Way way_to_fragment() {
  const vec3 from_light = world_position - light_position_far.xyz;
  const bool placed = light_position_far.w > 0.0;
  const float range_m = light_direction_range.w;
  const float depth = placed ? length(from_light) / range_m : gl_FragCoord.z;
  const float opaque = texelFetch(opaque_moments, ivec2(gl_FragCoord.xy), 0).r;
  return Way(placed ? -normalize(from_light) : -light_direction_range.xyz, depth * range_m, opaque * range_m, depth);
}
#else
layout(binding = UNIT_G_DEPTH) uniform sampler2D g_depth;

Way way_to_fragment() {
  const vec3 to_camera_ws = direction_to_camera(world_position);
  const float opaque = texelFetch(g_depth, ivec2(gl_FragCoord.xy), 0).r;
  const vec3 opaque_ws = position_from_depth(gl_FragCoord.xy, max(opaque, 1e-12));
  return Way(to_camera_ws, dot(camera.eye_ws.xyz - world_position, to_camera_ws),
             opaque > 0.0 ? dot(camera.eye_ws.xyz - opaque_ws, to_camera_ws) : 1e30, 1.0);
}
#endif

// Of a blended surface, else 1.
float coverage_of(Material material, vec4 base_color) {
  if ((material.flags & kMaterialAlphaMask) != 0u && base_color.a < material.alpha_cutoff) discard;
  return (material.flags & kMaterialAlphaBlend) != 0u ? clamp(base_color.a, 0.0, 1.0) : 1.0;
}

void main() {
  const Material material = fetch_material(material_index);
  const bool clear = (material.flags & kMaterialClear) != 0u;
#ifdef LIGHT_VIEW
  const bool counts = clear || (material.flags & kMaterialAlphaBlend) != 0u;
#else
  const bool counts = clear;  // blended surfaces are in the G-buffer, by chance
#endif
  if (!counts) discard;
  Attributes at;
  at.normal_ws = normalize(world_normal);
  at.tangent_ws = vec3(0.0);
  at.handedness = 1.0;
  at.uv0 = vec2(0.0);
  at.uv1 = vec2(0.0);
  at.color = vec4(1.0);
  vec2 footprint = vec2(0.0);
#ifdef HAS_TEXTURES
  at.tangent_ws = world_tangent.xyz;
  at.handedness = world_tangent.w;
  at.uv0 = texture_uv.xy;
  at.uv1 = texture_uv.zw;
  at.color = vertex_color_factor;
  const vec4 across = dFdx(texture_uv), down = dFdy(texture_uv);
  footprint = vec2(max(length(across.xy), length(down.xy)), max(length(across.zw), length(down.zw)));
#endif
  const Surface surface = shade_surface(material, at, footprint);
  const float coverage = coverage_of(material, surface.base_color);
  if (!clear && coverage >= kOpaqueAlpha) discard;
  const Way way = way_to_fragment();
  const bool before = way.distance_m < way.opaque_m;
  vec3 passed = vec3(0.0), absorbed = vec3(0.0);
#ifdef HAS_LOBES
  if (clear) {
    vec3 geometric_normal = cross(dFdx(world_position), dFdy(world_position));
    if (dot(geometric_normal, way.to_viewer_ws) < 0.0) geometric_normal = -geometric_normal;
    const bool behind = dot(at.normal_ws, geometric_normal) < 0.0;
    const Lobes lobes = shade_lobes(material_index, material, at, footprint);
    const bool is_volume = lobes.ior > 0.0;
#ifndef LIGHT_VIEW
    // The camera does not see backs.
    if (behind && !is_volume && (material.flags & kMaterialDoubleSided) == 0u) discard;
#endif
    Brdf brdf = make_brdf(clamp(surface.base_color.rgb, 0.0, 1.0), clamp(surface.metallic, 0.0, 1.0), surface.roughness,
                          material.f0_dielectric, material.specular_factor);
    brdf = with_lobes(brdf, clamp(surface.base_color.rgb, 0.0, 1.0), clamp(surface.metallic, 0.0, 1.0), lobes, 1.0);
    if (behind && is_volume) {
      brdf.clearcoat = 0.0;
      brdf.sheen_color = vec3(0.0);
    }
    passed = clear_transmittance(brdf, surface.normal_ws, way.to_viewer_ws);
    absorbed = lobes.absorption * (min(way.distance_m, way.opaque_m) * (behind ? 1.0 : -1.0));
  }
#endif
  const float kLeastPassed = 1e-6;
  const vec3 taken = -log(max(mix(vec3(1.0), passed, coverage), kLeastPassed));
  optical_depth = vec4((before ? taken : vec3(0.0)) + absorbed, before ? way.depth : 1.0);
}
