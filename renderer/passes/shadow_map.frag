// The moments of depth that a light sees: of the rasterised surface, or (FROM_DEPTHS) of what the processor has found.
#include "passes/bindings.glsl"
#include "shaders/packing.glsl"
#include "shaders/sampling.glsl"
#include "shaders/brdf.glsl"
#include "shaders/scene_data.glsl"
#ifdef HAS_TEXTURES
#include "shaders/textures.glsl"
flat in uint material_index;
in vec4 texture_uv;
#endif

layout(location = 0) out vec2 out_moments;

// The second moment takes in the slope of the surface within the texel: Donnelly and Lauritzen 2006, section 4.1.
vec2 moments_of(float depth, float slope2) { return vec2(depth, depth * depth + 0.25 * slope2); }

#ifdef FROM_DEPTHS
layout(binding = UNIT_VIEW_DEPTHS) uniform samplerBuffer view_depths;  // ViewDepth
uniform int side_px;

void main() {
  const ivec2 texel = ivec2(gl_FragCoord.xy);
  const vec2 met = texelFetch(view_depths, texel.y * side_px + texel.x).xy;
  out_moments = met.x >= 0.0 ? moments_of(met.x, met.y) : vec2(1.0);
}
#else
in vec3 world_position;

uniform vec4 light_position_far;  // xyz; w: distance of depth 1, or 0 for a directional light

void main() {
#ifdef HAS_TEXTURES
  const Material material = fetch_material(material_index);
#ifdef TINTED_SHADOWS
  if ((material.flags & kMaterialClear) != 0u) discard;  // see clear_layers.frag
#endif
  if ((material.flags & (kMaterialAlphaMask | kMaterialAlphaBlend)) != 0u) {
    float alpha = material.base_color.a;
    if (material.base_color_texture.slot != 0u)
      alpha *= sample_color_texture(material.base_color_texture, texture_uv.xy, texture_uv.zw, vec2(0.0)).a;
    const bool masked = (material.flags & kMaterialAlphaMask) != 0u;
    if (alpha < (masked ? material.alpha_cutoff : kOpaqueAlpha)) discard;
  }
#endif
  const float depth = light_position_far.w > 0.0
                          ? length(world_position - light_position_far.xyz) / light_position_far.w
                          : gl_FragCoord.z;
  const vec2 slope = vec2(dFdx(depth), dFdy(depth));
  out_moments = moments_of(depth, dot(slope, slope));
}
#endif
