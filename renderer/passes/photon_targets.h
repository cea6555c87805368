// Points of mirrors, for photons to be aimed at.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene/pose.h"

namespace lightwell {

/// As two texels of a vec4 each.
struct PhotonTarget {
  glm::vec3 position_ws{0.0f};
  float area_m2 = 0.0f;       // that it stands for: 1 / its density; the areas of all but sum to that of the surfaces
  glm::vec3 normal_ws{0.0f};  // unit, geometric
  float padding = 0.0f;
};
static_assert(sizeof(PhotonTarget) == 32);

/// Whether a material throws light on others from few directions, which rays sampled by the others' BRDFs seldom find:
/// it may be a smooth metal; textures are not looked into. Not glass: what it gathers looks wide from where it is
/// gathered, and guides to it did not pay.
bool throws_caustics(const Material& material);

/// `count` points of the instances with such materials, each of these getting as many as any other, its triangles
/// likewise; none if there is no such instance. The same numbers give the same points.
std::vector<PhotonTarget> photon_targets(const Scene& scene, const Pose& pose, std::uint32_t count, std::uint32_t seed);

}  // namespace lightwell
