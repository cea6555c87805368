// Rays of the occlusion map whose nearest hit is a clear surface go straight on: the hit behind it takes its place, and the
// surface's tint and own light are kept. FIRST: the hits are the tracer's; without it those of the rays that went on.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/scene_data.glsl"
#include "shaders/ray.glsl"
#include "shaders/textures.glsl"
#include "shaders/surface.glsl"
#include "shaders/hit_surface.glsl"
#include "shaders/lights.glsl"
#include "shaders/clear_hit.glsl"
#ifdef FIRST
#include "shaders/occlusion_ray.glsl"
#else
#include "shaders/fetch_hit.glsl"
#endif

layout(std430, binding = BINDING_HITS) buffer Hits { Hit hits[]; };  // the occlusion map's
layout(std430, binding = BINDING_RAYS) writeonly buffer Onward { Ray onward[]; };
// Two a record: what the clear surfaces pass, and what they send themselves.
layout(std430, binding = BINDING_ARRIVING) buffer Cleared { vec4 cleared[]; };
layout(std430, binding = BINDING_OUTPUT) buffer Count { uint onward_count; };

uniform uint record_count;
uniform int goes_on;  // 0: no further surface lets light through

const float kFootprintPerMetre = 0.1;  // as in hit_light.comp

// A clear surface's highlight of a lamp is so small that rays find it as rare bright spots: they see it wider (Kaplanyan and
// Dachsbacher 2013, "Path space regularization for holistic and robust light transport").
const float kLeastAlpha = 0.25;

// Light that the surface reflects and emits; the back of a volume's surface counts for nothing.
vec3 own_light(Ray ray, HitPoint point, bool inside) {
  Brdf brdf = point.brdf;
  brdf.transmission_color = vec3(0.0);
  brdf.alpha = max(brdf.alpha, kLeastAlpha);
  const vec3 light = point.surface.emission +
                     reflected_punctual_light(brdf, point.position_ws, point.surface.normal_ws, -ray.direction_ws);
  return inside ? vec3(0.0) : light;
}

void pass_surface(uint record, Ray ray, Hit hit, vec3 tint, vec3 own) {
  const HitPoint point = hit_point(ray, hit, hit.t * kFootprintPerMetre);
  const bool inside = point.from_behind && point.brdf.eta != 1.0;
  const vec3 passed = passed_straight(ray, hit, point);
  cleared[2u * record] = vec4(tint * passed, 0.0);
  cleared[2u * record + 1u] = vec4(own + tint * own_light(ray, point, inside), 0.0);
  onward[record] = past_surface(ray, hit);
  atomicAdd(onward_count, 1u);
}

void main() {
  const uint record = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (record >= record_count) return;
#ifdef FIRST
  const Ray ray = occlusion_ray(record);
  const Hit hit = hits[record];
  const vec3 tint = vec3(1.0), own = vec3(0.0);
  cleared[2u * record] = vec4(1.0);
  cleared[2u * record + 1u] = vec4(0.0);
#else
  const Ray ray = fetch_ray(int(record));
  if (ray.t_max < ray.t_min) return;
  const Hit hit = fetch_hit(int(record));
  hits[record] = hit;
  const vec3 tint = cleared[2u * record].rgb, own = cleared[2u * record + 1u].rgb;
#endif
  if (goes_on == 1 && is_clear(hit, kMaterialClear))
    pass_surface(record, ray, hit, tint, own);
  else
    onward[record] = Ray(vec3(0.0), 0.0, vec3(0.0, 1.0, 0.0), -1.0);
}
