// From scene-referred to display-referred colour.

// Khronos PBR Neutral: base colours under neutral light come out as they are, highlights are compressed and desaturated.
vec3 tone_map_pbr_neutral(vec3 color) {
  const float kStartCompression = 0.8 - 0.04;
  const float kDesaturation = 0.15;
  const float x = min(color.r, min(color.g, color.b));
  const float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
  color -= offset;
  const float peak = max(color.r, max(color.g, color.b));
  if (peak < kStartCompression) return color;
  const float d = 1.0 - kStartCompression;
  const float new_peak = 1.0 - d * d / (peak + d - kStartCompression);
  color *= new_peak / peak;
  const float g = 1.0 - 1.0 / (kDesaturation * (peak - new_peak) + 1.0);
  return mix(color, vec3(new_peak), g);
}

// IEC 61966-2-1.
vec3 srgb_from_linear(vec3 linear) {
  const vec3 c = clamp(linear, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-8)), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}
