#include "server/session/kept_session.h"

#include <algorithm>

#include "protocol/codec.h"

namespace lightwell {

double KeptSession::time_s(std::int64_t now_unix_ms) const {
  if (!request.playing) return request.time_s;
  return request.time_s + static_cast<double>(std::max<std::int64_t>(now_unix_ms - unix_ms, 0)) / 1000.0;
}

std::string text_of(const KeptSession& session) {
  return protocol::json_text({{"request", protocol::to_json(session.request)},
                              {"edits", session.edits},
                              {"scene_digest", session.scene_digest},
                              {"unix_ms", session.unix_ms},
                              {"revision", session.revision},
                              {"driver", session.driver}});
}

protocol::Decoded<KeptSession> parse_kept_session(std::string_view text) {
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    auto request = protocol::parse_session_request(protocol::json_text(json.at("request")));
    if (!request) return request.problem();
    KeptSession session;
    session.request = std::move(request).value();
    session.edits = json.at("edits");
    json.at("scene_digest").get_to(session.scene_digest);
    json.at("unix_ms").get_to(session.unix_ms);
    json.at("revision").get_to(session.revision);
    json.at("driver").get_to(session.driver);
    return session;
  } catch (const nlohmann::json::exception& broken) {
    return protocol::make_problem(500, broken.what());
  }
}

}  // namespace lightwell
