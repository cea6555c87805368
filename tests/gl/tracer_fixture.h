// Every tracer of the build on one context, and how their hits are compared.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "renderer/gl/device.h"
#include "tests/gl/trace_scenes.h"

namespace lightwell::test {

struct TraceResult {
  std::vector<Hit> hits;
  std::vector<bool> visible;  // of the first rays only: a software device is slow
};

inline bool is_hit(const Hit& hit) {
  return hit.t >= 0.0f;
}

class TracerTest : public testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void TearDown() override;

  /// Every tracer's results for these rays, by its name (without brute force where it would take too long): any_hit and
  /// the list of hits are held against closest_hit.
  static std::map<std::string, TraceResult> trace_all(const TraceWorld& world, const std::vector<Ray>& rays);

  /// `covered`: a hit whose texel or threshold the last bit of a barycentric decides may differ as well.
  static void expect_agreement(const TraceWorld& world, const std::vector<Ray>& rays, const std::vector<Hit>& a,
                               const std::vector<Hit>& b, bool covered = false);

  static std::unique_ptr<gl::Context> context_;
  static std::map<std::string, std::unique_ptr<Tracer>> tracers_;
};

}  // namespace lightwell::test
