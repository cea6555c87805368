// The parts of the atrium, each in its own source.
//
// Plan, seen from above (metres): the sun comes down the well, the main camera stands in the hall and looks into it.
//
//   z    x = -6.2   -5.2      -3.4 -3.0         3.0   4.0
//  -6.5   +------------------------------------------+
//  -5.5   |                     +---------------+    |
//         |                     |  well, 15 m   |    |   open to the sky; its floor is 0.64 m lower
//  -1.0   +---------------+     |               |    |
//   0.0   |    +----------+-----+ = = steps = = +----+
//         |    |  aisle    o        hall        |    |   vaulted, 6.6 m high
//   7.2   |    +-----------o--------------------+    |
//   8.2   +------------------------------------------+
#pragma once

#include "renderer/scene/builtin/scene_builder.h"

namespace lightwell::builtin::atrium {

constexpr float kHalfWidth = 3.0f;  // of well and hall
constexpr float kWallThickness = 1.0f;
constexpr float kWellBack = -5.5f;
constexpr float kWellTop = 15.0f;
constexpr float kWellFloor = -0.64f;
constexpr float kHallFront = 7.2f;
constexpr float kVaultSpring = 3.6f;
constexpr float kVaultTop = 7.4f;  // of the masonry; the vault itself reaches kVaultSpring + kHalfWidth

/// Floors, walls, vault, arcade, steps and the roof's opening.
void add_building(SceneBuilder& scene);

/// The hanging cloths, the bench and what stands on the floor.
void add_furnishings(SceneBuilder& scene);

/// The mobile under the opening, with its turning.
void add_mobile(SceneBuilder& scene);

}  // namespace lightwell::builtin::atrium
