// A session: its state, changed by requests and by its viewers' inputs, and the viewers themselves.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

#include "server/operations/metrics.h"
#include "server/render/render_loop.h"
#include "server/session/kept_session.h"
#include "server/session/own_look.h"
#include "server/session/session_state.h"
#include "server/stream/audience.h"
#include "server/stream/director.h"

namespace lightwell {

class Session;

/// There is none of this id: 404.
protocol::Problem no_such_session();

/// What all sessions of a server share.
struct SessionSurroundings {
  SessionRules rules;
  Metrics& metrics;
  std::function<void()> wake_render_loop;
  std::function<std::string()> device;  // for welcomes: what pictures are made with
  std::function<std::vector<std::string>()> methods;
  std::function<std::vector<std::string>()> codecs;  // that pictures can be sent as
  /// Has pictures made of what is directed, in the time of an account.
  std::function<void(std::shared_ptr<DirectedSession>, std::shared_ptr<RenderAccount>)> direct;
  /// Something has changed that is kept of a session.
  std::function<void(std::shared_ptr<const Session>)> changed;
};

/// Thread-safe. Readers get a state that never changes; writers make the next one, one at a time.
class Session : public ViewerHost, public DirectedSession, public std::enable_shared_from_this<Session> {
 public:
  /// `idle_s`: it ends after so long without viewers and requests.
  Session(std::string id, SessionState state, const SessionSurroundings& surroundings, double idle_s);

  const std::string& id() const { return id_; }
  /// Begins to have pictures made. Called once.
  void begin() { surroundings_.direct(shared_from_this(), account_); }
  std::size_t viewers() const { return audience_.size(); }
  protocol::Session describe() const;
  /// What is kept of it; its `unix_ms` is the caller's to set.
  KeptSession kept_form() const;
  /// For a while only a stream that is resumed with this token may drive. Called before the session has viewers.
  void reserve_seat(const std::string& resume_token);
  /// All of `patch` or nothing.
  std::optional<protocol::Problem> apply(const protocol::SessionPatch& patch) { return change(patch, nullptr, 0); }

  /// A new stream's end, which belongs to the audience until its connection closes. `may_drive`: whether its client's
  /// token lets it be a driver. Problem: 503 if there are too many.
  protocol::Decoded<std::shared_ptr<Viewer>> open_stream(bool may_drive);

  /// Closes all streams; no pictures are made from here on.
  void end(protocol::CloseCode code, const std::string& reason, bool reconnect);

  /// Viewers are told which scenes there are now.
  void scenes_changed();

  /// Someone has asked for it: it is not idle.
  void touch();
  /// Since when nobody watched or asked; never while someone watches.
  SteadyTime idle_since() const;
  double idle_s() const { return idle_s_; }

  // ViewerHost
  protocol::Decoded<protocol::Welcome> greet(const protocol::Hello& hello, Viewer& viewer) override;
  std::optional<protocol::Problem> apply_input(const protocol::Input& input, Viewer& by) override;
  std::optional<protocol::Problem> apply_look(const protocol::Look& look, Viewer& by) override;
  protocol::StateUpdate change_of(unsigned members) const override;
  void window_opened() override { surroundings_.wake_render_loop(); }
  void picture_sent(PictureCodec codec, std::uint64_t bytes) override {
    surroundings_.metrics.picture_sent(codec, bytes);
  }
  void picture_acknowledged(double seconds) override { surroundings_.metrics.picture_acknowledged(seconds); }
  void leave(Viewer& viewer) override;

  // DirectedSession
  std::shared_ptr<const SessionState> state() const override;
  Audience& audience() override { return audience_; }
  bool ended() const override { return ended_; }
  void encoding_failed(PictureCodec codec) override { surroundings_.metrics.encoding_failed(codec); }
  void picture_encoded(double seconds, const EncodedBytes& bytes) override {
    surroundings_.metrics.picture_encoded(seconds, bytes);
  }
  void wake_render_loop() override { surroundings_.wake_render_loop(); }

 private:
  std::optional<protocol::Problem> change(const protocol::SessionPatch& patch, Viewer* by, std::uint32_t seq);
  protocol::Welcome welcome(const SessionState& state) const;
  protocol::Role seat(const protocol::Hello& hello, const Viewer& viewer);
  void tell_changed() { surroundings_.changed(shared_from_this()); }
  void resume(const std::string& token);
  protocol::Decoded<std::shared_ptr<OwnLook>> own_look_of(Viewer& viewer);
  bool end_look(Viewer& viewer);
  void end_looks();

  const std::string id_;
  const SessionSurroundings& surroundings_;
  const double idle_s_;
  const std::shared_ptr<RenderAccount> account_ = RenderLoop::make_account();  // of all its pictures
  Audience audience_;  // all its viewers, those too who look for themselves
  std::atomic<bool> ended_ = false;

  std::mutex looks_mutex_;
  std::map<Viewer*, std::shared_ptr<OwnLook>> looks_;  // of viewers that have not left

  std::mutex change_mutex_;  // one change at a time; taken before state_mutex_
  mutable std::mutex state_mutex_;
  std::shared_ptr<const SessionState> state_;
  SteadyTime touched_;

  mutable std::mutex driver_mutex_;
  const Viewer* driver_ = nullptr;  // who drives; it leaves before it goes
  std::string reserved_for_;        // a resume token; empty: nobody
  SteadyTime reserved_until_{};
};

}  // namespace lightwell
