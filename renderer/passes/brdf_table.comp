// What GGX and sheen reflect of uniform light, by the cosine of the viewer (its square root across) and by roughness
// (rows of GGX, then rows of sheen): integrated once with the very functions that shade. See ggx_albedo(), sheen_albedo().
#include "passes/bindings.glsl"

layout(local_size_x = BRDF_TABLE_COLUMNS) in;  // a row

#include "shaders/sampling.glsl"
#include "shaders/microfacet.glsl"
#include "shaders/sheen.glsl"

layout(std430, binding = BINDING_OUTPUT) writeonly buffer Table { vec4 table[]; };

const uint kSamples = 256u;

shared vec2 row_albedo[BRDF_TABLE_COLUMNS];

// x: reflected if every microfacet reflects all, y: if by Schlick's weight.
vec2 integrate_ggx(vec3 out_direction, float alpha) {
  vec2 sum = vec2(0.0);
  for (uint i = 0u; i < kSamples; ++i) {
    const vec3 half_vector = sample_visible_normal(out_direction, alpha, sobol_2d(i, 1u));
    const float cos_difference = dot(out_direction, half_vector);
    const float cos_in = 2.0 * cos_difference * half_vector.z - out_direction.z;
    // f cos / pdf is the masking of the sampled direction.
    if (cos_in > 0.0) sum += 2.0 * cos_in * ggx_half_masking(cos_in, alpha) * vec2(1.0, schlick_weight(cos_difference));
  }
  return sum / float(kSamples);
}

float integrate_sheen(vec3 out_direction, float roughness) {
  float sum = 0.0;
  for (uint i = 0u; i < kSamples; ++i) {
    const vec2 u = sobol_2d(i, 2u);
    const float sine = sqrt(1.0 - u.x * u.x);  // uniform over the hemisphere
    const vec3 in_direction = vec3(sine * cos(2.0 * kPi * u.y), sine * sin(2.0 * kPi * u.y), max(u.x, 1e-4));
    const float cos_half = normalize(out_direction + in_direction).z;
    sum += sheen_value(out_direction.z, in_direction.z, cos_half, roughness) * in_direction.z;
  }
  return sum * (2.0 * kPi) / float(kSamples);
}

void main() {
  const uint column = gl_LocalInvocationID.x;
  const uint row = gl_WorkGroupID.x;
  const float last = float(BRDF_TABLE_COLUMNS - 1);
  const float root = max(float(column) / last, 0.01);
  const float cosine = root * root;
  const vec3 out_direction = vec3(sqrt(1.0 - cosine * cosine), 0.0, cosine);
  vec2 albedo;
  if (row < BRDF_TABLE_GGX_ROWS)
    albedo = integrate_ggx(out_direction, alpha_from_roughness(float(row) / float(BRDF_TABLE_GGX_ROWS - 1)));
  else
    albedo = vec2(integrate_sheen(out_direction, float(row - BRDF_TABLE_GGX_ROWS) / float(BRDF_TABLE_SHEEN_ROWS - 1)), 0.0);
  row_albedo[column] = albedo;
  barrier();
  // The cosine-weighted mean: 2 mu dmu = 4 root^3 droot, by the trapezoid rule.
  vec2 mean = vec2(0.0);
  float weights = 0.0;
  for (int i = 0; i < BRDF_TABLE_COLUMNS; ++i) {
    const float x = float(i) / last;
    const float weight = x * x * x * (i == BRDF_TABLE_COLUMNS - 1 ? 0.5 : 1.0);
    mean += weight * row_albedo[i];
    weights += weight;
  }
  table[row * BRDF_TABLE_COLUMNS + column] = vec4(albedo, mean / weights);
}
