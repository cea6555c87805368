// The realtime method while things move: what moves takes its history along.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

enum class Carrier { kNode, kJoint, kMorphTarget };

/// A room with a lamp, and a card that has come `way_m` towards the camera by what carries it.
Scene room_with_card(Carrier carrier, float way_m) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
  maker.point({-0.3f, 0.8f, 0.7f}, 3.0f);
  maker.quad({-0.5f, -0.6f, -0.8f}, {1, 0, 0}, {0, 1, 0}, maker.material(lambert({0.7f, 0.5f, 0.3f})));
  Scene scene = maker.take();
  Node& node = scene.nodes.back();
  auto mesh = std::make_shared<Mesh>(*scene.meshes.back());
  scene.meshes.back() = mesh;
  Primitive& card = mesh->primitives.front();
  const glm::vec3 way(0.3f * way_m, 0, way_m);
  if (carrier == Carrier::kNode) node.local.translation = way;
  if (carrier == Carrier::kJoint) {
    card.joints.assign(4, glm::uvec4(0));
    card.weights.assign(4, glm::vec4(1, 0, 0, 0));
    node.skin = 0;
    Node joint;
    joint.local.translation = way;
    scene.skins.push_back({"", {static_cast<int>(scene.nodes.size())}, {glm::mat4(1.0f)}});
    scene.roots.push_back(static_cast<int>(scene.nodes.size()));
    scene.nodes.push_back(joint);
  }
  if (carrier == Carrier::kMorphTarget) {
    MorphTarget target;
    target.positions.assign(4, glm::vec3(0.3f, 0, 1));
    card.morph_targets.push_back(target);
    node.weights = {way_m};
  }
  return scene;
}

/// Moves what `carrier` carries within the same scene, as an animation does.
void move_card(Scene& scene, Carrier carrier, float way_m) {
  const Scene placed = room_with_card(carrier, way_m);
  scene.nodes = placed.nodes;
}

/// Mean of (a - b)^2 / b^2.
double relative_error(const Pixels& a, const Pixels& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double share = static_cast<double>(a.rgb[i]) / static_cast<double>(b.rgb[i]) - 1.0;
    sum += share * share;
  }
  return sum / static_cast<double>(a.rgb.size());
}

TEST(RealtimeMotion, WhatMovesTakesItsHistoryAlong) {
  constexpr float kStep_m = 0.013f;  // more than what the history takes for the same plane
  constexpr int kFrames = 20;
  Settings settings = realtime_settings(2);
  settings.samples = 16;  // one ray a frame
  settings.view = ViewKind::kIndirect;
  const PlacedCamera camera = look_at({0.05f, -0.1f, -0.1f}, {0.05f, -0.1f, -1}, 0.5f);  // sees the card alone
  for (const Carrier carrier : {Carrier::kNode, Carrier::kJoint, Carrier::kMorphTarget}) {
    Scene scene = room_with_card(carrier, kStep_m * kFrames);
    Settings exact = reference_settings(2);
    exact.view = ViewKind::kIndirect;
    const Pixels truth = render(scene, camera, exact, {32, 32}, 512);
    const double first = relative_error(Film(camera, settings).next(scene), truth);
    Film film(camera, settings);
    for (int frame = 0; frame < kFrames; ++frame) {
      move_card(scene, carrier, kStep_m * static_cast<float>(frame));
      film.next(scene);
    }
    move_card(scene, carrier, kStep_m * kFrames);
    const double moving = relative_error(film.next(scene), truth);
    std::printf("carrier %d: error %.5f in a first frame, %.5f after %d in motion\n", static_cast<int>(carrier), first,
                moving, kFrames);
    EXPECT_LT(moving, 0.5 * first);
  }
}

}  // namespace
}  // namespace lightwell::testing
