// The thesis' acceleration (5.1, 5.2): what patches, groups and the reference map do to the picture, and what they must
// not.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "renderer/methods/brute_force.h"
#include "renderer/scene/builtin.h"
#include "tests/image/test_scenes.h"

namespace lightwell::testing {
namespace {

const glm::ivec2 kSizePx(96, 96);

Settings patch_settings(int patch, int groups = 1) {
  Settings settings;
  settings.samples = 64;
  settings.indirect_size = 48;
  settings.view = ViewKind::kIndirect;
  settings.patch = patch;
  settings.triangle_groups = groups;
  return settings;
}

// Mean of (a - b)^2 / (b^2 + 0.01), b scaled to a mean of 1.
double relative_error(const Pixels& a, const Pixels& b) {
  const glm::vec3 mean = b.mean();
  const double scale = 3.0 / (mean.r + mean.g + mean.b);
  double sum = 0.0;
  for (std::size_t i = 0; i < b.rgb.size(); ++i) {
    const double x = scale * a.rgb[i], y = scale * b.rgb[i];
    sum += (x - y) * (x - y) / (y * y + 0.01);
  }
  return sum / static_cast<double>(b.rgb.size());
}

struct View {
  Scene scene;
  PlacedCamera camera;
};

View builtin_view(const char* name) {
  View view{std::move(builtin_scene(name).value()), {}};
  const Pose pose = pose_at(view.scene, 1.0);
  view.camera = pose.cameras.empty() ? frame_camera(pose, 1.0f) : pose.cameras[0];
  return view;
}

Pixels show(const View& view, const Settings& settings) {
  return render(view.scene, view.camera, settings, kSizePx);
}

TEST(BruteForce, FindsWhatTheHierarchyFinds) {
  const View view = builtin_view("cornell");
  for (const int patch : {1, 2}) {
    Settings settings = patch_settings(patch, patch);
    const Pixels by_hierarchy = show(view, settings);
    settings.brute_force = true;
    EXPECT_LT(relative_error(show(view, settings), by_hierarchy), 1e-6) << "patches of " << patch;
    settings.trace_missed = false;
    show(view, settings);
  }
}

TEST(BruteForce, IsRefusedWhereItTakesSecondsAndHarmsNoOther) {
  Settings settings = patch_settings(1);
  settings.brute_force = true;
  settings.samples = 4096;  // times 48^2 pixels times 34 triangles: 3.2e8 tests
  EXPECT_EQ(check_brute_force(settings, kSizePx, 34, true).ok(), true);
  EXPECT_EQ(check_brute_force(settings, kSizePx, 1522, false).ok(), true);
  const View view = builtin_view("helicopters");
  FrameRequest request;
  request.camera = view.camera;
  request.size_px = kSizePx;
  request.settings = settings;
  const auto render_view = shared_renderer().make_view();
  const Result<Frame> refused = shared_renderer().render(view.scene, request, *render_view);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kTooLarge);
  EXPECT_NE(refused.error().message().find("9437184 rays that try 1522 triangles"), std::string::npos)
      << refused.error().message();
  request.settings.brute_force = false;
  request.settings.samples = 1;
  EXPECT_TRUE(shared_renderer().render(view.scene, request, *render_view).ok());
}

TEST(Patches, OfOnePixelInAnyNumberOfGroupsChangeNothing) {
  const View view = builtin_view("cornell");
  const Pixels plain = show(view, patch_settings(1));
  EXPECT_LT(relative_error(show(view, patch_settings(1, 3)), plain), 1e-6);
  EXPECT_LT(relative_error(show(view, patch_settings(1, 64)), plain), 1e-6) << "more groups than triangles";
}

// With so many directions that what remains is not their noise.
TEST(Patches, KeepThePicture) {
  for (const char* name : {"cornell", "helicopters"}) {
    const View view = builtin_view(name);
    const auto converged = [&](int patch) {
      Settings settings = patch_settings(patch);
      settings.samples = 1024;
      return show(view, settings);
    };
    const Pixels plain = converged(1);
    for (const int patch : {2, 4}) {
      const double error = relative_error(converged(patch), plain);
      std::printf("%-12s patch %d  relMSE against patch 1: %.5f\n", name, patch, error);
      EXPECT_LT(error, 0.02) << name << ", patch " << patch;
    }
  }
}

// The canopies are smooth and curved: single directions that are rare for a patch and bright for one of its pixels
// would be specks.
TEST(Patches, OfSmoothCurvedSurfacesHaveNoSpecks) {
  const View view = builtin_view("helicopters");
  Settings settings = patch_settings(8);
  settings.view = ViewKind::kFinal;
  settings.samples = 32;
  settings.indirect_size = 256;
  Settings plain = settings;
  plain.patch = 1;
  for (settings.seed = 0; settings.seed < 8; ++settings.seed) {
    const double error = relative_error(render(view.scene, view.camera, settings, {256, 256}),
                                        render(view.scene, view.camera, plain, {256, 256}));
    std::printf("seed %u: relMSE against patch 1: %.5f\n", settings.seed, error);
    EXPECT_LT(error, 0.02) << settings.seed;
  }
}

// The weight of a direction is the pixel's BRDF over the patch's density, so that sharing directions loses no energy.
// The camera looks askew: a pixel in the very edge of two walls would see out between them.
TEST(Patches, KeepTheFirstBounceInAClosedEmissiveBox) {
  SceneMaker maker;
  maker.room({-1, -1, -1}, {1, 1, 1}, maker.material(lambert(glm::vec3(0.6f), glm::vec3(2.0f))));
  const Pixels pixels =
      show({maker.take(), look_at({0.03f, 0.05f, 0.9f}, {0.0f, 0.02f, -1.0f}, 1.0f)}, patch_settings(4));
  for (const float value : pixels.rgb) ASSERT_NEAR(value, 1.2f, 1e-3f);
}

TEST(Patches, BreakWithTheSimilarityAsItIsPrinted) {
  const View view = builtin_view("helicopters");
  const Pixels plain = show(view, patch_settings(1));
  Settings literal = patch_settings(4);
  literal.similarity = Similarity::kLiteral;
  literal.trace_missed = false;
  const double corrected = relative_error(show(view, patch_settings(4)), plain);
  EXPECT_GT(relative_error(show(view, literal), plain), 3.0 * corrected);
}

// Without a pixel that is similar to another every pixel is a patch of its own, and traces its own rays.
TEST(Patches, OfWhichNothingIsSimilarAreThePixels) {
  const View view = builtin_view("cornell");
  Settings alone = patch_settings(1, 2);
  alone.depth_threshold = 0.0f;
  EXPECT_LT(relative_error(show(view, alone), show(view, patch_settings(1))), 1e-6);
}

TEST(Patches, GiveTheSameBytesTwice) {
  const View view = builtin_view("venus");
  const Pixels first = show(view, patch_settings(4, 2)), second = show(view, patch_settings(4, 2));
  EXPECT_EQ(std::memcmp(first.rgb.data(), second.rgb.data(), first.rgb.size() * sizeof(float)), 0);
}

TEST(Patches, OfFurtherBouncesFollowTheScreen) {
  const View view = builtin_view("cornell");
  Settings plain = patch_settings(1), patches = patch_settings(2);
  plain.bounces = patches.bounces = 3;
  plain.samples = patches.samples = 512;
  EXPECT_LT(relative_error(show(view, patches), show(view, plain)), 0.02);
}

TEST(Patches, OverNothingAreWellDefined) {
  const Settings settings = patch_settings(8, 4);
  EXPECT_EQ(render(Scene{}, look_at({0, 0, 1}, {0, 0, 0}), settings, {16, 16}).mean(), glm::vec3(0.0f));
  SceneMaker maker;
  maker.triangles({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {0, 1, 2}, maker.material(lambert(glm::vec3(0.5f))));
  EXPECT_EQ(render(maker.take(), look_at({0, 0, 1}, {0, 0, 0}), settings, {16, 16}).mean(), glm::vec3(0.0f));
  SceneMaker behind;
  behind.quad({-1, -1, 5}, {2, 0, 0}, {0, 2, 0}, behind.material(lambert(glm::vec3(0.5f))));
  EXPECT_EQ(render(behind.take(), look_at({0, 0, 1}, {0, 0, 0}), settings, {16, 16}).mean(), glm::vec3(0.0f));
}

TEST(Patches, BadSettingsAreRefusedByName) {
  const auto refused = [](auto change) {
    Settings settings;
    change(settings);
    const Status status = check_settings(settings, {64, 64});
    return status.ok() ? std::string("accepted") : status.error().where;
  };
  EXPECT_EQ(refused([](Settings& s) { s.patch = 0; }), "patch");
  EXPECT_EQ(refused([](Settings& s) { s.patch = 3; }), "patch");
  EXPECT_EQ(refused([](Settings& s) { s.patch = 32; }), "patch");
  EXPECT_EQ(refused([](Settings& s) { s.patch = 16, s.indirect_size = 8; }), "patch");
  EXPECT_EQ(refused([](Settings& s) { s.triangle_groups = 0; }), "triangle-groups");
  EXPECT_EQ(refused([](Settings& s) { s.triangle_groups = 65; }), "triangle-groups");
  EXPECT_EQ(refused([](Settings& s) { s.normal_threshold = 1.5f; }), "normal-threshold");
  EXPECT_EQ(refused([](Settings& s) { s.depth_threshold = -1.0f; }), "depth-threshold");
  EXPECT_EQ(refused([](Settings& s) { s.depth_threshold = std::nanf(""); }), "depth-threshold");
}

}  // namespace
}  // namespace lightwell::testing
