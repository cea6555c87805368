// Compiled once for each kind of processor, without products and sums in one rounding: so what an edge is to a pixel is
// for the triangle on its other side just the opposite, and no pixel falls between the two. Edge functions: Pineda
// 1988.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif

#include "renderer/lanes/view_triangles.h"
#include "renderer/lanes/rows.h"

namespace lightwell::lanes {
namespace {

constexpr std::int32_t kFewPixels = 4;  // across and down: larger ones are drawn row by row
constexpr float kFar_px = 16384.0f;     // from here on floats are too coarse
constexpr float kSlack_px = 1e-4f;      // of what is around a triangle

// A triangle in each lane, or one in all.
struct Corners {
  Float x[3], y[3], q[3];
  Float inverse_area;
};

Ints gathered_words(const std::uint32_t* from, Ints places) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  const __m512i at = reinterpret_cast<__m512i>(places);
  return Ints(_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff, at, from, 4));
#else
  Ints words;
  for (int i = 0; i < kLanes; ++i) words[i] = static_cast<std::int32_t>(from[places[i]]);
  return words;
#endif
}

// To the last bit, as the estimates of glsl.h are not.
Float exact_quotient(Float a, Float b) {
  return a.v / b.v;
}

Float edge(Float ax, Float ay, Float bx, Float by, Float x, Float y) {
  const Float one = (ax - x) * (by - y), other = (bx - x) * (ay - y);
  return one - other;
}

Mask covers(const Corners& c, Float x, Float y, Float& q) {
  const Float a = edge(c.x[1], c.y[1], c.x[2], c.y[2], x, y) * c.inverse_area;
  const Float b = edge(c.x[2], c.y[2], c.x[0], c.y[0], x, y) * c.inverse_area;
  const Float d = edge(c.x[0], c.y[0], c.x[1], c.y[1], x, y) * c.inverse_area;
  q = a * c.q[0] + b * c.q[1] + d * c.q[2];
  return a >= 0.0 && b >= 0.0 && d >= 0.0;
}

// How q changes from a pixel to the next.
vec2 slope_of_q(const Corners& c) {
  const Float first = c.q[0] - c.q[2], second = c.q[1] - c.q[2];
  return {((c.y[1] - c.y[2]) * first + (c.y[2] - c.y[0]) * second) * c.inverse_area,
          ((c.x[2] - c.x[1]) * first + (c.x[0] - c.x[2]) * second) * c.inverse_area};
}

struct Depths {
  Float depth, slope2;
};

Depths depths_at(const ViewTarget& target, const Corners& c, Float x, Float y, Float t) {
  vec2 slope = slope_of_q(c) * (target.is_perspective ? -(t * t) : Float(1.0f));
  if (!target.as_distance) {
    slope = slope * target.factor;
    return {t * target.factor, slope.x * slope.x + slope.y * slope.y};
  }
  const vec3 across = all_lanes(target.across_ws), down = all_lanes(target.down_ws);
  const vec3 direction = all_lanes(target.direction_ws) + x * across + y * down;
  const Float distance = length(direction), share = t / distance;
  slope = vec2(slope.x * distance + share * dot(direction, across), slope.y * distance + share * dot(direction, down)) *
          target.factor;
  return {t * distance * target.factor, slope.x * slope.x + slope.y * slope.y};
}

void keep_nearest(std::uint64_t& kept, std::uint64_t seen) {
  std::uint64_t before = __atomic_load_n(&kept, __ATOMIC_RELAXED);
  while (seen < before &&
         !__atomic_compare_exchange_n(&kept, &before, seen, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
}

// Keeps the triangle at the pixels (x, y) where it is wanted, covers the middle and is nearest so far.
void draw_pixels(const ViewTarget& target, const Corners& corners, Mask wanted, Float x, Float y, Ints numbers) {
  Float q;
  Mask covered = covers(corners, x, y, q) && wanted;
  if (!any(covered)) return;
  const Float t = target.is_perspective ? exact_quotient(1.0f, q) : q;
  covered = covered && t >= target.t_min && t <= target.t_max;
  Float depth = t;
  if (target.as_depths) {
    const Depths depths = depths_at(target, corners, x, y, t);
    depth = depths.depth;
    numbers = Ints(depths.slope2.v);
  }
  alignas(64) std::uint32_t high[kLanes], low[kLanes], place[kLanes];
  store(high, depth.v), store(low, numbers), store(place, truncated(y) * target.width_px + truncated(x));
  for (std::uint32_t left = lane_bits(covered); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    keep_nearest(target.nearest[place[lane]], std::uint64_t{high[lane]} << 32 | low[lane]);
  }
}

// Triangles in the picture, one a lane.
struct Projected {
  Corners corners;
  Mask is_seen, is_beyond;
  Ints first[2], last[2];  // column and row of the pixels whose middles they may cover

  Projected(const ViewTriangles& triangles, const ViewTarget& target, Ints which, Mask used) {
    Mask any_before = false, all_before = true;
    for (int corner = 0; corner < 3; ++corner)
      project(triangles, target, which * 3 + corner, corner, any_before, all_before);
    const Float* x = corners.x;
    const Float* y = corners.y;
    const Mask is_near = inside(x) && inside(y);
    const Mask overlaps_x = bound(x, 0, target.width_px), overlaps_y = bound(y, 1, target.height_px);
    const Float area = edge(x[1], y[1], x[2], y[2], x[0], y[0]);
    corners.inverse_area = exact_quotient(1.0f, area);
    const Mask faces = triangles.front != 0.0f ? area * triangles.front > 0.0 : !equal(Ints(abs(area).v), Ints{});
    is_beyond = used && any_before && !(all_before && is_near);
    is_seen = used && all_before && is_near && overlaps_x && overlaps_y && faces;
  }

 private:
  void project(const ViewTriangles& triangles, const ViewTarget& target, Ints place, int corner, Mask& any_before,
               Mask& all_before) {
    const Ints vertex = gathered_words(triangles.indices, place) * 3;
    const vec3 position(gathered(triangles.positions, vertex), gathered(triangles.positions, vertex + 1),
                        gathered(triangles.positions, vertex + 2));
    const auto row = [&](int i) {
      const float* r = triangles.rows[i];
      return position.x * r[0] + position.y * r[1] + position.z * r[2] + r[3];
    };
    corners.x[corner] = row(0), corners.y[corner] = row(1), corners.q[corner] = row(2);
    if (!target.is_perspective) {
      any_before = true;
      return;
    }
    const Mask is_before = corners.q[corner] > target.t_min;
    any_before = any_before || is_before;
    all_before = all_before && is_before;
    const Float inverse = exact_quotient(1.0f, corners.q[corner]);
    corners.x[corner] *= inverse, corners.y[corner] *= inverse, corners.q[corner] = inverse;
  }

  static Mask inside(const Float* values) { return max(max(abs(values[0]), abs(values[1])), abs(values[2])) < kFar_px; }

  // Whether there are any.
  Mask bound(const Float* values, int axis, std::int32_t size_px) {
    const Float least = min(min(values[0], values[1]), values[2]) - kSlack_px;
    const Float greatest = max(max(values[0], values[1]), values[2]) + kSlack_px;
    first[axis] = truncated(clamp(least, -1.0f, size_px) + 1.0f);
    last[axis] = truncated(clamp(greatest, -1.0f, size_px - 1) + 1.0f) - 1;
    return !less(last[axis], first[axis]);
  }
};

void draw_small(const ViewTarget& target, const Projected& seen, Mask small, Ints numbers) {
  for (std::int32_t down = 0; down < kFewPixels; ++down) {
    const Ints y = seen.first[1] + down;
    const Mask in_row = small && !less(seen.last[1], y);
    if (!any(in_row)) return;
    for (std::int32_t across = 0; across < kFewPixels; ++across) {
      const Ints x = seen.first[0] + across;
      const Mask wanted = in_row && !less(seen.last[0], x);
      if (!any(wanted)) break;
      draw_pixels(target, seen.corners, wanted, to_float(x), to_float(y), numbers);
    }
  }
}

void leave_large(const Projected& seen, std::uint32_t large, std::uint32_t first_number, ViewLeftovers& leftovers) {
  for (; large != 0; large &= large - 1) {
    const int lane = __builtin_ctz(large);
    ViewTriangle& triangle = leftovers.large[leftovers.large_count++];
    for (int corner = 0; corner < 3; ++corner) {
      triangle.x[corner] = seen.corners.x[corner].v[lane];
      triangle.y[corner] = seen.corners.y[corner].v[lane];
      triangle.q[corner] = seen.corners.q[corner].v[lane];
    }
    triangle.number = first_number + static_cast<std::uint32_t>(lane);
    for (int axis = 0; axis < 2; ++axis)
      triangle.first_px[axis] = seen.first[axis][lane], triangle.last_px[axis] = seen.last[axis][lane];
  }
}

void draw(const ViewTriangles& triangles, const ViewTarget& target, ViewLeftovers& leftovers) {
  for (std::uint32_t i = 0; i < triangles.count; i += kLanes) {
    const Mask used = in_run(i, {0, triangles.count});
    const auto first = static_cast<std::int32_t>(i), last = static_cast<std::int32_t>(triangles.count - 1);
    const Projected seen(triangles, target, select(used, lane_numbers() + first, Ints{} + last), used);
    const std::uint32_t first_number = triangles.first_number + i;
    for (std::uint32_t left = lane_bits(seen.is_beyond); left != 0; left &= left - 1)
      leftovers.beyond[leftovers.beyond_count++] = first_number + static_cast<std::uint32_t>(__builtin_ctz(left));
    if (!any(seen.is_seen)) continue;
    const Mask few = less(seen.last[0] - seen.first[0], Ints{} + kFewPixels) &&
                     less(seen.last[1] - seen.first[1], Ints{} + kFewPixels);
    draw_small(target, seen, seen.is_seen && few, lane_numbers() + static_cast<std::int32_t>(first_number));
    leave_large(seen, lane_bits(seen.is_seen && !few), first_number, leftovers);
  }
}

void fill(const ViewTriangle& triangle, const ViewTarget& target, std::int32_t first_px, std::int32_t last_px) {
  Corners corners;
  for (int corner = 0; corner < 3; ++corner)
    corners.x[corner] = triangle.x[corner], corners.y[corner] = triangle.y[corner],
    corners.q[corner] = triangle.q[corner];
  corners.inverse_area =
      exact_quotient(1.0f, edge(corners.x[1], corners.y[1], corners.x[2], corners.y[2], corners.x[0], corners.y[0]));
  const Ints numbers = Ints{} + static_cast<std::int32_t>(triangle.number);
  const Ints beyond = Ints{} + (triangle.last_px[0] + 1);
  for (std::int32_t row = first_px; row <= last_px; ++row)
    for (std::int32_t column = triangle.first_px[0]; column <= triangle.last_px[0]; column += kLanes) {
      const Ints x = lane_numbers() + column;
      draw_pixels(target, corners, less(x, beyond), to_float(x), Float(row), numbers);
    }
}

// Where the pixel's ray meets the triangle's plane: Moeller and Trumbore 1997. Clamped, for a sliver's may lie
// anywhere.
void find_barycentrics(ViewRow& row) {
  const vec3 right = all_lanes(row.world_from_object[0]), up = all_lanes(row.world_from_object[1]),
             back = all_lanes(row.world_from_object[2]), place = all_lanes(row.world_from_object[3]);
  const Float y = row.y;
  for (std::uint32_t i = 0; i < row.count; i += kLanes) {
    const Ints indices = load<Ints>(&row.triangle[i]) * 3;
    const auto corner_ws = [&](int corner) {
      const Ints vertex = gathered_words(row.indices, indices + corner) * 3;
      return right * gathered(row.positions, vertex) + up * gathered(row.positions, vertex + 1) +
             (back * gathered(row.positions, vertex + 2) + place);
    };
    const Float x = row.x + to_float(lane_numbers() + static_cast<std::int32_t>(i));
    const vec3 corner = corner_ws(0), b = corner_ws(1) - corner, c = corner_ws(2) - corner;
    const vec3 way =
        all_lanes(row.origin_ws) + x * all_lanes(row.origin_across_ws) + y * all_lanes(row.origin_down_ws) - corner;
    const vec3 direction =
        all_lanes(row.direction_ws) + x * all_lanes(row.direction_across_ws) + y * all_lanes(row.direction_down_ws);
    const vec3 across = cross(direction, c);
    const Float inverse = exact_quotient(1.0f, dot(b, across));
    const Float u = dot(way, across) * inverse, v = dot(direction, cross(way, b)) * inverse;
    const Float clamped = select(u > 0.0, min(u, 1.0), 0.0);
    store(&row.u[i], clamped.v);
    store(&row.v[i], select(v > 0.0, min(v, 1.0f - clamped), 0.0).v);
  }
}

}  // namespace

extern const ViewKernels LIGHTWELL_LANES_TABLE(ViewKernels);
const ViewKernels LIGHTWELL_LANES_TABLE(ViewKernels) = {kInstructions, draw, fill, find_barycentrics};

}  // namespace lightwell::lanes
