#include <array>

#include "protocol/codec.h"
#include "protocol/read_values.h"

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

constexpr ReadInteger<std::uint32_t> read_u32{0, 0xffffffff};
constexpr ReadArray read_texts{0, 4096, read_text};

void read_message(ObjectReader& object, Hello& out) {
  object.required("codecs", out.codecs, ReadArray{1, 16, ReadString{1, 32}});
  object.required("width", out.width, read_pixels);
  object.required("height", out.height, read_pixels);
  object.with_default("device_pixel_ratio", out.device_pixel_ratio, ReadNumber{0, 16, true});
  object.with_default("role", out.role, read_role);
  object.with_default("resume", out.resume, ReadNullable{read_token});
}

void read_message(ObjectReader& object, Input& out) {
  object.required("seq", out.seq, read_sequence);
  read_change(object, out.change);
}

void read_message(ObjectReader& object, Look& out) {
  object.required("seq", out.seq, read_sequence);
  object.optional("camera", out.camera, read_camera);
  object.optional("width", out.width, read_pixels);
  object.optional("height", out.height, read_pixels);
}

void read_message(ObjectReader& object, Ack& out) {
  object.required("frame", out.frame, read_sequence);
  object.optional("received_ms", out.received_ms, read_any_number);
  object.optional("decoded_ms", out.decoded_ms, read_any_number);
  object.optional("shown_ms", out.shown_ms, read_any_number);
  object.with_default("queue", out.queue, read_u32);
  object.optional("held_ms", out.held_ms, read_any_number);
}

void read_message(ObjectReader& object, Demotion& out) {
  object.required("reason", out.reason, ReadString{1, 256});
}

void read_message(ObjectReader& object, Ping& out) {
  object.required("t", out.t, read_any_number);
}
void read_message(ObjectReader& object, Pong& out) {
  object.required("t", out.t, read_any_number);
}

void read_scene_entry(const Value& value, SceneEntry& out) {
  ObjectReader object(value);
  object.required("name", out.name, read_scene_name);
  object.required("builtin", out.builtin, read_boolean);
  object.required("triangles", out.triangles, read_count);
  object.required("duration_s", out.duration_s, read_time);
  object.required("cameras", out.cameras, read_texts);
  object.required("animated", out.animated, read_boolean);
  object.finish();
}

void read_bounds(const Value& value, Bounds& out) {
  ObjectReader object(value);
  object.required("min", out.min, read_numbers<3>);
  object.required("max", out.max, read_numbers<3>);
  object.finish();
}

void read_light_entry(const Value& value, LightEntry& out) {
  ObjectReader object(value);
  object.required("index", out.index, read_index);
  object.required("name", out.name, read_text);
  object.required("kind", out.kind, read_token);
  object.required("node", out.node, read_index);
  object.required("position", out.position, read_numbers<3>);
  object.required("direction", out.direction, read_numbers<3>);
  object.required("color", out.color, read_numbers<3>);
  object.required("intensity", out.intensity, read_any_number);
  object.optional("parent_from_world", out.parent_from_world, read_numbers<16>);
  object.finish();
}

void read_limits(const Value& value, Limits& out) {
  ObjectReader object(value);
  object.required("max_width", out.max_width, read_u32);
  object.required("max_height", out.max_height, read_u32);
  object.required("max_samples", out.max_samples, read_u32);
  object.required("max_upload_bytes", out.max_upload_bytes, read_count);
  object.finish();
}

void read_stage(const Value& value, StageEntry& out) {
  ObjectReader object(value);
  object.required("name", out.name, read_text);
  object.required("ms", out.ms, read_any_number);
  object.finish();
}

void read_problem(const Value& value, Problem& out) {
  ObjectReader object(value);
  object.with_default("type", out.type, read_text);
  object.required("title", out.title, read_text);
  object.required("status", out.status, ReadInteger<int>{400, 599});
  object.required("detail", out.detail, read_text);
  object.with_default("instance", out.instance, read_text);
  object.with_default("pointer", out.pointer, read_text);
  object.finish();
}

constexpr ReadArray read_scenes{0, 65536, read_scene_entry};
constexpr ReadArray read_lights{0, 65536, read_light_entry};

void read_message(ObjectReader& object, Welcome& out) {
  object.required("session", out.session, read_token);
  object.required("role", out.role, read_role);
  object.required("codec", out.codec, read_token);
  object.required("protocol", out.protocol, ReadInteger<int>{kProtocolVersion, kProtocolVersion});
  object.required("resume", out.resume, read_token);
  object.required("scene", out.scene, read_scene_name);
  object.required("scenes", out.scenes, read_scenes);
  object.required("settings", out.settings, read_settings);
  object.required("camera", out.camera, read_camera);
  object.required("playing", out.playing, read_boolean);
  object.required("time_s", out.time_s, read_time);
  object.required("device", out.device, read_text);
  object.required("limits", out.limits, read_limits);
  object.required("methods", out.methods, read_texts);
  object.required("codecs", out.codecs, read_texts);
  object.required("bounds", out.bounds, read_bounds);
  object.required("view", out.view, read_free_camera);
  object.required("lights", out.lights, read_lights);
}

void read_message(ObjectReader& object, StateUpdate& out) {
  object.optional("seq", out.seq, read_sequence);
  object.optional("scene", out.scene, read_scene_name);
  object.optional("scenes", out.scenes, read_scenes);
  object.optional("settings", out.settings, read_settings);
  object.optional("camera", out.camera, read_camera);
  object.optional("playing", out.playing, read_boolean);
  object.optional("time_s", out.time_s, read_time);
  object.optional("bounds", out.bounds, read_bounds);
  object.optional("view", out.view, read_free_camera);
  object.optional("lights", out.lights, read_lights);
}

void read_message(ObjectReader& object, PoseUpdate& out) {
  object.required("frame", out.frame, read_sequence);
  object.required("view", out.view, read_free_camera);
  object.required("lights", out.lights, read_lights);
}

void read_message(ObjectReader& object, Stats& out) {
  object.required("fps", out.fps, read_any_number);
  object.required("render_ms", out.render_ms, read_any_number);
  object.required("encode_ms", out.encode_ms, read_any_number);
  object.required("stages", out.stages, ReadArray{0, 256, read_stage});
  object.required("rays", out.rays, read_count);
  object.required("triangles", out.triangles, read_count);
  object.required("exposure_ev", out.exposure_ev, read_any_number);
  object.required("accumulated", out.accumulated, read_u32);
  object.required("clamped_share", out.clamped_share, read_any_number);
  object.required("method", out.method, read_token);
  object.required("time_s", out.time_s, read_time);
}

void read_message(ObjectReader& object, ErrorMessage& out) {
  object.required("problem", out.problem, read_problem);
  object.optional("seq", out.seq, read_sequence);
}

void read_message(ObjectReader& object, Bye& out) {
  object.required("reason", out.reason, read_text);
  object.required("reconnect", out.reconnect, read_boolean);
}

/// A welcome lists every scene and light.
constexpr JsonLimits kServerLimits{.max_bytes = 16u << 20, .max_depth = 32, .max_values = 2'000'000};

template <class Variant>
using ReadAny = void (*)(ObjectReader&, Variant&);

template <class Variant>
struct MessageKind {
  std::string_view type;
  ReadAny<Variant> read;
};

template <class Message, class Variant>
constexpr MessageKind<Variant> kind(std::string_view type) {
  return {type, [](ObjectReader& object, Variant& out) { read_message(object, out.template emplace<Message>()); }};
}

constexpr std::array kClientKinds{kind<Hello, ClientMessage>("hello"),       kind<Input, ClientMessage>("input"),
                                  kind<Look, ClientMessage>("look"),         kind<Ack, ClientMessage>("ack"),
                                  kind<Demotion, ClientMessage>("demotion"), kind<Ping, ClientMessage>("ping")};
constexpr std::array kServerKinds{kind<Welcome, ServerMessage>("welcome"),
                                  kind<StateUpdate, ServerMessage>("state"),
                                  kind<PoseUpdate, ServerMessage>("pose"),
                                  kind<Stats, ServerMessage>("stats"),
                                  kind<ErrorMessage, ServerMessage>("error"),
                                  kind<Pong, ServerMessage>("pong"),
                                  kind<Bye, ServerMessage>("bye")};

template <class Variant, std::size_t count>
Decoded<Variant> parse_text(std::string_view text, const std::array<MessageKind<Variant>, count>& kinds,
                            UnknownMembers unknown_members, const JsonLimits& limits) {
  const Decoded<Json> json = parse_json(text, limits);
  if (!json) return json.problem();
  Reading reading(unknown_members);
  const Value value{*json, {}, reading};
  ObjectReader object(value);
  std::string type;
  object.required("type", type, ReadString{1, 32});
  if (reading.failed()) return reading.problem();
  for (const MessageKind<Variant>& candidate : kinds) {
    if (candidate.type != type) continue;
    Variant message;
    candidate.read(object, message);
    object.finish();
    if (reading.failed()) return reading.problem();
    return message;
  }
  return make_problem(422, "no message is called \"" + type + "\"", "/type");
}

}  // namespace

Decoded<ClientMessage> parse_client_message(std::string_view text) {
  return parse_text(text, kClientKinds, UnknownMembers::kRefused, {});
}

Decoded<ServerMessage> parse_server_message(std::string_view text) {
  return parse_text(text, kServerKinds, UnknownMembers::kIgnored, kServerLimits);
}

}  // namespace lightwell::protocol
