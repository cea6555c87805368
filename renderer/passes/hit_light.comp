// Light leaving the hits towards their pixels: the occlusion map as indirect light sources (thesis 4.2). A hit in shadow
// gives nothing but its own emission; misses are not here, see gather.comp. Hits are read as a buffer texture, see
// shaders/scene_data.glsl.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/ray.glsl"
#ifdef HAS_TEXTURES
#include "shaders/textures.glsl"
#endif
#include "shaders/surface.glsl"
#include "shaders/hit_surface.glsl"
#include "shaders/lights.glsl"
#include "shaders/hit_list.glsl"
#include "shaders/occlusion_ray.glsl"

layout(binding = UNIT_HITS) uniform usamplerBuffer hit_words;  // 5 texels a hit
layout(std430, binding = BINDING_ARRIVING) writeonly buffer Arriving { vec4 arriving[]; };  // radiance

#ifdef CLEAR_SURFACES
layout(binding = UNIT_CLEARED) uniform samplerBuffer cleared;  // see clear_hits.comp

// Of the hit's light what clear surfaces before it pass, with their own. Algorithm 2 weights no light but the hit's.
vec3 through_clear_surfaces(uint record, vec3 light) {
  const vec3 passed = light * texelFetch(cleared, int(2u * record)).rgb;
#ifdef LITERAL
  return passed;
#else
  return passed + texelFetch(cleared, int(2u * record + 1u)).rgb;
#endif
}
#else
vec3 through_clear_surfaces(uint record, vec3 light) { return light; }
#endif

const float kFootprintPerMetre = 0.1;  // a diffuse ray's cone: a fraction of its solid angle, for texture levels

#ifdef LITERAL
// Algorithm 2 as printed: the hit's BRDF between the direction to the hit and the one to the camera. Its 1/r^2 is
// applied where the sum is, since near hits would leave the range of halves; it knows no pdf, so no weight.
vec3 literal_weight(Ray ray, HitPoint point, Brdf brdf) {
  const mat3 frame = frame_around(point.surface.normal_ws);
  const vec3 in_direction = abs((camera.eye_ws.xyz - ray.origin_ws) * frame);
  const vec3 out_direction = abs(-ray.direction_ws * frame);
  const vec3 unit_in = normalize(in_direction);
  return brdf_times_cosine(brdf, out_direction, unit_in) / max(unit_in.z, 1e-4);
}
#endif

vec3 light_of_hit(Ray ray, Hit hit) {
  const HitPoint point = hit_point(ray, hit, hit.t * kFootprintPerMetre);
  if ((point.material_flags & kMaterialUnlit) != 0u) return vec3(0.0);
  const Brdf brdf = point.brdf;
  vec3 radiance = point.surface.emission + reflected_punctual_light(brdf, point.position_ws, point.surface.normal_ws,
                                                                    -ray.direction_ws);
#ifdef LITERAL
  radiance *= literal_weight(ray, point, brdf);
#endif
  return radiance;
}

void main() {
  if (gl_GlobalInvocationID.x >= hit_count) return;
  const uint index = hit_ray(gl_GlobalInvocationID.x);
  const int first = int(5u * index);
  const Hit hit = Hit(uintBitsToFloat(texelFetch(hit_words, first).x), texelFetch(hit_words, first + 1).x,
                      texelFetch(hit_words, first + 2).x, uintBitsToFloat(texelFetch(hit_words, first + 3).x),
                      uintBitsToFloat(texelFetch(hit_words, first + 4).x));
#ifdef CLEAR_SURFACES
  if (hit.t < 0.0) return;  // nothing is behind the clear surfaces that the list names
#endif
  arriving[index] = vec4(through_clear_surfaces(index, light_of_hit(occlusion_ray(index), hit)), 0.0);
}
