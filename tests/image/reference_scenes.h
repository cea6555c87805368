// Scenes and settings that several tests of the reference method share.
#pragma once

#include "tests/image/test_scenes.h"

namespace lightwell::testing {

Settings reference_settings(int bounces);

/// What `maker` built, under a sky of 1 nit all around.
Scene with_white_sky(SceneMaker maker);

/// A room with a lamp, a spot light, a floor of rough metal and a wall of plastic, under a sky through its open front.
Scene varied_room(float scale = 1.0f);

/// Of varied_room(): into its open front.
PlacedCamera before_varied_room(float scale = 1.0f);

}  // namespace lightwell::testing
