// How good pictures of every method are for their time: what `lightwell bench quality` measures.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/renderer.h"

namespace lightwell {

/// One way to make a picture.
struct QualityCase {
  std::string series;  // those that belong together: "thesis", "thesis, denoised", "reference"
  std::string setting;
  Settings settings;
  int frames = 1;  // accumulated
};

struct QualityResult {
  std::string series, setting;
  double ms = 0.0;  // of the renderer, after the first picture of the kind; the median of several runs
  double rel_mse = 0.0, rel_mse_trimmed = 0.0, flip = 0.0;
};

struct SceneQuality {
  std::string scene;
  std::vector<QualityResult> results;
};

struct QualityPlan {
  std::vector<std::string> scenes;  // built-in ones, by name
  glm::ivec2 size_px{256, 256};
  int bounces = 2;
  int reference_spp = 1024;
  int runs = 3;
};

/// What is measured on each scene.
std::vector<QualityCase> quality_cases(int bounces);

/// `progress` is told what is made next. The error is the renderer's.
Result<std::vector<SceneQuality>> measure_quality(Renderer& renderer, const QualityPlan& plan,
                                                  const std::function<void(const std::string&)>& progress);

nlohmann::json to_json(const QualityPlan& plan, const std::vector<SceneQuality>& scenes, const std::string& device);

/// Columns for people; also a table of Markdown.
std::string to_text(const std::vector<SceneQuality>& scenes);

}  // namespace lightwell
