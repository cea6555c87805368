// The node hierarchy, the shown scene, instances and skins.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Reads nodes, roots and skins. Everything that nodes refer to must have been read. Throws Failure for references that
/// lead nowhere, for nodes with several parents or in a circle, and when the instances hold too many triangles.
void read_nodes(Context& context, Scene& scene);

}  // namespace lightwell::gltf
