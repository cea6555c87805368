// Animations from glTF: what is loaded, and what is left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/gltf_loaded.h"

namespace lightwell {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A triangle whose node is animated by one channel.
GltfBuilder animated(const std::string& path, int input, int output, const GltfBuilder& base,
                     const std::string& interpolation = "LINEAR") {
  GltfBuilder builder = base;
  builder.add("animations", {{"name", "motion"},
                             {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}}}});
  return builder;
}

TEST(GltfAnimation, Translation) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0, 2}, "SCALAR");
  const int output = builder.add_accessor<float>({1, 2, 3, 4, 5, 6}, "VEC3");
  const Scene scene = loaded(animated("translation", input, output, builder, "STEP"));
  EXPECT_EQ(scene.animations[0].name, "motion");
  EXPECT_EQ(scene.animations[0].duration_s, 2.0f);
  const AnimationChannel& channel = scene.animations[0].channels[0];
  EXPECT_EQ(channel.node, 0);
  EXPECT_EQ(channel.property, AnimatedProperty::kTranslation);
  EXPECT_EQ(channel.interpolation, Interpolation::kStep);
  EXPECT_EQ(channel.width, 3);
  EXPECT_THAT(channel.times_s, ElementsAre(0, 2));
  EXPECT_THAT(channel.values, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(GltfAnimation, RotationsAreOfUnitLength) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0, 1, 2}, "SCALAR");
  const int output = builder.add_accessor<std::int16_t>({0, 0, 0, 32767, 0, 16384, 0, 0, 0, 0, 0, 0}, "VEC4", true);
  const Scene scene = loaded(animated("rotation", input, output, builder));
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("rotations without length")));
}

TEST(GltfAnimation, CubicSplinesHaveThreeValuesAKey) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0.5f}, "SCALAR");
  const int output = builder.add_accessor<float>({9, 9, 9, 9, 0, 0, 2, 0, 8, 8, 8, 8}, "VEC4");
  const Scene scene = loaded(animated("rotation", input, output, builder, "CUBICSPLINE"));
  EXPECT_EQ(scene.animations[0].channels[0].interpolation, Interpolation::kCubicSpline);
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(9, 9, 9, 9, 0, 0, 1, 0, 8, 8, 8, 8));
}

TEST(GltfAnimation, Weights) {
  GltfBuilder builder = GltfBuilder::triangle();
  builder.primitive()["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
  const int input = builder.add_accessor<float>({0, 1}, "SCALAR");
  const int output = builder.add_accessor<std::uint8_t>({0, 255, 51, 0}, "SCALAR", true);
  const Scene scene = loaded(animated("weights", input, output, builder));
  EXPECT_EQ(scene.animations[0].channels[0].width, 2);
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(0, 1, 0.2f, 0));
}

TEST(GltfAnimation, KeysThatDoNotAscendAreLeftOut) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0, 1, 1, 0.5f, 2}, "SCALAR");
  const int output = builder.add_accessor<float>({0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4}, "VEC3");
  const Scene scene = loaded(animated("scale", input, output, builder));
  EXPECT_THAT(scene.animations[0].channels[0].times_s, ElementsAre(0, 1, 2));
  EXPECT_THAT(scene.animations[0].channels[0].values, ElementsAre(0, 0, 0, 1, 1, 1, 4, 4, 4));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("2 keys")));
}

TEST(GltfAnimation, WhatNothingCanFollowIsLeftOut) {
  GltfBuilder builder = GltfBuilder::triangle();
  const int input = builder.add_accessor<float>({0}, "SCALAR");
  const int output = builder.add_accessor<float>({0, 0, 0}, "VEC3");
  Scene scene = loaded(animated("weights", input, output, builder));
  EXPECT_THAT(scene.animations[0].channels, IsEmpty());
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("morph targets that do not exist")));
  scene = loaded(animated("pointer", input, output, builder));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("animates 'pointer'")));
  GltfBuilder untargeted = animated("translation", input, output, builder);
  untargeted.root["animations"][0]["channels"][0]["target"].erase("node");
  scene = loaded(untargeted);
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("animations/0: channels that target no node")));
  builder.root["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  scene = loaded(animated("translation", input, output, builder));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("has a matrix")));
}

}  // namespace
}  // namespace lightwell
