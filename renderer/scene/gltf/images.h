// Encoded images into pixels.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Decodes the images that materials use, each once, and makes textures refer to them; textures that no material uses
/// lose their image. Materials must have been read. Throws Failure.
void read_images(Context& context, Scene& scene);

}  // namespace lightwell::gltf
