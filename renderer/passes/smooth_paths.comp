// Rays of single pixels that meet a mirror, or the surface of a clear volume, go on from there: what is seen in the mirror of
// a mirror, and through glass, is not to be blurred. Each ray in its wave becomes that of the last way, from where it would
// begin had it come straight on; what was lost or chosen by chance on the way goes into its weight. FIRST: the rays are
// those of the wave, in order; without it those that went on.
// MIRRORS_ALONE: rays of the indirect map, which would find the lamps that metals mirror as rare bright spots. So half of them
// end at the metal, where samples of the lights find those, and the others go on to all else.
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
#include "shaders/next_ray.glsl"
#include "shaders/fetch_hit.glsl"
#include "shaders/smooth_lobe.glsl"
#include "shaders/smooth_path.glsl"

layout(std430, binding = BINDING_HITS) buffer Hits { uint hits[]; };               // the wave's, 5 words a hit
layout(std430, binding = BINDING_SAMPLE_STATES) buffer States { vec4 states[]; };  // weight; density
layout(std430, binding = BINDING_RAYS) buffer WaveRays { vec4 wave_rays[]; };      // 2 a ray
layout(std430, binding = BINDING_ARRIVING) writeonly buffer Onward { vec4 onward[]; };  // 2 a ray
layout(std430, binding = BINDING_OUTPUT) buffer Count { uint onward_count; };

uniform uint sample_count;
uniform uint pixel_count;   // slots from here on are of light that has passed the pixel's surface
uniform uint most_bounces;
uniform uint surface;       // on the way, from 0
uniform uint frame_number;
uniform int goes_on;        // 0: this one is the last that is looked at

const float kFootprintPerMetre = 0.1;  // as in sample_hits.comp

// By the direction, for the sample's place may be another in every run.
uint seed_of(Ray ray) { return hash(floatBitsToUint(ray.direction_ws) + hash(frame_number * 16u + surface)); }

// The ray as if it had come `before_m` straight on.
void write_ray(uint index, Ray ray, float before_m, uint code) {
  wave_rays[2u * index] = vec4(ray.origin_ws - before_m * ray.direction_ws, before_m);
  wave_rays[2u * index + 1u] = vec4(ray.direction_ws, reach_of(code));
}

void write_hit(uint index, Hit hit, float before_m) {
  hits[5u * index] = floatBitsToUint(hit.t < 0.0 ? hit.t : hit.t + before_m);
  hits[5u * index + 1u] = hit.instance;
  hits[5u * index + 2u] = hit.triangle;
  hits[5u * index + 3u] = floatBitsToUint(hit.u);
  hits[5u * index + 4u] = floatBitsToUint(hit.v);
}

bool is_refracting(HitPoint point) {
#if defined(HAS_LOBES) && !defined(MIRRORS_ALONE)
  return (point.material_flags & kMaterialClear) != 0u && point.brdf.eta != 1.0;
#else
  return false;
#endif
}

// Of the lobes that keep an image.
Brdf image_lobes(Brdf brdf) {
  brdf.diffuse_albedo = vec3(0.0);
#ifdef HAS_LOBES
  brdf.sheen_color = vec3(0.0);
#endif
  return brdf;
}

struct LobeChoice {
  float u;       // for sample_brdf
  float weight;  // of what it gives
};

// Glass reflects little, but lamps it shows are bright: a fair share of the paths looks for them.
LobeChoice choose_lobe(Brdf brdf, vec3 out_direction, bool refracting, float u) {
#ifdef HAS_LOBES
  const float kLeastReflected = 0.08;
  const float passed = lobe_probabilities(brdf, out_direction).w;
  if (refracting && passed > 0.0) {
    const float passes = clamp(passed, kLeastReflected, 1.0 - kLeastReflected);
    if (u < passes) return LobeChoice(u / passes * passed, passed / passes);
    return LobeChoice(passed + (u - passes) / (1.0 - passes) * (1.0 - passed), (1.0 - passed) / (1.0 - passes));
  }
#endif
  return LobeChoice(u, 1.0);
}

struct Onwards {
  Ray ray;       // t_max: below 0 where the path ends here
  vec3 weight;   // of what is found, here or along the ray
  bool passed;   // went through the surface, or came from within it: no bounce
  bool dropped;  // the mirror image is left to others like it
};

Onwards go_on(Ray ray, Hit hit, HitPoint point, bool may_bounce) {
  Onwards next = Onwards(kNoRay, vec3(1.0), false, false);
  const bool refracting = is_refracting(point);
  const bool lit = (point.material_flags & kMaterialUnlit) == 0u;
  if (!lit || !(refracting || (is_smooth(point.brdf) && may_bounce))) return next;
  const mat3 frame = frame_around(point.surface.normal_ws);
  const vec3 out_direction = -ray.direction_ws * frame;
  const Brdf brdf = brdf_in_frame(point.brdf, frame);
#ifdef MIRRORS_ALONE
  if (diffuse_probability(brdf, out_direction) > 0.0) return next;
  const float share = 0.5;
#else
  const float share = refracting ? 1.0 : 1.0 - diffuse_probability(brdf, out_direction);
#endif
  const uint seed = seed_of(ray);
  if (unit_interval(seed) >= share) {
    next.weight = vec3(1.0 / (1.0 - share));
    next.dropped = true;
    return next;
  }
  const Brdf images = image_lobes(brdf);
  const uint a = hash(seed ^ 0x68bc21ebu), b = hash(a), c = hash(b);
  const LobeChoice lobe = choose_lobe(images, out_direction, refracting, unit_interval(c));
  const vec3 in_direction = sample_brdf(images, out_direction, vec2(unit_interval(a), unit_interval(b)), lobe.u);
  const vec3 in_ws = normalize(frame * in_direction);
  const float pdf = brdf_pdf(images, out_direction, in_direction);
  const bool agree = in_direction.z * dot(in_ws, point.geometric_normal_ws) > 0.0;
  next.weight = vec3(0.0);
  if (pdf <= 0.0 || !agree) return next;
  next.passed = in_direction.z < 0.0 || (refracting && point.from_behind);
  next.weight = brdf_times_cosine(images, out_direction, in_direction) *
                (lobe.weight / (pdf * share) * point.medium_transmittance);
  next.ray = Ray(lifted(point.position_ws, point.geometric_normal_ws, hit.t, in_ws), 0.0, in_ws, kFarReach);
  return next;
}

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= sample_count) return;
  const Ray ray = fetch_ray(int(index));
  Hit hit = fetch_hit(int(index));
#ifdef FIRST
  const float before_m = 0.0;
  uint bounces = index < pixel_count ? 1u : 0u;
#else
  if (ray.t_max < ray.t_min) return;
  const float before_m = uintBitsToFloat(hits[5u * index]);
  uint bounces = bounces_of(wave_rays[2u * index + 1u].w);
  write_hit(index, hit, before_m);
#endif
  Onwards next = Onwards(kNoRay, vec3(1.0), false, false);
  const bool met = hit.t >= 0.0;
  if (met && goes_on == 1)
    next = go_on(ray, hit, hit_point(ray, hit, (before_m + hit.t) * kFootprintPerMetre), bounces < most_bounces);
  const bool goes = next.ray.t_max > 0.0;
  vec4 state = states[index];
  state.rgb *= next.weight;
#ifdef MIRRORS_ALONE
  if (goes) state.a = 0.0;  // samples of the lights find all lamps
#else
  if (goes) state.a = kNoOtherStrategy;  // no sample of the lights competes with what an image shows
#endif
  states[index] = state;
  if (ray.t_max < 0.0) {
    write_ray(index, ray, 0.0, 0u);
    wave_rays[2u * index + 1u].w = -1.0;
  } else if (goes) {
    if (!next.passed) ++bounces;
    // Until its own hit comes, the record holds the length of the way so far.
    write_hit(index, hit, before_m);
    write_ray(index, next.ray, before_m + hit.t, path_code(bounces, false));
    atomicAdd(onward_count, 1u);
  } else {
    write_ray(index, ray, before_m, path_code(bounces, next.dropped));
  }
  onward[2u * index] = vec4(next.ray.origin_ws, next.ray.t_min);
  onward[2u * index + 1u] = vec4(next.ray.direction_ws, goes ? next.ray.t_max : -1.0);
}
