// Tangents for normal mapping, by the MikkTSpace convention that glTF names as its default: after Morten S. Mikkelsen,
// "Simulation of Wrinkled Surfaces Revisited" (Master's thesis, University of Copenhagen, 2008), written anew here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lightwell {

/// Tangents of a mesh. Where the corners that meet in a vertex have different tangents (at a mirrored seam, say) the
/// vertex is split: the first vertices are those given, in their order, the copies follow.
struct TangentMesh {
  std::vector<glm::vec4> tangents;             // per vertex; as Primitive::tangents
  std::vector<std::uint32_t> source_vertices;  // per vertex: the given vertex that it is or copies
  std::vector<std::uint32_t> indices;          // as given, with splits
};

/// Makes tangents from one position, unit normal and texture coordinate per vertex (v = 0 is the image's first row)
/// and three indices per triangle, all in range. Corners with equal position, normal and texture coordinate that are
/// connected through triangles of the same handedness share a tangent: the mean of their triangles' directions of
/// growing u, each in the plane of the normal and weighted with the corner's angle. A vertex that this leaves without
/// a direction gets any_tangent.
TangentMesh make_tangents(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                          std::span<const glm::vec2> uvs, std::span<const std::uint32_t> indices);

/// Some unit tangent at a right angle to a unit normal, with w = 1.
glm::vec4 any_tangent(const glm::vec3& normal);

}  // namespace lightwell
