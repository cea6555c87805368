// The sheen of KHR_materials_sheen: fibres that stand upright, with the distribution and masking of Conty and Kulla 2017,
// "Production friendly microfacet sheen BRDF". Needs shaders/sampling.glsl.

float sheen_alpha(float roughness) { return max(roughness * roughness, 0.005); }

float sheen_distribution(float cos_half, float alpha) {
  const float inverse = 1.0 / alpha;
  const float sin2 = max(1.0 - cos_half * cos_half, 1e-6);
  return (2.0 + inverse) * pow(sin2, 0.5 * inverse) / (2.0 * kPi);
}

float sheen_masking_exponent(float x, float alpha) {
  const float t = (1.0 - alpha) * (1.0 - alpha);
  const float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t), c = mix(0.19823, 0.16801, t);
  const float d = mix(-1.97760, -1.27393, t), e = mix(-4.32054, -4.85967, t);
  return a / (1.0 + b * pow(x, c)) + d * x + e;
}

float sheen_lambda(float cosine, float alpha) {
  const float x = clamp(cosine, 1e-4, 1.0);
  const float exponent = x < 0.5 ? sheen_masking_exponent(x, alpha)
                                 : 2.0 * sheen_masking_exponent(0.5, alpha) - sheen_masking_exponent(1.0 - x, alpha);
  return exp(exponent);
}

// f of white sheen.
float sheen_value(float cos_out, float cos_in, float cos_half, float roughness) {
  const float alpha = sheen_alpha(roughness);
  const float shadowing = 1.0 + sheen_lambda(cos_out, alpha) + sheen_lambda(cos_in, alpha);
  return sheen_distribution(cos_half, alpha) / max(shadowing * 4.0 * cos_out * cos_in, 1e-6);
}
