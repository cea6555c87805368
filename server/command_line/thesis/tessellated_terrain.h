// A scene of any number of triangles that always looks the same: what a frame costs more with more of them is the cost
// of the triangles alone.
#pragma once

#include "renderer/scene/scene.h"

namespace lightwell {

/// Triangles of the terrain before it is divided.
constexpr int kTerrainTriangles = 1458;
constexpr int kMaxTerrainDivisions = 64;

/// Hills between two walls, with a sun, a search light and a camera; nothing moves. Every edge is cut into `divisions`
/// (1..64) equal parts and every triangle into divisions^2 that lie in its plane: kTerrainTriangles * divisions^2.
Scene make_tessellated_terrain(int divisions);

}  // namespace lightwell
