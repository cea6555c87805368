// The light of a patch's samples, and the light found in the frames before: temporal reuse. The history follows the surface
// and counts where depth (as distance from the plane) and normal agree. The map holds light over directional albedo.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#define FLAT_CAMERA
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/patch_samples.glsl"
#include "shaders/sum_samples.glsl"
#include "shaders/map_variance.glsl"

layout(binding = UNIT_IMAGE_A) uniform sampler2D previous_map;           // rgb; a: frames in it
layout(binding = UNIT_IMAGE_B) uniform sampler2D previous_moments;       // of luminance: first, second; of late frames; frames
layout(binding = UNIT_IMAGE_C) uniform usampler2D previous_guide;        // position, normal and roughness

layout(location = 0) out vec4 out_map;
layout(location = 1) out vec4 out_moments;
layout(location = 2) out uvec4 out_guide;
layout(location = 3) out vec4 out_filtered;  // what patch_filter.frag begins with

#ifdef MOTION
layout(binding = UNIT_G_MOTION) uniform sampler2D g_motion;  // metres since the frame before
#endif

uniform mat4 previous_clip_from_world;
uniform float kept_frames;           // that the history counts for at most
uniform int has_history;

const float kPlaneTolerance = 0.02;  // of the distance from the eye
const float kLeastCosine = 0.9;
const float kMostRougher = 0.2;
const float kBorrowedFrames = 0.25;  // that another texel's rays count for
const float kGreatest = 1e15;
const float kLateFrames = 6.0;
const float kMostDeviations = 4.0;   // of the late frames' mean

struct History {
  vec3 light;
  float frames;
  vec3 moments;
  float weight;
};

// Whether late frames differ from all by more than their noise explains, over the texels around: then the light here has
// changed, and the history counts for less. Of the frames that the history may count for.
float frames_left_by_change(ivec2 texel, float frames) {
  float difference = 0.0, variance = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const vec3 moments = texelFetch(previous_moments, clamp(texel + ivec2(x, y), ivec2(0), map_size_px - 1), 0).xyz;
      difference += moments.z - moments.x;
      variance += max(moments.y - moments.x * moments.x, 0.0) / kLateFrames;
    }
  const float ratio = difference * difference / max(kMostDeviations * kMostDeviations * variance, 1e-30);
  return frames > 2.0 * kLateFrames && ratio > 1.0 ? max(kLateFrames / ratio, 1.0) : frames;
}

// What must be the same a frame ago, for the light found then to count.
struct Sought {
  vec3 position_ws;  // where the surface was
  vec3 normal_ws;
  float roughness;
  float plane_scale;
};

void add_tap(inout History history, ivec2 texel, float weight, Sought sought) {
  const ivec2 inside = clamp(texel, ivec2(0), map_size_px - 1);
  const uvec4 there = texelFetch(previous_guide, inside, 0);
  const vec4 value = texelFetch(previous_map, inside, 0);
  const vec4 other = unpack_normal_roughness(there.w);
  const float off_plane = abs(dot(uintBitsToFloat(there.xyz) - sought.position_ws, sought.normal_ws)) * sought.plane_scale;
  const bool same = inside == texel && value.a > 0.0 && off_plane < 1.0 && dot(other.xyz, sought.normal_ws) > kLeastCosine &&
                    abs(other.w - sought.roughness) < kMostRougher;
  if (!same) return;
  history.light += weight * value.rgb;
  history.frames += weight * value.a;
  history.moments += weight * texelFetch(previous_moments, inside, 0).xyz;
  history.weight += weight;
}

// Where the point was seen a frame ago, in pixels; not in the picture if it was behind the camera.
vec2 pixel_before(vec3 position_before_ws) {
  const vec4 clip = previous_clip_from_world * vec4(position_before_ws, 1.0);
  return clip.w > 0.0 ? (clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size_px.xy) : vec2(-1e6);
}

// About `before`, the place in the map where the surface was; texel n lies at n.
History history_at(vec2 before, Sought sought) {
  History history = History(vec3(0.0), 0.0, vec3(0.0), 0.0);
  if (has_history == 0) return history;
  const ivec2 corner = ivec2(floor(before));
  const vec2 fraction = before - vec2(corner);
  for (int i = 0; i < 4; ++i) {
    const ivec2 offset = ivec2(i & 1, i >> 1);
    const vec2 share = mix(1.0 - fraction, fraction, vec2(offset));
    if (share.x * share.y > 1e-3) add_tap(history, corner + offset, share.x * share.y, sought);
  }
  // An edge within the patch: its other surface was seen last. A neighbour knows this one. A loop, and no branch: what a
  // branch leaves out a software device does all the same.
  const ivec2 nearest = ivec2(floor(before + 0.5));
  const int neighbours = history.weight > 0.0 ? 0 : 9;
  for (int i = 0; i < neighbours; ++i) add_tap(history, nearest + ivec2(i % 3, i / 3) - 1, 1.0, sought);
  return history;
}

// Whether the texel's pixel is of the point's surface.
bool is_like(ivec2 texel, GBufferPoint point) {
  const GBufferPoint other = g_buffer_point(sampled_pixel(texel));
  const float off_plane = abs(dot(other.position_ws - point.position_ws, point.normal_ws));
  return other.valid && off_plane < kPlaneTolerance * point.view_depth_m && dot(other.normal_ws, point.normal_ws) > kLeastCosine;
}

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  const ivec2 pixel = sampled_pixel(texel);
  const GBufferPoint point = g_buffer_point(pixel);
  out_guide = uvec4(floatBitsToUint(point.position_ws),
                    pack_normal_roughness(point.normal_ws, sqrt(point.brdf.alpha)));
  if (!point.valid) {
    out_map = vec4(0.0);
    out_moments = vec4(0.0);
    out_filtered = vec4(0.0, 0.0, 0.0, -1.0);
    return;
  }
  const ivec2 traced = traced_texel(traced_index(texel));
  const bool is_traced = texel == traced;
  // History never lets go of what is not a number, and luminance is squared.
  const vec3 samples = light_of_samples(traced_index(texel));
  const vec3 now = mix(vec3(0.0), clamp(samples, 0.0, kGreatest), equal(samples, samples));
  const float now_luminance = luminance(now);
  Sought sought = Sought(point.position_ws, point.normal_ws, sqrt(point.brdf.alpha), 1.0 / (kPlaneTolerance * point.view_depth_m));
#ifdef MOTION
  sought.position_ws -= texelFetch(g_motion, pixel, 0).xyz;
#endif
  // By the texel's middle, not by the pixel's: what does not move is not resampled and stays sharp.
  const vec2 way_px = pixel_before(sought.position_ws) - (vec2(pixel) + 0.5);
  const vec2 before = vec2(texel) + way_px / pixels_per_texel;
  const History history = history_at(before, sought);
  const float share = 1.0 / max(history.weight, 1e-6);
  float frames = min(history.weight > 0.0 ? history.frames * share : 0.0, kept_frames);
  frames = frames_left_by_change(ivec2(floor(before + 0.5)), frames);
  // A texel that has no rays in this frame keeps what it knows; if that is nothing, what its patch has found on the same
  // surface will do until its turn comes.
  const bool borrows = !is_traced && history.weight <= 0.0;
  if (borrows && !is_like(traced, point)) {
    out_map = vec4(0.0);
    out_moments = vec4(0.0);
    out_filtered = vec4(0.0, 0.0, 0.0, -1.0);
    return;
  }
  const float counts = is_traced ? 1.0 : borrows ? kBorrowedFrames : 0.0;
  const float fresh = counts / max(frames + counts, 1e-6);
  frames += counts - 1.0;
  out_map = vec4(mix(history.light * share, now, fresh), frames + 1.0);
  out_moments.xy = mix(history.moments.xy * share, vec2(now_luminance, now_luminance * now_luminance), fresh);
  out_moments.z = mix(history.moments.z * share, now_luminance, counts > 0.0 ? max(fresh, 1.0 / kLateFrames) : 0.0);
  out_moments.w = frames + 1.0;
  out_filtered = vec4(out_map.rgb, variance_of_mean(out_moments.xy, out_moments.w));
}
