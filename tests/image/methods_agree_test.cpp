// The thesis method, its estimator corrected, against the reference at the first bounce, on closed Lambert rooms. What
// is printed is the table in the README. Direct light differs by what variance shadow maps take where their filter
// mixes depths: without a map there is no difference, and with finer ones there is less.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "renderer/passes/bindings.glsl"
#include "tests/image/estimate.h"

namespace lightwell::testing {
namespace {

const glm::ivec2 kSizePx(32, 32);
constexpr int kRuns = 8;

Settings settings_of(Method method, ViewKind view) {
  Settings settings;
  settings.method = method;
  settings.view = view;
  settings.samples = 32;
  settings.indirect_size = 32;
  return settings;
}

struct Difference {
  double share = 0.0;  // of the reference's mean
  double sigmas = 0.0;
};

PlacedCamera into_the_room() {
  return look_at({0.1f, 0.05f, 0.9f}, {0, -0.2f, -1}, 1.1f);
}

Difference difference(const char* name, const Scene& scene, ViewKind view) {
  const PlacedCamera camera = into_the_room();
  const Estimate thesis = estimate_mean(scene, camera, settings_of(Method::kThesis, view), kSizePx, 8, kRuns);
  const Estimate truth = estimate_mean(scene, camera, settings_of(Method::kReference, view), kSizePx, 64, kRuns);
  const double error = std::hypot(thesis.standard_error, truth.standard_error);
  const Difference result{thesis.mean / truth.mean - 1.0, (thesis.mean - truth.mean) / error};
  std::printf("%-28s %-9s thesis %.5f reference %.5f difference %+.2f %% (%+.1f standard errors)\n", name,
              std::string(name_of(view)).c_str(), thesis.mean, truth.mean, 100.0 * result.share, result.sigmas);
  return result;
}

void room(SceneMaker& maker, glm::vec3 emission = glm::vec3(0.0f)) {
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f), emission)));
}

void block(SceneMaker& maker) {
  const int grey = maker.material(lambert(glm::vec3(0.5f)));
  const glm::vec3 low(-0.5f, -0.999f, -0.6f), size(0.5f, 0.7f, 0.5f), x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  maker.quad(low + y, z, x, grey);
  maker.quad(low + z, x, y, grey);
  maker.quad(low + x + z, -z, y, grey);
  maker.quad(low, z, y, grey);
  maker.quad(low + x, -x, y, grey);
}

TEST(MethodsAgree, AnEmissiveRoom) {
  SceneMaker maker;
  room(maker, glm::vec3(1.0f));
  EXPECT_LT(std::abs(difference("emissive room", maker.take(), ViewKind::kFinal).share), 1e-3);
}

TEST(MethodsAgree, ARoomWithALamp) {
  SceneMaker maker;
  room(maker);
  block(maker);
  maker.quad({-0.4f, 0.9f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f},
             maker.material(lambert(glm::vec3(0.0f), glm::vec3(5.0f))));
  const Difference indirect = difference("lamp and block", maker.take(), ViewKind::kIndirect);
  EXPECT_LT(std::abs(indirect.sigmas), 3.0);
}

// The difference of direct light. Nothing in it is random but where in their pixels the frames look, which no seed
// changes.
double direct_difference(const char* name, const Scene& scene, int shadow_size, int shadow_filter) {
  constexpr int kThesisFrames = 32, kReferenceFrames = 128;
  Settings settings = settings_of(Method::kReference, ViewKind::kDirect);
  const double truth =
      static_cast<double>(render(scene, into_the_room(), settings, kSizePx, kReferenceFrames).mean().g);
  settings.method = Method::kThesis;
  settings.bounces = 0;
  settings.shadow_size = shadow_size;
  settings.shadow_filter = shadow_filter;
  const double share =
      static_cast<double>(render(scene, into_the_room(), settings, kSizePx, kThesisFrames).mean().g) / truth - 1.0;
  std::printf("%-28s direct, map %d, filter %d: difference %+.3f %%\n", name, shadow_size, shadow_filter,
              100.0 * share);
  return share;
}

/// Takes all layers of the shadow maps for lights without energy: later lights cast no shadow.
void take_all_shadow_maps(SceneMaker& maker) {
  for (int i = 0; i < MAX_SHADOW_LAYERS; ++i) maker.directional({0, -1, 0}, 0.0f);
}

Scene empty_room(bool with_shadow_map) {
  SceneMaker maker;
  room(maker);
  if (!with_shadow_map) take_all_shadow_maps(maker);
  maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
  return maker.take();
}

// In a convex room nothing casts a shadow: the light of a lamp without a shadow map is right, and is the reference's.
TEST(MethodsAgree, APointLightWithoutAShadowMapInAnEmptyRoom) {
  EXPECT_LT(std::abs(direct_difference("point light without a map", empty_room(false), 64, 3)), 2e-4);
}

TEST(MethodsAgree, APointLightInAnEmptyRoom) {
  const Scene scene = empty_room(true);
  const double fine = direct_difference("point light, empty room", scene, 512, 1);
  const double coarse = direct_difference("point light, empty room", scene, 512, 3);
  const double coarsest = direct_difference("point light, empty room", scene, 128, 3);
  EXPECT_LT(std::abs(fine), 4e-4);
  EXPECT_LT(std::abs(coarse), 2e-3);
  EXPECT_LT(coarse, fine);  // light is lost, not won, and the more the wider the filter is
  EXPECT_LT(coarsest, 2.0 * coarse);
  EXPECT_LT(std::abs(difference("point light, empty room", scene, ViewKind::kIndirect).sigmas), 3.0);
}

TEST(MethodsAgree, ABlockInTheLightOfAPoint) {
  SceneMaker maker;
  room(maker);
  block(maker);
  maker.point({0.3f, 0.6f, 0.2f}, 3.0f);
  const Scene scene = maker.take();
  EXPECT_LT(std::abs(direct_difference("point light, block", scene, 512, 3)), 3e-3);
  EXPECT_LT(std::abs(difference("point light, block", scene, ViewKind::kIndirect).sigmas), 3.0);
}

/// A pane that parts the room, the lamp behind it; `transmission` of what it does not reflect goes on.
Scene room_with_a_pane(float transmission) {
  SceneMaker maker;
  room(maker);
  block(maker);
  Material pane = lambert({0.8f, 0.5f, 0.2f});
  pane.roughness_factor = 0.0f;
  pane.transmission_factor = transmission;
  pane.double_sided = true;
  maker.quad({-1, -1, 0.2f}, {2, 0, 0}, {0, 2, 0}, maker.material(pane));
  maker.point({0.3f, 0.6f, -0.3f}, 3.0f);
  return maker.take();
}

TEST(MethodsAgree, ATintedPaneBeforeTheLamp) {
  const Scene scene = room_with_a_pane(1.0f);
  EXPECT_LT(std::abs(direct_difference("tinted pane", scene, 512, 3)), 3e-3);
  EXPECT_LT(std::abs(difference("tinted pane", scene, ViewKind::kIndirect).sigmas), 3.0);
}

TEST(MethodsAgree, APaneThatReflectsAndPasses) {
  const Scene scene = room_with_a_pane(0.5f);
  EXPECT_LT(std::abs(direct_difference("half reflecting pane", scene, 512, 3)), 3e-3);
  EXPECT_LT(std::abs(difference("half reflecting pane", scene, ViewKind::kIndirect).sigmas), 3.0);
}

}  // namespace
}  // namespace lightwell::testing
