// A viewer's own look at a session: the session as it is, with a camera or a size of the viewer's.
#pragma once

#include <atomic>
#include <mutex>

#include "server/stream/director.h"

namespace lightwell {

/// `state` with what the look gives.
SessionState looked_at(SessionState state, const protocol::Look& look);

/// Thread-safe. Watched by one viewer.
class OwnLook : public DirectedSession {
 public:
  OwnLook(std::shared_ptr<DirectedSession> session, std::shared_ptr<Viewer> viewer);

  /// The revision from which on its pictures show it.
  std::uint64_t change(const protocol::Look& look);
  /// No picture is made from here on.
  void end();

  // DirectedSession
  std::shared_ptr<const SessionState> state() const override;
  Audience& audience() override { return audience_; }
  bool ended() const override { return ended_ || session_->ended(); }
  void encoding_failed(PictureCodec codec) override { session_->encoding_failed(codec); }
  void picture_encoded(double seconds, const EncodedBytes& bytes) override {
    session_->picture_encoded(seconds, bytes);
  }
  void wake_render_loop() override { session_->wake_render_loop(); }

 private:
  const std::shared_ptr<DirectedSession> session_;
  const std::shared_ptr<Viewer> viewer_;
  Audience audience_;
  std::atomic<bool> ended_ = false;

  mutable std::mutex mutex_;
  protocol::Look look_;
  std::uint64_t looks_ = 0;
  mutable std::shared_ptr<const SessionState> of_session_;  // what `state_` was made from
  mutable std::shared_ptr<const SessionState> state_;
};

}  // namespace lightwell
