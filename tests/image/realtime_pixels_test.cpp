// The realtime method where single pixels get rays of their own: mirrors, glossy surfaces, and what is narrower than a
// texel of the indirect map.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/image/film.h"

namespace lightwell::testing {
namespace {

Material glossy(glm::vec3 color, float metallic, float roughness) {
  Material material;
  material.base_color_factor = glm::vec4(color, 1.0f);
  material.metallic_factor = metallic;
  material.roughness_factor = roughness;
  return material;
}

int emitting(SceneMaker& maker, glm::vec3 radiance) {
  return maker.material(lambert(glm::vec3(0.0f), radiance));
}

/// The mean of a part of the next `frames` pictures.
glm::vec3 mean_of(Film& film, const Scene& scene, int frames, glm::ivec2 low, glm::ivec2 high) {
  glm::vec3 sum(0.0f);
  for (int frame = 0; frame < frames; ++frame) {
    const Pixels pixels = film.next(scene);
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) sum += pixels.at(x, y);
  }
  return sum / static_cast<float>(frames * (high.x - low.x) * (high.y - low.y));
}

/// A mirror before the camera, and behind it two walls that glow, the left one 1 nit, the right one 3.
Scene mirrored_walls() {
  SceneMaker maker;
  maker.quad({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}, maker.material(glossy(glm::vec3(1.0f), 1.0f, 0.0f)));
  maker.quad({0, -3, 2}, {-6, 0, 0}, {0, 6, 0}, emitting(maker, glm::vec3(1.0f)));
  maker.quad({6, -3, 2}, {-6, 0, 0}, {0, 6, 0}, emitting(maker, glm::vec3(3.0f)));
  return maker.take();
}

const PlacedCamera kBeforeMirror = look_at({0, 0, 0.5f}, {0, 0, -1}, 0.8f);

TEST(RealtimeReflections, AMirrorShowsWhatIsBehindTheCamera) {
  const Scene scene = mirrored_walls();
  Film film(kBeforeMirror, realtime_settings(1));
  for (int frame = 0; frame < 4; ++frame) {
    const Pixels pixels = film.next(scene);
    for (const int x : {2, 8, 13}) {
      EXPECT_NEAR(pixels.at(x, 16).g, 1.0f, 0.01f) << frame << ", " << x;
      EXPECT_NEAR(pixels.at(31 - x, 16).g, 3.0f, 0.03f) << frame << ", " << x;
    }
  }
}

TEST(RealtimeReflections, AreLightThatHasBouncedOnce) {
  Film direct(kBeforeMirror, realtime_settings(0));
  EXPECT_EQ(direct.next(mirrored_walls()).mean(), glm::vec3(0.0f));
}

/// The green of three pixels one above the other: a sample of the lamps makes a bright spot of a pixel here and there.
float middle_of_three(const Pixels& pixels, int x, int y) {
  const float a = pixels.at(x, y - 1).g, b = pixels.at(x, y).g, c = pixels.at(x, y + 1).g;
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

// The camera moves; the images in the mirror stay in their places.
TEST(RealtimeReflections, FollowTheCamera) {
  const Scene scene = mirrored_walls();
  Film film(kBeforeMirror, realtime_settings(1));
  for (int frame = 0; frame < 8; ++frame) {
    const float x_m = 0.05f * static_cast<float>(frame);
    film.request().camera = look_at({x_m, 0, 0.5f}, {x_m, 0, -1}, 0.8f);
    const Pixels pixels = film.next(scene);
    // The edge of the walls lies at x = 0: 4.5 m behind the eye along its way to the mirror and back.
    const int edge_px = 16 - static_cast<int>(std::round(x_m / (4.5f * std::tan(0.4f)) * 16.0f));
    EXPECT_NEAR(middle_of_three(pixels, edge_px - 3, 16), 1.0f, 0.05f) << frame;
    EXPECT_NEAR(middle_of_three(pixels, edge_px + 3, 16), 3.0f, 0.15f) << frame;
  }
}

enum class BackWall { kWhite, kMirror };

/// A room with a lamp and a glossy floor.
Scene glossy_room(BackWall back) {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.7f)));
  maker.quad({-1, -1, 2}, {2, 0, 0}, {0, 0, -3}, maker.material(glossy({0.3f, 0.3f, 0.35f}, 0.0f, 0.15f)));
  maker.quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0},
             back == BackWall::kWhite ? white : maker.material(glossy(glm::vec3(0.95f), 1.0f, 0.0f)));
  maker.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 3}, white);
  maker.quad({-1, -1, 2}, {0, 0, -3}, {0, 2, 0}, maker.material(lambert({0.8f, 0.1f, 0.1f})));
  maker.quad({1, -1, -1}, {0, 0, 3}, {0, 2, 0}, maker.material(lambert({0.1f, 0.7f, 0.2f})));
  maker.quad({1, -1, 2}, {-2, 0, 0}, {0, 2, 0}, white);
  maker.quad({-0.5f, 0.9f, 0.0f}, {1, 0, 0}, {0, 0, 1}, emitting(maker, glm::vec3(8.0f)));
  return maker.take();
}

const PlacedCamera kInGlossyRoom = look_at({0.1f, 0.1f, 1.8f}, {0, -0.2f, -1}, 0.85f);

/// How far the mean of a part of the picture is from that of `reference`, as a share of it. Of several seeds: one's is
/// a few percent off by chance.
glm::vec3 difference_to_reference(const Scene& scene, glm::ivec2 low, glm::ivec2 high) {
  constexpr int kSeeds = 8;
  glm::vec3 found(0.0f);
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    Settings settings = realtime_settings(8);
    settings.seed = seed;
    Film film(kInGlossyRoom, settings);
    for (int frame = 0; frame < 48; ++frame) film.next(scene);
    found += mean_of(film, scene, 8, low, high) / static_cast<float>(kSeeds);
  }
  const Pixels truth = render(scene, kInGlossyRoom, reference_settings(8), {32, 32}, 256);
  glm::vec3 expected(0.0f);
  for (int y = low.y; y < high.y; ++y)
    for (int x = low.x; x < high.x; ++x) expected += truth.at(x, y);
  expected /= static_cast<float>((high.x - low.x) * (high.y - low.y));
  const glm::vec3 difference = found / expected - 1.0f;
  std::printf("%+.2f %% red, %+.2f %% green, %+.2f %% blue\n", 100.0 * static_cast<double>(difference.r),
              100.0 * static_cast<double>(difference.g), 100.0 * static_cast<double>(difference.b));
  return glm::abs(difference);
}

TEST(RealtimeReflections, AGlossyFloorIsNearToReference) {
  const glm::vec3 difference = difference_to_reference(glossy_room(BackWall::kWhite), {8, 24}, {24, 32});
  EXPECT_LT(std::max({difference.r, difference.g, difference.b}), 0.05f);
}

TEST(RealtimeReflections, AMirroredRoomIsNearToReference) {
  const glm::vec3 difference = difference_to_reference(glossy_room(BackWall::kMirror), {11, 9}, {21, 19});
  EXPECT_LT(std::max({difference.r, difference.g, difference.b}), 0.03f);
}

TEST(RealtimeReflections, AGlossyFloorInAMirrorIsNearToReference) {
  const glm::vec3 difference = difference_to_reference(glossy_room(BackWall::kMirror), {11, 20}, {21, 25});
  EXPECT_LT(std::max({difference.r, difference.g, difference.b}), 0.05f);
}

// What a mirror throws on a floor is blurred, and much of it misses the floor: 6 to 8 % of all light there.
TEST(RealtimeReflections, AGlossyFloorThatReflectsAMirrorIsNearToReference) {
  const glm::vec3 difference = difference_to_reference(glossy_room(BackWall::kMirror), {11, 27}, {21, 32});
  EXPECT_LT(std::max({difference.r, difference.g, difference.b}), 0.09f);
}

TEST(RealtimeReflections, TheSameFramesHaveTheSameBytes) {
  const Scene scene = glossy_room(BackWall::kMirror);
  Film first(kInGlossyRoom, realtime_settings(3)), second(kInGlossyRoom, realtime_settings(3));
  for (int frame = 0; frame < 6; ++frame) EXPECT_EQ(first.next(scene).rgb, second.next(scene).rgb) << frame;
}

// A bar two pixels wide where a texel of the map is eight: most frames none of its texels is of the bar.
TEST(RealtimeUnmatchedPixels, ANarrowBarHasItsOwnLight) {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.8f)));
  maker.quad({-0.0055f, -0.05f, -0.5f}, {0.011f, 0, 0}, {0, 0.1f, 0}, white);
  maker.quad({-3, -3, -4}, {6, 0, 0}, {0, 6, 0}, white);
  maker.quad({0.5f, -0.5f, 0.5f}, {-1, 0, 0}, {0, 1, 0}, emitting(maker, glm::vec3(1.0f)));
  const Scene scene = maker.take();
  const PlacedCamera camera = look_at({0, 0, 0}, {0, 0, -1});
  Settings settings = realtime_settings(1);
  settings.indirect_size = 8;
  constexpr int kSeeds = 16;  // one's light is a few percent off by chance
  glm::vec3 found(0.0f);
  for (settings.seed = 0; settings.seed < kSeeds; ++settings.seed) {
    Film film(camera, settings, {64, 64});
    found += mean_of(film, scene, 24, {31, 24}, {33, 40}) / static_cast<float>(kSeeds);
  }
  const Pixels truth = render(scene, camera, reference_settings(1), {64, 64}, 64);
  glm::vec3 expected(0.0f);
  for (int y = 24; y < 40; ++y) expected += (truth.at(31, y) + truth.at(32, y)) / 32.0f;
  std::printf("bar: %+.2f %%\n", 100.0 * static_cast<double>(found.g / expected.g - 1.0f));
  EXPECT_NEAR(found.g, expected.g, 0.05f * expected.g);
}

}  // namespace
}  // namespace lightwell::testing
