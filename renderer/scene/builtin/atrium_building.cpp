#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/builtin/atrium.h"
#include "renderer/scene/builtin/shapes.h"
#include "renderer/scene/builtin/textures.h"

namespace lightwell::builtin::atrium {
namespace {

constexpr float kLeft = -6.2f, kRight = kHalfWidth + kWallThickness;  // the outsides
constexpr float kAisleWall = -5.2f, kArcadeBack = -3.4f;
constexpr float kArchSpring = 2.3f;
constexpr int kBays = 4;
constexpr float kBay = kHallFront / kBays;  // from column to column
constexpr float kArchRadius = 0.5f * kBay - 0.19f;

/// The half circle over `center` from its left foot over the top to its right foot.
void add_arch(std::vector<glm::vec2>& outline, const glm::vec2& center, float radius, int spans) {
  for (int i = 0; i <= spans; ++i) {
    const float angle = glm::pi<float>() * static_cast<float>(spans - i) / static_cast<float>(spans);
    outline.push_back(center + radius * glm::vec2(std::cos(angle), std::sin(angle)));
  }
}

// Neighbouring solids reach a few centimetres into each other and share no plane: what merely touches lets rays slip
// through the seam, and what lies in one plane fights for depth. All walls are thick, so that no light leaks in.

MeshBuilder well_walls() {
  constexpr float kSide = kHalfWidth + 0.03f;
  MeshBuilder mesh;
  mesh.box({kLeft, -1.2f, kWellBack - 1.0f}, {kRight + 0.05f, kWellTop, kWellBack});
  mesh.box({-kRight, -1.2f, kWellBack - 0.1f}, {-kSide, kWellTop, 0.1f});
  mesh.box({kSide, -1.2f, kWellBack - 0.1f}, {kRight + 0.03f, kWellTop, 0.1f});
  mesh.box({-kRight + 0.05f, kVaultTop - 0.1f, 0.02f}, {kRight - 0.05f, kWellTop, 1.0f});  // above the vault
  return mesh;
}

MeshBuilder hall_walls() {
  MeshBuilder mesh;
  mesh.box({kLeft, -0.1f, kHallFront}, {kRight, kVaultTop + 0.05f, kHallFront + 1.0f});  // behind the camera
  mesh.box({kLeft, -0.1f, -1.0f}, {-kRight + 0.1f, 4.7f, 0.12f});                        // end of the aisle
  return mesh;
}

/// The aisle's ceiling stops short of its outer wall: daylight washes down there.
MeshBuilder aisle_ceiling() {
  MeshBuilder mesh;
  mesh.box({-4.72f, kVaultSpring - 0.02f, 0.0f}, {-kRight + 0.1f, 4.6f, kHallFront + 0.1f});
  return mesh;
}

/// The barrel vault and the masonry around it.
MeshBuilder vault() {
  std::vector<glm::vec2> outline = {{-kRight, kVaultTop}, {-kRight, kVaultSpring}};
  add_arch(outline, {0.0f, kVaultSpring}, kHalfWidth, 28);
  outline.insert(outline.end(), {{kRight, kVaultSpring}, {kRight, kVaultTop}});
  return extrude(outline, kHallFront + 0.1f);
}

/// Arches that carry the vault, one over each column, and the moulding it springs from.
MeshBuilder ribs() {
  constexpr float kDepth = 0.14f, kWidth = 0.30f;
  std::vector<glm::vec2> outline;
  add_arch(outline, {0.0f, kVaultSpring}, kHalfWidth + 0.02f, 28);
  std::vector<glm::vec2> inner;
  add_arch(inner, {0.0f, kVaultSpring}, kHalfWidth - kDepth, 28);
  outline.insert(outline.end(), inner.rbegin(), inner.rend());
  std::reverse(outline.begin(), outline.end());
  const MeshBuilder rib = extrude(outline, kWidth);
  MeshBuilder mesh;
  for (int i = 0; i < kBays; ++i) {
    const float z = i == 0 ? 0.02f : kBay * static_cast<float>(i) - 0.5f * kWidth;
    mesh.append(rib, glm::translate(glm::mat4(1.0f), {0.0f, 0.0f, z}));
  }
  for (const float side : {-1.0f, 1.0f}) {
    MeshBuilder moulding = bevelled_box({kHalfWidth - 0.17f, kVaultSpring - 0.16f, 0.015f},
                                        {kHalfWidth + 0.1f, kVaultSpring + 0.03f, kHallFront + 0.1f}, 0.02f);
    mesh.append(moulding, glm::scale(glm::mat4(1.0f), {side, 1.0f, 1.0f}));
  }
  return mesh;
}

/// The arches between hall and aisle, drawn in (z, y) and turned to stand along the hall.
MeshBuilder arcade() {
  constexpr float kTop = kVaultSpring + 0.05f, kEnd = kHallFront + 0.1f;
  std::vector<glm::vec2> outline = {{0.0f, kTop}, {0.0f, kArchSpring}};
  for (int bay = 0; bay < kBays; ++bay)
    add_arch(outline, {kBay * (static_cast<float>(bay) + 0.5f), kArchSpring}, kArchRadius, 16);
  outline.insert(outline.end(), {{kEnd, kArchSpring}, {kEnd, kTop}});
  MeshBuilder mesh;
  // (x, y, z) of the extrusion becomes (-z, y, x), so that it fills x from kArcadeBack to the hall.
  const glm::mat4 turn({0, 0, 1, 0}, {0, 1, 0, 0}, {-1, 0, 0, 0}, {-kHalfWidth, 0, 0, 1});
  mesh.append(extrude(outline, -kHalfWidth - kArcadeBack), turn);
  return mesh;
}

MeshBuilder column() {
  MeshBuilder mesh = bevelled_box({-0.20f, 0.0f, -0.20f}, {0.20f, 0.12f, 0.20f}, 0.012f);
  std::vector<glm::vec2> profile = {{0.17f, 0.12f},  {0.185f, 0.15f}, {0.17f, 0.18f}, {0.15f, 0.19f},
                                    {0.145f, 0.21f}, {0.13f, 0.225f}, {0.13f, 0.225f}};
  for (int i = 1; i <= 5; ++i) {  // the shaft, tapering with a slight swell
    const float t = static_cast<float>(i) / 5.0f;
    profile.emplace_back(0.13f - 0.022f * t * t, 0.225f + 1.735f * t);
  }
  profile.insert(profile.end(), {{0.108f, 1.96f},
                                 {0.125f, 1.965f},
                                 {0.125f, 1.99f},
                                 {0.108f, 1.995f},
                                 {0.108f, 1.995f},
                                 {0.112f, 2.06f},
                                 {0.135f, 2.12f},
                                 {0.18f, 2.16f}});
  mesh.append(lathe(profile, 18));
  mesh.append(bevelled_box({-0.195f, 2.16f, -0.195f}, {0.195f, kArchSpring + 0.02f, 0.195f}, 0.012f));
  return mesh;
}

/// From the hall down into the well.
MeshBuilder steps() {
  MeshBuilder mesh;
  constexpr int kSteps = 3;
  for (int i = 0; i < kSteps; ++i) {
    const float top = -0.16f * static_cast<float>(i + 1), front = -0.36f * static_cast<float>(i + 1);
    mesh.append(bevelled_box({-3.02f, kWellFloor - 0.05f, front}, {3.02f, top, 0.05f}, 0.01f));
  }
  return mesh;
}

MeshBuilder roof() {
  MeshBuilder mesh;
  const float low = kWellTop - 0.02f, high = kWellTop + 0.5f;
  mesh.box({-kRight, low, -6.5f}, {-2.6f, high, 1.0f});
  mesh.box({2.6f, low, -6.5f}, {kRight + 0.05f, high, 1.0f});
  mesh.box({-2.7f, low + 0.01f, -0.6f}, {2.7f, high - 0.01f, 0.99f});
  mesh.box({-2.7f, low + 0.01f, -6.49f}, {2.7f, high - 0.01f, -5.3f});
  return mesh;
}

}  // namespace

void add_building(SceneBuilder& scene) {
  const int lime = scene.material("lime plaster", plaster(256, {0.80f, 0.76f, 0.69f}, 0.05f), 4.0f, 0.95f);
  const int ochre = scene.material("ochre wash", plaster(256, {0.78f, 0.44f, 0.12f}, 0.10f), 4.0f, 0.9f);
  const int turquoise = scene.material("turquoise wash", plaster(256, {0.26f, 0.52f, 0.56f}, 0.10f), 4.0f, 0.9f);
  const int limestone = scene.material("limestone", {0.70f, 0.66f, 0.59f}, 0.75f);
  const int paving = scene.material("flagstones", flagstones(512, 5, 6, {0.62f, 0.57f, 0.50f}, 0.012f), 4.2f, 0.45f);

  MeshBuilder floors, right_wall, aisle_wall;
  floors.box({kLeft, -1.2f, 0.0f}, {kRight, 0.0f, kHallFront + 1.0f});
  floors.box({-kRight, -1.21f, -6.4f}, {kRight, kWellFloor, 0.1f});
  right_wall.box({kHalfWidth, -0.1f, 0.0f}, {kRight, kVaultSpring + 0.05f, kHallFront + 0.1f});
  aisle_wall.box({kLeft, -0.1f, 0.0f}, {kAisleWall, 4.71f, kHallFront + 0.1f});
  scene.mesh_node("floors", {{floors, paving}});
  scene.mesh_node("well walls", {{well_walls(), lime}});
  scene.mesh_node("hall walls", {{hall_walls(), lime}});
  scene.mesh_node("aisle ceiling", {{aisle_ceiling(), lime}});
  scene.mesh_node("roof", {{roof(), lime}});
  scene.mesh_node("vault", {{vault(), lime}});
  scene.mesh_node("hall wall", {{right_wall, ochre}});
  scene.mesh_node("aisle wall", {{aisle_wall, turquoise}});
  scene.mesh_node("arcade", {{arcade(), limestone}});
  scene.mesh_node("ribs", {{ribs(), limestone}});
  scene.mesh_node("steps", {{steps(), limestone}});

  const int column_mesh = scene.mesh("column", {{column(), limestone}});
  for (int i = 0; i <= kBays; ++i) {
    const glm::vec3 foot(0.5f * (kArcadeBack - kHalfWidth), 0.0f, kBay * static_cast<float>(i));
    scene.mesh_node("column " + std::to_string(i + 1), column_mesh, {foot, glm::quat(1, 0, 0, 0), glm::vec3(1.0f)});
  }
}

}  // namespace lightwell::builtin::atrium
