#include "server/session/session_state.h"

#include "server/convert.h"
#include "server/session/edit_log.h"

namespace lightwell {
namespace {

using protocol::Decoded;
using protocol::Problem;
using protocol::SessionPatch;

void open_scene(SessionState& state, const std::string& name, SceneStore::Source source) {
  state.scene_name = name;
  state.stage = source.scene;
  state.source = std::move(source);
  state.edits = std::make_shared<const protocol::Edits>(protocol::Edits::array());
}

/// Applies the members of a patch to a copy, one after another, until one is refused.
class Change {
 public:
  Change(SessionState& state, const SessionPatch& patch, const SessionRules& rules, SteadyTime now)
      : state_(state), patch_(patch), rules_(rules), now_(now) {}

  std::optional<Problem> apply() {
    const bool good = change_scene() && change_size() && change_settings() && change_edits() && change_camera();
    if (!good) return problem_;
    if (patch_.time_s) state_.clock.set_time(*patch_.time_s, now_);
    if (patch_.playing) state_.clock.set_playing(*patch_.playing, now_);
    return {};
  }

 private:
  bool refuse(Problem problem) {
    problem_ = std::move(problem);
    return false;
  }

  bool change_scene() {
    if (!patch_.scene) return true;
    auto source = rules_.scenes.source(*patch_.scene);
    if (!source) return refuse(no_such_scene(*patch_.scene, 422, "/scene"));
    open_scene(state_, *patch_.scene, std::move(*source));
    state_.camera = protocol::DefaultCamera();
    state_.clock.set_time(0.0, now_);
    return true;
  }

  bool change_size() {
    if (patch_.width) state_.size_px.x = *patch_.width;
    if (patch_.height) state_.size_px.y = *patch_.height;
    std::optional<Problem> bad = check_size(state_.size_px, rules_.limits, "");
    return !bad || refuse(std::move(*bad));
  }

  bool change_settings() {
    if (!patch_.settings) return true;
    Decoded<Settings> settings =
        with_spec(state_.settings, *patch_.settings, state_.size_px, rules_.limits, "/settings");
    if (!settings) return refuse(settings.problem());
    state_.settings = std::move(settings).value();
    return true;
  }

  bool change_edits() {
    if (!patch_.edits || patch_.edits->empty()) return true;
    Decoded<Scene> scene = edited(*state_.stage->scene(), *patch_.edits, rules_.limits);
    if (!scene) return refuse(scene.problem());
    state_.stage = std::make_shared<const StagedScene>(std::move(scene).value());
    if (state_.edits) state_.edits = with_edits(*state_.edits, *patch_.edits);
    return true;
  }

  bool change_camera() {
    if (patch_.camera)
      state_.camera = *patch_.camera;
    else if (!patch_.edits)
      return true;  // edits may take away the camera looked through
    Decoded<PlacedCamera> camera = state_.stage->place(state_.camera, 0.0, state_.aspect_ratio());
    return camera.ok() || refuse(camera.problem());
  }

  SessionState& state_;
  const SessionPatch& patch_;
  const SessionRules& rules_;
  SteadyTime now_;
  Problem problem_;
};

/// All members of a request as a change of everything.
SessionPatch patch_of(const protocol::SessionRequest& request) {
  SessionPatch everything;
  everything.scene = request.scene;
  everything.camera = request.camera;
  everything.settings = request.settings;
  everything.width = request.width;
  everything.height = request.height;
  everything.playing = request.playing;
  everything.time_s = request.time_s;
  return everything;
}

}  // namespace

double Clock::time_s(SteadyTime now) const {
  if (!playing_) return base_s_;
  return base_s_ + std::chrono::duration<double>(now - since_).count();
}

void Clock::set_playing(bool playing, SteadyTime now) {
  base_s_ = time_s(now);
  since_ = now;
  playing_ = playing;
}

void Clock::set_time(double time_s, SteadyTime now) {
  base_s_ = time_s;
  since_ = now;
}

Decoded<SessionState> make_session_state(const protocol::SessionRequest& request, const SessionRules& rules,
                                         SteadyTime now) {
  SessionState state;
  state.settings = rules.default_settings;
  if (auto problem = Change(state, patch_of(request), rules, now).apply()) return *problem;
  return state;
}

Decoded<SessionState> make_session_state(const protocol::SessionRequest& request, SceneStore::Source source,
                                         const protocol::Edits& edits, const SessionRules& rules, SteadyTime now) {
  SessionState state;
  state.settings = rules.default_settings;
  open_scene(state, request.scene, std::move(source));
  SessionPatch everything = patch_of(request);
  everything.scene.reset();
  everything.edits = edits;
  if (auto problem = Change(state, everything, rules, now).apply()) return *problem;
  return state;
}

Decoded<SessionState> changed(const SessionState& state, const SessionPatch& patch, const SessionRules& rules,
                              SteadyTime now) {
  SessionState next = state;
  if (auto problem = Change(next, patch, rules, now).apply()) return *problem;
  ++next.revision;
  return next;
}

protocol::StateUpdate state_update(const SessionState& state, unsigned members, double time_s) {
  protocol::StateUpdate update;
  const bool new_scene = (members & (kChangedScene | kChangedEdits)) != 0;
  if (members & kChangedScene) update.scene = state.scene_name;
  if (members & kChangedSettings) update.settings = spec_of(state.settings);
  if (members & (kChangedScene | kChangedCamera)) {
    update.camera = state.camera;
    update.view = view_at(state, time_s);
  }
  if (members & (kChangedScene | kChangedPlaying)) update.playing = state.clock.playing();
  if (members & (kChangedScene | kChangedPlaying | kChangedTime)) update.time_s = time_s;
  if (new_scene) {
    update.bounds = state.stage->bounds();
    update.lights = state.stage->lights(time_s);
  }
  return update;
}

protocol::FreeCamera view_at(const SessionState& state, double time_s) {
  if (const auto* free = std::get_if<protocol::FreeCamera>(&state.camera)) return *free;
  const auto camera = state.stage->place(state.camera, time_s, state.aspect_ratio());
  return camera ? view_of(*camera, state.stage->center()) : protocol::FreeCamera();
}

unsigned members_of(const SessionPatch& patch) {
  return (patch.scene ? kChangedScene : 0u) | (patch.edits ? kChangedEdits : 0u) |
         (patch.camera ? kChangedCamera : 0u) | (patch.settings ? kChangedSettings : 0u) |
         (patch.playing ? kChangedPlaying : 0u) | (patch.time_s ? kChangedTime : 0u) |
         (patch.width || patch.height ? kChangedSize : 0u);
}

}  // namespace lightwell
