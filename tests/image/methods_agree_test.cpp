// The thesis method, its estimator corrected, against the reference at the first bounce, on closed Lambert rooms. What
// its variance shadow maps do to the difference is printed: the table in the README is made of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

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

Difference difference(const char* name, const Scene& scene, ViewKind view) {
  const PlacedCamera camera = look_at({0.1f, 0.05f, 0.9f}, {0, -0.2f, -1}, 1.1f);
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

TEST(MethodsAgree, ARoomWithAPointLightAndNothingInItsWay) {
  SceneMaker maker;
  room(maker);
  maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
  const Scene scene = maker.take();
  EXPECT_LT(std::abs(difference("point light, empty room", scene, ViewKind::kDirect).share), 5e-3);
  EXPECT_LT(std::abs(difference("point light, empty room", scene, ViewKind::kIndirect).sigmas), 3.0);
}

// In a map's shadow edges, and where it bleeds, the two differ: by how much is bounded here and told in the README.
TEST(MethodsAgree, ABlockInTheLightOfAPoint) {
  SceneMaker maker;
  room(maker);
  block(maker);
  maker.point({0.3f, 0.6f, 0.2f}, 3.0f);
  const Scene scene = maker.take();
  EXPECT_LT(std::abs(difference("point light, block", scene, ViewKind::kDirect).share), 0.05);
  EXPECT_LT(std::abs(difference("point light, block", scene, ViewKind::kIndirect).share), 0.05);
}

}  // namespace
}  // namespace lightwell::testing
