// Scenes made in code, so that the first look and the tests need no file.
#pragma once

#include <string_view>
#include <vector>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Names of the built-in scenes, the default first: atrium, cornell, helicopters (1522 triangles), venus (3284).
const std::vector<std::string>& builtin_scene_names();

/// A built-in scene by name; kNotFound names the scenes that exist.
Result<Scene> builtin_scene(std::string_view name);

/// A soft neutral sky and a sun for a scene without punctual lights and environment; the faint sky alone where
/// materials emit. True if it was added.
bool add_default_light(Scene& scene);

}  // namespace lightwell
