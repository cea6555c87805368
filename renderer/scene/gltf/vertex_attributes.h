// The vertices of a primitive: attributes, influences of joints, morph targets.
#pragma once

#include <string>

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// What accessor an attribute is in, or kNone.
int find_attribute(const std::map<std::string, int>& attributes, const std::string& name);

/// Fills all per-vertex arrays of `target` that the file gives, and its morph targets. Normals and tangents may still
/// be missing, zero or not finite. Vertices must have been claimed for `vertex_count` positions; morph targets claim
/// their own. Throws Failure.
void read_vertices(Context& context, const tinygltf::Primitive& source, std::size_t vertex_count,
                   const std::string& where, Primitive& target);

}  // namespace lightwell::gltf
