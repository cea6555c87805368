// The mesh kit: shapes are closed, wound outward, and have the triangles their headers promise.
#include "renderer/scene/builtin/mesh_builder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <tuple>

#include "renderer/scene/builtin/shapes.h"
#include "renderer/scene/builtin/textures.h"

namespace lightwell::builtin {
namespace {

using Corner = std::tuple<int, int, int>;

/// A position on a grid of a tenth of a millimetre: equal for vertices that only differ in their normals.
Corner corner_of(const glm::vec3& p) {
  const auto rounded = [](float v) { return static_cast<int>(std::lround(v * 1e4f)); };
  return {rounded(p.x), rounded(p.y), rounded(p.z)};
}

/// Every edge is walked as often one way as the other: no holes, and neighbours are wound alike.
bool is_closed(const Primitive& primitive) {
  std::map<std::pair<Corner, Corner>, int> balance;
  for (std::size_t i = 0; i < primitive.indices.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const Corner a = corner_of(primitive.positions[primitive.indices[i]]);
    const Corner b = corner_of(primitive.positions[primitive.indices[next]]);
    ++balance[{a, b}];
    --balance[{b, a}];
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& edge) { return edge.second == 0; });
}

/// Positive when the triangles face outward.
float volume(const Primitive& primitive) {
  float six_volumes = 0.0f;
  for (std::size_t i = 0; i < primitive.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) { return primitive.positions[primitive.indices[i + k]]; };
    six_volumes += glm::dot(at(0), glm::cross(at(1), at(2)));
  }
  return six_volumes / 6.0f;
}

void expect_solid(const MeshBuilder& mesh, std::size_t triangles, float expected_volume, float tolerance) {
  EXPECT_EQ(mesh.triangle_count(), triangles);
  const Primitive primitive = mesh.finish(0);
  EXPECT_TRUE(is_closed(primitive));
  EXPECT_NEAR(volume(primitive), expected_volume, tolerance);
}

TEST(MeshKit, BoxesAreSolid) {
  MeshBuilder box;
  box.box({1, 2, 3}, {2, 4, 6});
  expect_solid(box, 12, 6.0f, 1e-4f);
  // Each of the twelve edges loses a prism of bevel^2 / 2, less what the corners share.
  expect_solid(bevelled_box({-1, -1, -1}, {1, 1, 1}, 0.1f), 44, 7.88f, 0.02f);
}

TEST(MeshKit, RoundShapesAreSolid) {
  expect_solid(sphere(1.0f, 48, 24), 2 * 48 * 23, 4.1888f, 0.05f);
  expect_solid(cylinder(1.0f, 1.0f, -1.0f, 1.0f, 64), 4 * 64 - 4, 6.2832f, 0.02f);
  expect_solid(cylinder(2.0f, 1.0f, 0.0f, 3.0f, 64), 4 * 64 - 4, 7.0f * 3.14159f, 0.06f);
  constexpr glm::vec2 kCreased[] = {{0, 0}, {1, 0}, {1, 0}, {1, 2}, {1, 2}, {0, 2}};
  expect_solid(lathe(kCreased, 32), 4 * 32, 6.2832f, 0.05f);
}

TEST(MeshKit, TubesAndSheetsAreSolid) {
  const std::array path = {glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(2, 1, 0), glm::vec3(2, 2, 1)};
  EXPECT_TRUE(is_closed(tube(path, std::array{0.1f}, 6).finish(0)));
  EXPECT_GT(volume(tube(path, std::array{0.1f}, 6).finish(0)), 0.0f);
  EXPECT_EQ(tube(path, std::array{0.1f}, 6).triangle_count(), 2u * 6 * 3 + 2 * 4);
  const Grid flat = make_grid(4, 3, false, [](float u, float v) { return glm::vec3(u, v, 0); });
  expect_solid(sheet(flat, 0.1f), 4 * 3 * 2 + 4 * (4 + 3 - 2), 0.1f, 1e-4f);
}

TEST(MeshKit, ExtrudesConcavePolygons) {
  constexpr glm::vec2 kLetterL[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  expect_solid(extrude(kLetterL, 0.5f), 2 * 4 + 2 * 6, 2.0f, 1e-4f);
}

TEST(MeshKit, AMirrorKeepsOutsidesOutside) {
  MeshBuilder box, mirrored;
  box.box({1, 1, 1}, {2, 3, 2});
  mirrored.append(box, glm::scale(glm::mat4(1.0f), {-1, 1, 1}));
  expect_solid(mirrored, 12, 2.0f, 1e-4f);
  const Primitive primitive = mirrored.finish(0);
  EXPECT_LT(primitive.bounds_max.x, 0.0f);
}

TEST(MeshKit, TangentsPointAlongU) {
  MeshBuilder mesh;
  mesh.quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const Primitive primitive = mesh.finish(0);
  for (const glm::vec4& tangent : primitive.tangents) {
    EXPECT_NEAR(tangent.x, 1.0f, 1e-6f);
    EXPECT_EQ(tangent.w, 1.0f);  // the bitangent points up in the image, as v does not
  }
}

TEST(MeshKit, AGridCanBeSplitBetweenMaterials) {
  const Grid ring = make_grid(
      8, 5, true, [](float u, float v) { return glm::vec3(std::cos(6.2831853f * u), v, -std::sin(6.2831853f * u)); });
  MeshBuilder lower, upper, whole;
  lower.grid(ring, [](int, int row) { return row < 2; });
  upper.grid(ring, [](int, int row) { return row >= 2; });
  whole.grid(ring);
  EXPECT_EQ(lower.triangle_count() + upper.triangle_count(), whole.triangle_count());
  EXPECT_LT(lower.finish(0).positions.size(), whole.finish(0).positions.size());
}

TEST(Textures, AreTheSameEveryTimeAndKeepTheirMeanColor) {
  const Image a = plaster(64, glm::vec3(0.5f), 0.1f), b = plaster(64, glm::vec3(0.5f), 0.1f);
  EXPECT_EQ(a.rgba, b.rgba);
  ASSERT_EQ(a.rgba.size(), 64u * 64 * 4);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) sum += std::pow(a.rgba[i] / 255.0, 2.2);
  EXPECT_NEAR(sum / (64 * 64), 0.5, 0.02);
  EXPECT_EQ(flagstones(64, 2, 2, glm::vec3(0.5f), 0.02f).rgba.size(), 64u * 64 * 4);
}

}  // namespace
}  // namespace lightwell::builtin
