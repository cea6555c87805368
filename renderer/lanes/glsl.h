// GLSL's types and functions for several pixels at once, one a lane of the processor's vectors, so that the light
// transport of shaders/ that is written without branches (shaders/select.glsl) compiles as C++ too: one implementation
// for all devices. Widths follow the instructions the file at hand is compiled for.
//
// Everything is in an unnamed namespace, and nothing else may be included beside it but what has no functions: code
// that is compiled for a newer processor must not be what the linker keeps for all.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cstdint>

// The name of a table of functions: k<kind of processor><kernels>.
#define LIGHTWELL_LANES_JOIN(prefix, kernels) prefix##kernels
#define LIGHTWELL_LANES_NAME(prefix, kernels) LIGHTWELL_LANES_JOIN(prefix, kernels)
#define LIGHTWELL_LANES_TABLE(kernels) LIGHTWELL_LANES_NAME(LIGHTWELL_LANES_PREFIX, kernels)

namespace lightwell {
namespace {

#if defined(__AVX512F__) && defined(__AVX512DQ__)
constexpr int kLanes = 16;
constexpr const char* kInstructions = "AVX-512";
#elif defined(__AVX2__)
constexpr int kLanes = 8;
constexpr const char* kInstructions = "AVX2";
#else
constexpr int kLanes = 4;
constexpr const char* kInstructions = "plain";
#endif

using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

// A bool in each lane.
struct Mask {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  __mmask16 bits;
  Mask(bool b) : bits(b ? 0xffff : 0) {}
  explicit Mask(__mmask16 b) : bits(b) {}
#else
  Ints bits;  // all bits or none
  Mask(bool b) : bits(Ints{} - static_cast<std::int32_t>(b)) {}
  explicit Mask(Ints b) : bits(b) {}
#endif
  Mask() = default;
};
using MaskBits = decltype(Mask::bits);
inline Mask operator&&(Mask a, Mask b) {
  return Mask(static_cast<MaskBits>(a.bits & b.bits));
}
inline Mask operator||(Mask a, Mask b) {
  return Mask(static_cast<MaskBits>(a.bits | b.bits));
}
inline Mask operator!(Mask a) {
  return Mask(static_cast<MaskBits>(~a.bits));
}
inline Mask operator==(Mask a, Mask b) {
  return Mask(static_cast<MaskBits>(~(a.bits ^ b.bits)));
}

// A bit for each lane, the first lane's the lowest.
inline std::uint32_t lane_bits(Mask mask) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return mask.bits;
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask.bits)));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(mask.bits)));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < kLanes; ++i) bits |= mask.bits[i] != 0 ? 1u << i : 0u;
  return bits;
#endif
}
inline bool any(Mask mask) {
  return lane_bits(mask) != 0;
}

// A float in each lane.
struct Float {
  Floats v;
  Float() = default;
  constexpr Float(Floats x) : v(x) {}
  constexpr Float(float x) : v(Floats{} + x) {}
  constexpr Float(double x) : v(Floats{} + static_cast<float>(x)) {}
  constexpr Float(int x) : v(Floats{} + static_cast<float>(x)) {}
};
inline Float operator+(Float a, Float b) {
  return a.v + b.v;
}
inline Float operator-(Float a, Float b) {
  return a.v - b.v;
}
inline Float operator*(Float a, Float b) {
  return a.v * b.v;
}
inline Float operator-(Float a) {
  return -a.v;
}
inline Float& operator+=(Float& a, Float b) {
  return a = a + b;
}
inline Float& operator*=(Float& a, Float b) {
  return a = a * b;
}

#if defined(__AVX512F__) && defined(__AVX512DQ__)
template <int comparison>
inline Mask compare(Float a, Float b) {
  return Mask(_mm512_cmp_ps_mask(reinterpret_cast<__m512>(a.v), reinterpret_cast<__m512>(b.v), comparison));
}
inline Mask operator<(Float a, Float b) {
  return compare<_CMP_LT_OQ>(a, b);
}
inline Mask operator>(Float a, Float b) {
  return compare<_CMP_GT_OQ>(a, b);
}
inline Mask operator<=(Float a, Float b) {
  return compare<_CMP_LE_OQ>(a, b);
}
inline Mask operator>=(Float a, Float b) {
  return compare<_CMP_GE_OQ>(a, b);
}
inline Mask equal(Ints a, Ints b) {
  return Mask(_mm512_cmpeq_epi32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
}
inline Mask less(Ints a, Ints b) {
  return Mask(_mm512_cmplt_epi32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
}
inline Float select(Mask condition, Float yes, Float no) {
  return Floats(_mm512_mask_blend_ps(condition.bits, reinterpret_cast<__m512>(no.v), reinterpret_cast<__m512>(yes.v)));
}
inline Ints select(Mask condition, Ints yes, Ints no) {
  return Ints(_mm512_mask_blend_epi32(condition.bits, reinterpret_cast<__m512i>(no), reinterpret_cast<__m512i>(yes)));
}
#else
inline Mask operator<(Float a, Float b) {
  return Mask(Ints(a.v < b.v));
}
inline Mask operator>(Float a, Float b) {
  return Mask(Ints(a.v > b.v));
}
inline Mask operator<=(Float a, Float b) {
  return Mask(Ints(a.v <= b.v));
}
inline Mask operator>=(Float a, Float b) {
  return Mask(Ints(a.v >= b.v));
}
inline Mask equal(Ints a, Ints b) {
  return Mask(Ints(a == b));
}
inline Mask less(Ints a, Ints b) {
  return Mask(Ints(a < b));
}
inline Float select(Mask condition, Float yes, Float no) {
  return condition.bits ? yes.v : no.v;
}
inline Ints select(Mask condition, Ints yes, Ints no) {
  return condition.bits ? yes : no;
}
#endif

// Of a number and what is none, the number: clamp() is within its bounds whatever it is given.
inline Float min(Float a, Float b) {
  return select(a < b, a, b);
}
inline Float max(Float a, Float b) {
  return select(a > b, a, b);
}
inline Float clamp(Float x, Float low, Float high) {
  return min(max(x, low), high);
}
inline Float abs(Float x) {
  return Floats(Ints(x.v) & 0x7fffffff);
}
inline Float mix(Float a, Float b, Float share) {
  return a + (b - a) * share;
}

// Quotients and roots from the processor's estimates and a step of Newton's: off by 2^-22 at most, three times as fast.
inline Float reciprocal(Float x) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  const Float estimate = Floats(_mm512_maskz_rcp14_ps(0xffff, reinterpret_cast<__m512>(x.v)));
#elif defined(__AVX2__)
  const Float estimate = Floats(_mm256_rcp_ps(reinterpret_cast<__m256>(x.v)));
#elif defined(__SSE2__)
  const Float estimate = Floats(_mm_rcp_ps(reinterpret_cast<__m128>(x.v)));
#else
  return 1.0f / x.v;
#endif
#if defined(__SSE2__)
  return estimate * (2.0f - x * estimate);
#endif
}
inline Float inversesqrt(Float x) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  const Float estimate = Floats(_mm512_maskz_rsqrt14_ps(0xffff, reinterpret_cast<__m512>(x.v)));
#elif defined(__AVX2__)
  const Float estimate = Floats(_mm256_rsqrt_ps(reinterpret_cast<__m256>(x.v)));
#elif defined(__SSE2__)
  const Float estimate = Floats(_mm_rsqrt_ps(reinterpret_cast<__m128>(x.v)));
#else
  for (int i = 0; i < kLanes; ++i) x.v[i] = 1.0f / __builtin_sqrtf(x.v[i]);
  return x;
#endif
#if defined(__SSE2__)
  return estimate * (1.5f - (0.5f * x * estimate) * estimate);
#endif
}
inline Float operator/(Float a, Float b) {
  return a * reciprocal(b);
}
inline Float sqrt(Float x) {
  return x * inversesqrt(max(x, 1e-30f));
}

inline Float smoothstep(Float low, Float high, Float x) {
  const Float t = clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// Towards zero.
inline Ints truncated(Float x) {
  return __builtin_convertvector(x.v, Ints);
}
inline Float to_float(Ints x) {
  return __builtin_convertvector(x, Floats);
}

struct vec2 {
  Float x, y;
  vec2() = default;
  vec2(Float a, Float b) : x(a), y(b) {}
};
inline vec2 operator*(vec2 a, Float b) {
  return {a.x * b, a.y * b};
}
inline vec2 operator/(vec2 a, Float b) {
  return a * reciprocal(b);
}
inline vec2 operator+(vec2 a, Float b) {
  return {a.x + b, a.y + b};
}

struct vec3 {
  Float x, y, z;
  vec3() = default;
  explicit vec3(Float a) : x(a), y(a), z(a) {}
  vec3(Float a, Float b, Float c) : x(a), y(b), z(c) {}
  vec3(vec2 a, Float c) : x(a.x), y(a.y), z(c) {}
};
inline vec3 operator+(vec3 a, vec3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline vec3 operator-(vec3 a, vec3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline vec3 operator*(vec3 a, vec3 b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
inline vec3 operator*(vec3 a, Float b) {
  return {a.x * b, a.y * b, a.z * b};
}
inline vec3 operator*(Float a, vec3 b) {
  return b * a;
}
inline vec3 operator/(vec3 a, Float b) {
  return a * reciprocal(b);
}
inline vec3 operator-(vec3 a) {
  return {-a.x, -a.y, -a.z};
}
inline vec3& operator+=(vec3& a, vec3 b) {
  return a = a + b;
}

inline Float dot(vec3 a, vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline vec3 cross(vec3 a, vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Float length(vec3 a) {
  return sqrt(dot(a, a));
}
inline vec3 normalize(vec3 a) {
  return a * inversesqrt(dot(a, a));
}
inline vec3 reflect(vec3 way, vec3 normal) {
  return way - (2.0f * dot(normal, way)) * normal;
}
inline vec3 abs(vec3 a) {
  return {abs(a.x), abs(a.y), abs(a.z)};
}
inline vec3 min(vec3 a, vec3 b) {
  return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
inline vec3 clamp(vec3 a, Float low, Float high) {
  return {clamp(a.x, low, high), clamp(a.y, low, high), clamp(a.z, low, high)};
}
inline vec3 mix(vec3 a, vec3 b, Float share) {
  return a + (b - a) * share;
}
inline vec3 select(Mask condition, vec3 yes, vec3 no) {
  return {select(condition, yes.x, no.x), select(condition, yes.y, no.y), select(condition, yes.z, no.z)};
}

struct vec4 {
  Float x, y, z, w;
  vec4() = default;
  vec4(Float a, Float b, Float c, Float d) : x(a), y(b), z(c), w(d) {}
  vec4(vec3 a, Float d) : x(a.x), y(a.y), z(a.z), w(d) {}
};
inline vec4 operator*(vec4 a, Float b) {
  return {a.x * b, a.y * b, a.z * b, a.w * b};
}
inline vec4 operator+(vec4 a, vec4 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}

struct mat3 {
  vec3 columns[3];
  mat3() = default;
  mat3(vec3 a, vec3 b, vec3 c) : columns{a, b, c} {}
};
inline vec3 operator*(vec3 row, const mat3& m) {
  return {dot(row, m.columns[0]), dot(row, m.columns[1]), dot(row, m.columns[2])};
}

struct mat4 {
  vec4 columns[4];
};
inline vec4 operator*(const mat4& m, vec4 v) {
  return m.columns[0] * v.x + m.columns[1] * v.y + m.columns[2] * v.z + m.columns[3] * v.w;
}

}  // namespace
}  // namespace lightwell
