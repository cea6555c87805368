// Materials, their textures and samplers.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Reads textures and materials, numbered as in the file; a factor out of its legal range is clamped with a warning.
/// Textures keep the image numbers of the file; images are read afterwards. Throws Failure.
void read_materials(Context& context, Scene& scene);

}  // namespace lightwell::gltf
