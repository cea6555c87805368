// EXT_mesh_gpu_instancing as plain nodes.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Gives every node with instances one child per instance, which takes over its mesh. Roots must have been found; nodes
/// that show nothing are passed over. Throws Failure.
void expand_instances(Context& context, Scene& scene);

}  // namespace lightwell::gltf
