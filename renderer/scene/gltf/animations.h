// Keyframe animation of nodes.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Reads all animations, numbered as in the file; channels that nothing can follow are left out with a warning. Nodes
/// and meshes must have been read. Throws Failure.
void read_animations(Context& context, Scene& scene);

}  // namespace lightwell::gltf
