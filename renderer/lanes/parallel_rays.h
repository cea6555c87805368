// Rays along one direction against triangles. For files that are compiled for a kind of processor: see
// renderer/lanes/glsl.h.
#pragma once

#include "renderer/lanes/rows.h"

namespace lightwell::lanes {
namespace {

constexpr float kNothing = __builtin_inff();
constexpr float kEdgeTolerance = 1e-6f;  // of barycentrics: rounding, so that no ray passes between two triangles

// A child of a node that may be met, and from where on: the bits of a distance, which is not negative, before its
// number. Nearer ones are less.
using Pending = std::uint64_t;

[[maybe_unused]] std::uint32_t bits_of(float distance) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &distance, sizeof bits);
  return bits;
}

// What rays have met so far.
struct MetRows {
  PixelFloats &t, &u, &v;
  PixelWords& number;
};

// Keeps the triangle where it is met nearer than what is kept. False if it is nowhere.
bool meet_rays(const PixelFloats* from, const MetRows& met, PixelRun run, const AffineTriangle& triangle,
               std::uint32_t number) {
  const vec3 corner = all_lanes(triangle.corner);
  const vec3 u_axis = all_lanes(triangle.u), v_axis = all_lanes(triangle.v), t_axis = all_lanes(triangle.t);
  bool any_nearer = false;
  for (std::uint32_t i = run.begin; i < run.end; i += kLanes) {
    const vec3 way = load_vec3(from, i) - corner;
    const Float u = dot(way, u_axis), v = dot(way, v_axis), t = dot(way, t_axis);
    const Float t_before = load_float(&met.t[i]);
    const Mask nearer =
        u >= -kEdgeTolerance && v >= -kEdgeTolerance && u + v <= 1.0f + kEdgeTolerance && t > 0.0 && t < t_before;
    if (!any(nearer)) continue;
    any_nearer = true;
    store(&met.t[i], select(nearer, t, t_before).v);
    store(&met.u[i], select(nearer, max(u, 0.0), load_float(&met.u[i])).v);
    store(&met.v[i], select(nearer, max(v, 0.0), load_float(&met.v[i])).v);
    const Ints numbers = Ints{} + static_cast<std::int32_t>(number);
    store(&met.number[i], select(nearer, numbers, load<Ints>(&met.number[i])));
  }
  return any_nearer;
}

// AffineTriangle, one a lane.
struct AffineTriangles {
  vec3 corner, u, v, t;
};

vec3 load_wide(const float (&rows)[3][kWide], int first) {
  return {load_float(&rows[0][first]), load_float(&rows[1][first]), load_float(&rows[2][first])};
}

// Of a ray in a triangle's plane the quotient is infinite: nothing compares true with what comes of it.
AffineTriangles affine_triangles(const WideLeaf& leaf, int first, vec3 direction) {
  const vec3 normal = load_wide(leaf.normal, first);
  const Float inverse = 1.0f / -dot(normal, direction);
  return {load_wide(leaf.corner, first), cross(direction, load_wide(leaf.to_third, first)) * inverse,
          cross(load_wide(leaf.to_second, first), direction) * inverse, normal * inverse};
}

// A bit for each triangle that a ray from within the box may meet before `far`.
std::uint32_t may_be_met(const AffineTriangles& triangles, vec3 center, vec3 half_size, float far) {
  const vec3 way = center - triangles.corner;
  const auto reach = [&](vec3 axis) { return dot(abs(axis), half_size) + kEdgeTolerance; };
  const Float u = dot(way, triangles.u), v = dot(way, triangles.v), t = dot(way, triangles.t);
  const Float u_reach = reach(triangles.u), v_reach = reach(triangles.v), t_reach = reach(triangles.t);
  return lane_bits(u >= -u_reach && v >= -v_reach && u + v <= 1.0f + u_reach + v_reach && t >= -t_reach &&
                   t - t_reach <= far);
}

// The triangles of a leaf that rays from a box meet, for every ray.
class ParallelLeaf {
 public:
  explicit ParallelLeaf(ParallelRays& rays) : rays_(rays), direction_(all_lanes(rays.direction_ws)) {
    start();
    for (int axis = 0; axis < 3; ++axis) find_bounds(axis);
    center_ = 0.5f * (all_lanes(least) + all_lanes(greatest));
    half_size_ = 0.5f * (all_lanes(greatest) - all_lanes(least)) * 1.000001f;
  }

  float least[3], greatest[3];  // of the origins

  // How far the farthest ray still looks, once the leaf has been tried.
  float try_leaf(const WideLeaf& leaf, std::uint32_t number, float far) {
    bool any_nearer = false;
    for (int first = 0; first < kWide; first += kLanes) {
      const AffineTriangles triangles = affine_triangles(leaf, first, direction_);
      std::uint32_t met = may_be_met(triangles, center_, half_size_, far);
      if (met == 0) continue;
      alignas(64) float rows[12][kLanes];
      const vec3 vectors[] = {triangles.corner, triangles.u, triangles.v, triangles.t};
      for (int i = 0; i < 4; ++i)
        store(rows[3 * i], vectors[i].x.v), store(rows[3 * i + 1], vectors[i].y.v),
            store(rows[3 * i + 2], vectors[i].z.v);
      for (; met != 0; met &= met - 1) {
        const int lane = __builtin_ctz(met);
        const auto vector = [&](int row, float(&to)[3]) {
          for (int axis = 0; axis < 3; ++axis) to[axis] = rows[3 * row + axis][lane];
        };
        AffineTriangle triangle;
        vector(0, triangle.corner), vector(1, triangle.u), vector(2, triangle.v), vector(3, triangle.t);
        any_nearer |= meet_rays(rays_.from, {rays_.t, rays_.u, rays_.v, rays_.triangle}, {0, rays_.count}, triangle,
                                number * kWide + static_cast<std::uint32_t>(first + lane));
      }
    }
    return any_nearer ? farthest() : far;
  }

 private:
  // Lanes beyond the last ray never meet anything.
  void start() {
    for (std::uint32_t i = 0; i < rays_.count; i += kLanes)
      store(&rays_.t[i], select(in_run(i, {0, rays_.count}), kNothing, 0.0).v);
  }

  void find_bounds(int axis) {
    const float* row = rays_.from[axis];
    Float low = row[0], high = row[0];
    for (std::uint32_t i = 0; i < rays_.count; i += kLanes) {
      const Mask used = in_run(i, {0, rays_.count});
      const Float here = load_float(&row[i]);
      low = select(used, min(low, here), low), high = select(used, max(high, here), high);
    }
    least[axis] = least_lane(low), greatest[axis] = -least_lane(-high);
  }

  float farthest() const {
    Float far = 0.0;
    for (std::uint32_t i = 0; i < rays_.count; i += kLanes) far = max(far, load_float(&rays_.t[i]));
    return -least_lane(-far);
  }

  ParallelRays& rays_;
  const vec3 direction_;
  vec3 center_, half_size_;
};

}  // namespace
}  // namespace lightwell::lanes
