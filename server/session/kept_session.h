// A session in the form in which it is kept, for another server to take it up.
#pragma once

#include <string>
#include <string_view>

#include "protocol/messages.h"

namespace lightwell {

struct KeptSession {
  protocol::SessionRequest request;  // by which one like it would be made; its idle_s is given
  protocol::Edits edits = protocol::Edits::array();
  std::string scene_digest;    // of the scene before the edits
  std::int64_t unix_ms = 0;    // when the request's time_s was the session's
  std::uint64_t revision = 1;  // of the session then
  std::string driver;          // the resume token of who drove; empty: nobody did

  /// The scene's time now: it has gone on if it was playing.
  double time_s(std::int64_t now_unix_ms) const;

  bool operator==(const KeptSession&) const = default;
};

std::string text_of(const KeptSession& session);
/// Problem: the text is not one that `text_of` gives.
protocol::Decoded<KeptSession> parse_kept_session(std::string_view text);

}  // namespace lightwell
