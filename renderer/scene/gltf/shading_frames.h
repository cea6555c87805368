// Normals and tangents where a file leaves them out, or gives what is none.
#pragma once

#include <string>

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Gives every vertex a unit normal. Without any in the file, the triangles are taken apart and shaded flat, as glTF
/// demands; single normals without length or not finite are made anew from the triangles around. Claims the vertices
/// it adds. Throws Failure if these are too many.
void complete_normals(Context& context, const std::string& where, Primitive& primitive);

/// Gives every vertex a unit tangent; normals must be complete. If the file gives none, they are made from the normal
/// texture's coordinates where `material` has one, which may split vertices, and arbitrarily elsewhere. Claims the
/// vertices it adds. Throws Failure if these are too many.
void complete_tangents(Context& context, const Material& material, const std::string& where, Primitive& primitive);

}  // namespace lightwell::gltf
