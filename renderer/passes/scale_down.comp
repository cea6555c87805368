// Position and normal-depth buffer of the patches (thesis 5.1): the mean over the pixels of a patch that are similar to its
// seed, the pixel nearest to its middle that sees a surface. The mean normal is made a unit vector again.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/camera.glsl"
#include "shaders/indirect_map.glsl"
#include "shaders/patches.glsl"
#include "shaders/similarity.glsl"

layout(std430, binding = BINDING_PATCH_POINTS) writeonly buffer PatchPoints { uvec4 patch_points[]; };  // 2 a patch

PatchPoint seed_of_patch(ivec2 corner, int side) {
  ivec2 seed = corner;
  int least = 1 << 30;
  for (int i = 0; i < side * side; ++i) {
    const ivec2 place = ivec2(i & (side - 1), i >> log2_patch_side);
    const ivec2 off_middle = 2 * place - side;
    const int distance2 = off_middle.x * off_middle.x + off_middle.y * off_middle.y;
    const bool nearer = distance2 < least && sees_surface(corner + place);
    least = nearer ? distance2 : least;
    seed = nearer ? corner + place : seed;
  }
  return point_of_pixel(seed);
}

PatchPoint mean_of_similar(PatchPoint seed, ivec2 corner, int side) {
  PatchPoint mean = seed;
  vec3 position_ws = vec3(0.0), normal_ws = vec3(0.0);
  float view_depth_m = 0.0, count = 0.0;
  for (int i = 0; i < side * side; ++i) {
    const PatchPoint point = point_of_pixel(corner + ivec2(i & (side - 1), i >> log2_patch_side));
    if (!is_similar(point, seed)) continue;
    position_ws += point.position_ws - seed.position_ws;
    normal_ws += point.normal_ws;
    view_depth_m += point.view_depth_m;
    count += 1.0;
  }
  if (count == 0.0) return seed;  // by the printed sign a seed is not even like itself
  mean.position_ws += position_ws / count;
  mean.normal_ws = normalize(normal_ws);
  mean.view_depth_m = view_depth_m / count;
  return mean;
}

void main() {
  const uint slot = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  const uint first_pixel = slot << 2 * log2_patch_side;
  if (first_pixel >= slot_count) return;
  const ivec2 corner = pixel_of_slot(first_pixel);
  const int side = 1 << log2_patch_side;
  const PatchPoint seed = seed_of_patch(corner, side);
  const PatchPoint mean = mean_of_similar(seed, corner, side);
  patch_points[2u * slot] = packed_position(mean);
  patch_points[2u * slot + 1u] = packed_surface(mean);
}
