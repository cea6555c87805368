// A point that the camera sees, without its material: what the G-buffer is made of. It comes from the rasteriser, or
// (FROM_HITS) from the hit of the pixel's ray; either file defines `SeenPoint seen_point()`. Needs camera, scene_data,
// surface.

struct SeenPoint {
  uint material;
  vec3 position_ws;
  float view_depth_m;        // of FROM_HITS alone
  Attributes at;
  vec2 footprint;            // of a pixel, in units of each set of uv
  vec3 geometric_normal_ws;  // on either side, of any length; zero where it is not known
#ifdef FILTER_SPECULAR
  vec3 normal_across;        // how at.normal_ws changes to the next pixel, along the triangle's plane
  vec3 normal_down;
#endif
#ifdef MOTION
  vec3 displacement_ws;      // since the frame before
#endif
};

// Without what textures need.
Attributes plain_attributes(vec3 normal_ws) { return Attributes(normal_ws, vec3(0.0), 1.0, vec2(0.0), vec2(0.0), vec4(1.0)); }

vec2 footprint_of(vec4 uv_across, vec4 uv_down) {
  return vec2(max(length(uv_across.xy), length(uv_down.xy)), max(length(uv_across.zw), length(uv_down.zw)));
}

#ifdef FROM_HITS
#include "shaders/hit_point.glsl"
#else
#include "shaders/rasterized_point.glsl"
#endif
