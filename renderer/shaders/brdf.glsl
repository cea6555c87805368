// The glTF 2.0 metallic-roughness BRDF (specification, appendix B), one implementation for every method. It departs where
// appendix B gains energy: with its factor of 1 less the Fresnel reflectance at the half vector, a white dielectric sends
// back up to 1.9 of the light at grazing angles. Here the diffuse base gets what the interface does not reflect.
// Needs shaders/sampling.glsl and shaders/packing.glsl, and passes/bindings.glsl for the variants:
// MULTISCATTER: light that bounces between microfacets is not lost (Kulla and Conty 2017), and the diffuse base gets all
//   that the interface leaves over (Kelemen and Szirmay-Kalos 2001); needs the table of passes/brdf_table.comp.
// LAMBERT_ONLY: for scenes whose materials are all without a specular lobe, in the frame of the normal.
// HAS_LOBES: the lobes of glTF's extensions, see shaders/brdf_lobes.glsl.
// A lobe made wider afterwards (Brdf::alpha) leaves the base what the interface of the material's roughness lets through.
// LANES: without what samples, see shaders/select.glsl.
#include "shaders/microfacet.glsl"

// What the BRDF needs to know of a surface point.
struct Brdf {
  vec3 diffuse_albedo;    // base colour * (1 - metallic) * (1 - transmission)
  vec3 f0;                // reflectance at normal incidence
  float f90;              // and at grazing: 1 for metals, the specular factor for dielectrics
  float f0_dielectric;    // what the dielectric's interface takes from what lies below it
  float f90_dielectric;
  float alpha;            // GGX, roughness squared
#ifndef MULTISCATTER
  float least_lifted;     // of a cosine to the dielectric's interface, and how much more by the cosine: most_reflected()
  float lifted_slope;
#endif
#ifdef MULTISCATTER
  vec3 mean_dielectric;   // cosine-weighted mean of the Fresnel reflectance
  vec3 mean_metal;
  float metallic;
#endif
#ifdef HAS_LOBES
  vec3 transmission_color;  // of what passes the interface, the share that goes on below the surface
  float eta;                // refractive index on the far side over that on the viewer's; 1: thin-walled
  float clearcoat;
  float clearcoat_alpha;
  vec3 clearcoat_normal;    // in the frame of the directions, on the viewer's side
  vec3 sheen_color;
  float sheen_roughness;
  vec3 demodulation_f0;     // f0 of the plain variant, see directional_albedo()
#endif
};

const float kSchlickMean = 1.0 / 21.0;  // cosine-weighted mean of Schlick's weight

// `f0_dielectric`: reflectance of the dielectric at normal incidence, before the specular factor.
Brdf make_brdf(vec3 base_color, float metallic, float roughness, vec3 f0_dielectric, float specular_factor) {
  const vec3 f0 = min(f0_dielectric, vec3(1.0)) * specular_factor;
  Brdf brdf;
  brdf.diffuse_albedo = base_color * (1.0 - metallic);
  brdf.f0_dielectric = max(f0.x, max(f0.y, f0.z));
  brdf.f90_dielectric = specular_factor;
  brdf.f0 = mix(f0, base_color, metallic);
  brdf.f90 = mix(specular_factor, 1.0, metallic);
  brdf.alpha = alpha_from_roughness(roughness);
#ifndef MULTISCATTER
  const float interface_roughness = sqrt(brdf.alpha);
  brdf.least_lifted = max((0.75 - 0.12 * interface_roughness) * interface_roughness - 0.09, 0.0);
  brdf.lifted_slope = 1.0 + (0.6 * interface_roughness - 1.3) * interface_roughness;
#endif
#ifdef MULTISCATTER
  brdf.mean_dielectric = mix(f0, vec3(specular_factor), kSchlickMean);
  brdf.mean_metal = mix(base_color, vec3(1.0), kSchlickMean);
  brdf.metallic = metallic;
#endif
#ifdef HAS_LOBES
  brdf.transmission_color = vec3(0.0);
  brdf.eta = 1.0;
  brdf.clearcoat = 0.0;
  brdf.clearcoat_alpha = kSmallestAlpha;
  brdf.clearcoat_normal = vec3(0.0, 0.0, 1.0);
  brdf.sheen_color = vec3(0.0);
  brdf.sheen_roughness = 0.0;
  brdf.demodulation_f0 = brdf.f0;
#endif
  return brdf;
}

Brdf make_brdf(vec3 base_color, float metallic, float roughness, float f0_dielectric, float specular_factor) {
  return make_brdf(base_color, metallic, roughness, vec3(f0_dielectric), specular_factor);
}

#if defined(MULTISCATTER) || defined(HAS_LOBES)
layout(binding = UNIT_BRDF_TABLE) uniform samplerBuffer brdf_table;  // see passes/brdf_table.comp

// Fetched without interpolation, which would cost a software device four times as much: the table is fine enough.
vec4 fetch_brdf_table(float cosine, float roughness, int first_row, int rows) {
  const int column = int(sqrt(clamp(cosine, 0.0, 1.0)) * float(BRDF_TABLE_COLUMNS - 1) + 0.5);
  const int row = first_row + int(roughness * float(rows - 1) + 0.5);
  return texelFetch(brdf_table, row * BRDF_TABLE_COLUMNS + column);
}

// What GGX reflects once of uniform light from a direction, x: if every microfacet reflects all; y: if by Schlick's
// weight. z, w: their cosine-weighted means over all directions.
vec4 ggx_albedo(float cosine, float alpha) {
  return fetch_brdf_table(cosine, sqrt(alpha), 0, BRDF_TABLE_GGX_ROWS);
}
#endif

#ifdef MULTISCATTER
// Of the light that a first bounce between microfacets leaves over, what comes out at last: Kulla and Conty 2017.
vec3 multiscatter_fresnel(vec3 mean_reflectance, float mean_albedo) {
  return mean_reflectance * mean_reflectance * mean_albedo / (1.0 - mean_reflectance * (1.0 - mean_albedo));
}
#endif

// Schlick's weight for light at this cosine to a microfacet.
float fresnel_weight(Brdf brdf, float cos_difference) {
#ifdef HAS_LOBES
  // Out of the denser medium: by the angle outside, all of it beyond the critical one.
  if (brdf.eta < 1.0) {
    const float sin2 = (1.0 - cos_difference * cos_difference) / (brdf.eta * brdf.eta);
    return sin2 >= 1.0 ? 1.0 : schlick_weight(sqrt(1.0 - sin2));
  }
#endif
  return schlick_weight(cos_difference);
}

#ifndef MULTISCATTER
// No less than what the dielectric's interface reflects of uniform light from a direction: Schlick's term with a cosine
// that roughness lifts, fitted from below to the integral of the specular lobe. 1 less it at the more grazing of both
// directions is reciprocal and keeps the sum of both lobes within 1.
float most_reflected(Brdf brdf, float cosine) {
  const float lifted = brdf.least_lifted + brdf.lifted_slope * cosine;
  return mix(brdf.f0_dielectric, brdf.f90_dielectric, schlick_weight(lifted));
}
#endif

// f * cos(theta_in) of the specular and diffuse lobes. `distribution` is the density of normals at the half vector.
vec3 base_times_cosine(Brdf brdf, float cos_out, float cos_in, float cos_difference, float distribution) {
  const vec3 fresnel = mix(brdf.f0, vec3(brdf.f90), fresnel_weight(brdf, cos_difference));
  vec3 value = fresnel * (distribution * ggx_visibility(cos_out, cos_in, brdf.alpha));
#ifdef MULTISCATTER
  const vec4 albedo_out = ggx_albedo(cos_out, brdf.alpha);
  const vec4 albedo_in = ggx_albedo(cos_in, brdf.alpha);
  const vec3 left_dielectric = multiscatter_fresnel(brdf.mean_dielectric, albedo_out.z);
  const vec3 left = mix(left_dielectric, multiscatter_fresnel(brdf.mean_metal, albedo_out.z), brdf.metallic);
  value += left * ((1.0 - albedo_out.x) * (1.0 - albedo_in.x) / (kPi * max(1.0 - albedo_out.z, 1e-4)));
  const float f0 = brdf.f0_dielectric, f90 = brdf.f90_dielectric;
  const float most_left = max(left_dielectric.r, max(left_dielectric.g, left_dielectric.b));
  const vec2 once = f0 * (vec2(albedo_out.x, albedo_in.x) - vec2(albedo_out.y, albedo_in.y)) +
                    f90 * vec2(albedo_out.y, albedo_in.y);
  const vec2 reflected = once + most_left * (1.0 - vec2(albedo_out.x, albedo_in.x));
  const float mean = f0 * (albedo_out.z - albedo_out.w) + f90 * albedo_out.w + most_left * (1.0 - albedo_out.z);
  const float passed = (1.0 - reflected.x) * (1.0 - reflected.y) / max(1.0 - mean, 1e-4);
#else
  const float passed = 1.0 - most_reflected(brdf, min(cos_out, cos_in));
#endif
  value += passed * (1.0 / kPi) * brdf.diffuse_albedo;
  return select(cos_out > 0.0 && cos_in > 0.0, value * cos_in, vec3(0.0));
}

#ifdef HAS_LOBES
#include "shaders/brdf_lobes.glsl"
#else
// f * cos(theta_in) for unit directions in any frame; zero below the surface.
vec3 brdf_times_cosine(Brdf brdf, vec3 normal, vec3 out_direction, vec3 in_direction) {
  const vec3 half_vector = normalize(out_direction + in_direction);
  return base_times_cosine(brdf, dot(normal, out_direction), dot(normal, in_direction), dot(out_direction, half_vector),
                           ggx_distribution(dot(normal, half_vector), brdf.alpha));
}

// The same for directions in the frame of the normal (+Z).
vec3 brdf_times_cosine(Brdf brdf, vec3 out_direction, vec3 in_direction) {
#ifdef LAMBERT_ONLY
  const bool above = out_direction.z > 0.0 && in_direction.z > 0.0;
  return above ? brdf.diffuse_albedo * (in_direction.z * (1.0 / kPi)) : vec3(0.0);
#endif
  const vec3 half_vector = normalize(out_direction + in_direction);
  return base_times_cosine(brdf, out_direction.z, in_direction.z, dot(out_direction, half_vector),
                           ggx_distribution(half_vector, brdf.alpha));
}

// The BRDF of a point for directions in a frame with the normal as its third axis.
Brdf brdf_in_frame(Brdf brdf, mat3 world_from_local) { return brdf; }

#ifndef LANES
// Share of samples given to the specular lobe: by the luminance each lobe reflects.
float specular_probability(Brdf brdf, float cos_out) {
  const float weight = schlick_weight(cos_out);
  const float specular = luminance(mix(brdf.f0, vec3(brdf.f90), weight));
  const float diffuse = luminance(brdf.diffuse_albedo) * (1.0 - mix(brdf.f0_dielectric, brdf.f90_dielectric, weight));
  if (specular <= 0.0) return 0.0;
  if (diffuse <= 0.0) return 1.0;
  return clamp(specular / (specular + diffuse), 0.1, 0.9);
}

// Share of samples given to the diffuse lobe.
float diffuse_probability(Brdf brdf, vec3 out_direction) { return 1.0 - specular_probability(brdf, out_direction.z); }

// Density over solid angle with which sample_brdf gives `in_direction`; directions in the frame of the normal.
float brdf_pdf(Brdf brdf, vec3 out_direction, vec3 in_direction) {
  if (out_direction.z <= 0.0 || in_direction.z <= 0.0) return 0.0;
#ifdef LAMBERT_ONLY
  return in_direction.z * (1.0 / kPi);
#endif
  const float share = specular_probability(brdf, out_direction.z);
  const vec3 half_vector = normalize(out_direction + in_direction);
  return (1.0 - share) * in_direction.z * (1.0 / kPi) +
         share * visible_normal_pdf(out_direction.z, half_vector, brdf.alpha);
}

// An importance-sampled direction; `u` chooses within a lobe, `u_lobe` the lobe. May point below the surface (pdf 0).
vec3 sample_brdf(Brdf brdf, vec3 out_direction, vec2 u, float u_lobe) {
#ifdef LAMBERT_ONLY
  return cosine_hemisphere(u);
#endif
  const bool specular = u_lobe < specular_probability(brdf, out_direction.z);
  const vec3 visible_normal = sample_visible_normal(out_direction, brdf.alpha, u);
  const vec3 reflected = reflect(-out_direction, visible_normal);
  return specular ? reflected : cosine_hemisphere(u);
}
#endif
#endif

#ifndef LANES
// What the surface reflects of uniform light, roughly: by it the indirect map is demodulated, so that the map stays smooth
// over textures. Any positive function keeps the picture's mean; the closer, the smoother. The same in all variants, for
// passes that divide by it and ones that multiply may not need the same.
// Specular part: the analytic fit of Karis 2014 ("Physically based shading on mobile").
vec3 directional_albedo(Brdf brdf, float cos_out) {
  const float roughness = sqrt(brdf.alpha);
  const vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  const float a004 = min(r.x * r.x, exp2(-9.28 * cos_out)) * r.x + r.y;
  const vec2 scale_bias = vec2(-1.04, 1.04) * a004 + r.zw;
#ifdef HAS_LOBES
  const vec3 f0 = brdf.demodulation_f0;
  const vec3 base = brdf.diffuse_albedo + brdf.transmission_color;
#else
  const vec3 f0 = brdf.f0;
  const vec3 base = brdf.diffuse_albedo;
#endif
  const vec3 specular = max(f0 * scale_bias.x + brdf.f90 * scale_bias.y, vec3(0.0));
  return base * (1.0 - brdf.f0_dielectric) + specular;
}
#endif
