// Tangents by the MikkTSpace convention, on meshes small enough to work them out by hand.
#include "renderer/scene/tangents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace lightwell {
namespace {

using testing::ElementsAre;

constexpr float kTolerance = 1e-5f;

struct Grid {
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;
  std::vector<std::uint32_t> indices;

  /// A vertex in the xy plane that faces +z.
  void add(glm::vec2 position, glm::vec2 uv) {
    positions.emplace_back(position, 0.0f);
    normals.emplace_back(0.0f, 0.0f, 1.0f);
    uvs.push_back(uv);
  }
  TangentMesh tangents() const { return make_tangents(positions, normals, uvs, indices); }
};

void expect_tangent(const glm::vec4& actual, const glm::vec3& direction, float handedness) {
  EXPECT_NEAR(actual.x, direction.x, kTolerance);
  EXPECT_NEAR(actual.y, direction.y, kTolerance);
  EXPECT_NEAR(actual.z, direction.z, kTolerance);
  EXPECT_EQ(actual.w, handedness);
}

/// A unit square; u to the right, v downwards, as an image lies on it.
Grid upright_square() {
  Grid grid;
  grid.add({0, 0}, {0, 1});
  grid.add({1, 0}, {1, 1});
  grid.add({1, 1}, {1, 0});
  grid.add({0, 1}, {0, 0});
  grid.indices = {0, 1, 2, 0, 2, 3};
  return grid;
}

TEST(Tangents, AnUprightImage) {
  // The bitangent w * cross(n, t) is +y: up in the image, as glTF's normal textures have it.
  const TangentMesh mesh = upright_square().tangents();
  EXPECT_EQ(mesh.indices, upright_square().indices);
  for (const glm::vec4& tangent : mesh.tangents) expect_tangent(tangent, {1, 0, 0}, 1.0f);
}

TEST(Tangents, AMirroredImage) {
  Grid grid = upright_square();
  for (glm::vec2& uv : grid.uvs) uv.x = 1.0f - uv.x;
  for (const glm::vec4& tangent : grid.tangents().tangents) expect_tangent(tangent, {-1, 0, 0}, -1.0f);
}

TEST(Tangents, ATurnedImage) {
  Grid grid = upright_square();
  for (glm::vec2& uv : grid.uvs) uv = {uv.y, -uv.x};
  for (const glm::vec4& tangent : grid.tangents().tangents) expect_tangent(tangent, {0, -1, 0}, 1.0f);
}

TEST(Tangents, VerticesOnAMirrorSeamAreSplit) {
  // Two squares side by side, the right one's image mirrored about the shared edge, whose vertices 1 and 2 are shared.
  Grid grid = upright_square();
  grid.add({2, 0}, {0, 1});
  grid.add({2, 1}, {0, 0});
  grid.indices.insert(grid.indices.end(), {1, 4, 5, 1, 5, 2});
  const TangentMesh mesh = grid.tangents();
  ASSERT_EQ(mesh.tangents.size(), 8u);
  EXPECT_THAT(mesh.source_vertices, ElementsAre(0, 1, 2, 3, 4, 5, 1, 2));
  EXPECT_THAT(mesh.indices, ElementsAre(0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7));
  for (const int v : {0, 1, 2, 3}) expect_tangent(mesh.tangents[v], {1, 0, 0}, 1.0f);
  for (const int v : {4, 5, 6, 7}) expect_tangent(mesh.tangents[v], {-1, 0, 0}, -1.0f);
}

TEST(Tangents, CornersWeighByTheirAngle) {
  // Around the origin a corner of 90 degrees, where a step of u goes along +x, and one of 45 degrees, where the edges
  // (0, 1) and (-1, 1) are the texture steps (0, -1) and (-1, -2): a step of u is twice the one less the other, (1, 1).
  Grid grid;
  grid.add({0, 0}, {0, 0});
  grid.add({1, 0}, {1, 0});
  grid.add({0, 1}, {0, -1});
  grid.add({-1, 1}, {-1, -2});
  grid.indices = {0, 1, 2, 0, 2, 3};
  const TangentMesh mesh = grid.tangents();
  ASSERT_EQ(mesh.tangents.size(), 4u);
  const float diagonal = std::sqrt(0.5f);
  expect_tangent(mesh.tangents[0], glm::normalize(glm::vec3(2.0f + diagonal, diagonal, 0)), 1.0f);
  expect_tangent(mesh.tangents[1], {1, 0, 0}, 1.0f);
  expect_tangent(mesh.tangents[3], {diagonal, diagonal, 0}, 1.0f);
}

TEST(Tangents, EqualVerticesShareWhetherIndexedOrNot) {
  // A ridge: the tangents of its two sides differ, and meet in the middle where normals are shared.
  const std::vector<glm::vec3> positions{{-1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 0, 1}, {1, 0, 0}, {0, 1, 1}};
  const glm::vec3 up(0, 0, 1);
  const std::vector<glm::vec3> normals{glm::normalize(glm::vec3(-1, 0, 1)), up, up, up,
                                       glm::normalize(glm::vec3(1, 0, 1)),  up};
  const std::vector<glm::vec2> uvs{{0, 1}, {1, 1}, {1, 0}, {1, 1}, {2, 1}, {1, 0}};
  const TangentMesh mesh = make_tangents(positions, normals, uvs, std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5});
  for (const int v : {1, 2, 3, 5}) expect_tangent(mesh.tangents[v], {1, 0, 0}, 1.0f);
  EXPECT_EQ(mesh.tangents[1], mesh.tangents[3]);
  expect_tangent(mesh.tangents[0], glm::normalize(glm::vec3(1, 0, 1)), 1.0f);
  expect_tangent(mesh.tangents[4], glm::normalize(glm::vec3(1, 0, -1)), 1.0f);
}

TEST(Tangents, TrianglesWithoutTextureAreaFollowTheirNeighbours) {
  Grid grid = upright_square();
  grid.uvs[3] = grid.uvs[0];  // the second triangle's image has no area
  const TangentMesh mesh = grid.tangents();
  EXPECT_EQ(mesh.indices, grid.indices);
  expect_tangent(mesh.tangents[0], {1, 0, 0}, 1.0f);
  expect_tangent(mesh.tangents[2], {1, 0, 0}, 1.0f);
  EXPECT_NEAR(mesh.tangents[3].z, 0.0f, kTolerance);
}

TEST(Tangents, TrianglesWithoutExtentSplitNothing) {
  Grid grid = upright_square();
  grid.indices.insert(grid.indices.end(), {0, 0, 1, 2, 3, 3});
  const TangentMesh mesh = grid.tangents();
  EXPECT_EQ(mesh.indices, grid.indices);
  for (const glm::vec4& tangent : mesh.tangents) expect_tangent(tangent, {1, 0, 0}, 1.0f);
}

TEST(Tangents, NothingIsNoProblem) {
  const TangentMesh mesh = make_tangents({}, {}, {}, {});
  EXPECT_TRUE(mesh.tangents.empty());
  EXPECT_TRUE(mesh.indices.empty());
}

TEST(Tangents, AnyTangentIsAtARightAngle) {
  for (const glm::vec3& direction : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(0, -1, 0),
                                     glm::vec3(1, 2, -3), glm::vec3(1e-4f, 0, -1)}) {
    const glm::vec3 normal = glm::normalize(direction);
    const glm::vec4 tangent = any_tangent(normal);
    EXPECT_NEAR(glm::dot(glm::vec3(tangent), normal), 0.0f, kTolerance);
    EXPECT_NEAR(glm::length(glm::vec3(tangent)), 1.0f, kTolerance);
  }
}

}  // namespace
}  // namespace lightwell
