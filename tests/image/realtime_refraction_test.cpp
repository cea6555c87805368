// The realtime method through glass that bends the light: a ball turns what is behind it round, a slab moves it aside,
// both colour it, and a mirror shows the same of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/image/clear_scenes.h"
#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

constexpr float kIor = 1.5f;

Material glass() {
  Material material = pane(glm::vec3(1.0f), 1.0f);
  material.double_sided = false;
  material.ior = kIor;
  material.thickness_factor = 1.0f;
  material.attenuation_distance = 1.0f;
  material.attenuation_color = {0.9f, 0.5f, 0.7f};
  return material;
}

/// Two walls that glow, side by side: 1 nit at x < 0, 3 nit at x > 0.
SceneMaker glowing_walls(float z) {
  SceneMaker maker;
  maker.quad({-9, -9, z}, {9, 0, 0}, {0, 18, 0}, maker.material(lambert(glm::vec3(0.0f), glm::vec3(1.0f))));
  maker.quad({0, -9, z}, {9, 0, 0}, {0, 18, 0}, maker.material(lambert(glm::vec3(0.0f), glm::vec3(3.0f))));
  return maker;
}

/// Of `frames` pictures after as many others.
Pixels mean_picture(const Scene& scene, const PlacedCamera& camera, int frames) {
  Film film(camera, realtime_settings(8));
  for (int frame = 0; frame < frames; ++frame) film.next(scene);
  Pixels sum = film.next(scene);
  for (int frame = 1; frame < frames; ++frame) {
    const Pixels next = film.next(scene);
    for (std::size_t i = 0; i < sum.rgb.size(); ++i) sum.rgb[i] += next.rgb[i];
  }
  for (float& value : sum.rgb) value /= static_cast<float>(frames);
  return sum;
}

Pixels exact_picture(const Scene& scene, const PlacedCamera& camera) {
  return render(scene, camera, reference_settings(8), {32, 32}, 256);
}

glm::vec3 mean_of(const Pixels& pixels, glm::ivec2 low, glm::ivec2 high) {
  glm::vec3 sum(0.0f);
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x) sum += pixels.at(x, y);
  return sum / static_cast<float>((high.x - low.x) * (high.y - low.y));
}

TEST(RealtimeRefraction, ABallTurnsThePictureRound) {
  SceneMaker maker = glowing_walls(-5.0f);
  maker.sphere({0, 0, -2}, 0.5f, 32, false, maker.material(glass()));
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0}, {0, 0, -1}, 0.4f);  // a little less than the ball
  const Pixels found = mean_picture(scene, camera, 16), exact = exact_picture(scene, camera);
  const glm::vec3 left = mean_of(found, {5, 8}, {13, 24}), right = mean_of(found, {19, 8}, {27, 24});
  EXPECT_GT(left.r, 2.0f * right.r);
  expect_near(left, mean_of(exact, {5, 8}, {13, 24}), 0.03f);
  expect_near(right, mean_of(exact, {19, 8}, {27, 24}), 0.03f);
}

/// Where the rows of the middle change from the one wall to the other, in pixels from the left.
float edge_px(const Pixels& pixels) {
  const float low = mean_of(pixels, {2, 2}, {10, 30}).g, high = mean_of(pixels, {24, 2}, {32, 30}).g;
  float below = 0.0f;
  for (int x = 0; x < 32; ++x) below += (high - mean_of(pixels, {x, 2}, {x + 1, 30}).g) / (high - low);
  return below;
}

// Snell: a ray at 45 degrees comes out of a slab beside its old way, by t sin(a) (1 - cos(a) / sqrt(n^2 - sin^2(a))).
TEST(RealtimeRefraction, ASlabMovesThePictureAside) {
  constexpr float kThickness_m = 0.6f, kWidth_m = 1.6f;
  SceneMaker maker = glowing_walls(-3.0f);
  const int material = maker.material(glass());
  maker.quad({-6, -4, -1.2f}, {12, 0, 0}, {0, 8, 0}, material);
  maker.quad({6, -4, -1.2f - kThickness_m}, {-12, 0, 0}, {0, 8, 0}, material);
  const Scene scene = maker.take();
  const float way_m = 6.0f * std::sqrt(0.5f);
  const PlacedCamera camera = look_parallel({-way_m, 0, -3.0f + way_m}, {0, 0, -3}, kWidth_m);
  const Pixels found = mean_picture(scene, camera, 16), exact = exact_picture(scene, camera);
  const float shift_m = kThickness_m * std::sqrt(0.5f) * (1.0f - std::sqrt(0.5f) / std::sqrt(kIor * kIor - 0.5f));
  EXPECT_NEAR(std::abs(edge_px(found) - 16.0f), shift_m / kWidth_m * 32.0f, 0.6f);
  EXPECT_NEAR(edge_px(found), edge_px(exact), 0.6f);
  expect_near(mean_of(found, {2, 2}, {8, 30}), mean_of(exact, {2, 2}, {8, 30}), 0.03f);
  expect_near(mean_of(found, {24, 2}, {30, 30}), mean_of(exact, {24, 2}, {30, 30}), 0.03f);
}

TEST(RealtimeRefraction, AMirrorShowsGlassAsItIs) {
  SceneMaker maker = glowing_walls(-5.0f);
  Material mirror;
  mirror.metallic_factor = 1.0f;
  mirror.roughness_factor = 0.0f;
  maker.quad({3, -3, 2}, {-6, 0, 0}, {0, 6, 0}, maker.material(mirror));
  maker.sphere({0, 0, -2}, 0.5f, 32, false, maker.material(glass()));
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0.5f}, {0, 0, 2}, 0.18f);
  const Pixels found = mean_picture(scene, camera, 16), exact = exact_picture(scene, camera);
  // Right and left change places in the mirror, and once more in the ball.
  const glm::vec3 left = mean_of(found, {8, 10}, {14, 22}), right = mean_of(found, {18, 10}, {24, 22});
  expect_near(left, mean_of(exact, {8, 10}, {14, 22}), 0.03f);
  expect_near(right, mean_of(exact, {18, 10}, {24, 22}), 0.03f);
  EXPECT_GT(right.r, 2.0f * left.r);
}

TEST(RealtimeRefraction, TheSameFramesHaveTheSameBytes) {
  SceneMaker maker = glowing_walls(-5.0f);
  maker.sphere({0, 0, -2}, 0.5f, 16, false, maker.material(glass()));
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0}, {0, 0, -1}, 0.6f);
  Film first(camera, realtime_settings(3)), second(camera, realtime_settings(3));
  for (int frame = 0; frame < 6; ++frame) EXPECT_EQ(first.next(scene).rgb, second.next(scene).rgb) << frame;
}

}  // namespace
}  // namespace lightwell::testing
