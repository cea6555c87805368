// What is kept of groups of triangles when sessions with different numbers of them take turns.
#include "renderer/tracing/triangle_groups.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace lightwell {
namespace {

/// Remembers what it was given: a tracer keeps the hierarchies of primitives by their addresses.
class NotingTracer final : public Tracer {
 public:
  NotingTracer(int& living, std::vector<std::weak_ptr<const Primitive>>& given) : living_(living), given_(given) {
    ++living_;
  }
  ~NotingTracer() override { --living_; }
  std::string_view name() const override { return "noting"; }
  void update(const TraceScene& scene) override {
    for (const Instance& instance : scene.instances) {
      const auto known = std::find_if(given_.begin(), given_.end(),
                                      [&](const auto& other) { return other.lock() == instance.primitive; });
      if (known == given_.end()) given_.push_back(instance.primitive);
    }
  }
  void closest_hit(const gl::Buffer&, std::uint32_t, gl::Buffer&, HitList*) override {}
  void any_hit(const gl::Buffer&, std::uint32_t, gl::Buffer&) override {}
  void test_candidates(const CandidateTest&, gl::Buffer&, HitList&) override {}
  std::uint64_t memory_bytes() const override { return 0; }

 private:
  int& living_;
  std::vector<std::weak_ptr<const Primitive>>& given_;
};

class TriangleGroupsTest : public ::testing::Test {
 protected:
  void update(std::uint32_t count) { groups_.update({instances_, coverage_}, count); }
  void use(const std::shared_ptr<const Primitive>& primitive) {
    instances_.assign(1, Instance{});
    instances_[0].primitive = primitive;
    coverage_.assign(1, Coverage{});
  }
  static std::shared_ptr<const Primitive> triangles(std::uint32_t count) {
    auto primitive = std::make_shared<Primitive>();
    primitive->positions.assign(3, glm::vec3(0.0f));
    for (std::uint32_t i = 0; i < 3 * count; ++i) primitive->indices.push_back(i % 3);
    return primitive;
  }

  int living_ = 0;
  std::vector<std::weak_ptr<const Primitive>> given_;  // parts that some tracer had not seen before
  std::vector<Instance> instances_;
  std::vector<Coverage> coverage_;
  TriangleGroups groups_{[this] { return std::make_unique<NotingTracer>(living_, given_); }};
};

TEST_F(TriangleGroupsTest, SessionsWithDifferentCountsDoNotRebuildEachOthers) {
  use(triangles(12));
  for (int frame = 0; frame < 5; ++frame)
    for (const std::uint32_t count : {2u, 4u, 3u}) update(count);
  EXPECT_EQ(given_.size(), 9u);
  EXPECT_EQ(living_, 9);
  EXPECT_EQ(given_[0].lock()->indices.size() / 3, 6u);
  EXPECT_EQ(given_[2].lock()->indices.size() / 3, 3u);
}

TEST_F(TriangleGroupsTest, NoMoreThanAFewAreKept) {
  use(triangles(12));
  for (const std::uint32_t count : {2u, 3u, 4u, 5u, 6u}) update(count);
  EXPECT_EQ(living_, 3 + 4 + 5 + 6);
  update(2);  // made anew; 3 goes
  EXPECT_EQ(living_, 2 + 4 + 5 + 6);
}

TEST_F(TriangleGroupsTest, WhatAnEditTakesAwayIsFreedForEveryCount) {
  use(triangles(12));
  update(2);
  update(4);
  use(triangles(8));
  update(4);
  EXPECT_EQ(living_, 4);  // those of two held the old primitive alone
  EXPECT_EQ(std::count_if(given_.begin(), given_.end(), [](const auto& part) { return part.expired(); }), 6);
}

TEST_F(TriangleGroupsTest, WhatNobodyAsksForAnyMoreIsFreed) {
  use(triangles(12));
  update(2);
  for (std::uint64_t frame = 0; frame <= TriangleGroups::kFramesUntilDropped; ++frame) update(3);
  EXPECT_EQ(living_, 3);
}

}  // namespace
}  // namespace lightwell
