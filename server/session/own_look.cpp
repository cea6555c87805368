#include "server/session/own_look.h"

#include <utility>

namespace lightwell {

SessionState looked_at(SessionState state, const protocol::Look& look) {
  if (look.camera) state.camera = *look.camera;
  state.size_px.x = look.width.value_or(static_cast<std::uint16_t>(state.size_px.x));
  state.size_px.y = look.height.value_or(static_cast<std::uint16_t>(state.size_px.y));
  return state;
}

OwnLook::OwnLook(std::shared_ptr<DirectedSession> session, std::shared_ptr<Viewer> viewer)
    : session_(std::move(session)), viewer_(std::move(viewer)) {
  audience_.join(viewer_, 1);
}

std::uint64_t OwnLook::change(const protocol::Look& look) {
  std::lock_guard lock(mutex_);
  look_ = look;
  ++looks_;
  state_.reset();
  return session_->state()->revision + looks_;
}

void OwnLook::end() {
  ended_ = true;
  audience_.leave(*viewer_);
  session_->wake_render_loop();
}

/// Its revision counts the session's changes and its own: it ascends, and another one is another state.
std::shared_ptr<const SessionState> OwnLook::state() const {
  std::lock_guard lock(mutex_);
  std::shared_ptr<const SessionState> of_session = session_->state();
  if (state_ && of_session == of_session_) return state_;
  SessionState state = looked_at(*of_session, look_);
  state.looks = looks_;
  state.revision += looks_;
  state_ = std::make_shared<const SessionState>(std::move(state));
  of_session_ = std::move(of_session);
  return state_;
}

}  // namespace lightwell
