// Scaling up (thesis 5.2): for a pixel and a direction the nearest of its patch's candidates that its own ray meets. An
// invocation looks after one pixel and one direction. See CandidateTest in renderer/tracing/tracer.h.
#include "shaders/ray.glsl"
#include "tracing/traversal.glsl"
#include "tracing/hit_list_writer.glsl"

layout(local_size_x = TRACE_GROUP_SIZE) in;

layout(std430, binding = TRACE_BINDING_RAYS) readonly buffer Candidates { Hit candidates[]; };
layout(std430, binding = TRACE_BINDING_RESULTS) writeonly buffer Hits { Hit hits[]; };
layout(std430, binding = TRACE_BINDING_PIXELS) readonly buffer Pixels { uvec4 pixels[]; };  // PixelOrigin
layout(std430, binding = TRACE_BINDING_DIRECTIONS) readonly buffer Directions { vec4 directions[]; };
layout(std430, binding = TRACE_BINDING_PLACES) readonly buffer Places { uint places[]; };          // of triangles
layout(std430, binding = TRACE_BINDING_INSTANCES) readonly buffer Instances { uvec2 instances[]; };  // group, first place

uniform uint pixel_count;
uniform uint patch_count;
uniform uint direction_count;
uniform uint group_count;     // of triangles
uniform int trace_missed;

const uint kNoPatch = 0xffffffffu;

// Keeps the candidate if the ray meets it nearer than `hit`.
void try_candidate(Ray ray, uint instance, uint triangle, inout Hit hit) {
  const uvec2 where = instances[instance];
  uvec4 group;
  const LocalRay local = enter_group(ray, where.x, group);
  test_leaf(local, places[where.y + triangle], 1u, group, ray.t_min, hit);
}

void main() {
  const uint record = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * TRACE_GROUP_SIZE + gl_LocalInvocationID.x;
  const uint pixel = record % pixel_count, direction = record / pixel_count;
  if (direction >= direction_count) return;
  const uvec4 above = pixels[2u * pixel];
  Hit hit = Hit(1e30, 0u, 0u, 0.0, 0.0);
  if (above.w != kNoPatch) {
    const uint patch_ray = direction * patch_count + above.w;
    const vec3 along = directions[patch_ray].xyz;
    const vec3 down = uintBitsToFloat(pixels[2u * pixel + 1u].xyz);
    const vec3 from = uintBitsToFloat(above.xyz) + (dot(along, down) > 0.0 ? down : vec3(0.0));
    const Ray ray = Ray(from, 0.0, along, 1e30);
    bool had_any = false;
    for (uint group = 0u; group < group_count; ++group) {
      const Hit candidate = candidates[group * direction_count * patch_count + patch_ray];
      if (candidate.t < 0.0) continue;
      had_any = true;
      try_candidate(ray, candidate.instance, candidate.triangle * group_count + group, hit);
    }
    if (had_any && hit.t == 1e30 && trace_missed == 1) {
      hit = trace(ray);
      atomicAdd(traced_anew, 1u);
    }
  }
  const bool is_hit = hit.t < 1e30;
  hits[record] = is_hit ? hit : Hit(-1.0, 0u, 0u, 0.0, 0.0);
  if (is_hit) add_to_list(record);
}
