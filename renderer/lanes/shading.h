// The light transport of shaders/ for lanes, and the punctual lights with their maps. For files that are compiled for a
// kind of processor: see renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/rows.h"

#define LANES
#define POINT_LIGHTS

namespace lightwell::lanes {
namespace {

#define float Float
#define bool Mask
#define uint std::uint32_t
// In the order of their needs.
// clang-format off
#include "renderer/shaders/frame.glsl"
#include "renderer/shaders/packing.glsl"
#include "renderer/shaders/brdf.glsl"
#include "renderer/shaders/receiver.glsl"
#include "renderer/shaders/shading_normal.glsl"
#include "renderer/shaders/sky_gradient.glsl"
// clang-format on
#undef float
#undef bool

// Of pairs of floats in rows of `stride` pairs: what lies between four of them, from the pair with this number on.
vec2 mixed_pairs(const float* pairs, std::int32_t stride, Ints first, Float share_x, Float share_y) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  const __m512i numbers = reinterpret_cast<__m512i>(first);
  const auto mixed_half = [&](__m256i at, __m512i lanes) {
    const auto pairs_from = [&](std::int32_t offset) {
      const __m512d gathered = _mm512_mask_i32gather_pd(_mm512_setzero_pd(), 0xff, at, pairs + 2 * offset, 8);
      return Float(reinterpret_cast<Floats>(gathered));
    };
    const Float x(Floats(_mm512_maskz_permutexvar_ps(0xffff, lanes, reinterpret_cast<__m512>(share_x.v))));
    const Float y(Floats(_mm512_maskz_permutexvar_ps(0xffff, lanes, reinterpret_cast<__m512>(share_y.v))));
    return mix(mix(pairs_from(0), pairs_from(1), x), mix(pairs_from(stride), pairs_from(stride + 1), x), y);
  };
  const __m512i lanes_low = _mm512_set_epi32(7, 7, 6, 6, 5, 5, 4, 4, 3, 3, 2, 2, 1, 1, 0, 0);
  const __m512i lanes_high = _mm512_set_epi32(15, 15, 14, 14, 13, 13, 12, 12, 11, 11, 10, 10, 9, 9, 8, 8);
  const __m512i first_of_pairs = _mm512_set_epi32(30, 28, 26, 24, 22, 20, 18, 16, 14, 12, 10, 8, 6, 4, 2, 0);
  const __m512i second_of_pairs = _mm512_set_epi32(31, 29, 27, 25, 23, 21, 19, 17, 15, 13, 11, 9, 7, 5, 3, 1);
  const __m512 low =
      reinterpret_cast<__m512>(mixed_half(_mm512_maskz_extracti32x8_epi32(0xff, numbers, 0), lanes_low).v);
  const __m512 high =
      reinterpret_cast<__m512>(mixed_half(_mm512_maskz_extracti32x8_epi32(0xff, numbers, 1), lanes_high).v);
  return {Floats(_mm512_permutex2var_ps(low, first_of_pairs, high)),
          Floats(_mm512_permutex2var_ps(low, second_of_pairs, high))};
#else
  alignas(64) std::int32_t texels[kLanes];
  alignas(64) float shares_x[kLanes], shares_y[kLanes], means[kLanes], mean_squares[kLanes];
  store(texels, first), store(shares_x, share_x.v), store(shares_y, share_y.v);
  using Pair = float __attribute__((vector_size(16)));  // two texels side by side
  for (int i = 0; i < kLanes; ++i) {
    const float* upper = pairs + 2 * static_cast<std::int64_t>(texels[i]);
    const Pair above = load<Pair>(upper), below = load<Pair>(upper + 2 * static_cast<std::int64_t>(stride));
    const Pair between = above + shares_y[i] * (below - above);
    const Pair right = __builtin_shufflevector(between, between, 2, 3, 2, 3);
    const Pair mixed = between + shares_x[i] * (right - between);
    means[i] = mixed[0], mean_squares[i] = mixed[1];
  }
  return {load_float(means), load_float(mean_squares)};
#endif
}

// The lights, their block and their maps.
struct Lighting {
  explicit Lighting(const LightEnvironment& environment)
      : environment_(environment),
        shadow_least_variance(environment.shadow_least_variance),
        shadow_cube_scale(environment.shadow_cube_scale) {}

  // Bilinear, clamped to the edge.
  vec2 shadow_moments_at(vec3 place) const {
    const std::int32_t side = environment_.shadow_side_px;
    const Float x = clamp(place.x * side - 0.5, 0, side - 1), y = clamp(place.y * side - 0.5, 0, side - 1);
    const Ints column = truncated(min(x, side - 2)), row = truncated(min(y, side - 2));
    const Ints texel = (truncated(max(place.z + 0.5, 0.0)) * side + row) * side + column;
    const Float share_x = x - to_float(column), share_y = y - to_float(row);
    return mixed_pairs(environment_.shadow_moments, side, texel, share_x, share_y);
  }

#define float Float
#define bool Mask
#include "renderer/shaders/lights.glsl"
#undef float
#undef bool
#undef uint

  static Light light_of(const PackedLight& packed) {
    Light light;
    light.position_ws = all_lanes(packed.position_ws);
    light.inverse_range = packed.inverse_range;
    light.direction_ws = all_lanes(packed.direction_ws);
    light.kind = packed.kind;
    light.intensity = all_lanes(packed.intensity);
    light.spot_scale = packed.spot_scale;
    light.spot_offset = packed.spot_offset;
    light.shadow_far_m = packed.shadow_far_m;
    light.first_shadow_layer = packed.first_shadow_layer;
    for (int i = 0; i < 4; ++i) {
      const float* column = packed.shadow_clip_from_world[i];
      light.shadow_clip_from_world.columns[i] = vec4(column[0], column[1], column[2], column[3]);
    }
    return light;
  }

  // reflected_punctual_light(), but that nothing is done for light that reaches no lane from the front.
  vec3 reflected(Mask wanted, const Brdf& brdf, vec3 position_ws, vec3 normal_ws, vec3 out_ws) {
    vec3 radiance(0.0);
    for (std::uint32_t i = 0; i < environment_.light_count; ++i) {
      const Light light = light_of(environment_.lights[i]);
      const LightSample at = light_at(light, position_ws);
      const Float most = max(at.irradiance.x, max(at.irradiance.y, at.irradiance.z));
      if (!any(wanted && most > 0.0 && dot(normal_ws, at.to_light_ws) > 0.0)) continue;
      radiance += brdf_times_cosine(brdf, normal_ws, out_ws, at.to_light_ws) * at.irradiance *
                  light_visibility(light, position_ws, normal_ws, at.to_light_ws);
    }
    return radiance;
  }

 private:
  const LightEnvironment& environment_;

 public:
  Float shadow_least_variance, shadow_cube_scale;
};

}  // namespace
}  // namespace lightwell::lanes
