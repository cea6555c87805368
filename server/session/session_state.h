// What a session shows, as a value: scene, camera, settings, size, clock. Changes make a new value or none at all.
#pragma once

#include <chrono>
#include <memory>

#include "protocol/messages.h"
#include "renderer/renderer.h"
#include "server/scenes/scene_store.h"

namespace lightwell {

using SteadyTime = std::chrono::steady_clock::time_point;

/// A scene's time: stands, or runs with the wall clock.
class Clock {
 public:
  bool playing() const { return playing_; }
  double time_s(SteadyTime now) const;
  void set_playing(bool playing, SteadyTime now);
  void set_time(double time_s, SteadyTime now);

 private:
  bool playing_ = false;
  double base_s_ = 0.0;  // the time at `since_`
  SteadyTime since_{};
};

struct SessionState {
  std::string scene_name;
  SceneStore::Source source;                     // the scene as it was chosen
  std::shared_ptr<const protocol::Edits> edits;  // since then; null: more than one may be told of
  std::shared_ptr<const StagedScene> stage;      // with them: the session's own once it has been edited
  protocol::CameraSpec camera;
  Settings settings;
  glm::ivec2 size_px{0};
  Clock clock;
  std::uint64_t revision = 1;  // counts all changes
  std::uint64_t looks = 0;     // of them, those of a viewer's own look; 0 but in what OwnView makes of it

  float aspect_ratio() const { return static_cast<float>(size_px.x) / static_cast<float>(size_px.y); }
  /// Whether its pictures change by themselves.
  bool moving() const { return clock.playing() && stage->animated(); }
};

/// Members of a session that clients are told of; `or` of what changed.
enum ChangedMembers : unsigned {
  kChangedScene = 1,
  kChangedEdits = 2,
  kChangedCamera = 4,
  kChangedSettings = 8,
  kChangedPlaying = 16,
  kChangedTime = 32,
  kChangedSize = 64,     // seen in the pictures themselves
  kChangedScenes = 128,  // the list of scenes there are
};

/// What changes need to know.
struct SessionRules {
  const SceneStore& scenes;
  const ServeLimits& limits;
  Settings default_settings;
};

protocol::Decoded<SessionState> make_session_state(const protocol::SessionRequest& request, const SessionRules& rules,
                                                   SteadyTime now);
/// The same over a scene that may be no longer in the store, with edits.
protocol::Decoded<SessionState> make_session_state(const protocol::SessionRequest& request, SceneStore::Source source,
                                                   const protocol::Edits& edits, const SessionRules& rules,
                                                   SteadyTime now);

/// `state` with all of `patch`, its revision one higher; or the first thing wrong.
/// A change of scene comes first: camera, edits and time are those of the new scene.
protocol::Decoded<SessionState> changed(const SessionState& state, const protocol::SessionPatch& patch,
                                        const SessionRules& rules, SteadyTime now);

/// What clients are told when `members` (ChangedMembers) of a session have changed. The list of scenes is left out.
protocol::StateUpdate state_update(const SessionState& state, unsigned members, double time_s);

/// The camera in world space at a time, however it was asked for.
protocol::FreeCamera view_at(const SessionState& state, double time_s);

/// ChangedMembers of what `patch` gives.
unsigned members_of(const protocol::SessionPatch& patch);

}  // namespace lightwell
