// Small pictures of the built-in scenes, view by view, against stored ones. LIGHTWELL_UPDATE_GOLDEN=1 stores them anew.
// On a failure the actual picture, the expected one and eight times their difference are saved beside each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "renderer/image_io/image_io.h"
#include "renderer/scene/builtin.h"
#include "tests/image/test_scenes.h"

namespace lightwell::testing {
namespace {

const glm::ivec2 kSizePx(96, 96);
// Drivers round differently by the vector width of the machine: a step of eight bits on average is too much, and so is
// more than one pixel in fifty that differs visibly.
constexpr double kMeanThreshold = 1.0;
constexpr int kVisibleDifference = 12;
constexpr double kVisibleShare = 0.02;

struct Case {
  const char* scene;
  double time_s;
  ViewKind view;
  int bounces;
};

std::string name_of_case(const Case& c) {
  std::string name = std::string(c.scene) + "-" + std::string(name_of(c.view));
  if (c.bounces != 1) name += "-" + std::to_string(c.bounces) + "-bounces";
  return name;
}

std::vector<std::uint8_t> picture_of(const Case& c) {
  const Scene scene = builtin_scene(c.scene).value();
  FrameRequest request;
  request.time_s = c.time_s;
  request.size_px = kSizePx;
  request.camera = pose_at(scene, c.time_s).cameras.at(0);
  request.settings.view = c.view;
  request.settings.bounces = c.bounces;
  request.settings.samples = 64;
  request.settings.indirect_size = 48;
  request.settings.denoise = c.bounces > 1;
  const auto view = shared_renderer().make_view();
  const Frame frame = shared_renderer().render(scene, request, *view).value();
  std::vector<std::uint8_t> rgb;
  for (std::size_t i = 0; i < frame.display_rgbx.size(); ++i)
    if (i % 4 != 3) rgb.push_back(frame.display_rgbx[i]);
  return rgb;
}

std::vector<std::uint8_t> stored(const std::filesystem::path& file) {
  const Result<FloatImage> image = read_image(file);
  EXPECT_TRUE(image.ok()) << file << ": store it with LIGHTWELL_UPDATE_GOLDEN=1";
  if (!image) return {};
  std::vector<std::uint8_t> rgb;
  for (const float linear : image->pixels) {
    const float srgb = linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
    rgb.push_back(static_cast<std::uint8_t>(std::lround(srgb * 255.0f)));
  }
  return rgb;
}

void save_failure(const std::string& name, const std::vector<std::uint8_t>& actual,
                  const std::vector<std::uint8_t>& expected) {
  const std::filesystem::path folder = "golden-failures";
  std::filesystem::create_directories(folder);
  std::vector<std::uint8_t> difference(actual.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    difference[i] = static_cast<std::uint8_t>(std::min(255, 8 * std::abs(actual[i] - expected[i])));
  (void)write_ldr(folder / (name + "-actual.png"), kSizePx, actual);
  (void)write_ldr(folder / (name + "-expected.png"), kSizePx, expected);
  (void)write_ldr(folder / (name + "-difference.png"), kSizePx, difference);
}

class Golden : public ::testing::TestWithParam<Case> {};

TEST_P(Golden, Picture) {
  const std::string name = name_of_case(GetParam());
  const std::filesystem::path file = std::filesystem::path(LIGHTWELL_GOLDEN_FOLDER) / (name + ".png");
  const std::vector<std::uint8_t> actual = picture_of(GetParam());
  if (std::getenv("LIGHTWELL_UPDATE_GOLDEN") != nullptr) {
    ASSERT_TRUE(write_ldr(file, kSizePx, actual).ok());
    return;
  }
  const std::vector<std::uint8_t> expected = stored(file);
  ASSERT_EQ(actual.size(), expected.size());
  double sum = 0.0;
  int visible = 0;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const int difference = std::abs(actual[i] - expected[i]);
    sum += difference;
    visible += difference > kVisibleDifference ? 1 : 0;
  }
  const double mean = sum / static_cast<double>(actual.size());
  const double share = visible / static_cast<double>(actual.size());
  EXPECT_LT(mean, kMeanThreshold);
  EXPECT_LT(share, kVisibleShare);
  if (HasFailure()) save_failure(name, actual, expected);
}

INSTANTIATE_TEST_SUITE_P(
    BuiltinScenes, Golden,
    ::testing::Values(Case{"cornell", 0.0, ViewKind::kFinal, 1}, Case{"cornell", 0.0, ViewKind::kFinal, 4},
                      Case{"cornell", 0.0, ViewKind::kDirect, 1}, Case{"cornell", 0.0, ViewKind::kIndirect, 1},
                      Case{"cornell", 0.0, ViewKind::kAlbedo, 1}, Case{"cornell", 0.0, ViewKind::kNormal, 1},
                      Case{"cornell", 0.0, ViewKind::kDepth, 1}, Case{"cornell", 0.0, ViewKind::kOcclusionDistance, 1},
                      Case{"helicopters", 1.0, ViewKind::kFinal, 2}, Case{"venus", 1.0, ViewKind::kFinal, 2},
                      Case{"atrium", 10.0, ViewKind::kDirect, 1}, Case{"atrium", 10.0, ViewKind::kFinal, 3}),
    [](const auto& test) {
      std::string name = name_of_case(test.param);
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

}  // namespace
}  // namespace lightwell::testing
