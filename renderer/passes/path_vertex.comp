// A path meets a surface, or leaves the scene. Its light is added, weighted against what the last surface's sample of the
// lights could have found (Veach 1997, power heuristic); a light is sampled, to be added if its shadow ray gets through;
// and the path goes on along a direction sampled by the BRDF, or ends.
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
#include "shaders/fetch_hit.glsl"
#include "shaders/path.glsl"

layout(binding = UNIT_PATH_SLOTS) uniform usamplerBuffer slots;      // where the paths are that go on
layout(binding = UNIT_PATH_STATES) uniform samplerBuffer states_in;  // throughput; density of the ray's direction
layout(binding = UNIT_PATH_PIXELS) uniform usamplerBuffer paths_in;
layout(std430, binding = BINDING_PATH_RAYS) writeonly buffer Rays { Ray rays[]; };
layout(std430, binding = BINDING_PATH_SHADOW_RAYS) writeonly buffer ShadowRays { Ray shadow_rays[]; };
layout(std430, binding = BINDING_PATH_STATES) writeonly buffer States { vec4 states[]; };
layout(std430, binding = BINDING_PATH_PIXELS) writeonly buffer Pixels { uint paths[]; };
layout(std430, binding = BINDING_PATH_PENDING) writeonly buffer Pending { uvec4 pending[]; };
layout(std430, binding = BINDING_PATH_RADIANCE) buffer Radiance { vec4 radiance[]; };

uniform uint path_count;
uniform uint most_bounces;
uniform vec2 strategies; // of sampling lights and of sampling the BRDF: 1 each; with one of them 0 the other stands alone

const uint kRouletteAfter = 3u;       // bounces
// Of Russian roulette: by the root of the throughput, for the little that a path still carries must not become as much noise
// as the paths before it. Measured against a path's cost: a tenth less error for the same time than by the root alone, a
// quarter less than by the throughput itself.
const float kSurvivalScale = 1.5;
const float kMostSurvival = 0.98;

// Of light found by a ray that a BRDF sampled, where sampling the lights has density `light_pdf`.
float weight_of_found_light(float brdf_pdf, float light_pdf) {
  if (light_pdf <= 0.0 || strategies.x < 0.5) return 1.0;
  return strategies.y > 0.5 ? mis_weight(brdf_pdf, light_pdf) : 0.0;
}

float weight_of_sampled_light(float light_pdf, float brdf_pdf) {
  if (light_pdf <= 0.0 || strategies.y < 0.5) return 1.0;  // no density: punctual, no ray finds it
  return strategies.x > 0.5 ? mis_weight(light_pdf, brdf_pdf) : 0.0;
}

struct Path {
  Ray ray;
  vec3 throughput;
  float pdf;
  uint pixel;
  uint depth;
  uint walls;
};

void add_light(Path path, vec3 light, bool direct) {
  if (greatest(light) > 0.0) radiance[path.pixel] += shown_light(light, direct);
}

// What the camera sees that is no lit surface: `mark` tells what it is, see Picture, unless there is a clear wall before it.
void see_unlit(Path path, vec3 light, float mark) {
  if (radiance[path.pixel].a == 0.0)
    radiance[path.pixel] = vec4(light * shown.x, mark);
  else
    add_light(path, path.throughput * light, true);
}

// Light from beyond the scene.
void leave_scene(Path path) {
  const vec3 direction = path.ray.direction_ws;
  if (path.depth == 0u) {
    see_unlit(path, background_radiance(direction), 0.0);
    return;
  }
#ifdef LIGHTS_ENVIRONMENT
  const float weight = weight_of_found_light(path.pdf, environment_pdf(direction));
  add_light(path, path.throughput * environment_radiance(direction) * weight, false);
#endif
}

void add_emission(Path path, Hit hit, HitPoint point) {
  const bool seen = path.depth == 0u;
  const bool unlit = (point.material_flags & kMaterialUnlit) != 0u;
  if (unlit) {
    if (seen) see_unlit(path, point.surface.base_color.rgb, -1.0);
    return;
  }
  float weight = 1.0;
#ifdef LIGHTS_TRIANGLES
  const float cosine = dot(point.geometric_normal_ws, path.ray.direction_ws);
  if (!seen) weight = weight_of_found_light(path.pdf, triangle_pdf(hit.instance, hit.triangle, hit.t, cosine));
#endif
  if (seen && radiance[path.pixel].a == 0.0) radiance[path.pixel].a = 1.0;  // a surface: see Picture
  add_light(path, path.throughput * point.surface.emission * weight, seen);
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

void sample_lights(uint slot, Path path, Hit hit, HitPoint point, mat3 frame, vec3 out_direction, uint pixel_seed,
                   float u_choice, bool lit) {
  Ray ray = kNoRay;
  vec3 light = vec3(0.0);
#if defined(LIGHTS_PUNCTUAL) || defined(LIGHTS_TRIANGLES) || defined(LIGHTS_ENVIRONMENT)
  const uint light_seed = decision_seed(pixel_seed, path.depth, kDecisionLight);
  const vec2 u = sobol_2d(sample_number, light_seed);
  const float u_cell = unit_interval(hash(light_seed + sample_number * 0x85ebca6bu));
  const TableSample at = sample_light(point.position_ws, path.depth >= most_bounces, u, u_choice, u_cell);
  const vec3 in_direction = at.to_light_ws * frame;
  const float weight = weight_of_sampled_light(at.pdf, brdf_pdf(point.brdf, out_direction, in_direction));
  if (lit && !is_straight_on(point, in_direction))
    light = path.throughput * reflected(point, out_direction, in_direction, at.to_light_ws) * at.value * weight;
  const bool worthwhile = greatest(light) > 0.0;
  const vec3 origin_ws = lifted(point.position_ws, point.geometric_normal_ws, hit.t, at.to_light_ws);
  if (worthwhile) ray = shadow_ray(origin_ws, point.position_ws, at);
  const bool direct = path.depth == 0u && at.pdf <= 0.0;
#else
  const bool direct = false;
#endif
  shadow_rays[slot] = ray;
  pending[slot] = uvec4(floatBitsToUint(light), ray.t_max > 0.0 ? pack_pending(path.pixel, direct) : kDeadPath);
}

// The next ray and what it will carry; ends the path where there is none.
void go_on(uint slot, Path path, Hit hit, HitPoint point, mat3 frame, vec3 out_direction, uint pixel_seed,
           float u_lobe, bool lit) {
  const vec2 u = sobol_2d(sample_number, decision_seed(pixel_seed, path.depth, kDecisionDirection));
  const vec3 in_direction = sample_brdf(point.brdf, out_direction, u, u_lobe);
  const float pdf = brdf_pdf(point.brdf, out_direction, in_direction);
  const vec3 in_ws = normalize(frame * in_direction);
  vec3 throughput = path.throughput * reflected(point, out_direction, in_direction, in_ws) / max(pdf, 1e-20);
  bool alive = lit && pdf > 0.0 && path.depth < min(most_bounces, kGreatestDepth) && greatest(throughput) > 0.0;
  if (path.depth >= kRouletteAfter) {
    const float survival = min(kSurvivalScale * sqrt(greatest(throughput)), kMostSurvival);
    alive = alive && sobol_1d(sample_number, decision_seed(pixel_seed, path.depth, kDecisionSurvival)) < survival;
    throughput /= max(survival, 1e-20);
  }
  const vec3 origin_ws = lifted(point.position_ws, point.geometric_normal_ws, hit.t, in_ws);
  rays[slot] = alive ? Ray(origin_ws, 0.0, in_ws, 1e30) : kNoRay;
  states[slot] = vec4(throughput, pdf);
  paths[slot] = alive ? pack_path(path.pixel, path.depth + 1u, 0u) : kDeadPath;
}

#ifdef CLEAR_WALLS
// By chance, instead of go_on(): the path passes the wall. Lights behind it are found by what comes before the wall, whose
// density stays.
bool passes_wall(uint slot, Path path, Hit hit, HitPoint point, vec3 out_direction, float u_lobe) {
  const float share = lobe_probabilities(point.brdf, out_direction).w;
  if ((point.material_flags & kMaterialClearWall) == 0u || u_lobe >= share) return false;
  const vec3 passed = clear_transmittance(point.brdf, vec3(0.0, 0.0, 1.0), out_direction);
  const vec3 throughput = path.throughput * passed / share;
  const bool alive = greatest(throughput) > 0.0;
  if (alive) rays[slot] = past_surface(path.ray, hit);
  else rays[slot] = kNoRay;
  states[slot] = vec4(throughput, path.pdf);
  paths[slot] = alive ? pack_path(path.pixel, path.depth, (path.walls + 1u) & 7u) : kDeadPath;
  return true;
}
#endif

void end_path(uint slot) {
  rays[slot] = kNoRay;
  shadow_rays[slot] = kNoRay;
  pending[slot].w = kDeadPath;
  paths[slot] = kDeadPath;
}

// The camera does not see backs, as in the G-buffer: its ray goes on behind them.
void pass_through(uint slot, Path path, Hit hit) {
  rays[slot] = Ray(path.ray.origin_ws, hit.t * (1.0 + 2e-6), path.ray.direction_ws, path.ray.t_max);
  shadow_rays[slot] = kNoRay;
  pending[slot].w = kDeadPath;
  states[slot] = vec4(path.throughput, path.pdf);
  paths[slot] = pack_path(path.pixel, path.depth, path.walls);
}

void main() {
  const uint slot = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (slot >= path_count) return;
  const int from = int(texelFetch(slots, int(slot)).x);
  const vec4 state = texelFetch(states_in, from);
  const uint packed_path = texelFetch(paths_in, from).x;
  const Hit hit = fetch_hit(from);
  Path path = Path(fetch_ray(from), state.xyz, state.w, path_pixel(packed_path), path_depth(packed_path),
                   path_walls(packed_path));
  if (hit.t < 0.0) {
    leave_scene(path);
    end_path(slot);
    return;
  }
  HitPoint point = hit_point(path.ray, hit, 0.0);
  if (path.depth == 0u && point.from_behind && (point.material_flags & kMaterialDoubleSided) == 0u) {
    pass_through(slot, path, hit);
    return;
  }
  path.throughput *= point.medium_transmittance;
  add_emission(path, hit, point);
  const bool lit = (point.material_flags & kMaterialUnlit) == 0u;
  const uint seed_of_pixel = pixel_seed(picture_pixel(path.pixel)) + path.walls * 0x68bc21ebu;
  const mat3 frame = frame_around(point.surface.normal_ws);
  const vec3 out_direction = -path.ray.direction_ws * frame;
  point.brdf = brdf_in_frame(point.brdf, frame);
  const vec2 u_kinds = sobol_2d(sample_number, decision_seed(seed_of_pixel, path.depth, kDecisionKinds));
  sample_lights(slot, path, hit, point, frame, out_direction, seed_of_pixel, u_kinds.x, lit);
#ifdef CLEAR_WALLS
  if (lit && passes_wall(slot, path, hit, point, out_direction, u_kinds.y)) return;
#endif
  go_on(slot, path, hit, point, frame, out_direction, seed_of_pixel, u_kinds.y, lit);
}
