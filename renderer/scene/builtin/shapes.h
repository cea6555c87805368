// Solids and surfaces for the built-in scenes. All face outward; triangle counts are part of the contract.
#pragma once

#include <span>

#include "renderer/scene/builtin/mesh_builder.h"

namespace lightwell::builtin {

/// A box whose edges are cut at 45 degrees, `bevel` metres from each: 44 triangles.
MeshBuilder bevelled_box(const glm::vec3& low, const glm::vec3& high, float bevel);

/// A solid of revolution about +Y. `profile` holds (radius, height), upward along the outside; a point given twice is
/// a crease. 2 * segments triangles per span of the profile, half as many where it touches the axis.
MeshBuilder lathe(std::span<const glm::vec2> profile, int segments);

/// A sphere about the origin: 2 * segments * (rows - 1) triangles.
MeshBuilder sphere(float radius, int segments, int rows);

/// An upright cylinder or cone frustum from y = `bottom` to `top` with flat ends: 4 * sides - 4 triangles.
MeshBuilder cylinder(float bottom_radius, float top_radius, float bottom, float top, int sides);

/// A flat disk facing +Y at height `y`: corners - 2 triangles.
MeshBuilder disk(float radius, float y, int corners);

/// A tube with flat ends along `path` (two points or more); `radii` has one radius per point, or one for all.
/// 2 * sides per span and sides - 2 for each end.
MeshBuilder tube(std::span<const glm::vec3> path, std::span<const float> radii, int sides);

/// A simple polygon in x and y, counter-clockwise, as a solid from z = 0 to z = `depth`. Its sides are smooth where
/// neighbours meet at less than 30 degrees. 2 * (n - 2) + 2 * n triangles.
MeshBuilder extrude(std::span<const glm::vec2> polygon, float depth);

/// An open grid given `thickness` metres, half to each side, closed around its rim.
/// 4 * (columns - 1) * (rows - 1) + 4 * (columns + rows - 2) triangles.
MeshBuilder sheet(const Grid& middle, float thickness);

}  // namespace lightwell::builtin
