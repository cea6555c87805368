// Scenes at one moment: interpolation, looping, hierarchy, skins, morph targets, lights and cameras, against values
// worked out by hand.
#include "renderer/scene/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene/animation.h"

namespace lightwell {
namespace {

constexpr float kTolerance = 1e-5f;

void expect_near(const glm::vec3& actual, const glm::vec3& expected, float tolerance = kTolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
}

/// One rotation is another, whichever of the two quaternions stands for it.
void expect_same_rotation(const glm::quat& actual, const glm::quat& expected) {
  EXPECT_NEAR(std::abs(glm::dot(actual, expected)), 1.0f, kTolerance);
  EXPECT_NEAR(glm::length(actual), 1.0f, kTolerance);
}

glm::quat about_y(float degrees) {
  return glm::angleAxis(glm::radians(degrees), glm::vec3(0, 1, 0));
}

glm::vec3 sample_vec3(const AnimationChannel& channel, float time_s) {
  glm::vec3 value(-99.0f);
  EXPECT_TRUE(sample_keyframes(channel.times_s, channel.values, channel.interpolation, time_s, {&value.x, 3}));
  return value;
}

/// A triangle with corners (0,0,0), (1,0,0), (0,1,0), facing +Z.
Primitive unit_triangle() {
  Primitive primitive;
  primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  primitive.tangents = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
  primitive.indices = {0, 1, 2};
  primitive.bounds_max = {1, 1, 0};
  return primitive;
}

int add_node(Scene& scene, const Transform& local = {}, int parent = -1) {
  const int index = static_cast<int>(scene.nodes.size());
  scene.nodes.emplace_back();
  scene.nodes.back().local = local;
  scene.nodes.back().parent = parent;
  (parent < 0 ? scene.roots : scene.nodes[static_cast<std::size_t>(parent)].children).push_back(index);
  return index;
}

Node& node_of(Scene& scene, int index) {
  return scene.nodes[static_cast<std::size_t>(index)];
}

/// A scene of one node that shows `primitive`.
Scene scene_of(Primitive primitive) {
  Scene scene;
  fill_bounds(primitive);
  auto mesh = std::make_shared<Mesh>();
  mesh->primitives.push_back(std::move(primitive));
  scene.meshes.push_back(std::move(mesh));
  node_of(scene, add_node(scene)).mesh = 0;
  return scene;
}

Transform moved(const glm::vec3& translation) {
  return {translation, glm::quat(1, 0, 0, 0), glm::vec3(1.0f)};
}

TEST(Animation, StepHoldsTheEarlierKey) {
  AnimationChannel channel{0,         AnimatedProperty::kTranslation, Interpolation::kStep,
                           {1, 2, 4}, {1, 1, 1, 2, 2, 2, 4, 4, 4},    3};
  expect_near(sample_vec3(channel, 0.0f), glm::vec3(1));
  expect_near(sample_vec3(channel, 1.99f), glm::vec3(1));
  expect_near(sample_vec3(channel, 2.0f), glm::vec3(2));
  expect_near(sample_vec3(channel, 3.99f), glm::vec3(2));
  expect_near(sample_vec3(channel, 9.0f), glm::vec3(4));
}

TEST(Animation, LinearIsProportionalAndClamps) {
  AnimationChannel channel{0, AnimatedProperty::kTranslation, Interpolation::kLinear, {1, 3}, {0, 0, 0, 4, -8, 2}, 3};
  expect_near(sample_vec3(channel, 1.5f), {1.0f, -2.0f, 0.5f});
  expect_near(sample_vec3(channel, -5.0f), {0, 0, 0});
  expect_near(sample_vec3(channel, 5.0f), {4, -8, 2});
}

TEST(Animation, CubicSplineFollowsHermite) {
  // Values 0 -> 1 over 2 s with out-tangent 3 and in-tangent -1 per second, by hand at fraction 1/4:
  // h00 = 27/32, h10 = 9/64, h01 = 5/32, h11 = -3/64; p = 2 * 3 * 9/64 + 5/32 + 2 * (-1) * (-3/64).
  const std::vector<float> values = {0, 0, 0, 0, 0, 0, 3, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0};
  AnimationChannel channel{0, AnimatedProperty::kTranslation, Interpolation::kCubicSpline, {10, 12}, values, 3};
  expect_near(sample_vec3(channel, 10.5f), {2 * 3 * 9.0f / 64 + 5.0f / 32 + 6.0f / 64, 0, 0});
  expect_near(sample_vec3(channel, 10.0f), {0, 0, 0});
  expect_near(sample_vec3(channel, 12.0f), {1, 0, 0});
  expect_near(sample_vec3(channel, 99.0f), {1, 0, 0});
}

TEST(Animation, RotationGoesTheShorterWay) {
  const glm::quat from = about_y(10), to = -about_y(90);  // the other sign of the same rotation
  const std::vector<float> times = {0, 1}, values = {from.x, from.y, from.z, from.w, to.x, to.y, to.z, to.w};
  glm::quat value;
  ASSERT_TRUE(sample_rotation(times, values, Interpolation::kLinear, 0.25f, value));
  expect_same_rotation(value, about_y(30));
  ASSERT_TRUE(sample_rotation(times, values, Interpolation::kStep, 0.99f, value));
  expect_same_rotation(value, about_y(10));
}

TEST(Animation, CubicRotationIsNormalised) {
  // With zero tangents the middle of two keys is their mean; normalised it is half the way for unit quaternions.
  const glm::quat a = about_y(0), b = about_y(120);
  const std::vector<float> times = {0, 2};
  const std::vector<float> values = {0, 0, 0, 0, a.x, a.y, a.z, a.w, 0, 0, 0, 0,
                                     0, 0, 0, 0, b.x, b.y, b.z, b.w, 0, 0, 0, 0};
  glm::quat value;
  ASSERT_TRUE(sample_rotation(times, values, Interpolation::kCubicSpline, 1.0f, value));
  expect_same_rotation(value, about_y(60));
}

TEST(Animation, MissingValuesLeaveTheOutputAlone) {
  glm::vec3 value(7.0f);
  const std::vector<float> times = {0, 1}, values = {1, 2, 3};
  EXPECT_FALSE(sample_keyframes(times, values, Interpolation::kLinear, 0.5f, {&value.x, 3}));
  EXPECT_FALSE(sample_keyframes({}, {}, Interpolation::kStep, 0.5f, {&value.x, 3}));
  EXPECT_EQ(value, glm::vec3(7.0f));
}

TEST(Animation, LocalTimeRepeats) {
  EXPECT_FLOAT_EQ(local_time_s(2.5, 4.0f), 2.5f);
  EXPECT_FLOAT_EQ(local_time_s(10.5, 4.0f), 2.5f);
  EXPECT_NEAR(local_time_s(4.0e6 + 1.25, 4.0f), 1.25f, 1e-6f);
  EXPECT_EQ(local_time_s(-1.0, 4.0f), 0.0f);
  EXPECT_EQ(local_time_s(1.0, 0.0f), 0.0f);
  EXPECT_EQ(local_time_s(std::nan(""), 4.0f), 0.0f);
}

TEST(Pose, HierarchyIsMultipliedOut) {
  Scene scene = scene_of(unit_triangle());
  // Node 0 becomes the grandchild of two nodes that come after it.
  scene.roots.clear();
  scene.nodes.resize(3);
  constexpr int kParent = 1, kGrandparent = 2;
  scene.roots = {kGrandparent};
  node_of(scene, kGrandparent).matrix = glm::translate(glm::mat4(1.0f), {100, 0, 0});
  node_of(scene, kGrandparent).local = moved({1, 1, 1});  // not looked at: the node has a matrix
  node_of(scene, kGrandparent).children = {kParent};
  node_of(scene, kParent).local = {{0, 0, 5}, about_y(90), glm::vec3(2)};
  node_of(scene, kParent).parent = kGrandparent;
  node_of(scene, kParent).children = {0};
  node_of(scene, 0).parent = kParent;
  node_of(scene, 0).local = moved({1, 0, 0});

  const Pose pose = pose_at(scene, 0);
  ASSERT_EQ(pose.instances.size(), 1u);
  // (1,0,0) in node 0 is (2,0,0) in the parent; scaled (4,0,0); turned a quarter about +Y (0,0,-4); moved.
  expect_near(glm::vec3(pose.instances[0].world_from_object * glm::vec4(1, 0, 0, 1)), {100, 0, 1});
  EXPECT_EQ(pose.instances[0].node, 0);
  EXPECT_EQ(pose.instances[0].primitive.get(), scene.meshes[0]->primitives.data());
  expect_near(pose.bounds_min, {100, 0, 1});
  expect_near(pose.bounds_max, {100, 2, 3});
}

TEST(Pose, AnimationsPlayTogetherAndRepeatEachAfterItsOwnDuration) {
  Scene scene = scene_of(unit_triangle());
  scene.animations.push_back(
      {"slide",
       {{0, AnimatedProperty::kTranslation, Interpolation::kLinear, {0, 2}, {0, 0, 0, 2, 0, 0}, 3}},
       {},
       2.0f});
  scene.animations.push_back(
      {"grow", {{0, AnimatedProperty::kScale, Interpolation::kLinear, {0, 3}, {1, 1, 1, 4, 4, 4}, 3}}, {}, 3.0f});
  EXPECT_DOUBLE_EQ(animation_duration_s(scene), 3.0);
  const glm::mat4 world = world_from_nodes(scene, 5.0).at(0);  // the slide at 1 s, the growth at 2 s
  expect_near(glm::vec3(world[3]), {1, 0, 0});
  expect_near(glm::vec3(world[0]), {3, 0, 0});
}

TEST(Pose, ANodeWithAMatrixIsNotAnimated) {
  Scene scene = scene_of(unit_triangle());
  node_of(scene, 0).matrix = glm::translate(glm::mat4(1.0f), {5, 0, 0});
  scene.animations.push_back(
      {"", {{0, AnimatedProperty::kTranslation, Interpolation::kStep, {0}, {1, 1, 1}, 3}}, {}, 1.0f});
  expect_near(glm::vec3(world_from_nodes(scene, 0.5)[0][3]), {5, 0, 0});
}

TEST(Pose, SkinBlendsJointsInWorldSpace) {
  Primitive primitive = unit_triangle();
  primitive.joints = {{0, 1, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}};
  primitive.weights = {{1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}, {1, 0, 0, 0}};
  Scene scene = scene_of(primitive);
  const int still = add_node(scene, moved({10, 0, 0}));
  const int turning = add_node(scene, {{0, 0, 0}, about_y(90), glm::vec3(1)}, still);
  const glm::mat4 joint_from_mesh = glm::translate(glm::mat4(1), {-10, 0, 0});
  scene.skins.push_back({"", {still, turning}, {joint_from_mesh, joint_from_mesh}});
  node_of(scene, 0).skin = 0;
  node_of(scene, 0).local = moved({0, 77, 0});  // a skinned mesh's own node does not move it

  const Pose pose = pose_at(scene, 0);
  ASSERT_TRUE(pose.instances[0].deformed);
  EXPECT_EQ(pose.instances[0].world_from_object, glm::mat4(1.0f));
  const DeformedVertices vertices = pose.instances[0].deformed->vertices();
  // Both joints' matrices take mesh space through joint space (x - 10) and back to the world (+ 10), the second one
  // turning a quarter about +Y in between: (x, y, z) -> (z + 10, y, 10 - x).
  expect_near(vertices.positions[0], {0, 0, 0});
  expect_near(vertices.positions[1], 0.5f * glm::vec3(1, 0, 0) + 0.5f * glm::vec3(10, 0, 9));
  expect_near(vertices.positions[2], {10, 1, 10});
  expect_near(vertices.normals[2], {1, 0, 0});
  expect_near(glm::vec3(vertices.tangents[2]), {0, 0, -1});
  expect_near(vertices.normals[1], glm::normalize(glm::vec3(1, 0, 1)));
  expect_near(pose.bounds_max, {10, 1, 10});
}

TEST(Pose, SkinnedNormalsStayPerpendicularUnderUnevenScale) {
  Primitive primitive = unit_triangle();
  primitive.positions = {{0, 0, 0}, {1, -1, 0}, {0, 0, 1}};  // in the plane x + y = 0
  primitive.normals.assign(3, glm::normalize(glm::vec3(1, 1, 0)));
  primitive.joints.assign(3, glm::uvec4(0));
  primitive.weights.assign(3, glm::vec4(1, 0, 0, 0));
  Scene scene = scene_of(primitive);
  const int joint = add_node(scene, {glm::vec3(0.0f), glm::quat(1, 0, 0, 0), {4, 1, 1}});
  scene.skins.push_back({"", {joint}, {glm::mat4(1)}});
  node_of(scene, 0).skin = 0;
  const Pose stretched = pose_at(scene, 0);
  const DeformedVertices vertices = stretched.instances[0].deformed->vertices();
  expect_near(vertices.normals[0], glm::normalize(glm::vec3(1, 4, 0)));
  EXPECT_NEAR(glm::dot(vertices.normals[0], vertices.positions[1] - vertices.positions[0]), 0.0f, kTolerance);
  node_of(scene, joint).local.scale = {-1, 1, 1};  // a mirror: still on the outside, handedness turned over
  const Pose mirrored = pose_at(scene, 0);
  expect_near(mirrored.instances[0].deformed->vertices().normals[0], glm::normalize(glm::vec3(-1, 1, 0)));
  EXPECT_EQ(mirrored.instances[0].deformed->vertices().tangents[0].w, -1.0f);
}

TEST(Pose, MorphWeightsComeFromAnimationNodeOrMesh) {
  Primitive primitive = unit_triangle();
  MorphTarget lift, lean;
  lift.positions.assign(3, {0, 0, 2});
  lean.positions.assign(3, {1, 0, 0});
  lean.normals.assign(3, {1, 0, 0});
  primitive.morph_targets = {lift, lean};
  Scene scene = scene_of(primitive);
  auto mesh = std::make_shared<Mesh>(*scene.meshes[0]);
  mesh->weights = {0.5f, 0.0f};
  scene.meshes[0] = mesh;
  expect_near(pose_at(scene, 0).instances[0].deformed->vertices().positions[0], {0, 0, 1});

  node_of(scene, 0).weights = {0.0f, 1.0f};
  node_of(scene, 0).local = moved({0, 3, 0});
  const Pose pose = pose_at(scene, 0);
  expect_near(pose.instances[0].deformed->vertices().positions[1], {2, 0, 0});  // in the node's space
  expect_near(pose.instances[0].deformed->vertices().normals[0], glm::normalize(glm::vec3(1, 0, 1)));
  expect_near(pose.bounds_min, {1, 3, 0});

  scene.animations.push_back(
      {"", {{0, AnimatedProperty::kWeights, Interpolation::kLinear, {0, 1}, {0, 0, 1, 1}, 2}}, {}, 1.0f});
  expect_near(pose_at(scene, 0.25).instances[0].deformed->vertices().positions[0], {0.25f, 0, 0.5f});
}

TEST(Pose, LightsShineAlongMinusZAndAnimateAsCopies) {
  Scene scene;
  Light sun;
  sun.kind = LightKind::kDirectional;
  sun.intensity = 5;
  scene.lights = {sun};
  const int n = add_node(scene, {{1, 2, 3}, about_y(90), glm::vec3(7)});
  node_of(scene, n).light = 0;
  LightChannel dim{0, LightChannel::Property::kIntensity, Interpolation::kLinear, {0, 1}, {4, 0}};
  LightChannel tint{0, LightChannel::Property::kColor, Interpolation::kStep, {0}, {1, 0.5f, 0}};
  scene.animations.push_back({"dusk", {}, {dim, tint}, 1.0f});
  const Pose pose = pose_at(scene, 0.25);
  ASSERT_EQ(pose.lights.size(), 1u);
  EXPECT_FLOAT_EQ(pose.lights[0].light.intensity, 3.0f);
  expect_near(pose.lights[0].light.color, {1, 0.5f, 0});
  expect_near(pose.lights[0].position_ws, {1, 2, 3});
  expect_near(pose.lights[0].direction_ws, {-1, 0, 0});
  EXPECT_EQ(scene.lights[0].intensity, 5.0f);
}

TEST(Pose, CamerasAreRigid) {
  Scene scene;
  scene.cameras.emplace_back();
  const int parent = add_node(scene, {glm::vec3(0.0f), about_y(30), {2, 5, 0.5f}});
  const int n = add_node(scene, {{0, 1, 0}, about_y(20), glm::vec3(3)}, parent);
  node_of(scene, n).camera = 0;
  const Pose pose = pose_at(scene, 0);
  ASSERT_EQ(pose.cameras.size(), 1u);
  const glm::mat3 turn(pose.cameras[0].world_from_view);
  const glm::mat3 product = glm::transpose(turn) * turn;
  for (int c = 0; c < 3; ++c) expect_near(product[c], glm::mat3(1.0f)[c]);
  EXPECT_NEAR(glm::determinant(turn), 1.0f, kTolerance);
  expect_near(glm::vec3(pose.cameras[0].world_from_view[3]), {0, 5, 0});
  const glm::vec3 back = world_from_nodes(scene, 0)[static_cast<std::size_t>(n)][2];
  expect_near(turn[2], glm::normalize(back));
}

TEST(Pose, HiddenNodesHideTheirSubtreeButKeepCameras) {
  Scene scene = scene_of(unit_triangle());
  scene.lights.emplace_back();
  scene.cameras.emplace_back();
  const int child = add_node(scene, {}, 0);
  node_of(scene, child).mesh = 0;
  node_of(scene, child).light = 0;
  node_of(scene, child).camera = 0;
  node_of(scene, 0).visible = false;
  const Pose pose = pose_at(scene, 0);
  EXPECT_TRUE(pose.instances.empty());
  EXPECT_TRUE(pose.lights.empty());
  EXPECT_EQ(pose.cameras.size(), 1u);
  EXPECT_EQ(pose.bounds_min, pose.bounds_max);
}

TEST(FrameCamera, ShowsAllCornersForAnyShape) {
  const glm::vec3 sizes[] = {{1, 1, 1}, {100, 1, 3}, {0.01f, 0.5f, 0.01f}, {5, 0, 5}, {2, 3, 4000}};
  for (const glm::vec3& size : sizes)
    for (const float aspect : {0.25f, 1.0f, 16.0f / 9.0f, 5.0f}) {
      Pose pose;
      pose.bounds_min = {-3, 10, 2};
      pose.bounds_max = pose.bounds_min + size;
      const PlacedCamera placed = frame_camera(pose, aspect);
      const glm::mat4 view_from_world = glm::inverse(placed.world_from_view);
      const float tan_y = std::tan(0.5f * placed.camera.yfov);
      float filled = 0.0f;
      for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner = pose.bounds_min + size * glm::vec3(i & 1, (i >> 1) & 1, i >> 2);
        const glm::vec3 at = glm::vec3(view_from_world * glm::vec4(corner, 1));
        ASSERT_GT(-at.z, placed.camera.znear);
        const float across = std::max(std::abs(at.x) / (tan_y * aspect), std::abs(at.y) / tan_y) / -at.z;
        EXPECT_LE(across, 1.0f);
        filled = std::max(filled, across);
      }
      EXPECT_GT(filled, 0.85f);  // and it is not a speck in the middle
    }
}

TEST(FrameCamera, AnEmptyPoseStillHasACamera) {
  const PlacedCamera placed = frame_camera(Pose{}, 1.0f);
  EXPECT_TRUE(std::isfinite(placed.world_from_view[3].z));
  EXPECT_GT(placed.camera.znear, 0.0f);
}

}  // namespace
}  // namespace lightwell
