// The lobes of glTF's material extensions around the base of shaders/brdf.glsl, which includes this in its variant
// HAS_LOBES: KHR_materials_clearcoat, _sheen, _transmission, _volume. From the outside in: clearcoat, sheen, base.
// Here a sampled direction may lie below the surface: light that passes it. The viewer is always above.

#include "shaders/sheen.glsl"

const float kClearcoatF0 = 0.04;  // refractive index 1.5

// What white sheen reflects of uniform light from a direction.
float sheen_albedo(float cosine, float roughness) {
  return fetch_brdf_table(cosine, roughness, BRDF_TABLE_GGX_ROWS, BRDF_TABLE_SHEEN_ROWS).x;
}

// What sheen leaves to the base: the smaller of both directions' shares, which keeps it reciprocal.
float sheen_passes(Brdf brdf, float cos_out, float cos_in) {
  const float most = max(brdf.sheen_color.r, max(brdf.sheen_color.g, brdf.sheen_color.b));
  if (most <= 0.0) return 1.0;
  const float taken =
      most * max(sheen_albedo(cos_out, brdf.sheen_roughness), sheen_albedo(cos_in, brdf.sheen_roughness));
  return max(1.0 - taken, 0.0);
}

// What the clearcoat takes from a ray through it. The extension counts it once, for the viewer; light passes it twice.
float clearcoat_reflectance(Brdf brdf, float cosine) {
  return brdf.clearcoat * mix(kClearcoatF0, 1.0, schlick_weight(abs(cosine)));
}

float precise_distribution(vec3 normal, vec3 half_vector, float alpha) {
  const vec3 across = cross(normal, half_vector);
  const float cosine = dot(normal, half_vector);
  const float a2 = alpha * alpha;
  const float d = dot(across, across) + cosine * cosine * a2;
  return cosine > 0.0 ? a2 / (kPi * d * d) : 0.0;
}

// The microfacet normal at which light from below reaches the viewer: Walter et al. 2007; for a thin wall, whose two faces
// undo the refraction, the one that mirrors the direction as it would be above (KHR_materials_transmission).
vec3 transmission_half_vector(Brdf brdf, vec3 normal, vec3 out_direction, vec3 in_direction) {
  if (brdf.eta == 1.0)
    return normalize(out_direction + in_direction - 2.0 * dot(normal, in_direction) * normal);
  const vec3 half_vector = normalize(out_direction + brdf.eta * in_direction);
  return dot(half_vector, normal) < 0.0 ? -half_vector : half_vector;
}

// Solid angle of microfacet normals per solid angle of directions below; 0 where no microfacet joins the two.
float transmission_jacobian(Brdf brdf, vec3 out_direction, vec3 in_direction, vec3 half_vector) {
  const float cos_out = dot(out_direction, half_vector), cos_in = dot(in_direction, half_vector);
  if (brdf.eta == 1.0) return cos_out > 0.0 ? 0.25 / cos_out : 0.0;
  if (cos_out <= 0.0 || cos_in >= 0.0) return 0.0;
  const float sum = cos_out + brdf.eta * cos_in;
  return -cos_in * brdf.eta * brdf.eta / max(sum * sum, 1e-12);
}

float interface_reflectance(Brdf brdf, float cos_difference) {
  return mix(brdf.f0_dielectric, brdf.f90_dielectric, fresnel_weight(brdf, cos_difference));
}

// Radiance from below towards the viewer over that below, times the cosine; the change of radiance with the refractive
// index is left out, since what enters a medium leaves it again (KHR_materials_volume does the same).
vec3 transmission_times_cosine(Brdf brdf, vec3 normal, vec3 out_direction, vec3 in_direction) {
  const vec3 half_vector = transmission_half_vector(brdf, normal, out_direction, in_direction);
  const float cos_out = dot(normal, out_direction), cos_in = abs(dot(normal, in_direction));
  const float cos_difference = dot(out_direction, half_vector);
  const float jacobian = transmission_jacobian(brdf, out_direction, in_direction, half_vector);
  const float density = precise_distribution(normal, half_vector, brdf.alpha) * max(cos_difference, 0.0);
  const float masked = 4.0 * ggx_visibility(cos_out, cos_in, brdf.alpha) * cos_in;
  return brdf.transmission_color * ((1.0 - interface_reflectance(brdf, cos_difference)) * density * masked * jacobian);
}

// f * cos(theta_in) for unit directions in any frame; `in_direction` may lie below the surface.
vec3 brdf_times_cosine(Brdf brdf, vec3 normal, vec3 out_direction, vec3 in_direction) {
  const float cos_out = dot(normal, out_direction), cos_in = dot(normal, in_direction);
  if (cos_out <= 0.0 || cos_in == 0.0) return vec3(0.0);
  const float coat_out = dot(brdf.clearcoat_normal, out_direction), coat_in = dot(brdf.clearcoat_normal, in_direction);
  const float under_coat = (1.0 - clearcoat_reflectance(brdf, coat_out)) * (1.0 - clearcoat_reflectance(brdf, coat_in));
  const float under_sheen = sheen_passes(brdf, cos_out, abs(cos_in));
  if (cos_in < 0.0)
    return transmission_times_cosine(brdf, normal, out_direction, in_direction) * (under_coat * under_sheen);
  const vec3 half_vector = normalize(out_direction + in_direction);
  const float cos_difference = dot(out_direction, half_vector);
  vec3 value = base_times_cosine(brdf, cos_out, cos_in, cos_difference,
                                 precise_distribution(normal, half_vector, brdf.alpha)) * under_sheen;
  value += brdf.sheen_color * (sheen_value(cos_out, cos_in, dot(normal, half_vector), brdf.sheen_roughness) * cos_in);
  value *= under_coat;
  if (coat_out > 0.0 && coat_in > 0.0)
    value += clearcoat_reflectance(brdf, cos_difference) * ggx_visibility(coat_out, coat_in, brdf.clearcoat_alpha) *
             precise_distribution(brdf.clearcoat_normal, half_vector, brdf.clearcoat_alpha) * coat_in;
  return value;
}

// The same for directions in the frame of the normal (+Z).
vec3 brdf_times_cosine(Brdf brdf, vec3 out_direction, vec3 in_direction) {
  return brdf_times_cosine(brdf, vec3(0.0, 0.0, 1.0), out_direction, in_direction);
}

// The BRDF of a point for directions in a frame with the normal as its third axis.
Brdf brdf_in_frame(Brdf brdf, mat3 world_from_local) {
  brdf.clearcoat_normal = brdf.clearcoat_normal * world_from_local;
  return brdf;
}

// Shares of the samples: specular, diffuse and sheen, clearcoat, transmission. They sum to 1.
vec4 lobe_probabilities(Brdf brdf, vec3 out_direction) {
  const float weight = fresnel_weight(brdf, out_direction.z);
  const float coat = clearcoat_reflectance(brdf, dot(brdf.clearcoat_normal, out_direction));
  const float passed = 1.0 - mix(brdf.f0_dielectric, brdf.f90_dielectric, weight);
  vec4 share = vec4(luminance(mix(brdf.f0, vec3(brdf.f90), weight)),
                    luminance(brdf.diffuse_albedo) * passed + luminance(brdf.sheen_color), 0.0,
                    luminance(brdf.transmission_color) * passed);
  share = vec4(share.xy, 0.0, share.w) * (1.0 - coat) + vec4(0.0, 0.0, coat, 0.0);
  const float sum = dot(share, vec4(1.0));
  if (sum <= 0.0) return vec4(0.0, 1.0, 0.0, 0.0);
  // No lobe that is there is left to chance alone.
  share = max(share, vec4(greaterThan(share, vec4(0.0))) * (0.02 * sum));
  return share / dot(share, vec4(1.0));
}

float diffuse_probability(Brdf brdf, vec3 out_direction) { return lobe_probabilities(brdf, out_direction).y; }

// Density over solid angle with which sample_brdf gives `in_direction`; directions in the frame of the normal.
float brdf_pdf(Brdf brdf, vec3 out_direction, vec3 in_direction) {
  if (out_direction.z <= 0.0 || in_direction.z == 0.0) return 0.0;
  const vec4 share = lobe_probabilities(brdf, out_direction);
  if (in_direction.z < 0.0) {
    const vec3 half_vector = transmission_half_vector(brdf, vec3(0.0, 0.0, 1.0), out_direction, in_direction);
    const float density = visible_normal_density(out_direction.z, half_vector, brdf.alpha) *
                          max(dot(out_direction, half_vector), 0.0);
    return share.w * density * transmission_jacobian(brdf, out_direction, in_direction, half_vector);
  }
  const vec3 half_vector = normalize(out_direction + in_direction);
  const float specular = visible_normal_pdf(out_direction.z, half_vector, brdf.alpha);
  float clearcoat = 0.0;
  const float coat_out = dot(brdf.clearcoat_normal, out_direction);
  if (share.z > 0.0 && coat_out > 0.0)
    clearcoat = 0.5 * ggx_half_masking(coat_out, brdf.clearcoat_alpha) *
                precise_distribution(brdf.clearcoat_normal, half_vector, brdf.clearcoat_alpha);
  return share.x * specular + share.y * in_direction.z * (1.0 / kPi) + share.z * clearcoat;
}

vec3 sample_clearcoat(Brdf brdf, vec3 out_direction, vec2 u) {
  const mat3 frame = frame_around(brdf.clearcoat_normal);
  return reflect(-out_direction, frame * sample_visible_normal(out_direction * frame, brdf.clearcoat_alpha, u));
}

// The direction below that a microfacet refracts to; (0, 0, 0) where it reflects everything.
vec3 sample_transmission(Brdf brdf, vec3 out_direction, vec2 u) {
  const vec3 visible_normal = sample_visible_normal(out_direction, brdf.alpha, u);
  if (brdf.eta == 1.0) return reflect(-out_direction, visible_normal) * vec3(1.0, 1.0, -1.0);
  return refract(-out_direction, visible_normal, 1.0 / brdf.eta);
}

// An importance-sampled direction, which lies below the surface (z < 0) where light passes it; `u` chooses within a lobe,
// `u_lobe` the lobe. Where brdf_pdf of it is 0, no light comes that way.
vec3 sample_brdf(Brdf brdf, vec3 out_direction, vec2 u, float u_lobe) {
  const vec4 share = lobe_probabilities(brdf, out_direction);
  if (u_lobe < share.w) {
    const vec3 below = sample_transmission(brdf, out_direction, u);
    return below.z < 0.0 ? below : vec3(0.0);
  }
  if (u_lobe < share.w + share.z) {
    const vec3 mirrored = sample_clearcoat(brdf, out_direction, u);
    return mirrored.z > 0.0 ? mirrored : vec3(0.0);
  }
  if (u_lobe < share.w + share.z + share.y) return cosine_hemisphere(u);
  const vec3 mirrored = reflect(-out_direction, sample_visible_normal(out_direction, brdf.alpha, u));
  return mirrored.z > 0.0 ? mirrored : vec3(0.0);
}
