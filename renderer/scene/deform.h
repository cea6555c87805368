// Morph targets and skins: a primitive's vertices at one moment, made by the processor. shaders of passes/deformer.*
// are held to it.
#pragma once

#include <span>

#include "renderer/scene/deformed_shape.h"

namespace lightwell {

/// `primitive` with its morph targets added, `weights[i]` times target i (missing weights are 0), in mesh space.
DeformedVertices morph(const Primitive& primitive, std::span<const float> weights);

/// Skins `vertices` (as many as the primitive has) in place by the primitive's joints and weights.
/// `world_from_mesh[j]` = world_from_joint * joint_from_mesh of joint j; joints beyond its end use the last one; none
/// at all leave the vertices as they are. Afterwards the vertices are in the space the matrices lead to. Normals go by
/// the inverse transpose.
void skin(const Primitive& primitive, std::span<const glm::mat4> world_from_mesh, DeformedVertices& vertices);

}  // namespace lightwell
