// The environment cut into cells of known brightness, so that light from it can be sampled where it comes from.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "renderer/scene/scene.h"

namespace lightwell {

/// Cells of a latitude-longitude grid that turns with the environment; row 0 is the zenith, columns begin where the
/// picture's do.
struct EnvironmentCells {
  glm::ivec2 size{0};
  std::vector<double> weights;  // luminance times solid angle, row by row; their sum is the whole, nit * steradian
};

/// Empty if the environment is black.
EnvironmentCells make_environment_cells(const Environment& environment);

}  // namespace lightwell
