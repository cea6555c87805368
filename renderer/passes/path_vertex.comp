// A path meets a surface. Its light is added, weighted against what the last surface's sample of the lights could have
// found (Veach 1997, power heuristic); a light is sampled, to be added if its shadow ray gets through; and the path goes
// on along a direction sampled by the BRDF or by photon guides (GUIDED), or ends.
// CLEAR_WALLS: there are thin surfaces that light goes straight on through. Shadow rays pass them (clear_shadows.comp), and
// so do paths, as if they met nothing: to pass one is no bounce.
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
#ifdef CLEAR_WALLS
#include "shaders/clear_hit.glsl"
#endif
#include "shaders/lights.glsl"
#include "shaders/environment.glsl"
#include "shaders/light_sampling.glsl"
#include "shaders/next_event.glsl"
#include "shaders/light_strategy.glsl"
#include "shaders/fetch_hit.glsl"
#include "shaders/path.glsl"
#ifdef GUIDED
#include "shaders/guide_cells.glsl"
#include "shaders/guides.glsl"
#endif
#include "shaders/direction_sampling.glsl"

layout(binding = UNIT_HIT_LIST) uniform usamplerBuffer hit_list;       // which paths met a surface
layout(binding = UNIT_PATH_STATES) uniform samplerBuffer states_in;    // throughput; density of the ray's direction
layout(binding = UNIT_PATH_PENDING) uniform usamplerBuffer pending_in;  // a path's word in w
layout(binding = UNIT_PATH_RADIANCE) uniform samplerBuffer radiance_before;
// All is written once, at the end, and by four words: on a software device every store is a loop over the lanes.
layout(std430, binding = BINDING_PATH_RAYS) writeonly buffer Rays { vec4 rays[]; };                     // 2 a ray
layout(std430, binding = BINDING_PATH_SHADOW_RAYS) writeonly buffer ShadowRays { vec4 shadow_rays[]; };  // 2 a ray
layout(std430, binding = BINDING_PATH_STATES) writeonly buffer States { vec4 states[]; };
layout(std430, binding = BINDING_PATH_PENDING) writeonly buffer Pending { uvec4 pending[]; };
layout(std430, binding = BINDING_PATH_RADIANCE) writeonly buffer Radiance { vec4 radiance[]; };

uniform uint path_count;
uniform uint most_bounces;

const uint kRouletteAfter = 3u;       // bounces
// Of Russian roulette: by the root of the throughput, for the little that a path still carries must not become as much noise
// as the paths before it. Measured against a path's cost: a tenth less error for the same time than by the root alone, a
// quarter less than by the throughput itself.
const float kSurvivalScale = 1.5;
const float kMostSurvival = 0.98;

struct Path {
  Ray ray;
  vec3 throughput;
  float pdf;
  uint pixel;
  uint depth;
  uint walls;
  vec4 before;  // the light its pixel has
};

// What a path takes from a surface.
struct Step {
  vec4 found;        // light, for its pixel
  vec3 light;        // that waits for its shadow ray
  Ray shadow_ray;
  Ray ray;
  vec3 throughput;
  float pdf;
  uint word;
};

vec4 emitted_light(Path path, Hit hit, HitPoint point) {
  const bool seen = path.depth == 0u;
  const bool unlit = (point.material_flags & kMaterialUnlit) != 0u;
  if (unlit) return seen ? unlit_light(point.surface.base_color.rgb, path.throughput, -1.0, path.before) : vec4(0.0);
  float weight = 1.0;
#ifdef LIGHTS_TRIANGLES
  const float cosine = dot(point.geometric_normal_ws, path.ray.direction_ws);
  if (!seen) weight = weight_of_found_light(path.pdf, triangle_pdf(hit.instance, hit.triangle, hit.t, cosine));
#endif
  const vec4 light = shown_light(path.throughput * point.surface.emission * weight, seen);
  return seen && path.before.a == 0.0 ? light + vec4(0.0, 0.0, 0.0, 1.0) : light;  // 1: a surface, see Picture
}

// The part of f cos(theta) that counts: shading and geometric normal must agree on which side a direction is.
vec3 reflected(HitPoint point, vec3 out_direction, vec3 in_direction, vec3 in_ws) {
  const bool agree = in_direction.z * dot(in_ws, point.geometric_normal_ws) > 0.0;
  return agree ? brdf_times_cosine(point.brdf, out_direction, in_direction) : vec3(0.0);
}

// A direction whose light the path's own ray brings, straight through a clear wall.
bool is_straight_on(HitPoint point, vec3 in_direction) {
#ifdef CLEAR_WALLS
  return (point.material_flags & kMaterialClearWall) != 0u && in_direction.z < 0.0;
#else
  return false;
#endif
}

void sample_lights(inout Step next, Path path, Hit hit, HitPoint point, DirectionSampling sampling, mat3 frame,
                   vec3 out_direction, uint pixel_seed, float u_choice) {
#if defined(LIGHTS_PUNCTUAL) || defined(LIGHTS_TRIANGLES) || defined(LIGHTS_ENVIRONMENT)
  const uint light_seed = decision_seed(pixel_seed, path.depth, kDecisionLight);
  const vec2 u = sobol_2d(sample_number, light_seed);
  const float u_cell = unit_interval(hash(light_seed + sample_number * 0x85ebca6bu));
  const TableSample at = sample_light(point.position_ws, path.depth >= most_bounces, u, u_choice, u_cell);
  const vec3 in_direction = at.to_light_ws * frame;
  const float weight =
      weight_of_sampled_light(at.pdf, direction_pdf(sampling, point, out_direction, in_direction, at.to_light_ws));
  const vec3 light = path.throughput * reflected(point, out_direction, in_direction, at.to_light_ws) * at.value * weight;
  if (greatest(light) <= 0.0 || is_straight_on(point, in_direction)) return;
  const Ray ray = shadow_ray(lifted(point.position_ws, point.geometric_normal_ws, hit.t, at.to_light_ws),
                             point.position_ws, at);
  if (ray.t_max <= 0.0) return;
  next.shadow_ray = ray;
  next.light = light;
  if (path.depth == 0u && at.pdf <= 0.0) next.word |= kDirectLight;
#endif
}

// The next ray and what it will carry; ends the path where there is none.
void go_on(inout Step next, Path path, Hit hit, HitPoint point, DirectionSampling sampling, mat3 frame,
           vec3 out_direction, uint pixel_seed, float u_lobe) {
  const vec2 u = sobol_2d(sample_number, decision_seed(pixel_seed, path.depth, kDecisionDirection));
  const vec3 in_direction = sample_direction(sampling, point, frame, out_direction, u, u_lobe);
  const vec3 in_ws = normalize(frame * in_direction);
  next.pdf = direction_pdf(sampling, point, out_direction, in_direction, in_ws);
  next.throughput = path.throughput * reflected(point, out_direction, in_direction, in_ws) / max(next.pdf, 1e-20);
  bool alive = next.pdf > 0.0 && path.depth < min(most_bounces, kGreatestDepth) && greatest(next.throughput) > 0.0;
  if (path.depth >= kRouletteAfter) {
    const float survival = min(kSurvivalScale * sqrt(greatest(next.throughput)), kMostSurvival);
    alive = alive && sobol_1d(sample_number, decision_seed(pixel_seed, path.depth, kDecisionSurvival)) < survival;
    next.throughput /= max(survival, 1e-20);
  }
  if (alive) next.ray = Ray(lifted(point.position_ws, point.geometric_normal_ws, hit.t, in_ws), 0.0, in_ws, 1e30);
}

#ifdef CLEAR_WALLS
// By chance, instead of go_on(): the path passes the wall. Lights behind it are found by what comes before the wall, whose
// density stays.
bool passes_wall(inout Step next, Path path, Hit hit, HitPoint point, vec3 out_direction, float u_lobe) {
  const float share = lobe_probabilities(point.brdf, out_direction).w;
  if ((point.material_flags & kMaterialClearWall) == 0u || u_lobe >= share) return false;
  const vec3 passed = clear_transmittance(point.brdf, vec3(0.0, 0.0, 1.0), out_direction);
  next.throughput = path.throughput * passed / share;
  next.pdf = path.pdf;
  next.word = pack_path(path.pixel, path.depth, path.walls + 1u) | (next.word & kDirectLight);
  if (greatest(next.throughput) > 0.0) next.ray = past_surface(path.ray, hit);
  return true;
}
#endif

// The camera does not see backs, as in the G-buffer: its ray goes on behind them.
Step pass_through(Path path, Hit hit) {
  const Ray ray = Ray(path.ray.origin_ws, hit.t * (1.0 + 2e-6), path.ray.direction_ws, path.ray.t_max);
  return Step(vec4(0.0), vec3(0.0), kNoRay, ray, path.throughput, path.pdf,
              pack_path(path.pixel, path.depth, path.walls));
}

Step meet_surface(Path path, Hit hit) {
  HitPoint point = hit_point(path.ray, hit, 0.0);
  if (path.depth == 0u && point.from_behind && (point.material_flags & kMaterialDoubleSided) == 0u)
    return pass_through(path, hit);
  path.throughput *= point.medium_transmittance;
  Step next = Step(emitted_light(path, hit, point), vec3(0.0), kNoRay, kNoRay, vec3(0.0), 0.0,
                   pack_path(path.pixel, path.depth + 1u, 0u));
  if ((point.material_flags & kMaterialUnlit) != 0u) return next;
  const uint seed_of_pixel = pixel_seed(picture_pixel(path.pixel)) + path.walls * 0x68bc21ebu;
  const mat3 frame = frame_around(point.surface.normal_ws);
  const vec3 out_direction = -path.ray.direction_ws * frame;
  point.brdf = brdf_in_frame(point.brdf, frame);
  const vec2 u_kinds = sobol_2d(sample_number, decision_seed(seed_of_pixel, path.depth, kDecisionKinds));
  const DirectionSampling sampling = direction_sampling(point, out_direction);
  sample_lights(next, path, hit, point, sampling, frame, out_direction, seed_of_pixel, u_kinds.x);
#ifdef CLEAR_WALLS
  if (passes_wall(next, path, hit, point, out_direction, u_kinds.y)) return next;
#endif
  go_on(next, path, hit, point, sampling, frame, out_direction, seed_of_pixel, u_kinds.y);
  return next;
}

void write(uint slot, Path path, Step next) {
  rays[2u * slot] = vec4(next.ray.origin_ws, next.ray.t_min);
  rays[2u * slot + 1u] = vec4(next.ray.direction_ws, next.ray.t_max);
  shadow_rays[2u * slot] = vec4(next.shadow_ray.origin_ws, next.shadow_ray.t_min);
  shadow_rays[2u * slot + 1u] = vec4(next.shadow_ray.direction_ws, next.shadow_ray.t_max);
  states[slot] = vec4(next.throughput, next.pdf);
  pending[slot] = uvec4(floatBitsToUint(next.light), next.word);
  if (next.found != vec4(0.0)) radiance[path.pixel] = path.before + next.found;
}

// Not ended early: under a branch a software device reads uniforms once a lane.
void main() {
  const uint invocation = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint slot = min(invocation, path_count - 1u);
  const int from = int(texelFetch(hit_list, int(slot)).x);
  const vec4 state = texelFetch(states_in, from);
  const uint word = texelFetch(pending_in, from).w;
  const uint pixel = path_pixel(word);
  const Path path = Path(fetch_ray(from), state.xyz, state.w, pixel, path_depth(word), path_walls(word),
                         texelFetch(radiance_before, int(pixel)));
  const Step next = meet_surface(path, fetch_hit(from));
  if (invocation < path_count) write(slot, path, next);
}
