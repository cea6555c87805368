// SCENE on the command line: a path to a .glb or .gltf, or builtin:NAME.
#pragma once

#include <string>

#include "renderer/error.h"
#include "renderer/image_io/environment_file.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Loads it, gives it the environment, lights it if it has no light then, and tells stderr what the loader warned of.
Result<Scene> load_scene_argument(const std::string& scene, const EnvironmentChoice& environment);

}  // namespace lightwell
