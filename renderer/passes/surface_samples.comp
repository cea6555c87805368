// From one real pixel of each patch: rays sampled by the BRDF, each with what its light counts for (f cos(theta) / pdf over
// the directional albedo), and a sample of the lights that have a size, weighted against those rays (Veach 1997).
// HAS_SIZED_LIGHTS: there are such lights in the table.
// REFLECTIONS: of smooth surfaces alone.
// REFRACTED: a pixel's second ray is of the light that has passed the surface of a volume.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#ifdef HAS_SIZED_LIGHTS
#include "shaders/scene_data.glsl"
#ifdef HAS_TEXTURES
#include "shaders/textures.glsl"
#endif
#include "shaders/surface.glsl"
#endif
#include "shaders/g_buffer.glsl"
#include "shaders/ray.glsl"
#include "shaders/patch_samples.glsl"
#include "shaders/smooth_lobe.glsl"
#include "shaders/smooth_path.glsl"
#ifdef HAS_SIZED_LIGHTS
#include "shaders/lights.glsl"
#include "shaders/environment.glsl"
#include "shaders/light_sampling.glsl"
#include "shaders/next_event.glsl"
#endif

// By four words: on a software device every store is a loop over the lanes.
layout(std430, binding = BINDING_SAMPLE_RAYS) writeonly buffer Rays { vec4 rays[]; };        // 2 a ray
layout(std430, binding = BINDING_SAMPLE_STATES) writeonly buffer States { vec4 states[]; };  // weight; density
layout(std430, binding = BINDING_SAMPLE_SHADOW_RAYS) writeonly buffer ShadowRays { vec4 shadow_rays[]; };  // 2 a ray
layout(std430, binding = BINDING_SAMPLE_LIGHT) writeonly buffer SampleLight { vec4 light[]; };

uniform uint sample_count;  // texels * rays_per_texel

struct SurfaceFrame {
  GBufferPoint point;
  Brdf brdf;           // in the frame
  mat3 frame;          // its third axis is the normal
  vec3 out_direction;
  vec3 albedo;         // what the map is demodulated by
};

// Light that passes the surface comes from below both normals, what is reflected from above both.
bool sides_agree(SurfaceFrame at, vec3 in_direction, vec3 in_ws) {
  return (dot(in_ws, at.point.geometric_normal_ws) < 0.0) == (in_direction.z < 0.0);
}

vec3 lifted_origin(SurfaceFrame at, bool below) {
  const vec3 lift_ws = at.point.geometric_normal_ws * ray_offset_m(at.point);
  return at.point.position_ws + (below ? -lift_ws : lift_ws);
}

void sample_direction(uint slot, uint ray, NetPlace place, SurfaceFrame at) {
  const uint number = sample_number(ray);
  const vec2 u = net_2d(place, number, kDecisionRay);
  const float u_lobe = net_1d(place, number, kDecisionLobe);
  const vec3 in_direction = sample_brdf(at.brdf, at.out_direction, u, u_lobe);
  const vec3 in_ws = normalize(at.frame * in_direction);
  const float pdf = brdf_pdf(at.brdf, at.out_direction, in_direction);
  const bool active_ray = at.point.valid && pdf > 0.0 && sides_agree(at, in_direction, in_ws);
  const vec3 value = brdf_times_cosine(at.brdf, at.out_direction, in_direction) / at.albedo;
  rays[2u * slot] = vec4(lifted_origin(at, in_direction.z < 0.0), 0.0);
  rays[2u * slot + 1u] = vec4(in_ws, active_ray ? 1e30 : -1.0);
#ifdef REFRACTED
  const float of_all = float(rays_per_texel);
#else
  const float of_all = 1.0;
#endif
  states[slot] = vec4(active_ray ? value * of_all / max(pdf, 1e-20) : vec3(0.0), pdf / of_all);
}

#ifdef REFRACTED
// Both rays count whole. No sample of the lights finds what comes through a volume.
void sample_refraction(uint slot, NetPlace place, SurfaceFrame at, Brdf through) {
  const vec2 u = net_2d(place, sample_number(0u), kDecisionRefraction);
  const vec3 in_direction = sample_transmission(through, at.out_direction, u);
  const vec3 in_ws = normalize(at.frame * in_direction);
  const float share = lobe_probabilities(through, at.out_direction).w;
  const float pdf = share > 0.0 ? brdf_pdf(through, at.out_direction, in_direction) / share : 0.0;
  const bool active_ray = at.point.valid && through.eta != 1.0 && in_direction.z < 0.0 && pdf > 0.0 &&
                          sides_agree(at, in_direction, in_ws);
  const vec3 value = brdf_times_cosine(through, at.out_direction, in_direction) / at.albedo;
  rays[2u * slot] = vec4(lifted_origin(at, true), 0.0);
  rays[2u * slot + 1u] = vec4(in_ws, active_ray ? kFarReach : -1.0);
  states[slot] = vec4(active_ray ? value * float(rays_per_texel) / max(pdf, 1e-20) : vec3(0.0), kNoOtherStrategy);
}
#endif

#ifdef HAS_SIZED_LIGHTS
// Its place among the shadow rays is behind those of the hits.
void sample_lamp(uint texel_index, NetPlace place, SurfaceFrame at) {
  const vec2 u = net_2d(place, own_frame(), kDecisionLamp);
  const vec2 u_choice = net_2d(place, own_frame(), kDecisionLampChoice);
  const TableSample lamp = sample_sized_light(at.point.position_ws, u, u_choice.x, u_choice.y);
  const vec3 in_direction = lamp.to_light_ws * at.frame;
  float rays_pdf = brdf_pdf(at.brdf, at.out_direction, in_direction);
#ifndef REFRACTED
  rays_pdf *= float(rays_per_texel);
#endif
  vec3 value = vec3(0.0);
  if (at.point.valid && lamp.pdf > 0.0 && sides_agree(at, in_direction, lamp.to_light_ws))
    value = brdf_times_cosine(at.brdf, at.out_direction, in_direction) / at.albedo * lamp.value *
            mis_weight(lamp.pdf, rays_pdf);
  Ray ray = kNoRay;
  if (greatest(value) > 0.0) ray = shadow_ray(lifted_origin(at, in_direction.z < 0.0), at.point.position_ws, lamp);
  const uint ray_index = sample_count + texel_index;
  shadow_rays[2u * ray_index] = vec4(ray.origin_ws, ray.t_min);
  shadow_rays[2u * ray_index + 1u] = vec4(ray.direction_ws, ray.t_max);
  light[2u * sample_count + texel_index] = vec4(value, 0.0);
}
#endif

// Without a branch, for under one a software device reads uniforms once a lane; what is beyond the last slot does it once
// more.
void main() {
  const uint invocation = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint slot = min(invocation, sample_count - 1u);
  const uint texels = traced_texels();
  const uint texel_index = slot % texels;
  const ivec2 texel = traced_texel(texel_index);
  SurfaceFrame at;
  at.point = g_buffer_point(sampled_pixel(texel));
#ifdef REFLECTIONS
  at.point.brdf = brdf_of_reflections(at.point.brdf);
#else
  at.point.brdf = brdf_of_map(at.point.brdf);
#endif
  at.frame = frame_around(at.point.normal_ws);
  at.out_direction = at.point.to_camera_ws * at.frame;
  at.brdf = brdf_in_frame(at.point.brdf, at.frame);
  at.albedo = max(directional_albedo(at.point.brdf, max(at.out_direction.z, 0.0)), vec3(1e-4));
  const NetPlace place = place_of_texel(texel);
#ifdef REFRACTED
  const Brdf through = at.brdf;
  at.brdf.transmission_color = vec3(0.0);
  if (slot >= texels) sample_refraction(slot, place, at, through);
  else sample_direction(slot, 0u, place, at);
#else
  sample_direction(slot, slot / texels, place, at);
#endif
#ifdef HAS_SIZED_LIGHTS
  if (slot < texels) sample_lamp(texel_index, place, at);
#endif
}
