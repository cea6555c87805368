// Clear surfaces, which light goes straight on through: kMaterialClear. Needs scene_data, brdf.

#ifdef HAS_LOBES
// What of the light along `direction` passes: the integral of transmission_times_cosine() over the directions below, where
// roughness vanishes. A volume's refraction is left out, and with it total reflection. `normal` and the clearcoat's in the
// frame of the direction, which may lie on either side.
vec3 clear_transmittance(Brdf brdf, vec3 normal, vec3 direction) {
  const float cosine = abs(dot(normal, direction));
  const float reflected = mix(brdf.f0_dielectric, brdf.f90_dielectric, schlick_weight(cosine));
  const float under_coat = 1.0 - clearcoat_reflectance(brdf, dot(brdf.clearcoat_normal, direction));
  return brdf.transmission_color *
         ((1.0 - reflected) * under_coat * under_coat * sheen_passes(brdf, cosine, cosine));
}
#endif
