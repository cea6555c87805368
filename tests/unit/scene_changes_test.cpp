// What counts as motion from one frame to the next.
#include "renderer/passes/scene_changes.h"

#include <gtest/gtest.h>

namespace lightwell {
namespace {

/// A triangle on one joint, which an animation moves for a second, and morphed by half a target.
Scene skinned_scene() {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.normals.assign(3, {0, 0, 1});
  primitive.tangents.assign(3, {1, 0, 0, 1});
  primitive.indices = {0, 1, 2};
  primitive.joints.assign(3, glm::uvec4(0));
  primitive.weights.assign(3, glm::vec4(1, 0, 0, 0));
  primitive.morph_targets.emplace_back().positions.assign(3, {0, 0, 1});
  fill_bounds(primitive);
  auto mesh = std::make_shared<Mesh>();
  mesh->primitives.push_back(primitive);
  mesh->weights = {0.5f};
  Scene scene;
  scene.meshes.push_back(mesh);
  scene.nodes.resize(2);
  scene.nodes[0].mesh = 0;
  scene.nodes[0].skin = 0;
  scene.roots = {0, 1};
  scene.skins.push_back({"", {1}, {glm::mat4(1.0f)}});
  scene.animations.push_back(
      {"", {{1, AnimatedProperty::kTranslation, Interpolation::kLinear, {0, 1}, {0, 0, 0, 0, 0, 4}, 3}}, {}, 1.0f});
  return scene;
}

TEST(SceneChanges, AShapeIsStillWhileItsMatricesAndWeightsAre) {
  Scene scene = skinned_scene();
  SceneChanges changes;
  EXPECT_FALSE(changes.look_at(scene, pose_at(scene, 0.25)).moving);
  EXPECT_FALSE(changes.look_at(scene, pose_at(scene, 0.25)).moving);
  EXPECT_TRUE(changes.look_at(scene, pose_at(scene, 0.5)).moving);
  EXPECT_FALSE(changes.look_at(scene, pose_at(scene, 0.5)).moving);
  scene.nodes[0].weights = {0.75f};
  EXPECT_TRUE(changes.look_at(scene, pose_at(scene, 0.5)).moving);
  EXPECT_FALSE(changes.look_at(scene, pose_at(scene, 0.5)).moving);
}

}  // namespace
}  // namespace lightwell
