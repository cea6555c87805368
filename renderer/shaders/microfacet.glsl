// Microfacets of Trowbridge and Reitz (GGX): what the lobes of shaders/brdf.glsl are made of. Directions are unit, in the
// frame of the normal (+Z), unless cosines alone are asked for. Needs shaders/sampling.glsl.
// LANES: without what samples, see shaders/select.glsl.

const float kSmallestAlpha = 0.0016;  // roughness 0.04: below it highlights of punctual lights vanish between pixels

float alpha_from_roughness(float roughness) { return max(roughness * roughness, kSmallestAlpha); }

// Schlick 1994: the weight of the reflectance at grazing incidence.
float schlick_weight(float cos_theta) {
  const float x = clamp(1.0 - cos_theta, 0.0, 1.0);
  const float x2 = x * x;
  return x2 * x2 * x;
}

// Density of normals, Trowbridge and Reitz 1975, from the cosine of the half vector with the normal.
float ggx_distribution(float cos_half, float alpha) {
  const float a2 = alpha * alpha;
  const float d = cos_half * cos_half * (a2 - 1.0) + 1.0;
  return a2 / (kPi * d * d);
}

// The same from the half vector, without the cancellation near the normal of smooth surfaces.
float ggx_distribution(vec3 half_vector, float alpha) {
  const float a2 = alpha * alpha;
  const float d = half_vector.x * half_vector.x + half_vector.y * half_vector.y + half_vector.z * half_vector.z * a2;
  return a2 / (kPi * d * d);
}

// Smith's masking of one direction over 2 cos: 1 / (cos + sqrt(a^2 + (1 - a^2) cos^2)).
float ggx_half_masking(float cosine, float alpha) {
  const float a2 = alpha * alpha;
  return 1.0 / max(cosine + sqrt(cosine * cosine * (1.0 - a2) + a2), 1e-9);
}

// Masking-shadowing over 4 cos cos: glTF 2.0, appendix B, which takes the two directions as independent (Smith 1967).
float ggx_visibility(float cos_out, float cos_in, float alpha) {
  return ggx_half_masking(cos_out, alpha) * ggx_half_masking(cos_in, alpha);
}

#ifndef LANES
// A visible normal of the GGX distribution: Dupuy and Benyoub 2023, "Sampling visible GGX normals with spherical caps".
vec3 sample_visible_normal(vec3 out_direction, float alpha, vec2 u) {
  const vec3 stretched = normalize(vec3(out_direction.xy * alpha, out_direction.z));
  const float phi = 2.0 * kPi * u.x;
  const float z = fma(1.0 - u.y, 1.0 + stretched.z, -stretched.z);
  const float sin_theta = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
  const vec3 cap = vec3(sin_theta * cos(phi), sin_theta * sin(phi), z) + stretched;
  return normalize(vec3(cap.xy * alpha, cap.z));
}

// Density of the normals that sample_visible_normal gives, over the cosine of the half vector with `out_direction`.
float visible_normal_density(float cos_out, vec3 half_vector, float alpha) {
  return 2.0 * ggx_half_masking(cos_out, alpha) * ggx_distribution(half_vector, alpha);
}

// Density over solid angle of the directions mirrored at such normals: Heitz 2018.
float visible_normal_pdf(float cos_out, vec3 half_vector, float alpha) {
  return 0.25 * visible_normal_density(cos_out, half_vector, alpha);
}
#endif
