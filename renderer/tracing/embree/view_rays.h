// The rays of views, in packets of neighbouring pixels. See ViewTracer.
#pragma once

#include "renderer/tracing/embree/embree_scene.h"
#include "renderer/tracing/tracer.h"
#include "renderer/tracing/view_tracer.h"

namespace lightwell {

/// Side of the square of pixels that one call looks after.
constexpr int kViewTile_px = 16;

/// How many of them cover a view: they are numbered row by row.
inline std::uint32_t view_tiles(glm::ivec2 size_px) {
  const glm::uvec2 tiles((size_px + kViewTile_px - 1) / kViewTile_px);
  return tiles.x * tiles.y;
}

/// `width`: rays that Embree takes at once.
template <int width>
void camera_hits(const EmbreeScene& scene, const ViewRays& rays, std::uint32_t tile, Hit* hits);

template <int width>
void view_depths(const EmbreeScene& scene, const ViewRays& rays, DepthMeasure measure, float factor, std::uint32_t tile,
                 ViewDepth* depths);

}  // namespace lightwell
