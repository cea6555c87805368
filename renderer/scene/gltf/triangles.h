// A primitive's indices as a plain list of triangles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/scene/gltf/context.h"

namespace lightwell::gltf {

/// Three indices per triangle of a primitive with `vertex_count` vertices: as given, counted up where there are none,
/// strips and fans taken apart. Empty, with a warning, for points, lines and fewer than three indices. Claims its
/// triangles. Throws Failure, for an index out of range in particular.
std::vector<std::uint32_t> read_triangles(Context& context, const tinygltf::Primitive& primitive,
                                          std::size_t vertex_count, const std::string& where);

}  // namespace lightwell::gltf
