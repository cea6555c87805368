// A photon meets a surface: from mirrors it goes on; where it then comes to a matt one, the cell there learns from where. Each of a cell's places keeps one photon, chosen by flux: the one with the least of exponential random
// numbers whose rates are the fluxes. Like the sum of fluxes, which is of integers, that does not depend on the order of
// threads.
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
#include "shaders/environment.glsl"
#include "shaders/light_sampling.glsl"
#include "shaders/next_event.glsl"
#include "shaders/fetch_hit.glsl"
#include "shaders/guide_cells.glsl"

layout(binding = UNIT_PHOTON_FLUXES) uniform samplerBuffer fluxes_before;
layout(std430, binding = BINDING_PHOTON_RAYS) writeonly buffer Rays { vec4 rays[]; };  // 2 a ray
layout(std430, binding = BINDING_PHOTON_FLUXES) writeonly buffer Fluxes { vec4 fluxes[]; };
layout(std430, binding = BINDING_PHOTON_ORIGINS) writeonly buffer Origins { vec4 origins[]; };
// Of each place the random number's upper half, then the photon's index.
layout(std430, binding = BINDING_GUIDE_CELLS) buffer Cells { uint cells[]; };
layout(std430, binding = BINDING_GUIDE_FLUXES) buffer CellFluxes { uint cell_fluxes[]; };

uniform uint photon_count;
uniform uint bounce;        // 0: at the first surface
uniform uint seed;
uniform float flux_scale;   // from flux to a cell's irradiance, in units of what the scene's surfaces get in the mean

const float kMatt = 0.5;           // share of the samples that go to the diffuse lobe
const float kGreatestFlux = 16.0;  // of a photon, scaled: the sum of all in one cell must stay below 2^32 steps

struct Photon {
  uint index;
  Ray ray;
  vec3 flux;
};

void deposit(Photon photon, HitPoint point) {
  const uint cell = guide_cell(point.position_ws, point.geometric_normal_ws);
  const uint random = hash(photon.index + seed);
  const float flux = luminance(photon.flux);
  const float steps = min(flux * flux_scale, kGreatestFlux) * GUIDE_FLUX_STEPS;
  atomicAdd(cell_fluxes[cell], uint(steps + unit_interval(hash(random))));
  const float wait = -log(max(unit_interval(random), 1e-9)) / flux;
  const uint place = GUIDES_PER_CELL * cell + (random & uint(GUIDES_PER_CELL - 1));
  atomicMin(cells[place], floatBitsToUint(wait) & 0xffff0000u | photon.index);
  origins[photon.index] = vec4(photon.ray.origin_ws, 0.0);
}

void reflect_photon(inout Photon photon, Hit hit, HitPoint point, mat3 frame, vec3 out_direction) {
  const uint decision_seed = seed + 2u * bounce + 2u;
  const vec2 u = sobol_2d(photon.index, hash(decision_seed));
  const vec3 in_direction = sample_brdf(point.brdf, out_direction, u, sobol_1d(photon.index, hash(decision_seed + 1u)));
  const float pdf = brdf_pdf(point.brdf, out_direction, in_direction);
  const vec3 in_ws = normalize(frame * in_direction);
  photon.flux *= point.medium_transmittance * brdf_times_cosine(point.brdf, out_direction, in_direction) / max(pdf, 1e-20);
  photon.ray = kNoRay;
  if (pdf > 0.0 && greatest(photon.flux) > 0.0)
    photon.ray = Ray(lifted(point.position_ws, point.geometric_normal_ws, hit.t, in_ws), 0.0, in_ws, 1e30);
}

Photon meet_surface(Photon photon, Hit hit) {
  HitPoint point = hit_point(photon.ray, hit, 0.0);
  const mat3 frame = frame_around(point.surface.normal_ws);
  const vec3 out_direction = -photon.ray.direction_ws * frame;
  point.brdf = brdf_in_frame(point.brdf, frame);
  if (diffuse_probability(point.brdf, out_direction) < kMatt) {
    reflect_photon(photon, hit, point, frame, out_direction);
    return photon;
  }
  if (bounce > 0u) deposit(photon, point);
  return Photon(photon.index, kNoRay, vec3(0.0));
}

void main() {
  const uint index = gl_GlobalInvocationID.x;
  if (index >= photon_count) return;
  const Hit hit = fetch_hit(int(index));
  Photon photon = Photon(index, fetch_ray(int(index)), texelFetch(fluxes_before, int(index)).xyz);
  if (photon.ray.t_max > 0.0 && hit.t >= 0.0)
    photon = meet_surface(photon, hit);
  else
    photon.ray = kNoRay;
  rays[2u * index] = vec4(photon.ray.origin_ws, photon.ray.t_min);
  rays[2u * index + 1u] = vec4(photon.ray.direction_ws, photon.ray.t_max);
  fluxes[index] = vec4(photon.flux, 0.0);
}
