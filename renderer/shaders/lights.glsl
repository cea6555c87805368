// Punctual lights and their variance shadow maps. Needs bindings, brdf, sampling.
// Defines, for what a scene has: MANY_LIGHTS for more than two, TWO_LIGHTS for two, else there is one or none.
// POINT_LIGHTS if some of them are; TINTED_SHADOWS if surfaces let light through that are not in the moments of depth,
// CLEAR_RECEIVER for the light of these surfaces themselves.

// LANES: the block, its maps and the loop over it are the caller's; see renderer/lanes/glsl.h.
#include "shaders/select.glsl"

struct Light {
  vec3 position_ws;
  float inverse_range;   // 0: infinite
  vec3 direction_ws;     // the way it shines
  uint kind;             // 0 directional, 1 point, 2 spot
  vec3 intensity;        // colour * lux (directional) or candela
  float spot_scale;      // KHR_lights_punctual's angular attenuation
  float spot_offset;
  float shadow_far_m;    // distance at which the normalised shadow depth is 1
  int first_shadow_layer; // -1: casts none
  float padding;
  mat4 shadow_clip_from_world;  // directional and spot lights
};

#ifndef LANES
layout(std140, binding = BINDING_LIGHTS) uniform Lights {
  uint light_count;
  float shadow_least_variance;
  float shadow_cube_scale;  // 1 / tangent of half a cube face's angle, a little under 1
  uint lights_padding;
  Light lights[MAX_LIGHTS];
};

layout(binding = UNIT_SHADOW_MOMENTS) uniform sampler2DArray shadow_moments;  // mean and mean square of depth
vec2 shadow_moments_at(vec3 place) { return textureLod(shadow_moments, place, 0.0).rg; }
#endif

#ifdef TINTED_SHADOWS
// What surfaces before the nearest opaque one let through, all together; a: the depth of the nearest of them.
layout(binding = UNIT_SHADOW_TINT) uniform sampler2DArray shadow_tint;
const float kTintBias = 2e-3;  // of depth

// How much farther than the nearest such surface a point lies that is behind it. What is clear itself (CLEAR_RECEIVER) must
// not tint its own light: the least depth about a texel is less than its own by its slope.
float tint_bias(vec3 normal_ws, vec3 to_light_ws, float depth) {
#ifdef CLEAR_RECEIVER
  const float cosine = max(abs(dot(normal_ws, to_light_ws)), 0.02);
  const float slope = sqrt(1.0 - min(cosine * cosine, 1.0)) / cosine;
  return kTintBias + 3.0 * slope * depth * 2.0 / float(textureSize(shadow_tint, 0).x);
#else
  return kTintBias;
#endif
}

#define Visibility vec3
Visibility tint_of_way(vec3 place, float depth, float bias) {
  const vec4 tint = textureLod(shadow_tint, place, 0.0);
  return depth > tint.a + bias ? tint.rgb : vec3(1.0);
}
#else
float tint_bias(vec3 normal_ws, vec3 to_light_ws, float depth) { return 0.0; }
#define Visibility float
Visibility tint_of_way(vec3 place, float depth, float bias) { return 1.0; }
#endif

// Chebyshev's inequality on the moments of depth: Donnelly and Lauritzen 2006, "Variance shadow maps".
float chebyshev_upper_bound(vec2 moments, float depth) {
  const float variance = max(moments.y - moments.x * moments.x, shadow_least_variance);
  const float distance = depth - moments.x;
  return select(distance <= 0.0, 1.0, variance / (variance + distance * distance));
}

// A cube face: +X -X +Y -Y +Z -Z, and where on it a direction points, in [-1, 1]. The axes are those of
// ShadowMapsPass's cube views.
vec3 cube_face(vec3 direction) {
  const vec3 size = abs(direction);
  const vec3 x_face = vec3(vec2(direction.z, direction.y) / size.x, select(direction.x >= 0.0, 0.0, 1.0));
  const vec3 y_face = vec3(vec2(direction.x, direction.z) / size.y, select(direction.y >= 0.0, 2.0, 3.0));
  const vec3 z_face = vec3(vec2(direction.x, direction.y) / size.z, select(direction.z >= 0.0, 4.0, 5.0));
  return select(size.x >= size.y && size.x >= size.z, x_face, select(size.y >= size.z, y_face, z_face));
}

// Share of the light that reaches a point, from the shadow map; 1 outside it.
Visibility light_visibility(Light light, vec3 position_ws, vec3 normal_ws, vec3 to_light_ws) {
  const vec3 from_light = position_ws - light.position_ws;
  const vec4 clip = light.shadow_clip_from_world * vec4(position_ws, 1.0);
  vec2 ndc = vec2(clip.x, clip.y) / clip.w;
  float layer = float(light.first_shadow_layer);
#ifdef POINT_LIGHTS
  if (light.kind == 1u) {
    const vec3 face = cube_face(from_light);
    ndc = vec2(face.x, face.y) * shadow_cube_scale;
    layer += face.z;
  }
#endif
  const float depth = light.kind == 0u ? clip.z : length(from_light) / light.shadow_far_m;
  const bool outside = max(abs(ndc.x), abs(ndc.y)) > 1.0 || (light.kind == 2u && clip.w <= 0.0);
  const vec3 place = vec3(ndc * 0.5 + 0.5, layer);
  const vec2 moments = shadow_moments_at(place);
  const bool unknown = outside || light.first_shadow_layer < 0;
  const Visibility known =
      chebyshev_upper_bound(moments, depth) * tint_of_way(place, depth, tint_bias(normal_ws, to_light_ws, depth));
  return select(unknown, Visibility(1.0), known);
}

struct LightSample {
  vec3 to_light_ws;   // unit
  vec3 irradiance;    // on a surface facing the light, unshadowed
};

LightSample light_at(Light light, vec3 position_ws) {
  LightSample at;
  if (light.kind == 0u) {
    at.to_light_ws = -light.direction_ws;
    at.irradiance = light.intensity;
    return at;
  }
  const vec3 to_light = light.position_ws - position_ws;
  const float distance2 = max(dot(to_light, to_light), 1e-8);
  at.to_light_ws = to_light * inversesqrt(distance2);
  const float ratio2 = distance2 * light.inverse_range * light.inverse_range;
  const float window = clamp(1.0 - ratio2 * ratio2, 0.0, 1.0);
  float cone = 1.0;
  if (light.kind == 2u) {
    cone = clamp(dot(-at.to_light_ws, light.direction_ws) * light.spot_scale + light.spot_offset, 0.0, 1.0);
    cone *= cone;
  }
  at.irradiance = light.intensity * (window * cone / distance2);
  return at;
}

#ifndef LANES
// What one light adds to reflected_punctual_light().
vec3 reflected_light(Light light, Brdf brdf, vec3 position_ws, vec3 normal_ws, vec3 out_ws) {
  const LightSample at = light_at(light, position_ws);
  const vec3 reflected = brdf_times_cosine(brdf, normal_ws, out_ws, at.to_light_ws);
  return reflected * at.irradiance * light_visibility(light, position_ws, normal_ws, at.to_light_ws);
}

// Radiance towards `out_ws` of punctual light reflected at a point. `normal_ws` is the shading normal on the viewer's side.
// Smooth normals decide alone what faces a light: with the geometric normal, the terminator on coarse meshes would show
// their triangles; what truly lies behind is in the shadow map's shadow.
// The first two lights are read by constant indices: on a software device a variable one costs a load per invocation
// and word, and a loop runs its body at least once.
vec3 reflected_punctual_light(Brdf brdf, vec3 position_ws, vec3 normal_ws, vec3 out_ws) {
  vec3 radiance = vec3(0.0);
  if (light_count > 0u)
    radiance += reflected_light(lights[0], brdf, position_ws, normal_ws, out_ws);
#if defined(TWO_LIGHTS) || defined(MANY_LIGHTS)
  radiance += reflected_light(lights[1], brdf, position_ws, normal_ws, out_ws);
#endif
#ifdef MANY_LIGHTS
  for (uint i = 2u; i < light_count; ++i)
    radiance += reflected_light(lights[i], brdf, position_ws, normal_ws, out_ws);
#endif
  return radiance;
}
#endif
