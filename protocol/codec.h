// Bytes to structs and back. Pure functions; nothing throws for what comes from outside.
//
// parse_*: strict. Text that is no JSON (or has a duplicate member, invalid UTF-8, a nesting of more than 32, a number
// beyond a double) is a problem of status 400; more than 1 MiB or 200,000 values of 413; a wrong type, a value out of
// range, a missing or unknown member of 422 with the JSON pointer of the member.
//
// to_json: the inverse. Numbers that are not finite travel as 0, so that what is written can always be read.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "protocol/json_text.h"
#include "protocol/messages.h"

namespace lightwell::protocol {

// Bodies and queries of HTTP requests.
Decoded<RenderRequest> parse_render_request(std::string_view body);
Decoded<SessionRequest> parse_session_request(std::string_view body);
Decoded<SessionPatch> parse_session_patch(std::string_view body);

/// Percent-decoded names and values. An unknown or repeated name is a problem; its pointer is "/" and the name.
Decoded<FrameQuery> parse_frame_query(std::span<const std::pair<std::string, std::string>> query);

/// A text message of the stream. What a client sends may have no unknown members; what a server sends may (a newer
/// server says more), and they are ignored; it may have 16 MiB, since a welcome lists every scene and light.
Decoded<ClientMessage> parse_client_message(std::string_view text);
Decoded<ServerMessage> parse_server_message(std::string_view text);

nlohmann::json to_json(const Problem& problem);
nlohmann::json to_json(const CameraSpec& camera);
nlohmann::json to_json(const FreeCamera& camera);
nlohmann::json to_json(const SettingsSpec& settings);  // only what is given
nlohmann::json to_json(const SceneEntry& entry);
nlohmann::json to_json(const LightEntry& entry);
nlohmann::json to_json(const Session& session);
nlohmann::json to_json(const RenderRequest& request);
nlohmann::json to_json(const SessionRequest& request);
nlohmann::json to_json(const SessionPatch& patch);
nlohmann::json to_json(const ClientMessage& message);
nlohmann::json to_json(const ServerMessage& message);

/// {"scenes":[...]}, the answer of GET /v1/scenes.
nlohmann::json to_json(std::span<const SceneEntry> scenes);

/// One text message of the stream.
std::string serialize(const ClientMessage& message);
std::string serialize(const ServerMessage& message);

}  // namespace lightwell::protocol
