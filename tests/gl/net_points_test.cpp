// Random numbers of texels side by side: nets along both axes and over the frames, and blue noise on the screen.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <set>
#include <span>

#include "renderer/gl/buffer.h"
#include "renderer/gl/device.h"
#include "renderer/gl/program.h"

namespace lightwell::test {

extern const char* const kNetPointsLabShader;  // net_points_lab.comp, made a source by the build

namespace {

using Points = std::vector<glm::vec2>;

class NetPoints : public testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = gl::Context::create(); }
  static void TearDownTestSuite() { context_.reset(); }

  /// Point n of texel (x, y) at [(y * side + x) * numbers + n].
  static Points make(std::uint32_t side, std::uint32_t numbers, std::uint32_t first_number, std::uint32_t decision,
                     std::uint32_t seed) {
    gl::ShaderLibrary shaders;
    const gl::ProgramPtr program = shaders.compute_text("net_points_lab.comp", kNetPointsLabShader, {});
    Points points(std::size_t{side} * side * numbers);
    gl::Buffer buffer("points", points.size() * sizeof(glm::vec2));
    buffer.bind_storage(0);
    gl::Uniform<std::uint32_t>(program, "side") = side;
    gl::Uniform<std::uint32_t>(program, "numbers") = numbers;
    gl::Uniform<std::uint32_t>(program, "first_number") = first_number;
    gl::Uniform<std::uint32_t>(program, "decision") = decision;
    gl::Uniform<std::uint32_t>(program, "seed") = seed;
    program->dispatch(static_cast<std::uint32_t>(points.size()));
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    buffer.download(std::as_writable_bytes(std::span(points)));
    return points;
  }

 private:
  static inline std::unique_ptr<gl::Context> context_;
};

/// Whether every rectangle of 4^-i by 4^-j that has the share of one point has one.
bool is_net(const Points& points) {
  for (std::size_t columns = 1; columns <= points.size(); columns *= 4) {
    const std::size_t rows = points.size() / columns;
    std::set<std::size_t> taken;
    for (const glm::vec2 p : points)
      taken.insert(static_cast<std::size_t>(p.x * static_cast<float>(columns)) * rows +
                   static_cast<std::size_t>(p.y * static_cast<float>(rows)));
    if (taken.size() != points.size()) return false;
  }
  return true;
}

TEST_F(NetPoints, AreNetsOverTexelsAndOverTheirNumbers) {
  constexpr std::uint32_t kSide = 8, kNumbers = 256;
  for (const std::uint32_t seed : {0u, 1u, 77u})
    for (const std::uint32_t first : {0u, 768u, 1024u}) {
      const Points all = make(kSide, kNumbers, first, seed % 5, seed);
      // Of a square of texels with its corner at (4, 0), the points of `numbers` from 192 on.
      const auto part = [&](std::uint32_t square, std::uint32_t numbers) {
        Points points;
        for (std::uint32_t y = 0; y < square; ++y)
          for (std::uint32_t x = 4; x < 4 + square; ++x)
            for (std::uint32_t n = 192; n < 192 + numbers; ++n) points.push_back(all[(y * kSide + x) * kNumbers + n]);
        return points;
      };
      for (const std::uint32_t square : {1u, 2u, 4u})
        for (const std::uint32_t numbers : {1u, 4u, 16u, 64u})
          EXPECT_TRUE(is_net(part(square, numbers))) << square << ", " << numbers << ", seed " << seed;
    }
}

TEST_F(NetPoints, AreOtherOnesForOtherDecisionsBlocksAndNets) {
  const Points points = make(8, 4, 0, 1, 5);
  EXPECT_NE(points, make(8, 4, 0, 2, 5));
  EXPECT_NE(points, make(8, 4, 0, 1, 6));
  EXPECT_NE(points, make(8, 4, 1024, 1, 5));
  EXPECT_NE(points[0], points[4 * 4]);
  EXPECT_EQ(points, make(8, 4, 0, 1, 5));
}

/// Error of each texel's mean of `value` over its points against the mean of all.
std::vector<double> errors(const Points& u, const Points& v, std::size_t numbers,
                           const std::function<double(glm::vec2, glm::vec2)>& value) {
  std::vector<double> means(u.size() / numbers, 0.0);
  double mean = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double x = value(u[i], v[i]);
    means[i / numbers] += x / static_cast<double>(numbers);
    mean += x / static_cast<double>(u.size());
  }
  for (double& x : means) x -= mean;
  return means;
}

/// Variance of the means of squares of texels, times their texels: the same for white noise, whatever the square.
double power(const std::vector<double>& texels, std::size_t side, std::size_t square) {
  double sum = 0.0;
  for (std::size_t corner_y = 0; corner_y < side; corner_y += square)
    for (std::size_t corner_x = 0; corner_x < side; corner_x += square) {
      double total = 0.0;
      for (std::size_t i = 0; i < square * square; ++i)
        total += texels[(corner_y + i / square) * side + corner_x + i % square];
      sum += total * total;
    }
  return sum / static_cast<double>(side * side);
}

double irradiance_of_sky(glm::vec2 u) {  // brighter towards one side; `u` as for a direction sampled by the cosine
  return 1.0 + std::sqrt(static_cast<double>(u.x)) * std::cos(6.283185307 * static_cast<double>(u.y));
}

// The power of low frequencies: white noise would have as much as texels have.
TEST_F(NetPoints, ErrorsAreBlueNoiseInEveryFrameAndInTheMeanOfFrames) {
  constexpr std::uint32_t kSide = 128;
  for (const std::uint32_t numbers : {1u, 4u, 16u, 64u}) {
    const Points u = make(kSide, numbers, 3 * numbers, 1, 3), v = make(kSide, numbers, 3 * numbers, 2, 3);
    const auto sky = [](glm::vec2 a, glm::vec2) { return irradiance_of_sky(a); };
    const auto lamp = [](glm::vec2 a, glm::vec2 b) { return a.x + a.y + b.x > 1.2f ? 1.0 : 0.0; };
    const std::vector<double> of_sky = errors(u, v, numbers, sky), of_lamp = errors(u, v, numbers, lamp);
    const double share = power(of_sky, kSide, 8) / power(of_sky, kSide, 1);
    const double shadowed = power(of_lamp, kSide, 8) / power(of_lamp, kSide, 1);
    std::printf("%u numbers: low frequencies have %.4f of white noise's power, of a shadowed lamp %.3f\n", numbers,
                share, shadowed);
    EXPECT_LT(share, 0.1) << numbers;
    EXPECT_LT(shadowed, 0.9) << numbers;
  }
}

// Decisions are independent: what two of them say together has no bias.
TEST_F(NetPoints, DecisionsAreIndependent) {
  constexpr std::uint32_t kSide = 256, kNumbers = 4;
  const Points u = make(kSide, kNumbers, 0, 1, 9), v = make(kSide, kNumbers, 0, 2, 9);
  std::vector<double> counts(256, 0.0);
  for (std::size_t i = 0; i < u.size(); ++i)
    ++counts[static_cast<std::size_t>(u[i].x * 16.0f) * 16 + static_cast<std::size_t>(v[i].y * 16.0f)];
  const double expected = static_cast<double>(u.size()) / 256.0;
  for (const double count : counts) EXPECT_NEAR(count, expected, 0.15 * expected);
}

}  // namespace
}  // namespace lightwell::test
