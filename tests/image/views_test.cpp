// What the views show, as values: scene-referred pictures hold metres, unit vectors and counts.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/image/test_scenes.h"

namespace lightwell::testing {
namespace {

// The inside of a box of 2 m; the camera sees its far side at z = -1 and parts of the others.
Scene room() {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f))));
  maker.point({0.2f, 0.3f, 0.1f}, 3.0f);
  return maker.take();
}

Pixels show(ViewKind view, int index = 0, int patch = 1, int groups = 1) {
  Settings settings;
  settings.samples = 16;
  settings.bounces = 3;
  settings.indirect_size = 32;
  settings.view = view;
  settings.view_index = index;
  settings.patch = patch;
  settings.triangle_groups = groups;
  return render(room(), look_at({0, 0, 0.9f}, {0, 0, -1}, 1.0f), settings, {32, 32});
}

TEST(Views, PositionIsInMetresOfTheWorld) {
  const Pixels pixels = show(ViewKind::kPosition);
  EXPECT_NEAR(pixels.center().z, -1.0f, 1e-3f);
  EXPECT_NEAR(pixels.center().x, 0.0f, 0.05f);
  for (const float value : pixels.rgb) EXPECT_LE(std::abs(value), 1.001f);
}

TEST(Views, NormalDepthHoldsBoth) {
  const glm::vec3 value = show(ViewKind::kNormalDepth).center();
  EXPECT_NEAR(value.x, 0.5f, 1e-3f);
  EXPECT_NEAR(value.y, 0.5f, 1e-3f);
  EXPECT_NEAR(value.z, 1.0f / 1.19f, 1e-3f);
}

TEST(Views, ADirectionIsAUnitVectorAndItsHitLiesOnTheBox) {
  for (const int patch : {1, 4}) {
    const Pixels positions = show(ViewKind::kPosition), directions = show(ViewKind::kDirection, 5, patch);
    const Pixels distances = show(ViewKind::kHitDistance, 5, patch);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const glm::vec3 direction = directions.at(x, y);
        ASSERT_NEAR(glm::length(direction), 1.0f, 1e-4f);
        const glm::vec3 hit = glm::abs(positions.at(x, y) + distances.at(x, y).r * direction);
        ASSERT_NEAR(std::max({hit.x, hit.y, hit.z}), 1.0f, 5e-3f) << x << ", " << y << ", patch " << patch;
      }
  }
}

TEST(Views, TheBouncesAloneAddUpToIndirectLight) {
  const Pixels all = show(ViewKind::kIndirect);
  const Pixels first = show(ViewKind::kBounce, 1), second = show(ViewKind::kBounce, 2);
  const Pixels third = show(ViewKind::kBounce, 3);
  EXPECT_GT(second.mean().g, 0.0f);
  EXPECT_LT(third.mean().g, second.mean().g);
  for (std::size_t i = 0; i < all.rgb.size(); ++i)
    ASSERT_NEAR(first.rgb[i] + second.rgb[i] + third.rgb[i], all.rgb[i], 1e-3f * all.rgb[i]);
}

TEST(Views, APlaneIsOnePatchBesideTheOther) {
  // On the far side all pixels are similar: none is unmatched, and each patch of 4 x 4 has one seed.
  const Pixels unmatched = show(ViewKind::kUnmatched, 0, 4), patches = show(ViewKind::kPatch, 0, 4);
  const Pixels references = show(ViewKind::kReference, 0, 4);
  int seeds = 0;
  for (int y = 12; y < 20; ++y)
    for (int x = 12; x < 20; ++x) {
      EXPECT_EQ(unmatched.at(x, y).r, 0.0f);
      EXPECT_EQ(references.at(x, y), glm::vec3(0.25f)) << "its own patch";
      seeds += patches.at(x, y) == glm::vec3(1.0f);
    }
  EXPECT_EQ(seeds, 4);
}

// A bar one pixel wide before a wall, beside the pixels that the patches of 4 x 4 trace from.
TEST(Views, UnmatchedPixelsOfAPatchThatAreAlikeShareRays) {
  SceneMaker maker;
  const int white = maker.material(lambert(glm::vec3(0.8f)));
  maker.quad({-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, white);
  maker.quad({0, -2, 0}, {0.0625f, 0, 0}, {0, 4, 0}, white);
  const Scene scene = maker.take();
  Settings settings = thesis_settings(1);
  settings.patch = 4;
  settings.indirect_size = 32;
  const auto count = [&](ViewKind view) {
    settings.view = view;
    const Pixels pixels = render(scene, look_parallel({0, 0, 1}, {0, 0, -1}, 2.0f), settings, {32, 32});
    int white_pixels = 0;
    for (int y = 0; y < 32; ++y) white_pixels += pixels.at(16, y) == glm::vec3(1.0f);
    return white_pixels;
  };
  EXPECT_EQ(count(ViewKind::kUnmatched), 32);
  EXPECT_EQ(count(ViewKind::kPatch), 8) << "one seed for every four";
}

TEST(Views, CandidatesAreCountedByGroup) {
  // Of a room's twelve triangles a ray meets up to three sides' planes, and one side alone from inside.
  const Pixels shares = show(ViewKind::kCandidates, 5, 4, 4);
  EXPECT_EQ(shares.center().r * 4.0f, std::round(shares.center().r * 4.0f));
  EXPECT_GE(shares.center().r, 0.25f);
  EXPECT_EQ(show(ViewKind::kCandidates, 5).center().r, 1.0f);
}

TEST(Views, OfWhatIsNotThereAreRefused) {
  Settings settings;
  settings.view = ViewKind::kBounce;
  EXPECT_FALSE(check_settings(settings, {64, 64}).ok()) << "bounces are counted from 1";
  settings.view_index = 2;
  EXPECT_FALSE(check_settings(settings, {64, 64}).ok()) << "there is one bounce";
  settings.view = ViewKind::kDirection;
  settings.view_index = settings.samples;
  EXPECT_FALSE(check_settings(settings, {64, 64}).ok());
  settings.view_index = settings.samples - 1;
  EXPECT_TRUE(check_settings(settings, {64, 64}).ok());
}

}  // namespace
}  // namespace lightwell::testing
