// Directions from which mirrors throw light on a matt surface, as photons found them: a sum of lobes, to be
// sampled. Needs guide_cells.

layout(binding = UNIT_GUIDE_CELLS) uniform usamplerBuffer guide_cells;        // a cell's photons, see photon_bounce.comp
layout(binding = UNIT_GUIDE_FLUXES) uniform usamplerBuffer guide_fluxes;      // and what all that came there brought
layout(binding = UNIT_PHOTON_ORIGINS) uniform samplerBuffer photon_origins;

const uint kNoPhoton = 0xffffffffu, kPhotonMask = 0xffffu;

// How far from a photon's direction the light may come at another point of the cell: as the cell is seen from there, and
// as wide as the image of a lamp. Halving or doubling either changes a picture's error by a tenth at most.
const float kSpread = 0.25;
const float kLeastAngle_rad = 0.02;

struct Guides {
  vec4 lobes[GUIDES_PER_CELL];  // unit axis; width, 0: no lobe
  float count;                  // of lobes
  float share;                  // of the light that comes to the cell, roughly
};

vec4 guide_lobe(uint word, vec3 position_ws, vec3 normal_ws) {
  if (word == kNoPhoton) return vec4(0.0);
  const vec3 to_origin = texelFetch(photon_origins, int(word & kPhotonMask)).xyz - position_ws;
  const float distance_m = max(length(to_origin), 1e-20);
  const vec3 axis = to_origin / distance_m;
  const float angle_rad = kSpread * guide_cell_m / distance_m;
  const float width = min(0.5 * (angle_rad * angle_rad + kLeastAngle_rad * kLeastAngle_rad), 1.0);
  return dot(axis, normal_ws) > 0.0 ? vec4(axis, width) : vec4(0.0);
}

Guides guides_at(vec3 position_ws, vec3 normal_ws) {
  const int cell = int(guide_cell(position_ws, normal_ws));
  const uvec4 words = texelFetch(guide_cells, cell);
  const float irradiance = float(texelFetch(guide_fluxes, cell).x) * (1.0 / GUIDE_FLUX_STEPS);
  Guides guides;
  guides.share = irradiance / (irradiance + 1.0);
  guides.count = 0.0;
  for (int i = 0; i < GUIDES_PER_CELL; ++i) {
    guides.lobes[i] = guide_lobe(words[i], position_ws, normal_ws);
    guides.count += guides.lobes[i].w > 0.0 ? 1.0 : 0.0;
  }
  return guides;
}

// Density over solid angle, of each lobe width (width + 2) / (4 pi (width + 1 - cosine)^2): half of it within an angle of
// about sqrt(2 width), the rest so wide that no direction is missed.
float guides_pdf(Guides guides, vec3 direction_ws) {
  float sum = 0.0;
  for (int i = 0; i < GUIDES_PER_CELL; ++i) {
    const float width = guides.lobes[i].w;
    const float apart = width + 1.0 - dot(guides.lobes[i].xyz, direction_ws);
    sum += width * (width + 2.0) / max(apart * apart, 1e-20);
  }
  return sum / (4.0 * kPi * max(guides.count, 1.0));
}

// `u_lobe` chooses a lobe, `u` a direction of it, by the inverse of its distribution. There must be a lobe.
vec3 sample_guides(Guides guides, vec2 u, float u_lobe) {
  vec4 lobe = vec4(0.0, 0.0, 1.0, 1.0);
  float before = floor(min(u_lobe, 0.999999) * guides.count);
  for (int i = 0; i < GUIDES_PER_CELL; ++i) {
    const bool there = guides.lobes[i].w > 0.0;
    if (there && before == 0.0) lobe = guides.lobes[i];
    before -= there ? 1.0 : 0.0;
  }
  const float below_axis = 2.0 * lobe.w * u.x / (lobe.w + 2.0 * (1.0 - u.x));  // 1 - cosine
  const float sine = sqrt(max(below_axis * (2.0 - below_axis), 0.0));
  const float phi = 2.0 * kPi * u.y;
  return frame_around(lobe.xyz) * vec3(sine * cos(phi), sine * sin(phi), 1.0 - below_axis);
}
