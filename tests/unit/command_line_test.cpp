// The command line's values: what is taken, what is refused, and how it says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/command_line/camera_argument.h"
#include "server/command_line/exit_code.h"
#include "server/command_line/output_file.h"
#include "server/command_line/parse_values.h"

namespace lightwell {
namespace {

using ::testing::HasSubstr;

TEST(ParseValues, Sizes) {
  EXPECT_EQ(*parse_size("640x480"), glm::ivec2(640, 480));
  EXPECT_EQ(*parse_size("1x16384"), glm::ivec2(1, 16384));
  for (const char* bad : {"", "x", "640", "640x", "x480", "0x480", "640x-1", "16385x1", "640x480x1", "640X480", "6.4x4",
                          " 640x480", "640x480 ", "99999999999999999999x1", "0x10x10"})
    EXPECT_FALSE(parse_size(bad)) << bad;
  EXPECT_THAT(parse_size("640").error().message(), HasSubstr("\"640\""));
}

TEST(ParseValues, Vectors) {
  EXPECT_EQ(*parse_vec3("1,-2.5,3e2"), glm::vec3(1.0f, -2.5f, 300.0f));
  for (const char* bad : {"", "1,2", "1,2,3,4", "1,2,", "a,b,c", "1,nan,3", "inf,0,0", "1e99,0,0", "1 ,2,3", "0x1,2,3"})
    EXPECT_FALSE(parse_vec3(bad)) << bad;
  EXPECT_TRUE(parse_color("0,0.5,100"));
  EXPECT_FALSE(parse_color("0,-0.5,1"));
}

TEST(ParseValues, FrameRanges) {
  const Result<FrameRange> range = parse_frame_range("3:17");
  ASSERT_TRUE(range);
  EXPECT_EQ(range->first, 3);
  EXPECT_EQ(range->last, 17);
  EXPECT_TRUE(parse_frame_range("5:5"));
  for (const char* bad : {"", "3", "3:", ":3", "5:4", "-1:4", "0:1000000", "1:2:3", "a:b"})
    EXPECT_FALSE(parse_frame_range(bad)) << bad;
}

TEST(ParseValues, Numbers) {
  EXPECT_EQ(*parse_integer("-7", -10, 10), -7);
  EXPECT_EQ(*parse_integer("+7", -10, 10), 7);
  for (const char* bad : {"", "+", "11", "-11", "7.0", "7a", "0x7", "99999999999999999999"})
    EXPECT_FALSE(parse_integer(bad, -10, 10)) << bad;
  EXPECT_EQ(*parse_number("0.5", 0.0, 1.0), 0.5);
  for (const char* bad : {"", "nan", "inf", "-0.1", "1.1", "0,5", "1e999"})
    EXPECT_FALSE(parse_number(bad, 0.0, 1.0)) << bad;
  EXPECT_THAT(parse_number("7", 0.0, 1.0).error().message(), HasSubstr("from 0 to 1"));
}

TEST(ParseValues, Devices) {
  EXPECT_EQ(*parse_device("software"), "software");
  for (const char* zero : {"0", "-0", "00"}) EXPECT_EQ(*parse_device(zero), "0") << zero;
  for (const char* bad : {"", "gpu", "-1", "1.5", "Software"}) EXPECT_FALSE(parse_device(bad)) << bad;
}

TEST(FramePattern, HoldsOnePlaceForTheNumber) {
  EXPECT_TRUE(is_frame_pattern("out/%04d.png"));
  EXPECT_TRUE(is_frame_pattern("frame%d.exr"));
  for (const char* bad : {"out.png", "%04d_%04d.png", "%s.png", "%4d.png", "%%04d.png", "%04d%n.png", "%012d.png"})
    EXPECT_FALSE(is_frame_pattern(bad)) << bad;
}

TEST(FramePattern, NamesFiles) {
  EXPECT_EQ(frame_file_name("out/%04d.png", 7), "out/0007.png");
  EXPECT_EQ(frame_file_name("%03d.png", 12345), "12345.png");
  EXPECT_EQ(frame_file_name("a%db.png", 0), "a0b.png");
}

TEST(OutputFile, KnowsEndings) {
  EXPECT_EQ(output_format_of("a.EXR"), OutputFormat::kExr);
  EXPECT_EQ(output_format_of("a.b/c.jpeg"), OutputFormat::kJpeg);
  EXPECT_EQ(output_format_of("a.png"), OutputFormat::kPng);
  for (const char* unknown : {"png", "a.gif", "a", "a.exr/b", ""}) EXPECT_FALSE(output_format_of(unknown)) << unknown;
  EXPECT_TRUE(is_scene_referred("a.exr"));
  EXPECT_TRUE(is_scene_referred("a.HDR"));
  EXPECT_FALSE(is_scene_referred("a.png"));
}

TEST(OutputFile, MissingFoldersAreFoundEarly) {
  EXPECT_TRUE(check_folder_of("a.png"));
  const Status status = check_folder_of("/no/such/folder/a.png");
  ASSERT_FALSE(status);
  EXPECT_EQ(exit_code_of(status.error().kind), kFailed);
  EXPECT_THAT(status.error().message(), HasSubstr("/no/such/folder"));
}

TEST(ExitCodes, FollowTheKindOfError) {
  EXPECT_EQ(exit_code_of(ErrorKind::kInvalidInput), 3);
  EXPECT_EQ(exit_code_of(ErrorKind::kNotFound), 3);
  EXPECT_EQ(exit_code_of(ErrorKind::kTooLarge), 3);
  EXPECT_EQ(exit_code_of(ErrorKind::kUnsupported), 3);
  EXPECT_EQ(exit_code_of(ErrorKind::kNoDevice), 4);
  EXPECT_EQ(exit_code_of(ErrorKind::kInternal), 1);
  EXPECT_EQ(exit_code_of(ErrorKind::kDeviceLost), 1);
}

Pose pose_with_cameras(int count) {
  Pose pose;
  pose.bounds_min = glm::vec3(-1.0f);
  pose.bounds_max = glm::vec3(1.0f);
  for (int i = 0; i < count; ++i) {
    PlacedCamera camera;
    camera.node = 10 + i;
    pose.cameras.push_back(camera);
  }
  return pose;
}

TEST(CameraArgument, TheScenesFirstByDefault) {
  EXPECT_EQ(place_camera({}, pose_with_cameras(2), 1.0f)->node, 10);
  CameraArgument second;
  second.index = 1;
  EXPECT_EQ(place_camera(second, pose_with_cameras(2), 1.0f)->node, 11);
}

TEST(CameraArgument, AnIndexThatDoesNotExistIsNamed) {
  CameraArgument third;
  third.index = 2;
  const Result<PlacedCamera> placed = place_camera(third, pose_with_cameras(2), 1.0f);
  ASSERT_FALSE(placed);
  EXPECT_THAT(placed.error().message(), ::testing::AllOf(HasSubstr("--camera"), HasSubstr("2")));
}

TEST(CameraArgument, EyeLooksAtTarget) {
  const auto expect_forward = [](glm::vec3 eye, glm::vec3 target) {
    CameraArgument argument;
    argument.eye = eye;
    argument.target = target;
    argument.yfov_degrees = 60.0;
    const Result<PlacedCamera> placed = place_camera(argument, pose_with_cameras(1), 1.0f);
    ASSERT_TRUE(placed);
    EXPECT_NEAR(placed->camera.yfov, 1.0471976f, 1e-5f);
    const glm::vec3 forward = -glm::vec3(placed->world_from_view[2]);
    const glm::vec3 position = glm::vec3(placed->world_from_view[3]);
    EXPECT_NEAR(glm::distance(forward, glm::normalize(target - eye)), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::distance(position, eye), 0.0f, 1e-5f);
    EXPECT_NEAR(glm::determinant(glm::mat3(placed->world_from_view)), 1.0f, 1e-5f);
  };
  expect_forward({1, 2, 3}, {0, 0, 0});
  expect_forward({0, 5, 0}, {0, 0, 0});  // straight down
  expect_forward({0, -5, 0}, {0, 0, 0});
}

TEST(CameraArgument, EyeMustNotBeItsTarget) {
  CameraArgument argument;
  argument.eye = argument.target = glm::vec3(1.0f);
  ASSERT_FALSE(place_camera(argument, pose_with_cameras(1), 1.0f));
}

}  // namespace
}  // namespace lightwell
