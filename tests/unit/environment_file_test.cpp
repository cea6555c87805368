// Environment maps from files: what is light is read, what cannot be light is refused by name.
#include "renderer/image_io/environment_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "renderer/image_io/image_io.h"

namespace lightwell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class EnvironmentFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("environment-" + std::to_string(::getpid()) + "-" +
                                                        testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  // A picture of 2 x 1 pixels.
  std::filesystem::path exr(std::vector<float> rgb) {
    const std::filesystem::path path = folder_ / "sky.exr";
    EXPECT_TRUE(write_exr(path, {{2, 1}, 3, std::move(rgb)}).ok());
    return path;
  }
  std::filesystem::path folder_;
};

TEST_F(EnvironmentFile, GivesItsTexels) {
  const auto image = read_environment(exr({1, 2, 3, 40000, 5, 0.25f}));
  ASSERT_TRUE(image.ok()) << image.error().message();
  EXPECT_EQ((*image)->size_px, glm::ivec2(2, 1));
  EXPECT_THAT((*image)->rgb, ElementsAre(1, 2, 3, 40000, 5, 0.25f));
}

TEST_F(EnvironmentFile, NegativeLightIsNone) {
  const auto image = read_environment(exr({-0.01f, 2, 3, 4, 5, 6}));
  ASSERT_TRUE(image.ok()) << image.error().message();
  EXPECT_EQ((*image)->rgb[0], 0.0f);
}

TEST_F(EnvironmentFile, WhatIsNoAmountOfLightIsRefusedByItsPixel) {
  for (const float value : {std::numeric_limits<float>::infinity(), std::nanf(""), 1e30f}) {
    const auto image = read_environment(exr({1, 2, 3, 4, value, 6}));
    ASSERT_FALSE(image.ok()) << value;
    EXPECT_EQ(image.error().kind, ErrorKind::kInvalidInput);
    EXPECT_THAT(image.error().message(), HasSubstr("pixel 1, 0"));
  }
}

TEST_F(EnvironmentFile, WhatIsNoPictureIsRefused) {
  const std::filesystem::path text = folder_ / "sky.hdr";
  std::ofstream(text) << "not a picture";
  for (const std::filesystem::path& path : {text, folder_, folder_ / "missing.exr"}) {
    const auto image = read_environment(path);
    ASSERT_FALSE(image.ok()) << path;
    EXPECT_THAT(image.error().message(), HasSubstr(path.string()));
  }
}

TEST_F(EnvironmentFile, WhatIsTooLargeIsRefusedByItsHeader) {
  const std::filesystem::path path = exr({1, 2, 3, 4, 5, 6});
  EXPECT_TRUE(read_environment(path, 2).ok());
  const auto refused = read_environment(path, 1);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kTooLarge);
  EXPECT_THAT(refused.error().what, HasSubstr("2 x 1"));

  const std::filesystem::path large = folder_ / "large.hdr";  // with nothing behind its header
  std::ofstream(large, std::ios::binary) << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 10000 +X 10000\n";
  const auto too_large = read_environment(large);
  ASSERT_FALSE(too_large.ok());
  EXPECT_EQ(too_large.error().kind, ErrorKind::kTooLarge) << too_large.error().message();
}

TEST_F(EnvironmentFile, AnAttributeLongerThanItsFileIsRefused) {
  const std::filesystem::path path = exr({1, 2, 3, 4, 5, 6});
  std::ifstream file(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto size = bytes.find("box2i") + 6;  // of the window that follows
  bytes.replace(size, 4, "\xff\xff\xff\x7f", 4);
  std::ofstream(path, std::ios::binary) << bytes;
  const auto refused = read_environment(path);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().what, HasSubstr("longer than the file"));
}

TEST_F(EnvironmentFile, AppliesWhatIsGivenAndNothingElse) {
  Environment environment;
  environment.zenith_radiance = glm::vec3(3.0f);
  environment.rotation = 1.0f;
  ASSERT_TRUE(apply_environment({{}, {}, 0.5f}, environment).ok());
  EXPECT_EQ(environment.strength, 0.5f);
  EXPECT_EQ(environment.rotation, 1.0f);
  EXPECT_EQ(environment.image, nullptr);
  ASSERT_FALSE(apply_environment({(folder_ / "missing.exr").string(), {}, 2.0f}, environment).ok());
  EXPECT_EQ(environment.strength, 0.5f);
  ASSERT_TRUE(apply_environment({exr({1, 1, 1, 2, 2, 2}).string(), 0.25f, {}}, environment).ok());
  EXPECT_NE(environment.image, nullptr);
  EXPECT_EQ(environment.strength, 1.0f);
  EXPECT_EQ(environment.rotation, 0.25f);
}

}  // namespace
}  // namespace lightwell
