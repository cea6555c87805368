// KHR_lights_punctual and cameras.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Reads all lights and cameras, numbered as in the file; what is out of range is put right with a warning. Throws
/// Failure for a kind of light or camera that does not exist.
void read_lights(Context& context, Scene& scene);
void read_cameras(Context& context, Scene& scene);

}  // namespace lightwell::gltf
