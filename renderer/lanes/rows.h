// Rows of numbers in memory and the lanes they are computed with. For files that are compiled for a kind of processor:
// see renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/glsl.h"
#include "renderer/lanes/patch_light.h"

namespace lightwell::lanes {
namespace {

template <class Vector>
Vector load(const void* from) {
  Vector vector;
  __builtin_memcpy(&vector, from, sizeof vector);
  return vector;
}
template <class Vector>
void store(void* to, Vector vector) {
  __builtin_memcpy(to, &vector, sizeof vector);
}

Float load_float(const float* from) {
  return load<Floats>(from);
}
vec3 load_vec3(const PixelFloats* from, std::uint32_t i) {
  return {load_float(&from[0][i]), load_float(&from[1][i]), load_float(&from[2][i])};
}
void store_vec3(PixelFloats* to, std::uint32_t i, vec3 value) {
  store(&to[0][i], value.x.v), store(&to[1][i], value.y.v), store(&to[2][i], value.z.v);
}
vec3 all_lanes(const float* value) {
  return {value[0], value[1], value[2]};
}

// from[places], one a lane.
Float gathered(const float* from, Ints places) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return Floats(_mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff, reinterpret_cast<__m512i>(places), from, 4));
#elif defined(__AVX2__)
  const __m256 all = reinterpret_cast<__m256>(Ints{} - 1);
  return Floats(_mm256_mask_i32gather_ps(_mm256_setzero_ps(), from, reinterpret_cast<__m256i>(places), all, 4));
#else
  Floats lanes;
  for (int i = 0; i < kLanes; ++i) lanes[i] = from[places[i]];
  return lanes;
#endif
}
vec3 gathered_vec3(const PixelFloats* from, Ints places) {
  return {gathered(from[0], places), gathered(from[1], places), gathered(from[2], places)};
}

float least_lane(Float lanes) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  const auto with = [](Float x, __m512 other) { return min(x, Floats(other)); };
  const auto vector = [](Float x) { return reinterpret_cast<__m512>(x.v); };
  lanes = with(lanes, _mm512_maskz_shuffle_f32x4(0xffff, vector(lanes), vector(lanes), 0x4e));
  lanes = with(lanes, _mm512_maskz_shuffle_f32x4(0xffff, vector(lanes), vector(lanes), 0xb1));
  lanes = with(lanes, _mm512_maskz_permute_ps(0xffff, vector(lanes), 0x4e));
  return with(lanes, _mm512_maskz_permute_ps(0xffff, vector(lanes), 0xb1)).v[0];
#else
  float least = lanes.v[0];
  for (int i = 1; i < kLanes; ++i) least = lanes.v[i] < least ? lanes.v[i] : least;
  return least;
#endif
}

Ints lane_numbers() {
  Ints numbers;
  for (int i = 0; i < kLanes; ++i) numbers[i] = i;
  return numbers;
}
Mask in_run(std::uint32_t i, PixelRun run) {
  return less(lane_numbers(), Ints{} + static_cast<std::int32_t>(run.end - i));
}

}  // namespace
}  // namespace lightwell::lanes
