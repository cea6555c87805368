// Properties between their keys, against values worked out by hand.
#include "server/sequences/keyframes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "protocol/codec.h"

namespace lightwell {
namespace {

using protocol::Keyframes;
using protocol::KeyInterpolation;

Keyframes keys(KeyInterpolation interpolation, std::vector<double> times, std::vector<std::vector<double>> values,
               std::string path = "/nodes/0/translation") {
  return {std::move(path), interpolation, std::move(times), std::move(values), false};
}

TEST(Keyframes, LinearAndStepBetweenAndBeyondTheKeys) {
  const auto linear = keys(KeyInterpolation::kLinear, {1, 3}, {{0, 10}, {4, 20}});
  EXPECT_EQ(value_at(linear, 0), (std::vector<double>{0, 10}));
  EXPECT_EQ(value_at(linear, 1.5), (std::vector<double>{1, 12.5}));
  EXPECT_EQ(value_at(linear, 3), (std::vector<double>{4, 20}));
  EXPECT_EQ(value_at(linear, 9), (std::vector<double>{4, 20}));
  const auto step = keys(KeyInterpolation::kStep, {1, 3}, {{0}, {4}});
  EXPECT_EQ(value_at(step, 2.999), (std::vector<double>{0}));
  EXPECT_EQ(value_at(step, 3), (std::vector<double>{4}));
}

TEST(Keyframes, CubicSplinesAreHermite) {
  // p(t) = t^3 between 0 and 2 has the slopes 0 and 12.
  const auto cube = keys(KeyInterpolation::kCubicSpline, {0, 2}, {{0}, {0}, {0}, {12}, {8}, {0}});
  for (const double t : {0.0, 0.5, 1.0, 1.7, 2.0}) EXPECT_NEAR(value_at(cube, t)[0], t * t * t, 1e-12) << t;
  EXPECT_EQ(value_at(cube, 5)[0], 8);
}

TEST(Keyframes, RotationsGoTheShorterWayOnTheSphere) {
  const double half = std::sqrt(0.5);
  const auto turn = keys(KeyInterpolation::kLinear, {0, 1}, {{0, 0, 0, 1}, {0, -half, 0, -half}}, "/nodes/a/rotation");
  const auto middle = value_at(turn, 0.5);  // a quarter turn, given with the other sign: 45 degrees in between
  EXPECT_NEAR(std::abs(middle[1]), std::sin(M_PI / 8), 1e-12);
  EXPECT_NEAR(std::abs(middle[3]), std::cos(M_PI / 8), 1e-12);
  EXPECT_GT(middle[1] * middle[3], 0.0);
  const auto long_one = keys(KeyInterpolation::kStep, {0}, {{0, 0, 0, 4}}, "/nodes/a/rotation");
  EXPECT_EQ(value_at(long_one, 0), (std::vector<double>{0, 0, 0, 1}));
}

TEST(Keyframes, BecomeEditsAndCameras) {
  Keyframes number{"/materials/0/roughness", KeyInterpolation::kLinear, {0, 2}, {{0}, {1}}, true};
  const auto edits = edits_at({number, keys(KeyInterpolation::kStep, {0}, {{1, 2, 3}})}, 1.0);
  EXPECT_EQ(edits[0], (nlohmann::json{{"op", "replace"}, {"path", "/materials/0/roughness"}, {"value", 0.5}}));
  EXPECT_EQ(edits[1]["value"], (nlohmann::json{1.0, 2.0, 3.0}));
  const auto camera = camera_at({}, {keys(KeyInterpolation::kLinear, {0, 1}, {{0, 0, 0}, {2, 4, 6}}, "/eye")}, 0.5);
  EXPECT_EQ(camera.eye, (protocol::Vector3{1, 2, 3}));
  EXPECT_EQ(camera.target, protocol::FreeCamera().target);
}

TEST(SequenceRequest, NamesWhatIsWrong) {
  struct Case {
    const char* body;
    const char* pointer;
  };
  const Case cases[] = {
      {R"({"scene":"a"})", ""},
      {R"({"scene":"a","last_frame":-1})", "/last_frame"},
      {R"({"scene":"a","first_frame":2,"last_frame":1})", "/last_frame"},
      {R"({"scene":"a","last_frame":1,"fps":0})", "/fps"},
      {R"({"scene":"a","last_frame":1,"views":[]})", "/views"},
      {R"({"scene":"a","last_frame":1,"more":1})", "/more"},
      {R"({"scene":"a","last_frame":1,"settings":{"view":"final"}})", "/settings/view"},
      {R"({"scene":"a","last_frame":1,"keyframes":[{"path":"x","times_s":[0],"values":[1]}]})", "/keyframes/0/path"},
      {R"({"scene":"a","last_frame":1,"keyframes":[{"path":"/x","times_s":[0,0],"values":[1,2]}]})",
       "/keyframes/0/times_s/1"},
      {R"({"scene":"a","last_frame":1,"keyframes":[{"path":"/x","times_s":[0,1],"values":[1]}]})",
       "/keyframes/0/values"},
      {R"({"scene":"a","last_frame":1,"keyframes":[{"path":"/x","times_s":[0,1],"values":[1,[2]]}]})",
       "/keyframes/0/values/1"},
      {R"({"scene":"a","last_frame":1,"keyframes":[{"path":"/x","times_s":[0],"values":[1],"interpolation":"X"}]})",
       "/keyframes/0/interpolation"},
      {R"({"scene":"a","last_frame":1,"keyframes":[{"path":"/x","times_s":[0],"values":[1]},)"
       R"({"path":"/x","times_s":[0],"values":[1]}]})",
       "/keyframes/1/path"},
      {R"({"scene":"a","last_frame":1,"camera_keyframes":[{"path":"/eye","times_s":[0],"values":[[1,2,3]]}]})",
       "/camera_keyframes"},
      {R"({"scene":"a","last_frame":1,"camera":{"eye":[0,0,1],"target":[0,0,0]},)"
       R"("camera_keyframes":[{"path":"/up","times_s":[0],"values":[[1,2,3]]}]})",
       "/camera_keyframes/0/path"},
      {R"({"scene":"a","last_frame":1,"camera":{"eye":[0,0,1],"target":[0,0,0]},)"
       R"("camera_keyframes":[{"path":"/eye","times_s":[0],"values":[1]}]})",
       "/camera_keyframes/0/values"}};
  for (const Case& bad : cases) {
    const auto request = protocol::parse_sequence_request(bad.body);
    ASSERT_FALSE(request.ok()) << bad.body;
    EXPECT_EQ(request.problem().status, 422);
    EXPECT_EQ(request.problem().pointer, bad.pointer) << bad.body << ": " << request.problem().detail;
  }
}

TEST(SequenceRequest, IsWrittenAsItIsRead) {
  const char* body =
      R"({"scene":"a","last_frame":9,"fps":25,"format":"exr","views":["final","depth"],"camera":{"eye":[0,0,1],)"
      R"("target":[0,0,0]},"camera_keyframes":[{"path":"/yfov","times_s":[0,1],"values":[0.5,0.9]}],"keyframes":)"
      R"([{"path":"/nodes/0/translation","interpolation":"STEP","times_s":[0],"values":[[1,2,3]]}]})";
  const auto request = protocol::parse_sequence_request(body);
  ASSERT_TRUE(request.ok()) << request.problem().detail;
  const auto again = protocol::parse_sequence_request(protocol::json_text(protocol::to_json(*request)));
  ASSERT_TRUE(again.ok()) << again.problem().detail;
  EXPECT_EQ(*again, *request);
}

}  // namespace
}  // namespace lightwell
