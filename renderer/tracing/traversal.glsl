// Follows rays through the two levels of hierarchies: the top one over groups of instances, and each group's own.
// Needs ray, and the defines: ANY_HIT 1 for visibility, 0 for nearest hits. COVERAGE 1 if some instance needs a coverage
// test. COUNT_TESTS 1 to count the triangles that are tried. BRUTE_FORCE 1 to try every triangle with every ray instead, whatever the hierarchies say.
#include "tracing/bindings.glsl"
#include "tracing/triangle.glsl"
#if COVERAGE
#include "tracing/coverage.glsl"
#endif

layout(std430, binding = TRACE_BINDING_NODES) readonly buffer Nodes { uvec4 node_words[]; };              // BvhNode
layout(std430, binding = TRACE_BINDING_TRIANGLES) readonly buffer Triangles { uvec4 triangle_words[]; };  // DeviceTriangle
layout(std430, binding = TRACE_BINDING_GROUPS) readonly buffer Groups { uvec4 group_words[]; };           // DeviceGroup

#if COUNT_TESTS
layout(std430, binding = TRACE_BINDING_TESTS) buffer Tests { uint triangle_tests; };
#endif

const uint kNeedsCoverage = 0x80000000u;  // DeviceGroup: beside the count of its triangles

uniform uint top_root;  // a BvhChild, or kDone if there is nothing to hit

// BvhChild, and two marks that no leaf looks like.
const uint kLeafBit = 0x80000000u, kCountShift = 27u, kFirstMask = 0x07ffffffu;
const uint kDone = 0xffffffffu, kLeaveGroup = 0xfffffffeu;

// Where the ray is followed: in the world, or in the space of the group it has entered.
struct LocalRay {
  vec3 origin;
  vec3 direction;
  vec3 inverse;  // of the direction, finite
};

LocalRay local_ray(vec3 origin, vec3 direction) {
  // A ray along a plane is tilted by so little that it stays in it, and no product is 0 * infinity.
  const vec3 kLeast = vec3(1e-20);
  const vec3 sign_bit = uintBitsToFloat((floatBitsToUint(direction) & 0x80000000u) | floatBitsToUint(kLeast));
  const vec3 safe = mix(direction, sign_bit, lessThan(abs(direction), kLeast));
  return LocalRay(origin, direction, 1.0 / safe);
}

// The distances at which the ray enters and leaves a box. The far one is enlarged by the rounding of the slab test, so
// that no box is missed: Ize 2013, "Robust BVH Ray Traversal".
vec2 box_interval(LocalRay ray, vec3 box_min, vec3 box_max, float t_min, float t_max) {
  const vec3 a = (box_min - ray.origin) * ray.inverse;
  const vec3 b = (box_max - ray.origin) * ray.inverse;
  const vec3 near = min(a, b), far = max(a, b);
  return vec2(max(max(near.x, near.y), max(near.z, t_min)),
              min(min(far.x, far.y), min(far.z, t_max)) * 1.0000005);
}

// Tests the `count` triangles of a leaf and keeps the nearest hit. Any hit ends the search if ANY_HIT.
void test_leaf(LocalRay ray, uint first, uint count, uvec4 group, float t_min, inout Hit hit) {
  for (uint i = first; i < first + count; ++i) {
    const uvec4 a = triangle_words[3u * i];
    const uvec4 b = triangle_words[3u * i + 1u];
    const uvec4 c = triangle_words[3u * i + 2u];
    float t;
    vec2 uv;
#if COUNT_TESTS
    atomicAdd(triangle_tests, 1u);
#endif
    if (!hits_triangle(ray.origin, ray.direction, t_min, hit.t, uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz),
                       uintBitsToFloat(c.xyz), t, uv))
      continue;
    const uint instance = group.y + b.w;
#if COVERAGE
    if ((group.z & kNeedsCoverage) != 0u && !is_covered(instance, a.w, uv)) continue;
#endif
    hit = Hit(t, instance, a.w, uv.x, uv.y);
#if ANY_HIT
    return;
#endif
  }
}

// The ray in the space of a group, which is read as well. The direction keeps its length there, so distances agree.
LocalRay enter_group(Ray ray, uint index, out uvec4 group) {
  const vec4 x = uintBitsToFloat(group_words[4u * index]), y = uintBitsToFloat(group_words[4u * index + 1u]);
  const vec4 z = uintBitsToFloat(group_words[4u * index + 2u]);
  group = group_words[4u * index + 3u];
  const vec4 origin = vec4(ray.origin_ws, 1.0), direction = vec4(ray.direction_ws, 0.0);
  return local_ray(vec3(dot(x, origin), dot(y, origin), dot(z, origin)),
                   vec3(dot(x, direction), dot(y, direction), dot(z, direction)));
}

#if BRUTE_FORCE
uniform uint scene_groups;  // of instances

// The nearest hit, or any hit if ANY_HIT; hit.t is t_max as it was if there is none.
Hit trace(Ray ray) {
  Hit hit = Hit(ray.t_max, 0u, 0u, 0.0, 0.0);
  for (uint i = 0u; i < scene_groups; ++i) {
    uvec4 group;
    const LocalRay local = enter_group(ray, i, group);
    test_leaf(local, group.w, group.z & ~kNeedsCoverage, group, ray.t_min, hit);
#if ANY_HIT
    if (hit.t < ray.t_max) break;
#endif
  }
  return hit;
}
#else
// The nearest hit, or any hit if ANY_HIT; hit.t is t_max as it was if there is none.
Hit trace(Ray ray) {
  Hit hit = Hit(ray.t_max, 0u, 0u, 0.0, 0.0);
  LocalRay local = local_ray(ray.origin_ws, ray.direction_ws);
  uvec4 group = uvec4(kDone);  // root, first instance, needs coverage; kDone: outside of all groups
  uint stack[TRACE_TOP_LEVELS + TRACE_BOTTOM_LEVELS + 2];
  uint size = 1u;
  stack[0] = kDone;
  uint child = top_root;
  while (true) {
    while ((child & kLeafBit) == 0u) {
      const uvec4 w0 = node_words[4u * child], w1 = node_words[4u * child + 1u];
      const uvec4 w2 = node_words[4u * child + 2u], w3 = node_words[4u * child + 3u];
      const vec2 left = box_interval(local, uintBitsToFloat(w0.xyz), uintBitsToFloat(uvec3(w0.w, w1.xy)), ray.t_min, hit.t);
      const vec2 right = box_interval(local, uintBitsToFloat(uvec3(w1.zw, w2.x)), uintBitsToFloat(w2.yzw), ray.t_min, hit.t);
      const bool hits_left = left.x <= left.y, hits_right = right.x <= right.y;
      if (hits_left && hits_right) {
        const bool left_first = left.x <= right.x;
        child = left_first ? w3.x : w3.y;
        stack[size++] = left_first ? w3.y : w3.x;
      } else if (hits_left || hits_right) {
        child = hits_left ? w3.x : w3.y;
      } else {
        child = stack[--size];
      }
    }
    if (child == kDone) break;
    if (child == kLeaveGroup) {
      local = local_ray(ray.origin_ws, ray.direction_ws);
      group.x = kDone;
      child = stack[--size];
      continue;
    }
    const uint first = child & kFirstMask;
    if (group.x == kDone) {
      local = enter_group(ray, first, group);  // a leaf of the top level is one group
      stack[size++] = kLeaveGroup;
      child = group.x;
      continue;
    }
    const uint count = ((child & ~kLeafBit) >> kCountShift) + 1u;
    test_leaf(local, first, count, group, ray.t_min, hit);
#if ANY_HIT
    if (hit.t < ray.t_max) break;
#endif
    child = stack[--size];
  }
  return hit;
}
#endif
