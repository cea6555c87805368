// The Cornell box after the measured one (Cornell University Program of Computer Graphics, 1998): its corners in
// millimetres, turned so that the open front faces +Z, scaled to a room 2 m high.
#include <array>

#include "renderer/scene/builtin/scene_builder.h"
#include "renderer/scene/builtin/scenes.h"

namespace lightwell::builtin {
namespace {

constexpr float kRoomHeightMm = 548.8f;
constexpr float kHeightM = 2.0f;

/// The box's own axes look into the room along +Z with +X to the left; ours look along -Z with +X to the right.
glm::vec3 measured(float x_mm, float y_mm, float z_mm) {
  constexpr float kScale = kHeightM / kRoomHeightMm;
  return kScale * glm::vec3(278.0f - x_mm, y_mm, 279.6f - z_mm);
}

/// A block on the floor from the measured corners of its top.
MeshBuilder block(const std::array<glm::vec3, 4>& top) {
  MeshBuilder mesh;
  mesh.quad(top[0], top[1], top[2], top[3]);
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::vec3 &a = top[i], &b = top[(i + 1) % 4];
    mesh.quad({a.x, 0.0f, a.z}, {b.x, 0.0f, b.z}, b, a);
  }
  const auto floor = [&](std::size_t i) { return glm::vec3(top[i].x, 0.0f, top[i].z); };
  mesh.quad(floor(3), floor(2), floor(1), floor(0));
  return mesh;
}

}  // namespace

Scene make_cornell() {
  SceneBuilder scene("cornell");
  const int white = scene.material("white", {0.737f, 0.737f, 0.737f}, 1.0f);
  const int red = scene.material("red", {0.611f, 0.056f, 0.062f}, 1.0f);
  const int green = scene.material("green", {0.117f, 0.435f, 0.115f}, 1.0f);
  const int lamp = scene.emitter("lamp", {8.5f, 6.0f, 2.9f});
  for (const int m : {white, red, green}) scene.material(m).specular_factor = 0.0f;

  const float left = measured(556.0f, 0, 0).x, right = measured(0, 0, 0).x;
  const float front = measured(0, 0, 0).z, back = measured(0, 0, 559.2f).z, top = kHeightM;
  MeshBuilder shell, left_wall, right_wall, light;
  shell.quad({left, 0, front}, {right, 0, front}, {right, 0, back}, {left, 0, back});
  shell.quad({left, top, back}, {right, top, back}, {right, top, front}, {left, top, front});
  shell.quad({left, 0, back}, {right, 0, back}, {right, top, back}, {left, top, back});
  left_wall.quad({left, 0, front}, {left, 0, back}, {left, top, back}, {left, top, front});
  right_wall.quad({right, 0, back}, {right, 0, front}, {right, top, front}, {right, top, back});
  // A hand's breadth of a millimetre below the ceiling: in its plane the two would fight for depth.
  const glm::vec3 low = measured(343.0f, 547.8f, 332.0f), high = measured(213.0f, 547.8f, 227.0f);
  light.quad({low.x, low.y, low.z}, {high.x, low.y, low.z}, {high.x, low.y, high.z}, {low.x, low.y, high.z});

  const MeshBuilder short_block =
      block({measured(130, 165, 65), measured(82, 165, 225), measured(240, 165, 272), measured(290, 165, 114)});
  const MeshBuilder tall_block =
      block({measured(423, 330, 247), measured(265, 330, 296), measured(314, 330, 456), measured(472, 330, 406)});
  scene.mesh_node("room", {{shell, white}});
  scene.mesh_node("red wall", {{left_wall, red}});
  scene.mesh_node("green wall", {{right_wall, green}});
  scene.mesh_node("short block", {{short_block, white}});
  scene.mesh_node("tall block", {{tall_block, white}});
  scene.mesh_node("lamp", {{light, lamp}});

  // Most of the light comes from a spot at the lamp, so that methods which know only punctual lights see it too.
  Light spot;
  spot.name = "lamp light";
  spot.kind = LightKind::kSpot;
  spot.color = {1.0f, 0.85f, 0.62f};
  spot.intensity = 12.0f;
  spot.inner_cone_angle = 0.8f;
  spot.outer_cone_angle = 1.22f;
  const glm::vec3 center = 0.5f * (low + high);
  scene.light_node(spot, {center - glm::vec3(0.0f, 0.01f, 0.0f), look_along({0.0f, -1.0f, 0.0f}), glm::vec3(1.0f)});

  scene.camera_node("front", measured(278, 273, -800), measured(278, 273, 0), 0.686f);
  return std::move(scene).finish();
}

}  // namespace lightwell::builtin
