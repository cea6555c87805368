#include "renderer/passes/view_rasterizer.h"

#include <algorithm>
#include <array>
#include <bit>

#include "renderer/check.h"
#include "renderer/lanes/affine_triangle.h"

namespace lightwell {
namespace {

constexpr int kRowsAtOnce = 8, kPixelsAtOnce = lanes::kMostRowPixels;
constexpr int kManyPixels = 4096;  // of what surrounds a triangle: more are drawn by several threads

std::uint32_t triangles_of(const Instance& instance) {
  return static_cast<std::uint32_t>(instance.primitive->indices.size() / 3);
}

// But for the place and what is seen there.
lanes::ViewRow row_of(const ViewRays& rays) {
  lanes::ViewRow row;
  lanes::assign(row.origin_ws, rays.origin_ws);
  lanes::assign(row.origin_across_ws, rays.origin_across_ws);
  lanes::assign(row.origin_down_ws, rays.origin_down_ws);
  lanes::assign(row.direction_ws, rays.direction_ws);
  lanes::assign(row.direction_across_ws, rays.direction_across_ws);
  lanes::assign(row.direction_down_ws, rays.direction_down_ws);
  return row;
}

bool is_large(const lanes::ViewTriangle& triangle) {
  return (triangle.last_px[0] - triangle.first_px[0] + 1) * (triangle.last_px[1] - triangle.first_px[1] + 1) >
         kManyPixels;
}

ViewDepth depth_of(std::uint64_t nearest) {
  if (nearest == lanes::kNothingSeen) return {-1.0f, 0.0f};
  return {std::bit_cast<float>(static_cast<std::uint32_t>(nearest >> 32)),
          std::bit_cast<float>(static_cast<std::uint32_t>(nearest))};
}

template <class T>
T* host_of(const ViewRays& rays, gl::Buffer& buffer) {
  const auto pixels = static_cast<std::uint64_t>(rays.size_px.x) * static_cast<std::uint64_t>(rays.size_px.y);
  LIGHTWELL_CHECK(buffer.host() != nullptr);
  LIGHTWELL_CHECK_OP(pixels * sizeof(T), <=, buffer.size_bytes());
  return reinterpret_cast<T*>(buffer.host());
}

}  // namespace

// What a view's pixels look along, and from the world to its pixels.
struct ViewRasterizer::View {
  ViewRays rays;
  lanes::ViewTarget target{};
  glm::dvec3 origin_ws;
  glm::dmat3 view_from_world;
  double front;  // sign of the areas of fronts

  View(const ViewRays& of, std::vector<std::uint64_t>& nearest) : rays(of) {
    nearest.assign(static_cast<std::size_t>(of.size_px.x) * static_cast<std::size_t>(of.size_px.y),
                   lanes::kNothingSeen);
    target.nearest = nearest.data();
    target.width_px = of.size_px.x, target.height_px = of.size_px.y;
    target.is_perspective = of.direction_across_ws != glm::vec3(0.0f);
    target.t_min = std::max(of.t_min, target.is_perspective ? 1e-12f : 0.0f), target.t_max = of.t_max;
    lanes::assign(target.direction_ws, of.direction_ws);
    lanes::assign(target.across_ws, of.direction_across_ws);
    lanes::assign(target.down_ws, of.direction_down_ws);
    const glm::dmat3 world_from_view(target.is_perspective ? of.direction_across_ws : of.origin_across_ws,
                                     target.is_perspective ? of.direction_down_ws : of.origin_down_ws, of.direction_ws);
    origin_ws = of.origin_ws;
    view_from_world = glm::inverse(world_from_view);
    front = glm::determinant(world_from_view) > 0.0 ? -1.0 : 1.0;
  }

  glm::dmat4x3 from_object(const glm::mat4& world_from_object) const {
    const glm::dmat4 world(world_from_object);
    const glm::dmat3 linear = view_from_world * glm::dmat3(world);
    return {linear[0], linear[1], linear[2], view_from_world * (glm::dvec3(world[3]) - origin_ws)};
  }

  // 0 where both sides are seen.
  double front_of(const Instance& instance, const Coverage& coverage) const {
    if (target.as_depths || coverage.double_sided) return 0.0;
    return glm::determinant(glm::mat3(instance.world_from_object)) < 0.0f ? -front : front;
  }
};

void ViewRasterizer::update(const TraceScene& scene) {
  scene_ = scene;
  views_drawn_ = 0;
  first_numbers_.clear();
  chunks_.clear();
  std::uint32_t number = 0;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const std::uint32_t count = triangles_of(scene.instances[i]);
    first_numbers_.push_back(number);
    for (std::uint32_t first = 0; first < count; first += lanes::kMostViewTriangles)
      chunks_.push_back({i, first, std::min(count - first, lanes::kMostViewTriangles)});
    number += count;
  }
  first_numbers_.push_back(number);
}

void ViewRasterizer::camera_hits(const ViewRays& rays, gl::Buffer& hits) {
  gl::wait_for_device();
  camera_hits(rays, host_of<Hit>(rays, hits));
}

void ViewRasterizer::depths(const ViewRays& rays, DepthMeasure measure, float factor, gl::Buffer& depths) {
  gl::wait_for_device();
  this->depths(rays, measure, factor, host_of<ViewDepth>(rays, depths));
}

void ViewRasterizer::camera_hits(const ViewRays& rays, Hit* hits) {
  const View view(rays, nearest_);
  draw(view);
  host_.parallel_for(static_cast<std::uint32_t>(rays.size_px.y), kRowsAtOnce,
                     [&](std::uint32_t begin, std::uint32_t end) {
                       for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                         for (int x = 0; x < rays.size_px.x; x += kPixelsAtOnce)
                           find_hits(view, {x, y}, std::min(kPixelsAtOnce, rays.size_px.x - x), hits);
                     });
}

void ViewRasterizer::depths(const ViewRays& rays, DepthMeasure measure, float factor, ViewDepth* depths) {
  View view(rays, nearest_);
  view.target.as_depths = true;
  view.target.as_distance = measure == DepthMeasure::kDistance;
  view.target.factor = factor;
  draw(view);
  constexpr std::uint32_t kPixelsOfAChunk = 8192;
  host_.parallel_for(static_cast<std::uint32_t>(nearest_.size()), kPixelsOfAChunk,
                     [&](std::uint32_t begin, std::uint32_t end) {
                       for (std::uint32_t i = begin; i < end; ++i) depths[i] = depth_of(nearest_[i]);
                     });
}

void ViewRasterizer::draw(const View& view) {
  ++views_drawn_;
  large_.clear();
  exact_.clear();
  host_.parallel_for(static_cast<std::uint32_t>(chunks_.size()), 1,
                     [&](std::uint32_t chunk, std::uint32_t) { draw_chunk(view, chunks_[chunk]); });
  if (large_.empty() && exact_.empty()) return;
  host_.parallel_for(static_cast<std::uint32_t>(view.target.height_px), kRowsAtOnce,
                     [&](std::uint32_t begin, std::uint32_t end) {
                       const int first = static_cast<int>(begin), last = static_cast<int>(end) - 1;
                       for (const lanes::ViewTriangle& triangle : large_)
                         kernels_.fill(triangle, view.target, std::max(first, triangle.first_px[1]),
                                       std::min(last, triangle.last_px[1]));
                       for (const ExactViewTriangle& triangle : exact_) triangle.draw(view.target, first, last + 1);
                     });
}

void ViewRasterizer::draw_chunk(const View& view, const Chunk& chunk) {
  const Instance& instance = scene_.instances[chunk.instance];
  lanes::ViewTriangles triangles;
  triangles.positions = &positions_of(instance).front().x;
  triangles.indices = &instance.primitive->indices[std::size_t{3} * chunk.first];
  triangles.count = chunk.count;
  triangles.first_number = first_numbers_[chunk.instance] + chunk.first;
  const glm::dmat4x3 from_object = view.from_object(instance.world_from_object);
  const double front = view.front_of(instance, scene_.coverage[chunk.instance]);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      triangles.rows[row][column] = static_cast<float>(from_object[column][row]);
  triangles.front = static_cast<float>(front);
  thread_local lanes::ViewLeftovers left;
  left.large_count = left.beyond_count = 0;
  kernels_.draw(triangles, view.target, left);
  std::uint32_t large = 0;
  for (std::uint32_t i = 0; i < left.large_count; ++i)
    if (is_large(left.large[i]))
      left.large[large++] = left.large[i];
    else
      kernels_.fill(left.large[i], view.target, left.large[i].first_px[1], left.large[i].last_px[1]);
  left.large_count = large;
  keep_for_later(left, triangles, from_object, front, view.target);
}

// What takes several threads.
void ViewRasterizer::keep_for_later(const lanes::ViewLeftovers& left, const lanes::ViewTriangles& triangles,
                                    const glm::dmat4x3& from_object, double front, const lanes::ViewTarget& target) {
  if (left.large_count == 0 && left.beyond_count == 0) return;
  std::vector<ExactViewTriangle> exact;
  for (std::uint32_t i = 0; i < left.beyond_count; ++i) {
    const std::uint32_t* indices = triangles.indices + std::size_t{3} * (left.beyond[i] - triangles.first_number);
    std::array<glm::dvec3, 3> corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const float* position = triangles.positions + std::size_t{3} * indices[corner];
      corners[corner] = from_object * glm::dvec4(position[0], position[1], position[2], 1.0);
    }
    if (const ExactViewTriangle triangle(corners, front, left.beyond[i], target); triangle.is_in_picture())
      exact.push_back(triangle);
  }
  std::lock_guard lock(mutex_);
  large_.insert(large_.end(), left.large, left.large + left.large_count);
  exact_.insert(exact_.end(), exact.begin(), exact.end());
}

// `guess`: that of a pixel nearby.
std::uint32_t ViewRasterizer::instance_of(std::uint32_t number, std::uint32_t guess) const {
  if (number >= first_numbers_[guess] && number < first_numbers_[guess + 1]) return guess;
  return static_cast<std::uint32_t>(std::upper_bound(first_numbers_.begin(), first_numbers_.end(), number) -
                                    first_numbers_.begin() - 1);
}

// Of some pixels of a row at once: what they see lies all over the memory, and is fetched before it is looked at.
void ViewRasterizer::find_hits(const View& view, glm::ivec2 first, int count, Hit* hits) const {
  std::array<const std::uint32_t*, kPixelsAtOnce> indices;
  const std::size_t begin = static_cast<std::size_t>(first.y) * static_cast<std::size_t>(view.rays.size_px.x) +
                            static_cast<std::size_t>(first.x);
  std::uint32_t instance = 0;
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::uint64_t nearest = nearest_[begin + at];
    const auto number = static_cast<std::uint32_t>(nearest);
    hits[begin + at] = {kMiss, 0, 0, 0.0f, 0.0f};
    if (nearest == lanes::kNothingSeen) continue;
    instance = instance_of(number, instance);
    const std::uint32_t triangle = number - first_numbers_[instance];
    indices[at] = &scene_.instances[instance].primitive->indices[std::size_t{3} * triangle];
    __builtin_prefetch(indices[at]);
    hits[begin + at] = {std::bit_cast<float>(static_cast<std::uint32_t>(nearest >> 32)), instance, triangle, 0.0f,
                        0.0f};
  }
  const auto for_hits = [&](const auto& body) {
    for (int i = 0; i < count; ++i)
      if (Hit& hit = hits[begin + static_cast<std::size_t>(i)]; hit.t >= 0.0f)
        body(i, hit, indices[static_cast<std::size_t>(i)]);
  };
  for_hits([&](int, const Hit& hit, const std::uint32_t* corners) {
    const std::span<const glm::vec3> positions = positions_of(scene_.instances[hit.instance]);
    for (int corner = 0; corner < 3; ++corner) __builtin_prefetch(&positions[corners[corner]]);
  });
  find_barycentrics(view.rays, first, {hits + begin, static_cast<std::size_t>(count)});
}

// A kernel's call for as many pixels side by side as see one instance, or nothing.
void ViewRasterizer::find_barycentrics(const ViewRays& rays, glm::ivec2 first, std::span<Hit> hits) const {
  lanes::ViewRow row = row_of(rays);
  row.y = static_cast<float>(first.y);
  std::size_t done = 0;
  while (done < hits.size()) {
    std::size_t end = done, seen = hits.size();
    for (; end < hits.size(); ++end) {
      if (hits[end].t < 0.0f) continue;
      if (seen == hits.size()) seen = end;
      if (hits[end].instance != hits[seen].instance) break;
    }
    if (seen == hits.size()) return;
    const Instance& instance = scene_.instances[hits[seen].instance];
    row.positions = &positions_of(instance).data()->x;
    row.indices = instance.primitive->indices.data();
    for (int column = 0; column < 4; ++column)
      lanes::assign(row.world_from_object[column], glm::vec3(instance.world_from_object[column]));
    row.x = static_cast<float>(first.x + static_cast<int>(done));
    row.count = static_cast<std::uint32_t>(end - done);
    std::fill(std::begin(row.triangle), std::end(row.triangle), hits[seen].triangle);
    for (std::size_t i = seen; i < end; ++i)
      if (hits[i].t >= 0.0f) row.triangle[i - done] = hits[i].triangle;
    kernels_.find_barycentrics(row);
    for (std::size_t i = seen; i < end; ++i)
      if (hits[i].t >= 0.0f) hits[i].u = row.u[i - done], hits[i].v = row.v[i - done];
    done = end;
  }
}

}  // namespace lightwell
