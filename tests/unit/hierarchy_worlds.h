// Scenes for hierarchies on the processor, and what rays meet in them.
#pragma once

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "renderer/tracing/tracer.h"

namespace lightwell::test {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : random_(seed) {}
  float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
  glm::vec3 in_box(float half) { return {between(-half, half), between(-half, half), between(-half, half)}; }
  glm::vec3 direction() {
    for (;;) {
      const glm::vec3 point = in_box(1.0f);
      if (glm::dot(point, point) > 0.01f && glm::dot(point, point) < 1.0f) return glm::normalize(point);
    }
  }

 private:
  std::mt19937 random_;
};

inline std::shared_ptr<const Primitive> random_triangles(std::size_t count, float size_m, std::uint32_t seed) {
  Numbers numbers(seed);
  auto primitive = std::make_shared<Primitive>();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 center = numbers.in_box(2.0f);
    for (int corner = 0; corner < 3; ++corner) {
      primitive->indices.push_back(static_cast<std::uint32_t>(primitive->positions.size()));
      primitive->positions.push_back(center + numbers.in_box(size_m));
    }
  }
  return primitive;
}

inline Instance instance_of(std::shared_ptr<const Primitive> primitive, const glm::mat4& world_from_object, int node) {
  Instance instance;
  instance.primitive = std::move(primitive);
  instance.world_from_object = world_from_object;
  instance.node = node;
  return instance;
}

/// Two placings of one mesh, one of them mirrored, and a small mesh of its own.
inline std::vector<Instance> crowd(float turn) {
  const auto shared = random_triangles(300, 0.4f, 1), small = random_triangles(5, 1.0f, 2);
  const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), turn, glm::vec3(0.6f, 0.8f, 0.0f));
  return {instance_of(shared, turned, 0),
          instance_of(shared, glm::scale(glm::translate(glm::mat4(1.0f), {3.0f, 0.5f, 0.0f}), {-1.0f, 2.0f, 0.5f}), 1),
          instance_of(small, glm::translate(turned, {0.0f, 3.0f, 1.0f}), 2)};
}

/// By Moeller and Trumbore in doubles, over all triangles.
inline Hit brute_force(std::span<const Instance> instances, glm::vec3 origin_ws, glm::vec3 direction_ws) {
  Hit nearest{kMiss, 0, 0, 0.0f, 0.0f};
  const glm::dvec3 direction(direction_ws);
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const Primitive& primitive = *instances[i].primitive;
    for (std::uint32_t t = 0; t < primitive.indices.size() / 3; ++t) {
      glm::dvec3 corners[3];
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = glm::dvec3(glm::dmat4(instances[i].world_from_object) *
                                glm::dvec4(glm::dvec3(primitive.positions[primitive.indices[3 * t + c]]), 1.0));
      const glm::dvec3 b = corners[1] - corners[0], c = corners[2] - corners[0], across = glm::cross(direction, c);
      const glm::dvec3 way = glm::dvec3(origin_ws) - corners[0];
      const double inverse = 1.0 / glm::dot(b, across);
      const double u = glm::dot(way, across) * inverse, v = glm::dot(direction, glm::cross(way, b)) * inverse;
      const double distance = glm::dot(c, glm::cross(way, b)) * inverse;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || distance <= 0.0) continue;
      if (nearest.t >= 0.0f && distance >= static_cast<double>(nearest.t)) continue;
      nearest = {static_cast<float>(distance), i, t, static_cast<float>(u), static_cast<float>(v)};
    }
  }
  return nearest;
}

/// Rays within rounding of an edge may find the other side of it.
struct Comparison {
  int rays = 0, hits = 0, different = 0;
  void add(const Hit& found, const Hit& expected) {
    ++rays;
    hits += expected.t >= 0.0f ? 1 : 0;
    const bool both = found.t >= 0.0f && expected.t >= 0.0f;
    const bool same = both ? found.instance == expected.instance && found.triangle == expected.triangle &&
                                 std::abs(found.t - expected.t) < 1e-4f && std::abs(found.u - expected.u) < 1e-3f &&
                                 std::abs(found.v - expected.v) < 1e-3f
                           : found.t < 0.0f && expected.t < 0.0f;
    different += same ? 0 : 1;
  }
  void expect_agreement() const {
    EXPECT_GT(hits, rays / 5);
    EXPECT_LT(hits, rays);
    EXPECT_LE(different, rays / 1000);
  }
};

}  // namespace lightwell::test
