// How samples of the lights and rays that find them share a light between them. Needs next_event.

uniform vec2 strategies;  // of sampling lights and of sampling the BRDF: 1 each; with one of them 0 the other stands alone

// Of light found by a ray that a BRDF sampled, where sampling the lights has density `light_pdf`.
float weight_of_found_light(float brdf_pdf, float light_pdf) {
  if (light_pdf <= 0.0 || strategies.x < 0.5) return 1.0;
  return strategies.y > 0.5 ? mis_weight(brdf_pdf, light_pdf) : 0.0;
}

float weight_of_sampled_light(float light_pdf, float brdf_pdf) {
  if (light_pdf <= 0.0 || strategies.y < 0.5) return 1.0;  // no density: punctual, no ray finds it
  return strategies.x > 0.5 ? mis_weight(light_pdf, brdf_pdf) : 0.0;
}
