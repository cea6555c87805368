#include "server/command_line/quality_table.h"

#include <algorithm>
#include <cstdio>

#include "renderer/image_metrics/compare.h"
#include "renderer/scene/builtin.h"
#include "server/serve.h"

namespace lightwell {

namespace {

constexpr std::uint32_t kSeedOfReference = 1u << 30;  // apart from those of the pictures that it judges

struct Made {
  metrics::Picture picture;
  double ms = 0.0;
};

Result<Made> make_picture(Renderer& renderer, RenderView& view, const Scene& scene, FrameRequest request, int frames) {
  Made made;
  request.want_display = false;
  request.is_unseen = true;
  for (int i = 0; i < warm_up_frames(request.settings); ++i) {
    const Result<Frame> frame = renderer.render(scene, request, view);
    if (!frame) return frame.error();
    made.ms += frame->total_ms;
  }
  request.is_unseen = false;
  for (int i = 0; i < frames; ++i) {
    request.accumulate = i > 0;
    request.want_linear = i + 1 == frames;
    Result<Frame> frame = renderer.render(scene, request, view);
    if (!frame) return frame.error();
    made.ms += frame->total_ms;
    if (request.want_linear) made.picture = {request.size_px.x, request.size_px.y, std::move(frame->linear_rgb)};
  }
  return made;
}

Result<QualityResult> measure_case(Renderer& renderer, const Scene& scene, FrameRequest request,
                                   const QualityCase& what, const QualityPlan& plan, const metrics::Picture& truth) {
  request.settings = what.settings;
  // Shaders are compiled with the first picture.
  if (const Result<Made> first = make_picture(renderer, *renderer.make_view(), scene, request, 1); !first)
    return first.error();
  std::vector<double> times;
  Made last;
  for (int run = 0; run < plan.runs; ++run) {
    // From a standing start each: a view knows its earlier frames.
    const std::unique_ptr<RenderView> view = renderer.make_view();
    Result<Made> made = make_picture(renderer, *view, scene, request, what.frames);
    if (!made) return made.error();
    times.push_back(made->ms);
    last = std::move(made).value();
  }
  std::sort(times.begin(), times.end());
  const Result<metrics::Comparison> comparison = metrics::compare(last.picture, truth);
  if (!comparison) return comparison.error();
  return QualityResult{what.series,
                       what.setting,
                       times[times.size() / 2],
                       comparison->linear.rel_mse,
                       comparison->linear.rel_mse_trimmed,
                       comparison->flip};
}

Result<SceneQuality> measure_scene(Renderer& renderer, const std::string& name, const QualityPlan& plan,
                                   const std::function<void(const std::string&)>& progress) {
  const Result<Scene> scene = builtin_scene(name);
  if (!scene) return scene.error();
  const Pose pose = pose_at(*scene, 0.0);
  FrameRequest request;
  request.size_px = plan.size_px;
  const float aspect_ratio = static_cast<float>(plan.size_px.x) / static_cast<float>(plan.size_px.y);
  request.camera = pose.cameras.empty() ? frame_camera(pose, aspect_ratio) : pose.cameras.front();
  request.settings.method = Method::kReference;
  request.settings.bounces = plan.bounces;
  request.settings.seed = kSeedOfReference;
  progress(name + ": the converged reference");
  const std::unique_ptr<RenderView> view = renderer.make_view();
  const Result<Made> truth = make_picture(renderer, *view, *scene, request, plan.reference_spp);
  if (!truth) return truth.error();
  SceneQuality quality{name, {}};
  for (const QualityCase& what : quality_cases(plan.bounces)) {
    progress(name + ": " + what.series + ", " + what.setting);
    Result<QualityResult> result = measure_case(renderer, *scene, request, what, plan, truth->picture);
    if (!result) return result.error();
    quality.results.push_back(std::move(result).value());
  }
  return quality;
}

}  // namespace

std::vector<QualityCase> quality_cases(int bounces) {
  std::vector<QualityCase> cases;
  for (const bool denoise : {false, true})
    for (const int samples : {8, 32, 128}) {
      Settings settings;
      settings.bounces = bounces;
      settings.samples = samples;
      settings.denoise = denoise;
      cases.push_back({denoise ? "thesis, denoised" : "thesis", std::to_string(samples) + " directions", settings, 1});
    }
  Settings as_served = viewing_settings();  // and what `thesis` is with the same
  as_served.bounces = bounces;
  Settings realtime = as_served;
  realtime.warm_up = 0;
  for (const int frames : {1, 4, 16, 32})
    cases.push_back({"realtime", std::to_string(frames) + (frames == 1 ? " frame" : " frames"), realtime, frames});
  Settings fewer = realtime;
  fewer.samples = 48;
  cases.push_back({"realtime, 48 directions", "4 frames", fewer, 4});
  cases.push_back({"realtime, served picture", std::to_string(as_served.warm_up) + " unseen frames", as_served, 1});
  as_served.method = Method::kThesis;
  for (const int samples : {32, 64}) {
    as_served.samples = samples;
    cases.push_back({"thesis, as served", std::to_string(samples) + " directions", as_served, 1});
  }
  for (const int spp : {1, 4, 16, 64}) {
    Settings settings;
    settings.method = Method::kReference;
    settings.bounces = bounces;
    cases.push_back({"reference", std::to_string(spp) + " paths", settings, spp});
  }
  return cases;
}

Result<std::vector<SceneQuality>> measure_quality(Renderer& renderer, const QualityPlan& plan,
                                                  const std::function<void(const std::string&)>& progress) {
  std::vector<SceneQuality> all;
  for (const std::string& name : plan.scenes) {
    Result<SceneQuality> scene = measure_scene(renderer, name, plan, progress);
    if (!scene) return scene.error();
    all.push_back(std::move(scene).value());
  }
  return all;
}

nlohmann::json to_json(const QualityPlan& plan, const std::vector<SceneQuality>& scenes, const std::string& device) {
  nlohmann::json json = {{"device", device},
                         {"width", plan.size_px.x},
                         {"height", plan.size_px.y},
                         {"bounces", plan.bounces},
                         {"reference_spp", plan.reference_spp},
                         {"runs", plan.runs},
                         {"scenes", nlohmann::json::array()}};
  for (const SceneQuality& scene : scenes) {
    nlohmann::json results = nlohmann::json::array();
    for (const QualityResult& result : scene.results)
      results.push_back({{"series", result.series},
                         {"setting", result.setting},
                         {"ms", result.ms},
                         {"rel_mse", result.rel_mse},
                         {"rel_mse_trimmed", result.rel_mse_trimmed},
                         {"flip", result.flip}});
    json["scenes"].push_back({{"scene", scene.scene}, {"results", std::move(results)}});
  }
  return json;
}

std::string to_text(const std::vector<SceneQuality>& scenes) {
  std::string text =
      "| Scene | Method | Setting | ms | relMSE | relMSE without the worst 0.1 % | FLIP "
      "|\n|---|---|---|---|---|---|---|\n";
  for (const SceneQuality& scene : scenes)
    for (const QualityResult& result : scene.results) {
      char line[256];
      std::snprintf(line, sizeof line, "| %s | %s | %s | %.1f | %.5f | %.5f | %.4f |\n", scene.scene.c_str(),
                    result.series.c_str(), result.setting.c_str(), result.ms, result.rel_mse, result.rel_mse_trimmed,
                    result.flip);
      text += line;
    }
  return text;
}

}  // namespace lightwell
