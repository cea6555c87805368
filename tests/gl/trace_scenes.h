// Scenes and rays for the tracers' tests and benchmarks, made in code and seeded.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "renderer/tracing/tracer.h"

namespace lightwell::test {

/// A world that owns what a TraceScene looks at.
struct TraceWorld {
  std::string name;
  std::vector<Instance> instances;
  std::vector<Coverage> coverage;
  glm::vec3 bounds_min{-10.0f}, bounds_max{10.0f};  // where random rays start

  DevicePositions positions{};  // of deformed instances, where a test brings them to the device

  TraceScene scene() const { return {instances, coverage, positions}; }
  void add(std::shared_ptr<const Primitive> primitive, const glm::mat4& world_from_object = glm::mat4(1.0f),
           Coverage covered = {});
};

/// `count` triangles of about `size` in a cube of half-width 10, with texture coordinates.
std::shared_ptr<Primitive> random_triangles(std::uint32_t count, float size, std::uint32_t seed);

/// A closed, bumpy shell of 2 * side * side triangles around the origin, radius about 8: seen from inside it hides
/// itself often enough for rays to be as varied as in a room.
std::shared_ptr<Primitive> bumpy_shell(std::uint32_t side);

/// A height field of 2 * side * side triangles over the square of half-width 10.
std::shared_ptr<Primitive> terrain(std::uint32_t side);

/// Origins anywhere in the bounds, directions over the whole sphere.
std::vector<Ray> random_rays(const TraceWorld& world, std::uint32_t count, std::uint32_t seed);

/// Rays of a square pin-hole camera of 90 degrees at `eye` that looks along -Z, row by row.
std::vector<Ray> camera_rays(glm::vec3 eye, std::uint32_t width_px);

/// Cosine-distributed rays, `per_point` from each of the points that `first` hit, on the side they came from.
std::vector<Ray> diffuse_rays(const TraceWorld& world, const std::vector<Ray>& first, const std::vector<Hit>& hits,
                              std::uint32_t per_point, std::uint32_t seed);

/// The nearest hit by trying every triangle in double precision, opaque ones only; `second_t` is the distance of the
/// next triangle on the same ray (infinite if there is none).
struct BruteHit {
  Hit hit;
  double second_t;
};
BruteHit brute_force(const TraceWorld& world, const Ray& ray);

/// Where a ray meets the plane of the triangle it hit, in double precision.
struct PlaneDistance {
  double distance_m;
  double cosine;                // of the ray with the plane's normal, 0 to 1
  double largest_coordinate_m;  // of the ray's origin and the triangle, in the world or the object
};
PlaneDistance plane_distance(const TraceWorld& world, const Ray& ray, const Hit& hit);

}  // namespace lightwell::test
