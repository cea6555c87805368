// Smooth surfaces mirror: what the picture shows of that is too sharp for the indirect map. Rays of their own, one a pixel, find
// it, and the map holds all else. SMOOTH_SURFACES: there may be some. Needs brdf.

const float kSmoothAlpha = 0.0625;  // roughness 0.25; rougher ones blur over a patch
const float kMirrorAlpha = 0.0025;  // of a smoother surface all rays of a pixel go to the same place

// Lobes above or below the base would have to be told from it.
bool is_smooth(Brdf brdf) {
#ifdef HAS_LOBES
  const vec3 others = max(brdf.sheen_color, brdf.transmission_color);
  if (brdf.clearcoat + others.r + others.g + others.b > 0.0) return false;
#endif
  return brdf.alpha < kSmoothAlpha && max(brdf.f90, max(brdf.f0.r, max(brdf.f0.g, brdf.f0.b))) > 0.0;
}

// Of which the indirect map gathers light; as before, less what the interface takes of it.
Brdf brdf_of_map(Brdf brdf) {
#ifdef SMOOTH_SURFACES
  const bool smooth_one = is_smooth(brdf);
  brdf.f0 = smooth_one ? vec3(0.0) : brdf.f0;
  brdf.f90 = smooth_one ? 0.0 : brdf.f90;
#ifdef MULTISCATTER
  brdf.mean_dielectric = smooth_one ? vec3(0.0) : brdf.mean_dielectric;
  brdf.mean_metal = smooth_one ? vec3(0.0) : brdf.mean_metal;
#endif
#ifdef HAS_LOBES
  brdf.demodulation_f0 = smooth_one ? vec3(0.0) : brdf.demodulation_f0;
#endif
#endif
  return brdf;
}

// What brdf_of_map() leaves out of a smooth surface. WHOLE_BRDF: all, for surfaces that no map is of.
Brdf brdf_of_reflections(Brdf brdf) {
#ifdef WHOLE_BRDF
  return brdf;
#endif
  brdf.diffuse_albedo = vec3(0.0);
  return brdf;
}
