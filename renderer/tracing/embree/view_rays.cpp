#include "renderer/tracing/embree/view_rays.h"

#include <algorithm>
#include <cmath>

#include "renderer/tracing/embree/packet.h"

namespace lightwell {
namespace {

// How far beyond a back that is not seen a ray starts anew, relative to the way so far: more than the rounding between
// two ways in which Embree meets the same triangle.
constexpr float kBeyondBack = 4e-6f;

// Rays of a few rows of neighbouring pixels.
template <int width>
class ViewPacket {
 public:
  static constexpr int kColumns = 4, kRows = width / kColumns;

  ViewPacket() { std::fill(std::begin(packet_.ray.mask), std::end(packet_.ray.mask), ~0u); }

  // Those of the pixels from `corner` on that lie within the view.
  void place(const ViewRays& rays, glm::ivec2 corner) {
    auto& r = packet_.ray;
    for (int lane = 0; lane < width; ++lane) {
      const glm::ivec2 pixel = corner + glm::ivec2(lane % kColumns, lane / kColumns);
      const glm::vec2 at(pixel);
      const glm::vec3 origin = rays.origin_ws + at.x * rays.origin_across_ws + at.y * rays.origin_down_ws;
      const glm::vec3 direction = rays.direction_ws + at.x * rays.direction_across_ws + at.y * rays.direction_down_ws;
      r.org_x[lane] = origin.x, r.org_y[lane] = origin.y, r.org_z[lane] = origin.z;
      r.dir_x[lane] = direction.x, r.dir_y[lane] = direction.y, r.dir_z[lane] = direction.z;
      r.tnear[lane] = rays.t_min, r.tfar[lane] = rays.t_max;
      valid_[lane] = pixel.x < rays.size_px.x && pixel.y < rays.size_px.y ? -1 : 0;
      packet_.hit.geomID[lane] = packet_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
      pixels_[lane] = pixel.y * rays.size_px.x + pixel.x;
      active_[lane] = valid_[lane];
    }
  }

  void intersect(const EmbreeScene& scene) {
    EmbreeContext context;
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    context.scene = &scene;
    PacketTypes<width>::kIntersect(active_, scene.top_level(), &context.embree, &packet_);
  }

  // Has the rays go on that meet the back of a triangle which is not seen from there. Whether there are any.
  bool pass_backs(const EmbreeScene& scene) {
    bool any = false;
    for (int lane = 0; lane < width; ++lane) {
      const bool passes = active_[lane] != 0 && is_met(lane) && !scene.is_double_sided(instance(lane, scene)) &&
                          glm::dot(normal(lane, scene), direction(lane)) > 0.0f;
      active_[lane] = passes ? -1 : 0;
      if (!passes) continue;
      any = true;
      packet_.ray.tnear[lane] = packet_.ray.tfar[lane] * (1.0f + kBeyondBack);
      packet_.ray.tfar[lane] = t_max_;
      packet_.hit.geomID[lane] = packet_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    return any;
  }
  void let_go_on_to(float t_max) { t_max_ = t_max; }

  bool is_valid(int lane) const { return valid_[lane] != 0; }
  int pixel(int lane) const { return pixels_[lane]; }
  bool is_met(int lane) const { return packet_.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID; }
  float t(int lane) const { return packet_.ray.tfar[lane]; }
  glm::vec3 direction(int lane) const {
    return {packet_.ray.dir_x[lane], packet_.ray.dir_y[lane], packet_.ray.dir_z[lane]};
  }
  // Not a unit vector; its front is where the winding is counter-clockwise.
  glm::vec3 normal(int lane, const EmbreeScene& scene) const {
    const auto& h = packet_.hit;
    return scene.normal_ws(h.instID[0][lane], {h.Ng_x[lane], h.Ng_y[lane], h.Ng_z[lane]});
  }
  Hit hit(int lane, const EmbreeScene& scene) const {
    if (!is_met(lane)) return {kMiss, 0, 0, 0.0f, 0.0f};
    const auto& h = packet_.hit;
    return {t(lane), instance(lane, scene), h.primID[lane], h.u[lane], h.v[lane]};
  }

 private:
  std::uint32_t instance(int lane, const EmbreeScene& scene) const {
    return scene.instance_of(packet_.hit.instID[0][lane], packet_.hit.geomID[lane]);
  }

  alignas(64) int valid_[width] = {}, active_[width] = {};
  alignas(64) typename PacketTypes<width>::RayHit packet_ = {};
  int pixels_[width] = {};
  float t_max_ = 0.0f;
};

// Calls body(corner) for the packets of a tile.
template <int width, class Body>
void for_packets(glm::ivec2 size_px, std::uint32_t tile, const Body& body) {
  const int columns = (size_px.x + kViewTile_px - 1) / kViewTile_px;
  const glm::ivec2 first =
      kViewTile_px * glm::ivec2(static_cast<int>(tile) % columns, static_cast<int>(tile) / columns);
  const glm::ivec2 end = glm::min(first + kViewTile_px, size_px);
  for (int y = first.y; y < end.y; y += ViewPacket<width>::kRows)
    for (int x = first.x; x < end.x; x += ViewPacket<width>::kColumns) body(glm::ivec2(x, y));
}

// A degenerate camera's: Embree ends the process over them.
bool are_finite(const ViewRays& rays) {
  const glm::vec3 vectors[] = {rays.origin_ws,    rays.origin_across_ws,    rays.origin_down_ws,
                               rays.direction_ws, rays.direction_across_ws, rays.direction_down_ws};
  const glm::vec2 size(rays.size_px);
  const float most = 1e18f / std::max({1.0f, size.x, size.y});
  return std::all_of(std::begin(vectors), std::end(vectors), [&](const glm::vec3& v) {
    return std::abs(v.x) < most && std::abs(v.y) < most && std::abs(v.z) < most;
  });
}

// How t changes from a pixel to its neighbour, whose ray differs by these: both meet the plane of `normal`.
float change_of_t(glm::vec3 normal, glm::vec3 direction, float t, glm::vec3 origin_step, glm::vec3 direction_step) {
  return -glm::dot(normal, origin_step + t * direction_step) / glm::dot(normal, direction);
}

}  // namespace

template <int width>
void camera_hits(const EmbreeScene& scene, const ViewRays& rays, std::uint32_t tile, Hit* hits) {
  const FlushDenormals flush;
  const bool finite = are_finite(rays);
  ViewPacket<width> packet;
  packet.let_go_on_to(rays.t_max);
  for_packets<width>(rays.size_px, tile, [&](glm::ivec2 corner) {
    packet.place(rays, corner);
    if (finite) do
        packet.intersect(scene);
      while (packet.pass_backs(scene));
    for (int lane = 0; lane < width; ++lane)
      if (packet.is_valid(lane)) hits[packet.pixel(lane)] = packet.hit(lane, scene);
  });
}

template <int width>
void view_depths(const EmbreeScene& scene, const ViewRays& rays, DepthMeasure measure, float factor, std::uint32_t tile,
                 ViewDepth* depths) {
  const FlushDenormals flush;
  const bool finite = are_finite(rays);
  ViewPacket<width> packet;
  const auto depth_of = [&](int lane) -> ViewDepth {
    if (!packet.is_met(lane)) return {-1.0f, 0.0f};
    const glm::vec3 normal = packet.normal(lane, scene), direction = packet.direction(lane);
    const float t = packet.t(lane);
    float depth = t;
    glm::vec2 slope(change_of_t(normal, direction, t, rays.origin_across_ws, rays.direction_across_ws),
                    change_of_t(normal, direction, t, rays.origin_down_ws, rays.direction_down_ws));
    if (measure == DepthMeasure::kDistance) {
      const float length = glm::length(direction);
      depth = t * length;
      slope = slope * length +
              t / length *
                  glm::vec2(glm::dot(direction, rays.direction_across_ws), glm::dot(direction, rays.direction_down_ws));
    }
    slope *= factor;
    return {factor * depth, glm::dot(slope, slope)};
  };
  for_packets<width>(rays.size_px, tile, [&](glm::ivec2 corner) {
    packet.place(rays, corner);
    if (finite) packet.intersect(scene);
    for (int lane = 0; lane < width; ++lane)
      if (packet.is_valid(lane)) depths[packet.pixel(lane)] = depth_of(lane);
  });
}

template void camera_hits<4>(const EmbreeScene&, const ViewRays&, std::uint32_t, Hit*);
template void camera_hits<8>(const EmbreeScene&, const ViewRays&, std::uint32_t, Hit*);
template void camera_hits<16>(const EmbreeScene&, const ViewRays&, std::uint32_t, Hit*);
template void view_depths<4>(const EmbreeScene&, const ViewRays&, DepthMeasure, float, std::uint32_t, ViewDepth*);
template void view_depths<8>(const EmbreeScene&, const ViewRays&, DepthMeasure, float, std::uint32_t, ViewDepth*);
template void view_depths<16>(const EmbreeScene&, const ViewRays&, DepthMeasure, float, std::uint32_t, ViewDepth*);

}  // namespace lightwell
