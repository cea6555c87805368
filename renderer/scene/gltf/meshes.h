// Meshes: primitives as indexed triangles with complete vertices.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Reads all meshes, numbered as in the file; primitives without triangles are left out with a warning. Materials must
/// have been read. Throws Failure.
void read_meshes(Context& context, Scene& scene);

}  // namespace lightwell::gltf
