// How a path chooses where to go on: by the BRDF and, GUIDED, with some of its diffuse samples towards what guides know;
// both as one density, so that neither strategy is noisy where the other is good. Needs hit_surface and, GUIDED, guides.

struct DirectionSampling {
  float guided_share;
#ifdef GUIDED
  Guides guides;
#endif
};

DirectionSampling direction_sampling(HitPoint point, vec3 out_direction) {
  DirectionSampling sampling;
  sampling.guided_share = 0.0;
#ifdef GUIDED
  const float kMostGuided = 0.5;
  sampling.guides = guides_at(point.position_ws, point.geometric_normal_ws);
  const bool guided = sampling.guides.count > 0.0 && (point.material_flags & kMaterialClearWall) == 0u;
  if (guided) sampling.guided_share = kMostGuided * sampling.guides.share * diffuse_probability(point.brdf, out_direction);
#endif
  return sampling;
}

// Density over solid angle with which sample_direction gives `in_direction`, which is `in_ws` in the frame of the normal.
float direction_pdf(DirectionSampling sampling, HitPoint point, vec3 out_direction, vec3 in_direction, vec3 in_ws) {
  const float pdf = brdf_pdf(point.brdf, out_direction, in_direction);
#ifdef GUIDED
  return mix(pdf, guides_pdf(sampling.guides, in_ws), sampling.guided_share);
#else
  return pdf;
#endif
}

// A direction in the frame of the normal; `u` and `u_choice` as for sample_brdf.
vec3 sample_direction(DirectionSampling sampling, HitPoint point, mat3 frame, vec3 out_direction, vec2 u,
                      float u_choice) {
#ifdef GUIDED
  const float share = sampling.guided_share;
  if (u_choice < share) return sample_guides(sampling.guides, u, u_choice / share) * frame;
  return sample_brdf(point.brdf, out_direction, u, (u_choice - share) / (1.0 - share));
#else
  return sample_brdf(point.brdf, out_direction, u, u_choice);
#endif
}
