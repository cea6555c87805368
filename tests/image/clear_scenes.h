// Scenes with panes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/image/test_scenes.h"

namespace lightwell::testing {

/// A thin wall that passes `color`, and reflects nothing unless `specular` is greater than 0.
inline Material pane(glm::vec3 color, float specular = 0.0f) {
  Material material;
  material.base_color_factor = glm::vec4(color, 1.0f);
  material.metallic_factor = 0.0f;
  material.roughness_factor = 0.0f;
  material.specular_factor = specular;
  material.transmission_factor = 1.0f;
  material.double_sided = true;
  return material;
}

inline void expect_near(glm::vec3 seen, glm::vec3 expected, float share) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(seen[c], expected[c], std::max(share * expected[c], 1e-6f)) << "channel " << c;
}

/// A Lambert floor under a level pane at half a metre.
inline SceneMaker floor_under(const Material& material, float albedo) {
  SceneMaker maker;
  maker.quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, maker.material(lambert(glm::vec3(albedo))));
  maker.quad({-2, 0.5f, -2}, {0, 0, 4}, {4, 0, 0}, maker.material(material));
  return maker;
}

inline const glm::vec3 kTint(0.9f, 0.5f, 0.2f);

/// Through the pane of `floor_under`, straight down.
inline const PlacedCamera kOverThePane = look_parallel({0, 2, 0}, {0, 0, 0}, 0.2f);

}  // namespace lightwell::testing
