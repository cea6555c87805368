// Coverage and grouping: what both tracers are told alike.
#include "renderer/tracing/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <set>

#include "renderer/tracing/geometry_groups.h"

namespace lightwell {
namespace {

std::shared_ptr<Image> image_of(std::vector<std::uint8_t> alphas, glm::ivec2 size_px) {
  auto image = std::make_shared<Image>();
  image->size_px = size_px;
  for (const std::uint8_t alpha : alphas) image->rgba.insert(image->rgba.end(), {1, 2, 3, alpha});
  return image;
}

std::shared_ptr<Primitive> triangle() {
  auto primitive = std::make_shared<Primitive>();
  primitive->positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.0f, 1.0f, 0.0f}};
  primitive->uv0 = {{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}};
  primitive->indices = {0, 1, 2};
  return primitive;
}

CoverageTest prepare(const Coverage& coverage) {
  AlphaRanges ranges;
  return prepare_coverage(coverage, *triangle(), ranges);
}

TEST(Coverage, NearestTexelWrapsAsOpenGlDoes) {
  const auto texels = [](Wrap wrap) {
    std::vector<int> found;
    for (int i = -5; i < 9; ++i) found.push_back(nearest_texel((static_cast<float>(i) + 0.5f) / 3.0f, 3, wrap));
    return found;
  };
  EXPECT_EQ(texels(Wrap::kRepeat), (std::vector<int>{1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(texels(Wrap::kMirroredRepeat), (std::vector<int>{1, 2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0, 1, 2}));
  EXPECT_EQ(texels(Wrap::kClampToEdge), (std::vector<int>{0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 2, 2}));
}

TEST(Coverage, NearestTexelStaysInsideForAnyNumber) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kMirroredRepeat, Wrap::kClampToEdge})
    for (const float x :
         {1e30f, -1e30f, std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
          std::numeric_limits<float>::quiet_NaN(), 1e9f, -0.0f})
      for (const int size_px : {1, 7, 16384}) {
        EXPECT_GE(nearest_texel(x, size_px, wrap), 0);
        EXPECT_LT(nearest_texel(x, size_px, wrap), size_px);
      }
}

TEST(Coverage, WhatCannotBeTransparentNeedsNoTest) {
  Coverage coverage;
  coverage.mode = AlphaMode::kBlend;
  EXPECT_EQ(prepare(coverage).outcome, CoverageTest::Outcome::kAlwaysHit);
  coverage.image = image_of({255, 255}, {2, 1});
  EXPECT_EQ(prepare(coverage).outcome, CoverageTest::Outcome::kAlwaysHit);
  coverage.factor = 0.5f;
  EXPECT_EQ(prepare(coverage).outcome, CoverageTest::Outcome::kBlend);
  coverage.factor = 0.0f;
  EXPECT_EQ(prepare(coverage).outcome, CoverageTest::Outcome::kNeverHit);
  coverage = {};
  coverage.mode = AlphaMode::kMask;
  coverage.image = image_of({200, 130}, {2, 1});
  EXPECT_EQ(prepare(coverage).outcome, CoverageTest::Outcome::kAlwaysHit);
  coverage.cutoff = 0.6f;
  EXPECT_EQ(prepare(coverage).outcome, CoverageTest::Outcome::kMask);
  coverage.cutoff = 1.5f;
  EXPECT_EQ(prepare(coverage).outcome, CoverageTest::Outcome::kNeverHit);
}

TEST(Coverage, MaskComparesAsItsDefinitionDoes) {
  for (const float cutoff : {0.0f, 0.2f, 0.5f, 128.0f / 255.0f, 1.0f})
    for (const float factor : {0.3f, 0.8f, 1.0f}) {
      std::vector<std::uint8_t> alphas;
      for (int a = 0; a < 256; ++a) alphas.push_back(static_cast<std::uint8_t>(a));
      Coverage coverage{AlphaMode::kMask, cutoff, factor, image_of(alphas, {256, 1}), {}, Wrap::kRepeat, Wrap::kRepeat};
      const CoverageTest test = prepare(coverage);
      for (int a = 0; a < 256; ++a)
        EXPECT_EQ(is_covered(test, *triangle(), 0, 0, (static_cast<float>(a) + 0.5f) / 256.0f, 0.0f),
                  static_cast<float>(a) / 255.0f * factor >= cutoff);
    }
}

TEST(Coverage, TheTextureTransformTurnsCounterClockwiseAsSeen) {
  Coverage coverage{AlphaMode::kMask, 0.5f, 1.0f, image_of({255, 0, 0, 0}, {2, 2}), {}, Wrap::kRepeat, Wrap::kRepeat};
  coverage.use.rotation = glm::half_pi<float>();
  const CoverageTest test = prepare(coverage);
  // (u, v) goes to (v, -u): the covered texel, u' and v' below one half, is where v < 0.5 and u > 0.5.
  EXPECT_TRUE(is_covered(test, *triangle(), 0, 0, 0.75f, 0.2f));
  EXPECT_FALSE(is_covered(test, *triangle(), 0, 0, 0.25f, 0.2f));
  EXPECT_FALSE(is_covered(test, *triangle(), 0, 0, 0.2f, 0.7f));
}

TEST(Coverage, ThresholdsAreEvenlySpread) {
  constexpr int kCells = 16, kDraws = 64000;
  std::vector<int> counts(kCells);
  for (std::uint32_t i = 0; i < kDraws; ++i)
    ++counts[coverage_threshold(i % 5, i / 1000, static_cast<float>(i % 200) / 200.0f,
                                static_cast<float>(i % 37) / 40.0f) >>
             20];
  double chi_square = 0.0;
  for (const int n : counts) chi_square += std::pow(n - kDraws / kCells, 2.0) / (kDraws / kCells);
  EXPECT_LT(chi_square, 50.0);  // 15 degrees of freedom: one in 100000 by chance
}

Instance instance_of(std::shared_ptr<const Primitive> primitive, int node) {
  Instance instance;
  instance.primitive = std::move(primitive);
  instance.node = node;
  return instance;
}

TEST(GeometryGroups, PrimitivesOfOneNodeShareAHierarchy) {
  const auto a = triangle(), b = triangle();
  std::vector<Instance> instances = {instance_of(a, 3), instance_of(b, 3), instance_of(a, 4), instance_of(b, 4)};
  auto groups = group_instances(instances, std::vector<bool>(4));
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].key, groups[1].key);
  EXPECT_EQ(groups[1].first_instance, 2u);
  groups = group_instances(instances, {false, true, false, false});
  ASSERT_EQ(groups.size(), 3u);  // the filtered one stands alone
  EXPECT_TRUE(groups[1].key.filtered);
}

TEST(GeometryGroups, LeavesOutWhatCannotBeTraced) {
  std::vector<Instance> instances = {instance_of(triangle(), 0), instance_of(std::make_shared<Primitive>(), 1),
                                     instance_of(triangle(), 2)};
  instances[0].world_from_object[3].x = std::numeric_limits<float>::quiet_NaN();
  const auto groups = group_instances(instances, std::vector<bool>(3));
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].first_instance, 2u);
}

TEST(GeometryGroups, AFlattenedObjectIsPlacedInTheWorld) {
  std::vector<Instance> instances = {instance_of(triangle(), 0), instance_of(triangle(), 1)};
  instances[0].world_from_object = glm::scale(glm::mat4(1.0f), {2.0f, 0.0f, 1.0f});
  instances[1].world_from_object = glm::scale(glm::mat4(1.0f), glm::vec3(1e-6f));  // small, not flat
  const auto groups = group_instances(instances, std::vector<bool>(2));
  ASSERT_EQ(groups.size(), 2u);
  ASSERT_TRUE(groups[0].deformed);
  EXPECT_EQ(groups[0].world_from_object, glm::mat4(1.0f));
  EXPECT_EQ(groups[0].deformed->positions()[1], glm::vec3(2.0f, 0.0f, 0.0f));
  EXPECT_FALSE(groups[1].deformed);
}

}  // namespace
}  // namespace lightwell
