#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/builtin/atrium.h"
#include "renderer/scene/builtin/shapes.h"

namespace lightwell::builtin::atrium {
namespace {

/// A cloth `width` by `length` hanging from a rod along x at y = 0, its folds even at the rod and loose below.
MeshBuilder cloth(float width, float length, float folds, float seed) {
  const Grid grid = make_grid(40, 18, false, [&](float u, float v) {
    const float down = 1.0f - v;
    const float wander = 0.35f * std::sin(2.1f * down + seed) + 0.2f * std::sin(4.7f * down + 2.0f * seed);
    const float fold = std::sin(glm::two_pi<float>() * folds * u + wander * (0.4f + down));
    const float broad = std::sin(glm::two_pi<float>() * 1.3f * u + seed + 1.4f * down);
    const float depth = (0.055f + 0.035f * down) * fold + 0.10f * down * down * broad;
    const float gather = 1.0f - 0.05f * std::sin(glm::pi<float>() * down);
    return glm::vec3((u - 0.5f) * width * gather, -length * down - 0.03f * down * broad, depth);
  });
  return sheet(grid, 0.012f);
}

/// Rod and cloth, the cloth's front towards +Z before `placement`.
void hang(SceneBuilder& scene, const std::string& name, const MeshBuilder& fabric, float width, int material, int metal,
          const Transform& placement) {
  const std::array ends = {glm::vec3(-0.5f * width - 0.25f, 0.02f, 0.0f), glm::vec3(0.5f * width + 0.25f, 0.02f, 0.0f)};
  scene.mesh_node(name, {{fabric, material}, {tube(ends, std::array{0.025f}, 8), metal}}, placement);
}

MeshBuilder bench() {
  MeshBuilder mesh = bevelled_box({-0.24f, 0.40f, -1.3f}, {0.24f, 0.47f, 1.3f}, 0.012f);
  for (const float z : {-0.95f, 0.95f})
    mesh.append(bevelled_box({-0.2f, 0.0f, z - 0.09f}, {0.2f, 0.41f, z + 0.09f}, 0.01f));
  return mesh;
}

MeshBuilder bowl() {
  constexpr glm::vec2 kProfile[] = {{0.0f, 0.0f},     {0.09f, 0.0f},   {0.09f, 0.0f},   {0.085f, 0.02f},
                                    {0.14f, 0.045f},  {0.20f, 0.09f},  {0.235f, 0.14f}, {0.25f, 0.19f},
                                    {0.247f, 0.196f}, {0.24f, 0.19f},  {0.222f, 0.14f}, {0.185f, 0.095f},
                                    {0.13f, 0.058f},  {0.07f, 0.042f}, {0.0f, 0.038f}};
  return lathe(kProfile, 32);
}

/// A storage jar, its mouth open.
MeshBuilder jar() {
  constexpr glm::vec2 kProfile[] = {{0.0f, 0.0f},    {0.15f, 0.0f},  {0.15f, 0.0f},  {0.20f, 0.08f},   {0.29f, 0.26f},
                                    {0.345f, 0.45f}, {0.34f, 0.60f}, {0.28f, 0.74f}, {0.19f, 0.83f},   {0.16f, 0.88f},
                                    {0.165f, 0.93f}, {0.20f, 0.96f}, {0.20f, 0.98f}, {0.165f, 0.985f}, {0.13f, 0.94f},
                                    {0.125f, 0.87f}, {0.16f, 0.80f}, {0.0f, 0.74f}};
  return lathe(kProfile, 28);
}

}  // namespace

void add_furnishings(SceneBuilder& scene) {
  const int red = scene.material("red cloth", {0.62f, 0.035f, 0.025f}, 0.95f);
  const int blue = scene.material("blue cloth", {0.035f, 0.12f, 0.54f}, 0.95f);
  const int iron = scene.material("iron", {0.08f, 0.075f, 0.07f}, 0.5f, 0.6f);
  const int oak = scene.material("oak", {0.34f, 0.19f, 0.09f}, 0.6f);
  const int glaze = scene.material("white glaze", {0.82f, 0.81f, 0.78f}, 0.25f);
  const int terracotta = scene.material("terracotta", {0.56f, 0.23f, 0.11f}, 0.7f);

  const auto stand = [](const glm::vec3& at) { return Transform{at, glm::quat(1, 0, 0, 0), glm::vec3(1.0f)}; };
  hang(scene, "red cloth", cloth(2.0f, 8.3f, 7.0f, 0.4f), 2.0f, red, iron,
       {{-1.75f, 9.4f, -4.2f}, look_along({0.25f, 0, -1}), glm::vec3(1)});
  hang(scene, "blue cloth", cloth(1.5f, 6.9f, 5.0f, 2.2f), 1.5f, blue, iron,
       {{2.05f, 9.1f, -4.7f}, look_along({-0.2f, 0, -1}), glm::vec3(1)});
  scene.mesh_node("bench", {{bench(), oak}}, stand({2.6f, 0.0f, 1.9f}));
  scene.mesh_node("bowl", {{bowl(), glaze}}, stand({2.6f, 0.47f, 1.5f}));
  scene.mesh_node("sphere", {{sphere(0.55f, 40, 20), glaze}}, stand({1.55f, kWellFloor + 0.55f, -3.3f}));
  scene.mesh_node("jar", {{jar(), terracotta}}, stand({-2.45f, 0.0f, 0.95f}));
}

}  // namespace lightwell::builtin::atrium
