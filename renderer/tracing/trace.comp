// Traces a batch of rays: visibility bits if ANY_HIT, else nearest hits.
#include "shaders/ray.glsl"
#include "tracing/traversal.glsl"

layout(local_size_x = TRACE_GROUP_SIZE) in;

layout(std430, binding = TRACE_BINDING_RAYS) readonly buffer Rays { Ray rays[]; };
#if ANY_HIT
layout(std430, binding = TRACE_BINDING_RESULTS) writeonly buffer Visible { uint visible[]; };
shared uint group_visible[TRACE_GROUP_SIZE / 32];
#else
layout(std430, binding = TRACE_BINDING_RESULTS) writeonly buffer Hits { Hit hits[]; };
#include "tracing/hit_list_writer.glsl"
uniform int lists_hits;
#endif
uniform uint ray_count;

void main() {
  const uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * TRACE_GROUP_SIZE + gl_LocalInvocationID.x;
  const bool exists = index < ray_count;
  bool is_hit = false;
  Hit hit;
  if (exists) {
    const Ray ray = rays[index];
    if (ray.t_max >= ray.t_min) {
      hit = trace(ray);
      is_hit = hit.t < ray.t_max;
    }
  }
#if ANY_HIT
  const uint lane = gl_LocalInvocationID.x;
  if (lane < TRACE_GROUP_SIZE / 32) group_visible[lane] = 0u;
  barrier();
  if (exists && !is_hit) atomicOr(group_visible[lane / 32u], 1u << (lane % 32u));
  barrier();
  if (exists && lane % 32u == 0u) visible[index / 32u] = group_visible[lane / 32u];
#else
  if (exists) hits[index] = is_hit ? hit : Hit(-1.0, 0u, 0u, 0.0, 0.0);
  if (lists_hits == 1 && is_hit) add_to_list(index);
#endif
}
