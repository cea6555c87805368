// A small scene that the edit tests change: indices and names in the order below.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "renderer/scene/gltf/edit.h"

namespace lightwell {

using Json = nlohmann::json;

inline std::shared_ptr<Mesh> make_triangle(const std::string& name, int material, std::size_t morph_targets = 0) {
  auto mesh = std::make_shared<Mesh>();
  mesh->name = name;
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.indices = {0, 1, 2};
  primitive.material = material;
  primitive.morph_targets.resize(morph_targets);
  mesh->primitives.push_back(std::move(primitive));
  return mesh;
}

/// nodes: 0 body (child 1), 1 rotor (child 2), 2 blade, 3 lamp, 4 bone, 5 a/b~c
/// materials: 0 red, 1 green, 2 blue; meshes: 0 red triangle, 1 blue triangle with two morph targets
/// lights: 0 sun, 1 spot; cameras: 0 front
inline Scene make_edit_scene() {
  Scene scene;
  scene.materials.resize(3);
  for (std::size_t i = 0; i < 3; ++i) scene.materials[i].name = std::array{"red", "green", "blue"}[i];
  scene.meshes = {make_triangle("red triangle", 0), make_triangle("blue triangle", 2, 2)};
  scene.textures = {Texture{"bricks", -1, {}}, Texture{"bumps", -1, {}}};
  scene.nodes.resize(6);
  for (std::size_t i = 0; i < 6; ++i)
    scene.nodes[i].name = std::array{"body", "rotor", "blade", "lamp", "bone", "a/b~c"}[i];
  scene.nodes[0].children = {1};
  scene.nodes[1].parent = 0;
  scene.nodes[1].children = {2};
  scene.nodes[2].parent = 1;
  scene.nodes[0].mesh = 0;
  scene.nodes[2].mesh = 1;
  scene.nodes[3].light = 1;
  scene.nodes[5].camera = 0;
  scene.roots = {0, 3, 4, 5};
  scene.lights.resize(2);
  scene.lights[0].name = "sun";
  scene.lights[0].kind = LightKind::kDirectional;
  scene.lights[1].name = "spot";
  scene.lights[1].kind = LightKind::kSpot;
  scene.cameras.resize(1);
  scene.cameras[0].name = "front";
  scene.skins = {Skin{"skin", {4}, {glm::mat4(1.0f)}}};
  Animation animation;
  animation.name = "turn";
  animation.duration_s = 1.0f;
  const std::vector<float> times{0.0f, 1.0f};
  animation.channels = {{1, AnimatedProperty::kRotation, Interpolation::kLinear, times, {0, 0, 0, 1, 0, 1, 0, 0}, 4},
                        {3, AnimatedProperty::kTranslation, Interpolation::kLinear, times, {0, 0, 0, 1, 1, 1}, 3}};
  animation.light_channels = {{1, LightChannel::Property::kIntensity, Interpolation::kLinear, times, {0, 10}}};
  scene.animations = {animation};
  return scene;
}

inline Json edit(const char* op, const std::string& path, Json value) {
  return {{"op", op}, {"path", path}, {"value", std::move(value)}};
}

inline Json removal(const std::string& path) {
  return {{"op", "remove"}, {"path", path}};
}

/// A JSON Patch of these edits.
template <class... Edits>
Json patch(Edits... edits) {
  Json array = Json::array();
  (array.push_back(Json(std::move(edits))), ...);
  return array;
}

/// Fails the test if the patch is refused.
inline void apply_or_fail(Scene& scene, const Json& edits) {
  const Status applied = apply_edits(scene, edits);
  ASSERT_TRUE(applied.ok()) << applied.error().message();
}

/// Expects that the patch is refused at `where`, and that nothing changed.
inline void expect_refused(const Json& edits, ErrorKind kind, const std::string& where,
                           const Scene& before = make_edit_scene()) {
  SCOPED_TRACE(edits.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, 200));
  Scene scene = before;
  const Json model = describe_scene(scene);
  const Status applied = apply_edits(scene, edits);
  ASSERT_FALSE(applied.ok());
  EXPECT_EQ(applied.error().kind, kind) << applied.error().message();
  EXPECT_EQ(applied.error().where, where) << applied.error().what;
  EXPECT_FALSE(applied.error().what.empty());
  EXPECT_EQ(describe_scene(scene), model);
}

}  // namespace lightwell
