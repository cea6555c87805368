// The glTF 2.0 metallic-roughness BRDF (specification, appendix B), one implementation for every method.
// Needs shaders/sampling.glsl and shaders/packing.glsl.

// What the BRDF needs to know of a surface point.
struct Brdf {
  vec3 diffuse_albedo;    // base colour * (1 - metallic)
  vec3 f0;                // reflectance at normal incidence
  float f90;              // and at grazing: 1 for metals, the specular factor for dielectrics
  float f0_dielectric;    // what the dielectric's interface takes from the diffuse lobe
  float f90_dielectric;
  float alpha;            // GGX, roughness squared
};

const float kSmallestAlpha = 0.0016;  // roughness 0.04: below it highlights of punctual lights vanish between pixels

Brdf make_brdf(vec3 base_color, float metallic, float roughness, float f0_dielectric, float specular_factor) {
  Brdf brdf;
  brdf.diffuse_albedo = base_color * (1.0 - metallic);
  brdf.f0_dielectric = f0_dielectric * specular_factor;
  brdf.f90_dielectric = specular_factor;
  brdf.f0 = mix(vec3(brdf.f0_dielectric), base_color, metallic);
  brdf.f90 = mix(specular_factor, 1.0, metallic);
  brdf.alpha = max(roughness * roughness, kSmallestAlpha);
  return brdf;
}

// Schlick 1994.
float schlick_weight(float cos_theta) {
  const float x = clamp(1.0 - cos_theta, 0.0, 1.0);
  const float x2 = x * x;
  return x2 * x2 * x;
}

// Trowbridge and Reitz 1975 with the height-correlated masking-shadowing of Heitz 2014; the 4 cos cos is divided out.
float ggx_distribution(float cos_half, float alpha) {
  const float a2 = alpha * alpha;
  const float d = cos_half * cos_half * (a2 - 1.0) + 1.0;
  return a2 / (kPi * d * d);
}

float ggx_visibility(float cos_out, float cos_in, float alpha) {
  const float a2 = alpha * alpha;
  const float out_term = cos_in * sqrt(cos_out * cos_out * (1.0 - a2) + a2);
  const float in_term = cos_out * sqrt(cos_in * cos_in * (1.0 - a2) + a2);
  return 0.5 / max(out_term + in_term, 1e-9);
}

// f * cos(theta_in) from the cosines of the directions with the normal, of the half vector with the normal, and of the
// half vector with the directions; zero below the surface.
vec3 brdf_times_cosine(Brdf brdf, float cos_out, float cos_in, float cos_half, float cos_difference) {
  const float weight = schlick_weight(cos_difference);
  const vec3 fresnel = mix(brdf.f0, vec3(brdf.f90), weight);
  const float fresnel_dielectric = mix(brdf.f0_dielectric, brdf.f90_dielectric, weight);
  const vec3 diffuse = (1.0 - fresnel_dielectric) * (1.0 / kPi) * brdf.diffuse_albedo;
  const float specular = ggx_distribution(cos_half, brdf.alpha) * ggx_visibility(cos_out, cos_in, brdf.alpha);
  return cos_out > 0.0 && cos_in > 0.0 ? (diffuse + fresnel * specular) * cos_in : vec3(0.0);
}

// The same for directions in the frame of the normal (+Z).
vec3 brdf_times_cosine(Brdf brdf, vec3 out_direction, vec3 in_direction) {
  const vec3 half_vector = normalize(out_direction + in_direction);
  return brdf_times_cosine(brdf, out_direction.z, in_direction.z, half_vector.z, dot(out_direction, half_vector));
}

// Share of samples given to the specular lobe: by the luminance each lobe reflects.
float specular_probability(Brdf brdf, float cos_out) {
  const float weight = schlick_weight(cos_out);
  const float specular = luminance(mix(brdf.f0, vec3(brdf.f90), weight));
  const float diffuse = luminance(brdf.diffuse_albedo) * (1.0 - mix(brdf.f0_dielectric, brdf.f90_dielectric, weight));
  if (specular <= 0.0) return 0.0;
  if (diffuse <= 0.0) return 1.0;
  return clamp(specular / (specular + diffuse), 0.1, 0.9);
}

// Density of visible normals turned into one of reflected directions: Heitz 2018.
float visible_normal_pdf(float cos_out, float cos_half, float alpha) {
  const float a2 = alpha * alpha;
  const float smith = 2.0 / (1.0 + sqrt(1.0 + a2 * (1.0 / (cos_out * cos_out) - 1.0))) * 0.5;
  return smith * ggx_distribution(cos_half, alpha) / (2.0 * cos_out);
}

// A visible normal of the GGX distribution: Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps".
vec3 sample_visible_normal(vec3 out_direction, float alpha, vec2 u) {
  const vec3 stretched = normalize(vec3(out_direction.xy * alpha, out_direction.z));
  const float phi = 2.0 * kPi * u.x;
  const float z = fma(1.0 - u.y, 1.0 + stretched.z, -stretched.z);
  const float sin_theta = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  const vec3 cap = vec3(sin_theta * cos(phi), sin_theta * sin(phi), z) + stretched;
  return normalize(vec3(cap.xy * alpha, cap.z));
}

// Density over solid angle with which sample_brdf gives `in_direction`.
float brdf_pdf(Brdf brdf, vec3 out_direction, vec3 in_direction) {
  if (out_direction.z <= 0.0 || in_direction.z <= 0.0) return 0.0;
  const float share = specular_probability(brdf, out_direction.z);
  const vec3 half_vector = normalize(out_direction + in_direction);
  return (1.0 - share) * in_direction.z * (1.0 / kPi) +
         share * visible_normal_pdf(out_direction.z, half_vector.z, brdf.alpha);
}

// An importance-sampled direction; `u` chooses within a lobe, `u_lobe` the lobe. May point below the surface (pdf 0).
vec3 sample_brdf(Brdf brdf, vec3 out_direction, vec2 u, float u_lobe) {
  const bool specular = u_lobe < specular_probability(brdf, out_direction.z);
  const vec3 visible_normal = sample_visible_normal(out_direction, brdf.alpha, u);
  const vec3 reflected = reflect(-out_direction, visible_normal);
  return specular ? reflected : cosine_hemisphere(u);
}

// What the surface reflects of uniform light, roughly: by it the indirect map is demodulated, so that the map stays
// smooth over textures. Any positive function keeps the picture's mean; the closer, the smoother.
// Specular part: the analytic fit of Karis 2014 ("Physically based shading on mobile").
vec3 directional_albedo(Brdf brdf, float cos_out) {
  const float roughness = sqrt(brdf.alpha);
  const vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  const float a004 = min(r.x * r.x, exp2(-9.28 * cos_out)) * r.x + r.y;
  const vec2 scale_bias = vec2(-1.04, 1.04) * a004 + r.zw;
  const vec3 specular = max(brdf.f0 * scale_bias.x + brdf.f90 * scale_bias.y, vec3(0.0));
  return brdf.diffuse_albedo * (1.0 - brdf.f0_dielectric) + specular;
}
