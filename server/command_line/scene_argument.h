// SCENE on the command line: a path to a .glb or .gltf, or builtin:NAME.
#pragma once

#include <string>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Loads it, lights it if it brings no light of its own, and tells stderr what the loader warned of.
Result<Scene> load_scene_argument(const std::string& scene);

}  // namespace lightwell
