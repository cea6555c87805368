// What leaves the hits of the occlusion map: their emission, a sample of the lights that waits for its shadow ray, and light
// that has bounced before, from the radiance cache. Some hits' paths go on by one more ray, sampled by the cosine: what
// comes along them fills the cache. FIRST_HITS: along the rays from pixels; else along those from hits.
// SMOOTH_PATHS, MIRRORS_ALONE: rays may have come by way of mirrors, see smooth_paths.comp.
// CLEAR_SURFACES: rays may have come through some, see clear_samples.comp.
// FIREFLY_CLAMP: what comes straight from lamps and the sky is told apart, see firefly_clamp.comp.
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
#include "shaders/patch_samples.glsl"
#ifdef SMOOTH_PATHS
#include "shaders/smooth_lobe.glsl"
#include "shaders/smooth_path.glsl"
#endif
#define CELL_INSERTION
#include "shaders/radiance_cache.glsl"

#ifdef CLEAR_SURFACES
layout(binding = UNIT_CLEARED) uniform samplerBuffer tints;
#endif
layout(binding = UNIT_SAMPLE_STATES) uniform samplerBuffer states_in;  // a: density of the ray
// All is written once, at the end, and by four words: on a software device every store is a loop over the lanes.
layout(std430, binding = BINDING_SAMPLE_SHADOW_RAYS) writeonly buffer ShadowRays { vec4 shadow_rays[]; };  // 2 a ray
// Two a slot: what is known; what waits for the shadow ray. From first_direct on, one a slot: of the known, what has not bounced.
layout(std430, binding = BINDING_SAMPLE_LIGHT) writeonly buffer SampleLight { vec4 light[]; };
// Of paths that go on, two a path each: rays; reflectance and density, and the cells that the path fills.
layout(std430, binding = BINDING_SAMPLE_RAYS) writeonly buffer Rays { vec4 next_rays[]; };
layout(std430, binding = BINDING_SAMPLE_STATES) writeonly buffer States { vec4 next_states[]; };

uniform uint path_count;
uniform uint path_stride;     // of every so many slots one's path goes on
uniform uint path_phase;      // which one
uniform uint first_next;      // the first place for a path that goes on, and how many there are
uniform uint most_next;
#ifdef FIREFLY_CLAMP
uniform uint first_direct;
#endif
uniform int lamps_light_hits;  // 0: punctual lights alone, in the last bounce
uniform int cache_lights_hits; // 0: not in the last bounces
#ifdef SMOOTH_PATHS
uniform uint most_bounces;     // by which it is known where those are
#endif

const float kFootprintPerMetre = 0.1;  // a diffuse ray's cone: a fraction of its solid angle, for texture levels
const float kSideOverDistance = 0.5;   // of a cell over the length of the ray that came to it

// What a smooth surface mirrors of a light into other surfaces, rays find as rare bright spots: at hits it is as rough as this
// at least (Kaplanyan and Dachsbacher 2013, "Path space regularization for holistic and robust light transport").
const float kLeastAlphaAtHits = 0.25;

struct PathVertex {
  uint slot;
  uint next;         // where its path goes on
  uint number;       // in the sequences of the decisions here
#ifdef FIRST_HITS
  NetPlace place;
#else
  uint seed;
#endif
  Ray ray;
  float ray_pdf;     // times how many such rays there are
  float light_share; // of the density of table lights in the sampling that the rays compete with
};

#ifdef FIRST_HITS
vec2 random_2d(PathVertex at, uint decision) { return net_2d(at.place, at.number, decision); }
#else
vec2 random_2d(PathVertex at, uint decision) { return sobol_2d(at.number, at.seed + decision * 0x9e3779b9u); }
#endif

#ifdef SMOOTH_PATHS
bool lamps_light(PathVertex at) { return bounces_of(at.ray.t_max) < most_bounces; }
bool cache_lights(PathVertex at) { return max(bounces_of(at.ray.t_max), 1u) < most_bounces; }
#else
bool lamps_light(PathVertex at) { return lamps_light_hits == 1; }
bool cache_lights(PathVertex at) { return cache_lights_hits == 1; }
#endif

// A metal that has left to other rays all but the lamps that it mirrors.
bool is_for_lamps_alone(PathVertex at) {
#ifdef MIRRORS_ALONE
  return is_mirror_dropped(at.ray.t_max);
#else
  return false;
#endif
}

// Of the volume between what the ray passed last and its hit.
vec3 absorbed_on_the_way(PathVertex at, Hit hit, HitPoint point) {
#ifdef SMOOTH_PATHS
  return pow(point.medium_transmittance, vec3(max(hit.t - at.ray.t_min, 0.0) / max(hit.t, 1e-20)));
#else
  return point.medium_transmittance;
#endif
}

vec3 light_of_miss(PathVertex at) {
  float weight = 1.0;
#ifdef LIGHTS_ENVIRONMENT
  weight = mis_weight(at.ray_pdf, environment_pdf(at.ray.direction_ws) / at.light_share);
#endif
  return environment_radiance(at.ray.direction_ws) * weight;
}

vec3 emission_of(PathVertex at, Hit hit, HitPoint point) {
  float weight = 1.0;
#ifdef LIGHTS_TRIANGLES
  const float cosine = dot(point.geometric_normal_ws, at.ray.direction_ws);
  const float density = triangle_pdf(hit.instance, hit.triangle, hit.t, cosine) / at.light_share;
  if (density > 0.0) weight = mis_weight(at.ray_pdf, density);
#endif
  return point.surface.emission * weight;
}

// A direction counts where shading and geometric normal agree on its side.
bool is_above(HitPoint point, vec3 in_direction, vec3 in_ws) {
  return in_direction.z > 0.0 && dot(in_ws, point.geometric_normal_ws) > 0.0;
}

struct Cells {
  uint fine, coarse;
};

// What a path finds, and how it goes on.
struct Step {
  vec3 known;
  vec3 direct;      // of it, what comes straight from a lamp or the sky
  vec3 waiting;     // for the shadow ray
  Ray shadow_ray;
  Ray ray;
  vec3 reflected_share;
  float pdf;
  Cells cells;
  float distance_m;
  bool own_path;    // what comes along the ray counts for the slot itself
};

void sample_lights(inout Step next, PathVertex at, Hit hit, HitPoint point, mat3 frame) {
#if defined(LIGHTS_PUNCTUAL) || defined(LIGHTS_TRIANGLES) || defined(LIGHTS_ENVIRONMENT)
  const vec2 u = random_2d(at, kDecisionLight);
  const vec2 u_choice = random_2d(at, kDecisionLightChoice);
  const TableSample lamp = sample_light(point.position_ws, !lamps_light(at), u, u_choice.x, u_choice.y);
  const vec3 in_direction = lamp.to_light_ws * frame;
  // The rays that may find the same light are sampled by the cosine.
  float weight = lamp.pdf > 0.0 ? mis_weight(lamp.pdf, in_direction.z / kPi) : 1.0;
  if (is_for_lamps_alone(at)) weight = 1.0;
  if (is_above(point, in_direction, lamp.to_light_ws))
    next.waiting = brdf_times_cosine(point.brdf, -at.ray.direction_ws * frame, in_direction) * lamp.value * weight;
  if (greatest(next.waiting) > 0.0)
    next.shadow_ray = shadow_ray(lifted(point.position_ws, point.geometric_normal_ws, hit.t, lamp.to_light_ws),
                                 point.position_ws, lamp);
#endif
}

// What the surface sends back of light that arrives from everywhere alike.
vec3 reflectance(PathVertex at, HitPoint point) {
  const float cosine = max(dot(point.surface.normal_ws, -at.ray.direction_ws), 0.0);
  const vec3 all = directional_albedo(point.brdf, cosine);
#ifdef MULTISCATTER
  return all;
#else
  // The base gets what the interface leaves at the more grazing of both directions; over all that come, about so.
  const float kMeanCosine = 0.6;
  const float taken = most_reflected(point.brdf, min(cosine, kMeanCosine));
  return max(all - point.brdf.diffuse_albedo * (taken - point.brdf.f0_dielectric), vec3(0.0));
#endif
}

Cells cells_at(PathVertex at, Hit hit, HitPoint point, bool fills) {
  const vec2 u = random_2d(at, kDecisionCell);
  const float most_side_m = hit.t * kSideOverDistance;
  const CellPlace fine = cell_place(point.position_ws, point.geometric_normal_ws, most_side_m, false, u);
  const CellPlace coarse = cell_place(point.position_ws, point.geometric_normal_ws, most_side_m, true, u);
  Cells cells = Cells(find_cell(fine), find_cell(coarse));
  const uint made_fine = make_cell(fine, fills && cells.fine == kNoCell);
  const uint made_coarse = make_cell(coarse, fills && cells.coarse == kNoCell);
  cells.fine = cells.fine == kNoCell ? made_fine : cells.fine;
  cells.coarse = cells.coarse == kNoCell ? made_coarse : cells.coarse;
  return cells;
}

// The fine cell's, unless it has hardly begun.
CellValue light_of(Cells cells) {
  const CellValue fine = value_of(cells.fine);
  const CellValue coarse = value_of(cells.coarse);
  if (fine.samples >= kFewSamples || fine.samples >= coarse.samples) return fine;
  return coarse;
}

// The ray of the path, should it go on.
void go_on(inout Step next, PathVertex at, Hit hit, HitPoint point, mat3 frame) {
  const vec3 in_direction = cosine_hemisphere(random_2d(at, kDecisionNextRay));
  const vec3 in_ws = normalize(frame * in_direction);
  if (!is_above(point, in_direction, in_ws)) return;
  next.ray = Ray(lifted(point.position_ws, point.geometric_normal_ws, hit.t, in_ws), 0.0, in_ws, 1e30);
  next.pdf = in_direction.z / kPi;
}

const uint kNowhere = 0xffffffffu;

// Where the slot's path goes on, or kNowhere.
uint place_of_next(uint slot) {
  const uint place = slot / path_stride;
  return slot % path_stride == path_phase && place < most_next ? first_next + place : kNowhere;
}

PathVertex vertex_of(uint slot) {
  PathVertex at;
  at.slot = slot;
  at.ray = fetch_ray(int(slot));
  at.next = place_of_next(slot);
#ifdef FIRST_HITS
  const uint texels = traced_texels();
  const ivec2 texel = traced_texel(slot % texels);
  at.number = sample_number(slot / texels);
  at.place = place_of_texel(texel);
  at.ray_pdf = texelFetch(states_in, int(slot)).a * float(rays_per_texel);
  at.light_share = table_sized_share;
#else
  at.number = frame_number;
  at.seed = hash(uvec3(slot, 0x1234567u, seed));
  at.ray_pdf = texelFetch(states_in, int(2u * slot)).a;
  at.light_share = 1.0;
#endif
  return at;
}

Step nothing() {
  return Step(vec3(0.0), vec3(0.0), vec3(0.0), kNoRay, kNoRay, vec3(0.0), 0.0, Cells(kNoCell, kNoCell), -1.0, false);
}

Step meet_surface(PathVertex at, Hit hit, bool goes_on) {
  Step next = nothing();
  HitPoint point = hit_point(at.ray, hit, hit.t * kFootprintPerMetre);
  const bool lit = (point.material_flags & kMaterialUnlit) == 0u;
#ifdef CLEAR_SURFACES
  if ((point.material_flags & kMaterialClear) != 0u) point.brdf.transmission_color = vec3(0.0);
#endif
#if defined(SMOOTH_PATHS) && !defined(MIRRORS_ALONE)
  if (is_mirror_dropped(at.ray.t_max)) point.brdf = brdf_of_map(point.brdf);
#endif
  const mat3 frame = frame_around(point.surface.normal_ws);
  const vec3 reflected_share = reflectance(at, point);
  point.brdf = brdf_in_frame(point.brdf, frame);
  point.brdf.alpha = max(point.brdf.alpha, kLeastAlphaAtHits);
  sample_lights(next, at, hit, point, frame);
  const Cells cells = cells_at(at, hit, point, goes_on && lit);
  const CellValue bounced = light_of(cells);
#ifdef FIRST_HITS
  next.own_path = goes_on && bounced.samples < kFewSamples && !is_for_lamps_alone(at);
#endif
  next.direct = emission_of(at, hit, point);
  next.known = next.direct;
  if (cache_lights(at) && !next.own_path && !is_for_lamps_alone(at)) next.known += bounced.light * reflected_share;
  const vec3 arriving = lit ? absorbed_on_the_way(at, hit, point) : vec3(0.0);
  next.known *= arriving;
  next.direct *= arriving;
  next.waiting *= arriving;
  next.distance_m = hit.t;
  if (lit) {
    go_on(next, at, hit, point, frame);
    next.reflected_share = reflected_share;
    next.cells = cells;
  }
  return next;
}

void write(PathVertex at, Step next) {
  const uint slot = at.slot;
  shadow_rays[2u * slot] = vec4(next.shadow_ray.origin_ws, next.shadow_ray.t_min);
  shadow_rays[2u * slot + 1u] = vec4(next.shadow_ray.direction_ws, next.shadow_ray.t_max);
  light[2u * slot] = vec4(next.known, next.distance_m);
  light[2u * slot + 1u] = vec4(next.waiting, next.own_path ? 1.0 : 0.0);
#ifdef FIREFLY_CLAMP
  light[first_direct + slot] = vec4(next.direct, 0.0);
#endif
  if (at.next == kNowhere) return;
  next_rays[2u * at.next] = vec4(next.ray.origin_ws, next.ray.t_min);
  next_rays[2u * at.next + 1u] = vec4(next.ray.direction_ws, next.ray.t_max);
  next_states[2u * at.next] = vec4(next.reflected_share, next.pdf);
  next_states[2u * at.next + 1u] = vec4(uintBitsToFloat(uvec2(next.cells.fine, next.cells.coarse)), 0.0, 0.0);
}

// Hardly with a branch, for under one a software device reads uniforms once a lane: a miss looks at any surface for
// nothing, and what is beyond the last slot does it once more.
void main() {
  const uint invocation = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const PathVertex at = vertex_of(min(invocation, path_count - 1u));
  Hit hit = fetch_hit(int(at.slot));
  const bool missed = hit.t < 0.0;
  if (missed) hit = Hit(1.0, 0u, 0u, 0.0, 0.0);
  Step next = meet_surface(at, hit, at.next != kNowhere && !missed);
  const vec3 sky = light_of_miss(at);
  if (missed) {
    next = nothing();
    next.known = at.ray.t_max > 0.0 ? sky : vec3(0.0);
    next.direct = next.known;
  }
#ifdef CLEAR_SURFACES
  const vec3 tint = texelFetch(tints, int(at.slot)).rgb;
  next.known *= tint;
  next.direct *= tint;
  next.waiting *= tint;
#endif
  write(at, next);
}
