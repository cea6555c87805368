// What the rays of listed pixels have found, into the picture. REFLECTIONS: joined by what earlier frames found; else in
// place of the indirect map's light.
layout(local_size_x = 64) in;

#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/camera.glsl"
#include "shaders/g_buffer.glsl"
#include "shaders/patch_samples.glsl"
#include "shaders/sum_samples.glsl"
#include "shaders/smooth_lobe.glsl"
#include "shaders/upscaled_map.glsl"

layout(rgba32f, binding = 0) uniform image2D picture;

uniform uint pixel_count;
uniform float share;  // of this frame in the picture

#ifdef REFLECTIONS
#ifdef MOTION
layout(binding = UNIT_G_MOTION) uniform sampler2D g_motion;  // metres since the frame before
#endif
// Two a pixel: light over directional albedo, and frames in it; frame number, normal and roughness, how far behind the
// surface its mirror image lies in the mean.
layout(std430, binding = BINDING_REFLECTIONS) writeonly buffer Reflections { uvec4 reflections[]; };
layout(binding = UNIT_REFLECTIONS_BEFORE) uniform usamplerBuffer reflections_before;

uniform mat4 previous_clip_from_world;
uniform float kept_frames;
uniform float all_rests;  // 1: neither the camera nor anything in the scene has moved since the frame before

const float kLeastCosine = 0.98;
const float kFarthest_m = 1e6;      // where the sky's image lies
const float kMostFarther = 0.1;     // of the image's distance, for images to be the same
const float kGreatest = 1e15;

// What was known of a pixel a frame ago, if it was of this surface.
struct Before {
  vec4 light;  // a: frames, 0 if nothing is known
  float image_m;
};

// The pixel where a place was seen a frame ago; outside of the picture if it was not.
ivec2 pixel_before(vec3 place_ws) {
  const vec4 clip = previous_clip_from_world * vec4(place_ws, 1.0);
  return clip.w > 0.0 ? ivec2(floor((clip.xy / clip.w * 0.5 + 0.5) * vec2(camera.size_px.xy))) : ivec2(-1);
}

Before known_of(ivec2 before, GBufferPoint point) {
  const bool seen = all(greaterThanEqual(before, ivec2(0))) && all(lessThan(before, camera.size_px.xy));
  const int index = seen ? 2 * (before.y * camera.size_px.x + before.x) : 0;
  const uvec4 known = texelFetch(reflections_before, index), of = texelFetch(reflections_before, index + 1);
  const bool same = seen && of.x + 1u == frame_number &&
                    dot(unpack_normal_roughness(of.y).xyz, point.normal_ws) > kLeastCosine;
  return Before(same ? uintBitsToFloat(known) : vec4(0.0), uintBitsToFloat(of.z));
}

// By how far images move as the camera does.
float mean_distance(float a_m, float b_m, float share_of_b, float view_depth_m) {
  const float depth_m = max(view_depth_m, 1e-6);
  return max(1.0 / mix(1.0 / (a_m + depth_m), 1.0 / (b_m + depth_m), share_of_b) - depth_m, 0.0);
}

// A rough surface's rays go to near and far things by turns: where its image lies is their mean, for else every ray would
// take the others' light for that of another image. `image_m`: of this frame's ray; becomes that of all.
Before light_before(GBufferPoint point, ivec2 pixel, bool found, inout float image_m) {
  vec3 surface_ws = point.position_ws;
#ifdef MOTION
  surface_ws -= texelFetch(g_motion, pixel, 0).xyz;
#endif
  const Before here = known_of(pixel_before(surface_ws), point);
  const float frames = min(here.light.a, kept_frames);
  const bool blurs = point.brdf.alpha > kMirrorAlpha || all_rests > 0.5;
  if (frames > 0.0 && (blurs || !found))
    image_m = mean_distance(here.image_m, image_m, found ? 1.0 / (frames + 1.0) : 0.0, point.view_depth_m);
  if (all_rests > 0.5) return here;
  // As in a plane mirror: straight on behind the surface.
  Before image = known_of(pixel_before(surface_ws - image_m * point.to_camera_ws), point);
  if (abs(image.image_m - image_m) >= kMostFarther * (image_m + point.view_depth_m)) image.light = vec4(0.0);
  return image;
}

vec3 light_of_pixel(uint index, ivec2 pixel, GBufferPoint point) {
  point.brdf = brdf_of_reflections(point.brdf);
#ifdef REFRACTED
  const uint slot = index + (point.brdf.eta != 1.0 ? pixel_count : 0u);  // what is seen through the surface
#else
  const uint slot = index;
#endif
  const float hit_m = texelFetch(light, int(2u * slot)).a;
  float image_m = hit_m < 0.0 ? kFarthest_m : min(hit_m, kFarthest_m);
  const bool found = any(greaterThan(texelFetch(states, int(slot)).rgb, vec3(0.0)));  // or no ray was sent at all
  const vec3 samples = light_of_samples(index);
  // History never lets go of what is not a number.
  const vec3 now = mix(vec3(0.0), clamp(samples, 0.0, kGreatest), equal(samples, samples));
  const vec4 before = light_before(point, pixel, found, image_m).light;
  const float frames = min(before.a, kept_frames);
  const vec3 joined = mix(before.rgb, now, 1.0 / (frames + 1.0));
  const uint place = 2u * uint(pixel.y * camera.size_px.x + pixel.x);
  reflections[place] = floatBitsToUint(vec4(joined, frames + 1.0));
  reflections[place + 1u] =
      uvec4(frame_number, pack_normal_roughness(point.normal_ws, sqrt(point.brdf.alpha)), floatBitsToUint(image_m), 0u);
  return modulated(point, vec4(joined, 1.0));
}
#else
vec3 light_of_pixel(uint index, ivec2 pixel, GBufferPoint point) {
  const vec2 uv = (vec2(pixel) + 0.5) / vec2(camera.size_px.xy);
  point.brdf = brdf_of_map(point.brdf);
  return modulated(point, vec4(light_of_samples(index), 1.0)) - modulated(point, upscaled_map(point, uv).light);
}
#endif

void main() {
  const uint index = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
  if (index >= pixel_count) return;
  const ivec2 pixel = sampled_pixel(ivec2(index, 0));
  const vec3 added = share * light_of_pixel(index, pixel, g_buffer_point(pixel));
  const vec4 there = imageLoad(picture, pixel);
  imageStore(picture, pixel, there + vec4(added, there.a < 0.0 ? 0.0 : luminance(added)));
}
