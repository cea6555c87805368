// What is given up of a moving picture so that it comes in time: quality first, then resolution, then rate. Pure.
#pragma once

#include <chrono>
#include <glm/glm.hpp>

#include "server/stream/link_pace.h"
#include "server/stream/render_cost.h"

namespace lightwell {

struct PictureGrade {
  int quality = 80;                      // JPEG
  double scale = 1.0;                    // of width and height
  std::chrono::microseconds interval{};  // between pictures, at least

  /// `size_px` scaled, even where it was, never less than 16 pixels unless it was.
  glm::ivec2 scaled(glm::ivec2 size_px) const;
};

/// Chooses a grade from what the link can take and what pictures have cost so far.
class PictureGrader {
 public:
  /// `quality`: where nothing has to be given up.
  explicit PictureGrader(int quality) : full_quality_(quality) {}

  /// A moving picture of the full size times `grade.scale` was rendered and encoded.
  void made(const PictureGrade& grade, double bytes, double render_s);

  /// For what a link takes.
  PictureGrade choose(const LinkPace& pace);

 private:
  int level_for(double budget_bytes) const;
  double scale_for_rendering(double delay_s) const;

  const int full_quality_;
  double full_bytes_ = 0.0;  // of a picture with nothing given up; 0: none was made
  RenderCost render_cost_;
  int level_ = 0;              // what is given up for the link, in steps
  double render_scale_ = 1.0;  // and for rendering
};

}  // namespace lightwell
