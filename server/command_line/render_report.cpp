#include "server/command_line/render_report.h"

#include <algorithm>
#include <cstdio>

#include "server/command_line/device_report.h"
#include "server/command_line/render_command.h"

namespace lightwell {

void PictureCost::add(const Frame& frame) {
  for (const StageTime& stage : frame.stages) {
    const auto known =
        std::find_if(stages_.begin(), stages_.end(), [&](const StageTime& other) { return other.name == stage.name; });
    if (known == stages_.end())
      stages_.push_back(stage);
    else
      known->ms += stage.ms;
  }
  total_ms_ += frame.total_ms;
  rays_ += frame.rays;
}

void PictureCost::give(Frame& frame) const {
  frame.stages = stages_;
  frame.total_ms = total_ms_;
  frame.rays = rays_;
}

std::map<std::string, std::string> exr_metadata(const RenderArguments& arguments, double time_s, const Frame& frame) {
  const Settings& settings = arguments.settings;
  return {{"lightwell:scene", arguments.scene},
          {"lightwell:time_s", std::to_string(time_s)},
          {"lightwell:method", std::string(name_of(settings.method))},
          {"lightwell:estimator", std::string(name_of(settings.estimator))},
          {"lightwell:view", std::string(name_of(settings.view))},
          {"lightwell:samples", std::to_string(settings.samples)},
          {"lightwell:bounces", std::to_string(settings.bounces)},
          {"lightwell:indirect_size", std::to_string(settings.indirect_size)},
          {"lightwell:patch", std::to_string(settings.patch)},
          {"lightwell:triangle_groups", std::to_string(settings.triangle_groups)},
          {"lightwell:normal_threshold", std::to_string(settings.normal_threshold)},
          {"lightwell:depth_threshold", std::to_string(settings.depth_threshold)},
          {"lightwell:similarity", std::string(name_of(settings.similarity))},
          {"lightwell:trace_missed", settings.trace_missed ? "true" : "false"},
          {"lightwell:brute_force", settings.brute_force ? "true" : "false"},
          {"lightwell:view_index", std::to_string(settings.view_index)},
          {"lightwell:shadow_size", std::to_string(settings.shadow_size)},
          {"lightwell:shadow_filter", std::to_string(settings.shadow_filter)},
          {"lightwell:denoise", settings.denoise ? "true" : "false"},
          {"lightwell:multiple_scattering", settings.multiple_scattering ? "true" : "false"},
          {"lightwell:temporal_antialiasing", settings.temporal_antialiasing ? "true" : "false"},
          {"lightwell:firefly_clamp", std::to_string(settings.firefly_clamp)},
          {"lightwell:clamped_share", std::to_string(frame.clamped_share)},
          {"lightwell:photon_guides", settings.photon_guides ? "true" : "false"},
          {"lightwell:target_fps", std::to_string(settings.target_fps)},
          {"lightwell:warm_up", std::to_string(settings.warm_up)},
          {"lightwell:seed", std::to_string(settings.seed)},
          {"lightwell:accumulated", std::to_string(frame.accumulated)}};
}

RenderReport::RenderReport(const RenderArguments& arguments)
    : arguments_(arguments), last_(std::chrono::steady_clock::now()) {
  const Settings& settings = arguments.settings;
  json_ = {{"scene", arguments.scene},
           {"width", arguments.size_px.x},
           {"height", arguments.size_px.y},
           {"settings",
            {{"method", name_of(settings.method)},
             {"samples", settings.samples},
             {"bounces", settings.bounces},
             {"indirect_size", settings.indirect_size},
             {"estimator", name_of(settings.estimator)},
             {"view", name_of(settings.view)},
             {"seed", settings.seed}}},
           {"pictures", nlohmann::json::array()}};
}

double RenderReport::ms_since_last() {
  const auto now = std::chrono::steady_clock::now();
  return std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
}

void RenderReport::scene_loaded() {
  json_["load_ms"] = ms_since_last();
}

void RenderReport::renderer_started(Renderer& renderer) {
  json_["start_ms"] = ms_since_last();
  json_["device"] = to_json(renderer.context().device());
  json_["device"]["why"] = renderer.context().why();
  json_["tracer"] = renderer.tracer_name();
}

void RenderReport::add_picture(const std::string& file, double time_s, const Frame& frame) {
  ++pictures_;
  total_ms_ += frame.total_ms;
  if (!arguments_.json) return;  // ten thousand frames would fill tens of megabytes for nobody
  nlohmann::json stages = nlohmann::json::array();
  for (const StageTime& stage : frame.stages) stages.push_back({{"name", stage.name}, {"ms", stage.ms}});
  json_["pictures"].push_back({{"file", file},
                               {"time_s", time_s},
                               {"total_ms", frame.total_ms},
                               {"stages", stages},
                               {"rays", frame.rays},
                               {"triangles", frame.triangles},
                               {"exposure_ev", frame.exposure_ev},
                               {"accumulated", frame.accumulated},
                               {"clamped_share", frame.clamped_share}});
}

void RenderReport::print() const {
  if (arguments_.json) {
    std::printf("%s\n", json_.dump(2).c_str());
    return;
  }
  std::fprintf(stderr, "lightwell: %zu picture%s of %dx%d in %.1f ms: %s (%s, tracer %s)\n", pictures_,
               pictures_ == 1 ? "" : "s", arguments_.size_px.x, arguments_.size_px.y, total_ms_,
               arguments_.output.c_str(), json_.at("device").at("gl_renderer").get<std::string>().c_str(),
               json_.at("tracer").get<std::string>().c_str());
}

}  // namespace lightwell
