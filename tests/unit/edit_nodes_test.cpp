// Edits of nodes: placement, hierarchy, what comes and goes, what is animated.
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "renderer/scene/pose.h"
#include "tests/unit/edit_scene.h"

namespace lightwell {
namespace {

/// Parents, children and roots agree, and every index is one.
void expect_consistent(const Scene& scene) {
  const int count = static_cast<int>(scene.nodes.size());
  std::vector<int> named(scene.nodes.size(), 0);
  for (const int root : scene.roots) {
    ASSERT_TRUE(root >= 0 && root < count);
    EXPECT_EQ(scene.nodes[static_cast<std::size_t>(root)].parent, -1);
    ++named[static_cast<std::size_t>(root)];
  }
  for (int i = 0; i < count; ++i) {
    for (const int child : scene.nodes[static_cast<std::size_t>(i)].children) {
      ASSERT_TRUE(child >= 0 && child < count);
      EXPECT_EQ(scene.nodes[static_cast<std::size_t>(child)].parent, i);
      ++named[static_cast<std::size_t>(child)];
    }
    EXPECT_LT(scene.nodes[static_cast<std::size_t>(i)].parent, count);
  }
  for (const int times : named) EXPECT_LE(times, 1);
}

TEST(NodeEdits, PlaceANode) {
  Scene scene = make_edit_scene();
  apply_or_fail(
      scene,
      patch(edit("replace", "/nodes/0/translation", {1, -2.5, 1e3}), edit("add", "/nodes/0/rotation", {0, 3, 0, 4}),
            edit("replace", "/nodes/0/scale", {2, 0, -1}), edit("replace", "/nodes/0/translation/1", 7)));
  EXPECT_EQ(scene.nodes[0].local.translation, glm::vec3(1, 7, 1e3));
  EXPECT_EQ(scene.nodes[0].local.rotation, glm::quat(0.8f, 0, 0.6f, 0));  // w first
  EXPECT_EQ(scene.nodes[0].local.scale, glm::vec3(2, 0, -1));
  apply_or_fail(scene, patch(edit("test", "/nodes/0/rotation", {0, 0.6, 0, 0.8}), removal("/nodes/0/translation"),
                             removal("/nodes/0/rotation"), edit("test", "/nodes/0/rotation", {0, 0, 0, 1})));
  EXPECT_EQ(scene.nodes[0].local.translation, glm::vec3(0));
}

TEST(NodeEdits, RefuseWhatIsNoPlacement) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused(patch(edit("replace", "/nodes/0/rotation", {0, 0, 0, 0})), ErrorKind::kInvalidInput,
                 "/nodes/0/rotation");
  expect_refused(patch(edit("replace", "/nodes/0/rotation", {0, 0, 1e-9, 0})), ErrorKind::kInvalidInput,
                 "/nodes/0/rotation");
  expect_refused(patch(edit("replace", "/nodes/0/translation", {0, nan, 0})), ErrorKind::kInvalidInput,
                 "/nodes/0/translation/1");
  expect_refused(patch(edit("replace", "/nodes/0/translation", {inf, 0, 0})), ErrorKind::kInvalidInput,
                 "/nodes/0/translation/0");
  expect_refused(patch(edit("replace", "/nodes/0/scale", {1, 1, 1e16})), ErrorKind::kInvalidInput, "/nodes/0/scale/2");
  expect_refused(patch(edit("replace", "/nodes/0/scale", {1, 1})), ErrorKind::kInvalidInput, "/nodes/0/scale");
  expect_refused(patch(edit("replace", "/nodes/0/scale", 2)), ErrorKind::kInvalidInput, "/nodes/0/scale");
  expect_refused(patch(edit("replace", "/nodes/0/scale", {1, "1", 1})), ErrorKind::kInvalidInput, "/nodes/0/scale/1");
  expect_refused(patch(edit("add", "/nodes/0/translation/-", 1)), ErrorKind::kInvalidInput, "/nodes/0/translation/-");
  expect_refused(patch(removal("/nodes/0/translation/0")), ErrorKind::kInvalidInput, "/nodes/0/translation/0");
  expect_refused(patch(edit("replace", "/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1})),
                 ErrorKind::kInvalidInput, "/nodes/0/matrix");
  expect_refused(patch(removal("/nodes/0/matrix")), ErrorKind::kNotFound, "/nodes/0/matrix");
}

TEST(NodeEdits, AMatrixAndTheOthersReplaceEachOther) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("replace", "/nodes/0/scale", {9, 9, 9}),
                             edit("add", "/nodes/0/matrix", {0, 0, -2, 0, 0, 3, 0, 0, 4, 0, 0, 0, 5, 6, 7, 1})));
  ASSERT_TRUE(scene.nodes[0].matrix);
  const glm::mat4 matrix = *scene.nodes[0].matrix;
  expect_refused(patch(edit("test", "/nodes/0/scale", {9, 9, 9})), ErrorKind::kNotFound, "/nodes/0/scale", scene);
  apply_or_fail(scene, patch(edit("replace", "/nodes/0/translation", {1, 1, 1})));
  EXPECT_FALSE(scene.nodes[0].matrix);
  const glm::mat4 now = world_from_nodes(scene, 0.0)[0];
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(now[column][row], matrix[column][row], 1e-6f);
  EXPECT_EQ(glm::vec3(now[3]), glm::vec3(1));
}

TEST(NodeEdits, AMirroringMatrixStaysOne) {
  Scene scene = make_edit_scene();
  scene.nodes[0].matrix = glm::scale(glm::rotate(glm::mat4(1.0f), 1.0f, glm::vec3(0, 0.6f, 0.8f)), {1, 2, -3});
  const glm::mat4 before = *scene.nodes[0].matrix;
  apply_or_fail(scene, patch(edit("replace", "/nodes/0/translation", {0, 0, 0})));
  EXPECT_FALSE(scene.nodes[0].matrix);
  const glm::mat4 after = world_from_nodes(scene, 0.0)[0];
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) EXPECT_NEAR(after[column][row], before[column][row], 1e-6f);
}

TEST(NodeEdits, WhatIsEditedIsAnimatedNoMore) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("replace", "/nodes/lamp/translation", {5, 0, 0})));
  ASSERT_EQ(scene.animations[0].channels.size(), 1u);
  EXPECT_EQ(scene.animations[0].channels[0].node, 1);
  EXPECT_EQ(scene.animations[0].duration_s, 1.0f);
  EXPECT_EQ(glm::vec3(world_from_nodes(scene, 0.5)[3][3]), glm::vec3(5, 0, 0));
  apply_or_fail(scene, patch(edit("replace", "/nodes/rotor/translation", {1, 0, 0})));  // not animated: nothing stops
  EXPECT_EQ(scene.animations[0].channels.size(), 1u);
  apply_or_fail(scene, patch(edit("replace", "/nodes/rotor/rotation", {0, 0, 0, 1}),
                             edit("replace", "/extensions/KHR_lights_punctual/lights/spot/intensity", 3)));
  EXPECT_TRUE(scene.animations[0].channels.empty());
  EXPECT_TRUE(scene.animations[0].light_channels.empty());
  EXPECT_EQ(animation_duration_s(scene), 0.0);
}

TEST(NodeEdits, MorphWeights) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene,
                patch(edit("add", "/nodes/blade/weights", {0.25, 1}), edit("replace", "/nodes/blade/weights/1", 0.5)));
  EXPECT_EQ(scene.nodes[2].weights, (std::vector<float>{0.25f, 0.5f}));
  apply_or_fail(scene, patch(edit("replace", "/nodes/blade/mesh", 0)));
  EXPECT_TRUE(scene.nodes[2].weights.empty());
  expect_refused(patch(edit("add", "/nodes/blade/weights", {1})), ErrorKind::kInvalidInput, "/nodes/blade/weights");
  expect_refused(patch(edit("add", "/nodes/lamp/weights", {1})), ErrorKind::kInvalidInput, "/nodes/lamp/weights");
  expect_refused(patch(edit("add", "/nodes/lamp/weights", Json::array())), ErrorKind::kInvalidInput,
                 "/nodes/lamp/weights");
}

TEST(NodeEdits, References) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("replace", "/nodes/1/mesh", 1), edit("add", "/nodes/1/camera", 0),
                             edit("add", "/nodes/1/extensions/KHR_lights_punctual/light", 0),
                             edit("add", "/nodes/1/extensions/KHR_node_visibility/visible", false),
                             edit("add", "/nodes/1/skin", 0)));
  EXPECT_EQ(scene.nodes[1].mesh, 1);
  EXPECT_EQ(scene.nodes[1].camera, 0);
  EXPECT_EQ(scene.nodes[1].light, 0);
  EXPECT_EQ(scene.nodes[1].skin, 0);
  EXPECT_FALSE(scene.nodes[1].visible);
  apply_or_fail(scene, patch(removal("/nodes/1/extensions/KHR_lights_punctual"),
                             removal("/nodes/1/extensions/KHR_node_visibility/visible")));
  EXPECT_EQ(scene.nodes[1].light, -1);
  EXPECT_TRUE(scene.nodes[1].visible);
  for (const Json& wrong : {Json(2), Json(-1), Json(0.5), Json(1e300), Json(nullptr), Json(true), Json::array()}) {
    Scene copy = make_edit_scene();
    const Status applied = apply_edits(copy, patch(edit("replace", "/nodes/0/mesh", wrong)));
    ASSERT_FALSE(applied.ok()) << wrong;
    EXPECT_EQ(applied.error().where, "/nodes/0/mesh");
  }
}

TEST(Hierarchy, MovesANodeToAnotherParent) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(removal("/nodes/1/children/0"), edit("add", "/nodes/3/children/-", 2)));
  EXPECT_EQ(scene.nodes[2].parent, 3);
  expect_consistent(scene);
  apply_or_fail(scene, patch(removal("/nodes/3/children")));
  EXPECT_EQ(scene.nodes[2].parent, -1);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 3, 4, 5}));  // no place in the scene
  apply_or_fail(scene, patch(edit("add", "/scenes/0/nodes/-", 2)));
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 3, 4, 5, 2}));
  apply_or_fail(scene, patch(removal("/scenes/0/nodes/0"), edit("replace", "/scenes/0/nodes/0", 0)));
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 4, 5, 2}));
  expect_consistent(scene);
}

TEST(Hierarchy, RefusesWhatIsNoTree) {
  expect_refused(patch(edit("add", "/nodes/2/children/-", 0)), ErrorKind::kInvalidInput, "/nodes/2/children");
  expect_refused(patch(edit("add", "/nodes/0/children/-", 0)), ErrorKind::kInvalidInput, "/nodes/0/children");
  expect_refused(patch(edit("add", "/nodes/3/children/-", 1)), ErrorKind::kInvalidInput, "/nodes/3/children");
  expect_refused(patch(edit("add", "/nodes/0/children/-", 1)), ErrorKind::kInvalidInput, "/nodes/0/children");
  expect_refused(patch(edit("add", "/nodes/0/children/-", 6)), ErrorKind::kNotFound, "/nodes/0/children/1");
  expect_refused(patch(edit("replace", "/nodes/0/children", {3, 3})), ErrorKind::kInvalidInput, "/nodes/0/children");
  expect_refused(patch(edit("replace", "/nodes/0/children", 3)), ErrorKind::kInvalidInput, "/nodes/0/children");
  expect_refused(patch(edit("add", "/scenes/0/nodes/-", 1)), ErrorKind::kInvalidInput, "/scenes/0/nodes");
  expect_refused(patch(edit("add", "/scenes/0/nodes/-", 0)), ErrorKind::kInvalidInput, "/scenes/0/nodes");
}

TEST(WholeNodes, AreAdded) {
  Scene scene = make_edit_scene();
  const Json lamp{
      {"name", "new"},
      {"translation", {1, 2, 3}},
      {"children", {3}},
      {"mesh", "red triangle"},
      {"extras", {{"ours", 1}}},
      {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}, {"KHR_node_visibility", {{"visible", false}}}}}};
  apply_or_fail(scene, patch(edit("add", "/nodes/-", lamp), edit("add", "/nodes/0/children/-", "new")));
  ASSERT_EQ(scene.nodes.size(), 7u);
  EXPECT_EQ(scene.nodes[6].local.translation, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.nodes[6].parent, 0);
  EXPECT_EQ(scene.nodes[6].children, (std::vector<int>{3}));
  EXPECT_EQ(scene.nodes[6].mesh, 0);
  EXPECT_EQ(scene.nodes[6].light, 1);
  EXPECT_FALSE(scene.nodes[6].visible);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 4, 5}));
  expect_consistent(scene);
}

TEST(WholeNodes, AddedBeforeOthersMoveThem) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("add", "/nodes/1", {{"name", "new"}})));
  EXPECT_EQ(scene.nodes[0].children, (std::vector<int>{2}));
  EXPECT_EQ(scene.nodes[2].name, "rotor");
  EXPECT_EQ(scene.nodes[3].parent, 2);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 4, 5, 6, 1}));
  EXPECT_EQ(scene.skins[0].joints, (std::vector<int>{5}));
  EXPECT_EQ(scene.animations[0].channels[0].node, 2);
  EXPECT_EQ(scene.animations[0].channels[1].node, 4);
  expect_consistent(scene);
}

TEST(WholeNodes, AreRemoved) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(removal("/nodes/rotor")));
  ASSERT_EQ(scene.nodes.size(), 5u);
  EXPECT_TRUE(scene.nodes[0].children.empty());
  EXPECT_EQ(scene.nodes[1].name, "blade");
  EXPECT_EQ(scene.nodes[1].parent, -1);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 2, 3, 4}));
  EXPECT_EQ(scene.skins[0].joints, (std::vector<int>{3}));
  ASSERT_EQ(scene.animations[0].channels.size(), 1u);
  EXPECT_EQ(scene.animations[0].channels[0].node, 2);
  expect_consistent(scene);
  EXPECT_EQ(pose_at(scene, 0.0).instances.size(), 1u);  // the blade went out of sight with the rotor
  expect_refused(patch(removal("/nodes/bone")), ErrorKind::kInvalidInput, "/nodes/bone");
}

TEST(WholeNodes, AreReplaced) {
  Scene scene = make_edit_scene();
  apply_or_fail(scene, patch(edit("replace", "/nodes/1", {{"name", "stub"}})));
  EXPECT_EQ(scene.nodes[1].parent, 0);
  EXPECT_TRUE(scene.nodes[1].children.empty());
  EXPECT_EQ(scene.nodes[2].parent, -1);
  EXPECT_EQ(scene.animations[0].channels.size(), 1u);
  expect_consistent(scene);
}

TEST(WholeNodes, AreChecked) {
  const Json matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  expect_refused(patch(edit("add", "/nodes/-", 3)), ErrorKind::kInvalidInput, "/nodes/-");
  expect_refused(patch(edit("add", "/nodes/-", {{"matrix", matrix}, {"scale", {1, 1, 1}}})), ErrorKind::kInvalidInput,
                 "/nodes/-");
  expect_refused(patch(edit("add", "/nodes/-", {{"rotation", {0, 0, 0, 0}}})), ErrorKind::kInvalidInput,
                 "/nodes/-/rotation");
  expect_refused(patch(edit("add", "/nodes/-", {{"children", {6}}})), ErrorKind::kInvalidInput, "/nodes/-/children");
  expect_refused(patch(edit("add", "/nodes/-", {{"colour", 1}})), ErrorKind::kNotFound, "/nodes/-/colour");
  expect_refused(patch(edit("add", "/nodes/-", {{"extensions", {{"KHR_node_visibility", true}}}})),
                 ErrorKind::kInvalidInput, "/nodes/-/extensions/KHR_node_visibility");
  expect_refused(patch(edit("add", "/nodes/rotor", Json::object())), ErrorKind::kNotFound, "/nodes/rotor");
}

}  // namespace
}  // namespace lightwell
