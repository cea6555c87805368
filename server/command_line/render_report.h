// What `render` says about its pictures: metadata in the file, a line or JSON for the caller.
#pragma once

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/renderer.h"

namespace lightwell {

struct RenderArguments;

/// Adds up what the frames of one picture cost.
class PictureCost {
 public:
  void add(const Frame& frame);
  /// Puts the sums in the place of the last frame's own figures.
  void give(Frame& frame) const;

 private:
  std::vector<StageTime> stages_;
  double total_ms_ = 0.0;
  std::uint64_t rays_ = 0;
};

/// The settings that made a picture, as text: they stand in the header of an .exr.
std::map<std::string, std::string> exr_metadata(const RenderArguments& arguments, double time_s, const Frame& frame);

class RenderReport {
 public:
  explicit RenderReport(const RenderArguments& arguments);

  void scene_loaded();
  void renderer_started(Renderer& renderer);
  void add_picture(const std::string& file, double time_s, const Frame& frame);

  /// JSON to stdout if it was asked for, else a line to stderr.
  void print() const;

 private:
  double ms_since_last();
  const RenderArguments& arguments_;
  std::chrono::steady_clock::time_point last_;
  nlohmann::json json_;
  std::size_t pictures_ = 0;
  double total_ms_ = 0.0;
};

}  // namespace lightwell
