// Evaluates or samples the BRDF of shaders/brdf.glsl for brdf_lab.cpp.
layout(local_size_x = 64) in;
#include "passes/bindings.glsl"
#include "shaders/sampling.glsl"
#include "shaders/packing.glsl"
#include "shaders/brdf.glsl"

struct Sample { vec4 direction_pdf; vec4 value; };
layout(std430, binding = 0) readonly buffer Material {
  vec4 base_color_metallic;
  vec4 f0_roughness;
  vec4 sheen;
  vec4 clearcoat_normal_factor;
  vec4 specular_coat_roughness_transmission_eta;
  vec4 out_direction;
};
layout(std430, binding = 1) readonly buffer Queries { vec4 queries[]; };
layout(std430, binding = 2) writeonly buffer Results { Sample results[]; };
uniform uint count;
uniform int sampled;

Brdf lab_brdf() {
  const vec4 rest = specular_coat_roughness_transmission_eta;
  Brdf brdf = make_brdf(base_color_metallic.rgb, base_color_metallic.w, f0_roughness.w, f0_roughness.rgb, rest.x);
#ifdef HAS_LOBES
  brdf.transmission_color = brdf.diffuse_albedo * rest.z;
  brdf.diffuse_albedo *= 1.0 - rest.z;
  brdf.eta = rest.w;
  brdf.clearcoat = clearcoat_normal_factor.w;
  brdf.clearcoat_alpha = alpha_from_roughness(rest.y);
  brdf.clearcoat_normal = clearcoat_normal_factor.xyz;
  brdf.sheen_color = sheen.rgb;
  brdf.sheen_roughness = sheen.w;
#endif
  return brdf;
}

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= count) return;
  const Brdf brdf = lab_brdf();
  const vec3 query = queries[index].xyz;
  const vec3 direction = sampled == 1 ? sample_brdf(brdf, out_direction.xyz, query.xy, query.z) : query;
  const float pdf = brdf_pdf(brdf, out_direction.xyz, direction);
  const vec3 value = brdf_times_cosine(brdf, out_direction.xyz, direction);
  results[index] = Sample(vec4(direction, pdf), vec4(value, 0.0));
}
