// Skins: joints and inverse bind matrices.
#pragma once

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Reads all skins, numbered as in the file. Throws Failure for joints that are no nodes and matrices too few.
void read_skins(Context& context, Scene& scene);

/// Holds each skinned node's mesh against its skin. Throws Failure if a vertex follows a joint that the skin has not;
/// takes a skin away, with a warning, where there is nothing to deform.
void check_skins(Context& context, Scene& scene);

}  // namespace lightwell::gltf
