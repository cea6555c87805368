// Alpha coverage at a hit; the C++ side, and the definition of every step, is coverage.cpp.
#include "tracing/bindings.glsl"

const uint kOutcomeNeverHit = 1u, kOutcomeMask = 2u, kOutcomeBlend = 3u;
const uint kWrapRepeat = 0u, kWrapMirroredRepeat = 1u, kWrapClampToEdge = 2u;

// Four words by four an instance: DeviceCoverage.
layout(std430, binding = TRACE_BINDING_COVERAGE) readonly buffer Coverage { uvec4 coverage_words[]; };
layout(std430, binding = TRACE_BINDING_CORNER_UVS) readonly buffer CornerUvs { vec2 corner_uvs[]; };  // 3 a triangle
layout(std430, binding = TRACE_BINDING_ALPHA) readonly buffer Alpha { uint alpha_words[]; };          // 4 texels each

uint coverage_hash(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  return v.x + v.y * v.w;
}

uint coverage_threshold(uint instance, uint triangle, vec2 uv) {
  const uvec2 cell = uvec2(clamp(uv, 0.0, 1.0) * 4096.0);
  return coverage_hash(uvec4(instance, triangle, cell)) >> 8u;
}

int nearest_texel(float coordinate, int size_px, uint wrap) {
  const float kLimit = 1073741824.0;
  float x = floor(coordinate * float(size_px));
  x = x > -kLimit ? x : -kLimit;
  x = x < kLimit ? x : kLimit;
  const int texel = int(x);
  if (wrap == kWrapClampToEdge) return clamp(texel, 0, size_px - 1);
  const int period = wrap == kWrapRepeat ? size_px : 2 * size_px;
  const int wrapped = texel >= 0 ? texel % period : period - 1 - (-1 - texel) % period;
  return wrapped < size_px ? wrapped : period - 1 - wrapped;
}

bool is_covered(uint instance, uint triangle, vec2 uv) {
  const uvec4 test = coverage_words[4u * instance];    // outcome, least texel, blend factor, wraps
  const uvec4 image = coverage_words[4u * instance + 1u];  // first texel, width, height, first corner
  if (test.x < kOutcomeMask) return test.x != kOutcomeNeverHit;
  uint texel = 255u;
  if (image.y > 0u) {
    const vec3 u_row = uintBitsToFloat(coverage_words[4u * instance + 2u].xyz);
    const vec3 v_row = uintBitsToFloat(coverage_words[4u * instance + 3u].xyz);
    const uint corner = image.w + 3u * triangle;
    const vec3 st = vec3((1.0 - uv.x - uv.y) * corner_uvs[corner] + uv.x * corner_uvs[corner + 1u] +
                             uv.y * corner_uvs[corner + 2u], 1.0);
    const uint x = uint(nearest_texel(dot(u_row, st), int(image.y), test.w & 0xffu));
    const uint y = uint(nearest_texel(dot(v_row, st), int(image.z), test.w >> 8u));
    const uint index = image.x + y * image.y + x;
    texel = bitfieldExtract(alpha_words[index >> 2u], int(8u * (index & 3u)), 8);
  }
  if (test.x == kOutcomeMask) return texel >= test.y;
  return ((texel * test.z) << 8u) > coverage_threshold(instance, triangle, uv) * 255u;
}
