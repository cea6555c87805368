#include "server/sequences/sequence_plan.h"

#include "server/convert.h"
#include "server/sequences/keyframes.h"

namespace lightwell {
namespace {

using protocol::Decoded;
using protocol::Keyframes;
using protocol::Problem;

Decoded<std::shared_ptr<const StagedScene>> with_edits(const StagedScene& stage, const protocol::Edits& edits,
                                                       const ServeLimits& limits) {
  Decoded<Scene> scene = edited(*stage.scene(), edits, limits);
  if (!scene) return scene.problem();
  return std::shared_ptr<const StagedScene>(std::make_shared<StagedScene>(std::move(scene).value()));
}

}  // namespace

Decoded<std::shared_ptr<const SequencePlan>> SequencePlan::make(const protocol::SequenceRequest& request,
                                                                std::shared_ptr<const StagedScene> stage,
                                                                const ServeOptions& options) {
  std::shared_ptr<SequencePlan> plan(new SequencePlan());
  plan->request_ = request;
  plan->limits_ = options.limits;
  plan->stage_ = std::move(stage);
  const std::uint32_t frames = request.last_frame - request.first_frame + 1;
  if (frames > static_cast<std::uint32_t>(options.limits.max_sequence_frames))
    return protocol::make_problem(422,
                                  "a sequence may have at most " + std::to_string(options.limits.max_sequence_frames) +
                                      " frames, not " + std::to_string(frames),
                                  "/last_frame");
  if (auto problem = plan->read_settings(options)) return *problem;
  if (!request.edits.empty()) {
    auto edited_stage = with_edits(*plan->stage_, request.edits, options.limits);
    if (!edited_stage) return edited_stage.problem();
    plan->stage_ = std::move(edited_stage).value();
  }
  if (auto problem = plan->check_keyframes()) return *problem;
  if (auto problem = plan->check_frames()) return *problem;
  return std::shared_ptr<const SequencePlan>(std::move(plan));
}

std::optional<Problem> SequencePlan::read_settings(const ServeOptions& options) {
  const glm::ivec2 size_px(request_.width, request_.height);
  if (auto problem = check_size(size_px, options.limits, "")) return problem;
  if (request_.spp_frames > static_cast<std::uint32_t>(options.limits.max_spp_frames))
    return protocol::make_problem(
        422, "a picture may have at most " + std::to_string(options.limits.max_spp_frames) + " frames", "/spp_frames");
  auto settings = with_spec(options.settings, request_.settings, size_px, options.limits, "/settings");
  if (!settings) return settings.problem();
  settings->target_fps = 0;                    // nobody waits, and the same request gives the same bytes
  settings->hand_over = Settings().hand_over;  // of no account, so that it makes no other name either
  for (std::size_t i = 0; i < request_.views.size(); ++i) {
    const auto view = view_kind_from_name(request_.views[i]);
    if (!view)
      return protocol::make_problem(422, "there is no view \"" + request_.views[i] + "\"",
                                    "/views/" + std::to_string(i));
    settings_.push_back(*settings);
    settings_.back().view = *view;
  }
  request_.settings = spec_of(*settings);
  request_.settings.view.reset();
  return {};
}

/// Each property by itself at its first key, so that the pointer is its own.
std::optional<Problem> SequencePlan::check_keyframes() const {
  for (std::size_t i = 0; i < request_.keyframes.size(); ++i) {
    const Keyframes& keys = request_.keyframes[i];
    const auto scene = edited(*stage_->scene(), edits_at({keys}, keys.times_s.front()), limits_);
    if (scene) continue;
    Problem problem = scene.problem();
    problem.pointer = "/keyframes/" + std::to_string(i);
    return problem;
  }
  return {};
}

std::optional<Problem> SequencePlan::check_frames() const {
  for (const std::uint32_t frame : {request_.first_frame, request_.last_frame})
    if (const auto shot = this->shot(frame, 0); !shot) return shot.problem();
  return {};
}

Decoded<std::shared_ptr<const StagedScene>> SequencePlan::stage_at(double time_s) const {
  if (request_.keyframes.empty()) return stage_;
  auto stage = with_edits(*stage_, edits_at(request_.keyframes, time_s), limits_);
  if (stage) return stage;
  Problem problem = stage.problem();
  problem.pointer =
      "/keyframes" + problem.pointer.substr(std::min(problem.pointer.size(), std::string("/edits").size()));
  return problem;
}

Decoded<Shot> SequencePlan::shot(std::uint32_t frame, std::size_t view) const {
  const double time_s = frame / request_.fps;
  const auto stage = stage_at(time_s);
  if (!stage) return stage.problem();
  Shot shot;
  shot.scene = (*stage)->scene();
  shot.request.time_s = time_s;
  shot.request.size_px = {request_.width, request_.height};
  shot.request.settings = settings_[view];
  shot.request.want_linear = request_.format == protocol::ImageFormat::kExr;
  shot.request.want_display = !shot.request.want_linear;
  protocol::CameraSpec camera = request_.camera;
  if (auto* free = std::get_if<protocol::FreeCamera>(&camera))
    *free = camera_at(*free, request_.camera_keyframes, time_s);
  const float aspect_ratio = static_cast<float>(request_.width) / static_cast<float>(request_.height);
  auto place = (*stage)->place(camera, time_s, aspect_ratio);
  if (!place) return place.problem();
  shot.request.camera = std::move(place).value();
  return shot;
}

}  // namespace lightwell
