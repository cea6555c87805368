// What is given up of a moving picture so that it comes in time: quality first, then resolution, then rate. Pure.
#pragma once

#include <chrono>
#include <deque>
#include <glm/glm.hpp>

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

  /// For a link on which `budget_bytes` arrive in time and that carries `bytes_per_s` (0: not known).
  PictureGrade choose(double budget_bytes, double bytes_per_s);

 private:
  int level_for(double budget_bytes) const;
  double scale_for_rendering() const;
  double usual_render_s() const;

  const int full_quality_;
  double full_bytes_ = 0.0;           // of a picture with nothing given up; 0: none was made
  std::deque<double> full_render_s_;  // times to render one, the last three: a shader that is new is slow only once
  int level_ = 0;                     // what is given up for the link, in steps
  double render_scale_ = 1.0;         // and for rendering
};

}  // namespace lightwell
