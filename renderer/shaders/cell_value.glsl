// The value of a cell of the radiance cache.

const uint kNoCell = 0xffffffffu;

uniform uint cache_frame;         // this frame's number in the cache's count
uniform float forgetting;         // of what a cell knows, in halvings a frame
uniform uint frames_since_change;  // since the light changed at once
uniform float kept_after_change;  // what a cell of before then counts for, in samples

struct CellValue {
  vec3 light;     // irradiance over pi, nit
  float samples;  // that it stands for today
};

const float kSampleUnit = 1.0 / 128.0;

CellValue unpack_cell_value(uvec4 packed_value) {
  const uint age = (cache_frame - packed_value.w) & 0xffffu;
  const float samples = float(packed_value.w >> 16) * kSampleUnit * exp2(-forgetting * float(age));
  const bool is_of_before = age > frames_since_change;
  const vec3 light = is_of_before && kept_after_change == 0.0 ? vec3(0.0) : uintBitsToFloat(packed_value.xyz);
  return CellValue(light, is_of_before ? min(samples, kept_after_change) : samples);
}

uvec4 pack_cell_value(CellValue value) {
  const uint samples = uint(min(value.samples / kSampleUnit, 65535.0));
  return uvec4(floatBitsToUint(value.light), samples << 16 | (cache_frame & 0xffffu));
}
