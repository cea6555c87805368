#include <cmath>

#include "protocol/codec.h"
#include "protocol/names.h"

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

Json number(double value) {
  return std::isfinite(value) ? value : 0.0;
}

template <std::size_t count>
Json numbers(const std::array<double, count>& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(number(value));
  return array;
}

Json bounds_json(const Bounds& bounds) {
  return {{"min", numbers(bounds.min)}, {"max", numbers(bounds.max)}};
}

template <class T>
Json array_of(const std::vector<T>& elements) {
  Json array = Json::array();
  for (const T& element : elements) array.push_back(to_json(element));
  return array;
}

/// Sets object[name] if there is a value.
template <class T, class Write>
void give(Json& object, const char* name, const std::optional<T>& value, Write write) {
  if (value) object[name] = write(*value);
}

template <class T>
void give(Json& object, const char* name, const std::optional<T>& value) {
  if (value) object[name] = *value;
}

const auto camera_json = [](const auto& camera) { return to_json(camera); };

/// Adds the members of a change to an object that may have others.
void give_change(Json& object, const SessionPatch& patch) {
  give(object, "edits", patch.edits);
  give(object, "camera", patch.camera, camera_json);
  give(object, "settings", patch.settings, [](const SettingsSpec& settings) { return to_json(settings); });
  give(object, "playing", patch.playing);
  give(object, "time_s", patch.time_s, number);
  give(object, "scene", patch.scene);
  give(object, "width", patch.width);
  give(object, "height", patch.height);
}

Json limits_json(const Limits& limits) {
  return {{"max_width", limits.max_width},
          {"max_height", limits.max_height},
          {"max_samples", limits.max_samples},
          {"max_upload_bytes", limits.max_upload_bytes}};
}

/// One overload for each message; all but `type`, which stands first.
struct MessageWriter {
  Json operator()(const Hello& hello) const {
    return {{"type", "hello"},
            {"codecs", hello.codecs},
            {"width", hello.width},
            {"height", hello.height},
            {"device_pixel_ratio", number(hello.device_pixel_ratio)},
            {"role", name_of(hello.role)},
            {"resume", hello.resume ? Json(*hello.resume) : Json(nullptr)}};
  }

  Json operator()(const Input& input) const {
    Json object{{"type", "input"}, {"seq", input.seq}};
    give_change(object, input.change);
    return object;
  }

  Json operator()(const Look& look) const {
    Json object{{"type", "look"}, {"seq", look.seq}};
    if (look.camera) object["camera"] = to_json(*look.camera);
    give(object, "width", look.width);
    give(object, "height", look.height);
    return object;
  }

  Json operator()(const Ack& ack) const {
    Json object{{"type", "ack"}, {"frame", ack.frame}, {"queue", ack.queue}};
    give(object, "received_ms", ack.received_ms, number);
    give(object, "decoded_ms", ack.decoded_ms, number);
    give(object, "shown_ms", ack.shown_ms, number);
    give(object, "held_ms", ack.held_ms, number);
    return object;
  }

  Json operator()(const Demotion& demotion) const { return {{"type", "demotion"}, {"reason", demotion.reason}}; }

  Json operator()(const Ping& ping) const { return {{"type", "ping"}, {"t", number(ping.t)}}; }
  Json operator()(const Pong& pong) const { return {{"type", "pong"}, {"t", number(pong.t)}}; }

  Json operator()(const Welcome& welcome) const {
    return {{"type", "welcome"},
            {"session", welcome.session},
            {"role", name_of(welcome.role)},
            {"codec", welcome.codec},
            {"protocol", welcome.protocol},
            {"resume", welcome.resume},
            {"scene", welcome.scene},
            {"scenes", array_of(welcome.scenes)},
            {"settings", to_json(welcome.settings)},
            {"camera", to_json(welcome.camera)},
            {"playing", welcome.playing},
            {"time_s", number(welcome.time_s)},
            {"device", welcome.device},
            {"limits", limits_json(welcome.limits)},
            {"methods", welcome.methods},
            {"codecs", welcome.codecs},
            {"bounds", bounds_json(welcome.bounds)},
            {"view", to_json(welcome.view)},
            {"lights", array_of(welcome.lights)}};
  }

  Json operator()(const StateUpdate& state) const {
    Json object{{"type", "state"}};
    give(object, "seq", state.seq);
    give(object, "scene", state.scene);
    give(object, "scenes", state.scenes, [](const auto& scenes) { return array_of(scenes); });
    give(object, "settings", state.settings, [](const SettingsSpec& settings) { return to_json(settings); });
    give(object, "camera", state.camera, camera_json);
    give(object, "playing", state.playing);
    give(object, "time_s", state.time_s, number);
    give(object, "bounds", state.bounds, bounds_json);
    give(object, "view", state.view, camera_json);
    give(object, "lights", state.lights, [](const auto& lights) { return array_of(lights); });
    return object;
  }

  Json operator()(const PoseUpdate& pose) const {
    return {{"type", "pose"}, {"frame", pose.frame}, {"view", to_json(pose.view)}, {"lights", array_of(pose.lights)}};
  }

  Json operator()(const Stats& stats) const {
    Json stages = Json::array();
    for (const StageEntry& stage : stats.stages) stages.push_back({{"name", stage.name}, {"ms", number(stage.ms)}});
    return {{"type", "stats"},
            {"fps", number(stats.fps)},
            {"render_ms", number(stats.render_ms)},
            {"encode_ms", number(stats.encode_ms)},
            {"stages", std::move(stages)},
            {"rays", stats.rays},
            {"triangles", stats.triangles},
            {"exposure_ev", number(stats.exposure_ev)},
            {"accumulated", stats.accumulated},
            {"clamped_share", number(stats.clamped_share)},
            {"method", stats.method},
            {"time_s", number(stats.time_s)}};
  }

  Json operator()(const ErrorMessage& error) const {
    Json object{{"type", "error"}, {"problem", to_json(error.problem)}};
    give(object, "seq", error.seq);
    return object;
  }

  Json operator()(const Bye& bye) const {
    return {{"type", "bye"}, {"reason", bye.reason}, {"reconnect", bye.reconnect}};
  }
};

}  // namespace

Json to_json(const Problem& problem) {
  Json object{{"type", problem.type}, {"title", problem.title}, {"status", problem.status}, {"detail", problem.detail}};
  if (!problem.instance.empty()) object["instance"] = problem.instance;
  if (!problem.pointer.empty()) object["pointer"] = problem.pointer;
  return object;
}

Json to_json(const FreeCamera& camera) {
  Json object{{"eye", numbers(camera.eye)}, {"target", numbers(camera.target)}, {"yfov", number(camera.yfov)}};
  give(object, "znear", camera.znear, number);
  return object;
}

Json to_json(const CameraSpec& camera) {
  if (const auto* of_scene = std::get_if<SceneCamera>(&camera)) return {{"index", of_scene->index}};
  if (const auto* free = std::get_if<FreeCamera>(&camera)) return to_json(*free);
  return nullptr;
}

Json to_json(const SettingsSpec& settings) {
  Json object = Json::object();
  give(object, "method", settings.method);
  give(object, "samples", settings.samples);
  give(object, "bounces", settings.bounces,
       [](std::int32_t bounces) { return bounces == kEndlessBounces ? Json("inf") : Json(bounces); });
  give(object, "indirect_size", settings.indirect_size);
  give(object, "estimator", settings.estimator);
  give(object, "view", settings.view);
  give(object, "view_index", settings.view_index);
  give(object, "patch", settings.patch);
  give(object, "triangle_groups", settings.triangle_groups);
  give(object, "normal_threshold", settings.normal_threshold);
  give(object, "depth_threshold", settings.depth_threshold);
  give(object, "similarity", settings.similarity);
  give(object, "trace_missed", settings.trace_missed);
  give(object, "brute_force", settings.brute_force);
  give(object, "exposure_ev", settings.exposure_ev,
       [](const std::optional<double>& ev) { return ev ? number(*ev) : Json(nullptr); });
  give(object, "tone_map", settings.tone_map);
  give(object, "seed", settings.seed);
  give(object, "background", settings.background,
       [](const std::optional<Vector3>& color) { return color ? numbers(*color) : Json(nullptr); });
  give(object, "shadow_size", settings.shadow_size);
  give(object, "shadow_filter", settings.shadow_filter);
  give(object, "denoise", settings.denoise);
  give(object, "multiple_scattering", settings.multiple_scattering);
  give(object, "temporal_antialiasing", settings.temporal_antialiasing);
  give(object, "firefly_clamp", settings.firefly_clamp);
  give(object, "hand_over", settings.hand_over);
  give(object, "target_fps", settings.target_fps);
  give(object, "warm_up", settings.warm_up);
  return object;
}

Json to_json(const SceneEntry& entry) {
  return {{"name", entry.name},           {"builtin", entry.builtin},
          {"triangles", entry.triangles}, {"duration_s", number(entry.duration_s)},
          {"cameras", entry.cameras},     {"animated", entry.animated}};
}

Json to_json(std::span<const SceneEntry> scenes) {
  Json array = Json::array();
  for (const SceneEntry& entry : scenes) array.push_back(to_json(entry));
  return {{"scenes", std::move(array)}};
}

Json to_json(const LightEntry& entry) {
  Json object{{"index", entry.index},
              {"name", entry.name},
              {"kind", entry.kind},
              {"node", entry.node},
              {"position", numbers(entry.position)},
              {"direction", numbers(entry.direction)},
              {"color", numbers(entry.color)},
              {"intensity", number(entry.intensity)}};
  give(object, "parent_from_world", entry.parent_from_world, numbers<16>);
  return object;
}

Json to_json(const Session& session) {
  return {{"id", session.id},
          {"scene", session.scene},
          {"width", session.width},
          {"height", session.height},
          {"camera", to_json(session.camera)},
          {"settings", to_json(session.settings)},
          {"playing", session.playing},
          {"time_s", number(session.time_s)},
          {"revision", session.revision},
          {"viewers", session.viewers},
          {"idle_s", number(session.idle_s)}};
}

Json to_json(const RenderRequest& request) {
  return {{"scene", request.scene},
          {"time_s", number(request.time_s)},
          {"edits", request.edits},
          {"camera", to_json(request.camera)},
          {"width", request.width},
          {"height", request.height},
          {"settings", to_json(request.settings)},
          {"format", name_of(request.format)},
          {"spp_frames", request.spp_frames}};
}

Json to_json(const SessionRequest& request) {
  Json object{
      {"scene", request.scene},          {"camera", to_json(request.camera)}, {"settings", to_json(request.settings)},
      {"width", request.width},          {"height", request.height},          {"playing", request.playing},
      {"time_s", number(request.time_s)}};
  give(object, "idle_s", request.idle_s, number);
  return object;
}

Json to_json(const SessionPatch& patch) {
  Json object = Json::object();
  give_change(object, patch);
  return object;
}

Json to_json(const ClientMessage& message) {
  return std::visit(MessageWriter{}, message);
}
Json to_json(const ServerMessage& message) {
  return std::visit(MessageWriter{}, message);
}

std::string serialize(const ClientMessage& message) {
  return json_text(to_json(message));
}
std::string serialize(const ServerMessage& message) {
  return json_text(to_json(message));
}

}  // namespace lightwell::protocol
