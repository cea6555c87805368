#include "protocol/codec.h"
#include "protocol/names.h"
#include "protocol/read_values.h"

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

void read_render_request(const Value& value, RenderRequest& out) {
  ObjectReader object(value);
  object.required("scene", out.scene, read_scene_name);
  object.with_default("time_s", out.time_s, read_time);
  object.with_default("edits", out.edits, read_edits);
  object.with_default("camera", out.camera, read_camera);
  object.with_default("width", out.width, read_pixels);
  object.with_default("height", out.height, read_pixels);
  object.with_default("settings", out.settings, read_settings);
  object.with_default("format", out.format, read_image_format);
  object.with_default("spp_frames", out.spp_frames, ReadInteger<std::uint32_t>{1, 4096});
  object.finish();
}

void read_session_request(const Value& value, SessionRequest& out) {
  ObjectReader object(value);
  object.required("scene", out.scene, read_scene_name);
  object.with_default("camera", out.camera, read_camera);
  object.with_default("settings", out.settings, read_settings);
  object.with_default("width", out.width, read_pixels);
  object.with_default("height", out.height, read_pixels);
  object.with_default("playing", out.playing, read_boolean);
  object.with_default("time_s", out.time_s, read_time);
  object.optional("idle_s", out.idle_s, read_time);
  object.finish();
}

void read_session_patch(const Value& value, SessionPatch& out) {
  ObjectReader object(value);
  read_change(object, out);
  object.finish();
}

template <class T>
Decoded<T> parse_body(std::string_view body, void (*read)(const Value&, T&)) {
  const Decoded<Json> json = parse_json(body);
  if (!json) return json.problem();
  Reading reading(UnknownMembers::kRefused);
  T request;
  read(Value{*json, {}, reading}, request);
  if (reading.failed()) return reading.problem();
  return request;
}

/// A query's text as the JSON value it stands for: pixels are numbers, everything else strings.
Json query_value(const std::string& name, const std::string& text) {
  const bool is_number = name == "width" || name == "height";
  const bool has_digits =
      !text.empty() && text.size() <= 6 && text.find_first_not_of("0123456789") == std::string::npos;
  return is_number && has_digits ? Json(std::stoi(text)) : Json(text);
}

}  // namespace

Decoded<RenderRequest> parse_render_request(std::string_view body) {
  return parse_body<RenderRequest>(body, read_render_request);
}

Decoded<SessionRequest> parse_session_request(std::string_view body) {
  return parse_body<SessionRequest>(body, read_session_request);
}

Decoded<SessionPatch> parse_session_patch(std::string_view body) {
  return parse_body<SessionPatch>(body, read_session_patch);
}

Decoded<FrameQuery> parse_frame_query(std::span<const std::pair<std::string, std::string>> query) {
  Json members = Json::object();
  Reading reading(UnknownMembers::kRefused);
  for (const auto& [name, text] : query) {
    if (members.contains(name)) reading.fail(400, "given twice", '/' + escape_pointer_token(name));
    members[name] = query_value(name, text);
  }
  FrameQuery frame_query;
  const Value value{members, {}, reading};
  ObjectReader object(value);
  object.with_default("format", frame_query.format, read_image_format);
  object.optional("width", frame_query.width, read_pixels);
  object.optional("height", frame_query.height, read_pixels);
  object.optional("view", frame_query.view, read_token);
  object.finish();
  if (reading.failed()) return reading.problem();
  return frame_query;
}

}  // namespace lightwell::protocol
