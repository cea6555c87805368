// What a frame costs: the median over frames of an animation, and what follows from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/command_line/thesis/printed_tables.h"

namespace lightwell {

struct Frame;

struct StageCost {
  std::string name;
  double ms = 0.0;
};

struct FrameCost {
  double ms = 0.0;
  std::vector<StageCost> stages;
  std::uint64_t rays = 0;  // traced
};

FrameCost cost_of(const Frame& frame);

/// The median of each figure by itself, so that stages need not add up to the frame. Stages stand in the order in
/// which they first appear; one that a frame lacks cost it nothing. `frames` must not be empty.
FrameCost median_cost(const std::vector<FrameCost>& frames);

/// Moments that cover [0, duration_s) evenly however early one stops: the van der Corput points.
double moment_s(int frame, double duration_s);

/// A row of the thesis' tables, measured here.
struct MeasuredRow {
  PrintedRow printed;
  int indirect_side_px = 0;  // the printed one, scaled with the picture
  FrameCost median;
  int frames = 0;        // that the median is over
  double rel_mse = 0.0;  // of a frame against the same with patches of one pixel

  double frames_per_s() const { return 1000.0 / median.ms; }
  /// Above 1: faster than in 2009.
  double ratio() const { return frames_per_s() / printed.frames_per_s; }
  /// Directions whose nearest hit is known after each frame (pixels of the indirect map times samples), a second.
  double rays_resolved_per_s() const;
  double rays_traced_per_s() const;
};

/// A frame of the tessellated terrain.
struct MeasuredTerrain {
  std::uint64_t triangles = 0;
  double first_frame_ms = 0.0;  // with the hierarchies' building and all uploads
  FrameCost median;
  int frames = 0;
  std::optional<FrameCost> brute_force =
      {};  // the same frame with every ray trying every triangle, where it was measured

  double rays_traced_per_s() const;
};

/// What finding the hits takes of a frame: the stages of tracing and of the candidates, in ms.
double tracing_ms(const FrameCost& cost);

/// Everything that `lightwell bench thesis` found.
struct ThesisBench {
  std::string device, tracer;
  unsigned threads = 0;
  int side_px = kPrintedSide_px;
  int bounces = 1;
  std::vector<MeasuredRow> rows;
  int terrain_samples = 0, terrain_indirect_side_px = 0;
  std::vector<MeasuredTerrain> terrains;  // by rising count of triangles
  int patch = 1, triangle_groups = 1;
  int most_brute_triangles = 0;  // up to which brute force was measured as well; 0: not at all
};

}  // namespace lightwell
