#include "protocol/read_values.h"

#include <algorithm>

#include "protocol/names.h"

namespace lightwell::protocol {
namespace {

/// RFC 6901: empty, or tokens each after a slash in which ~ stands only before 0 and 1.
bool is_json_pointer(const std::string& text) {
  if (!text.empty() && text.front() != '/') return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '~' && (i + 1 == text.size() || (text[i + 1] != '0' && text[i + 1] != '1'))) return false;
  return true;
}

void check_path(const Value& edit, std::string_view name) {
  if (!edit.json.contains(name)) return edit.fail("the member \"" + std::string(name) + "\" is missing");
  const Value path = edit.member(name);
  std::string text;
  ReadString{0, kLongestPath}(path, text);
  if (!is_json_pointer(text)) path.fail("is no JSON pointer: " + in_words(path.json));
}

void check_edit(const Value& edit) {
  if (!edit.json.is_object()) return edit.fail("must be an object, not " + in_words(edit.json));
  if (!edit.json.contains("op")) return edit.fail("the member \"op\" is missing");
  const Value op = edit.member("op");
  if (op.json == "move" || op.json == "copy") return op.fail("\"move\" and \"copy\" are not supported");
  const bool takes_value = op.json == "add" || op.json == "replace" || op.json == "test";
  if (!takes_value && op.json != "remove")
    return op.fail("must be \"add\", \"remove\", \"replace\" or \"test\", not " + in_words(op.json));
  check_path(edit, "path");
  if (takes_value && !edit.json.contains("value")) edit.fail("the member \"value\" is missing");
}

void read_color(const Value& value, Vector3& out) {
  Vector3 color;
  read_numbers<3>(value, color);
  for (std::size_t channel = 0; channel < 3 && !value.reading.failed(); ++channel)
    ReadNumber{0, kLargestFloat}(value.element(channel), color[channel]);
  if (!value.reading.failed()) out = color;
}

void read_bounces(const Value& value, std::int32_t& out) {
  if (value.json == "inf")
    out = kEndlessBounces;
  else if (value.json.is_string())
    value.fail("must be an integer or \"inf\", not " + in_words(value.json));
  else
    ReadInteger<std::int32_t>{0, 0x7fffffff}(value, out);
}

template <class Enum>
void read_name(const Value& value, Enum& out, std::optional<Enum> (*from_name)(std::string_view), const char* names) {
  if (!value.json.is_string()) return value.fail("must be a string, not " + in_words(value.json));
  const std::optional<Enum> found = from_name(value.json.get_ref<const std::string&>());
  if (!found) return value.fail("must be " + std::string(names) + ", not " + in_words(value.json));
  out = *found;
}

}  // namespace

void read_scene_name(const Value& value, std::string& out) {
  if (!value.json.is_string() || !is_scene_name(value.json.get_ref<const std::string&>()))
    return value.fail("must be a scene's name, 1 to 64 of a-z, 0-9, _ and -, not " + in_words(value.json));
  out = value.json.get<std::string>();
}

void read_free_camera(const Value& value, FreeCamera& out) {
  FreeCamera camera;
  ObjectReader object(value);
  object.required("eye", camera.eye, read_numbers<3>);
  object.required("target", camera.target, read_numbers<3>);
  object.with_default("yfov", camera.yfov, ReadNumber{0, 3.14, true});
  object.optional("znear", camera.znear, ReadNumber{0, kLargestFloat, true});
  object.finish();
  if (camera.eye == camera.target) value.fail("eye and target are the same point");
  if (!value.reading.failed()) out = camera;
}

void read_camera(const Value& value, CameraSpec& out) {
  if (value.json.is_null()) {
    out = DefaultCamera{};
  } else if (value.json.is_object() && value.json.contains("index")) {
    SceneCamera camera;
    ObjectReader object(value);
    object.required("index", camera.index, read_index);
    object.finish();
    out = camera;
  } else {
    FreeCamera camera;
    read_free_camera(value, camera);
    out = camera;
  }
}

void read_settings(const Value& value, SettingsSpec& out) {
  constexpr ReadInteger<std::int32_t> at_least_one{1, 0x7fffffff};
  SettingsSpec settings;
  ObjectReader object(value);
  object.optional("method", settings.method, read_token);
  object.optional("samples", settings.samples, at_least_one);
  object.optional("bounces", settings.bounces, read_bounces);
  object.optional("indirect_size", settings.indirect_size, at_least_one);
  object.optional("estimator", settings.estimator, read_token);
  object.optional("view", settings.view, read_token);
  object.optional("view_index", settings.view_index, ReadInteger<std::int32_t>{0, 0x7fffffff});
  object.optional("patch", settings.patch, at_least_one);
  object.optional("triangle_groups", settings.triangle_groups, at_least_one);
  object.optional("normal_threshold", settings.normal_threshold, ReadNumber{-1, 1});
  object.optional("depth_threshold", settings.depth_threshold, ReadNumber{0, 10});
  object.optional("similarity", settings.similarity, read_token);
  object.optional("trace_missed", settings.trace_missed, read_boolean);
  object.optional("brute_force", settings.brute_force, read_boolean);
  object.optional("exposure_ev", settings.exposure_ev, ReadNullable{ReadNumber{-64, 64}});
  object.optional("tone_map", settings.tone_map, read_token);
  object.optional("seed", settings.seed, ReadInteger<std::uint32_t>{0, 0xffffffff});
  object.optional("background", settings.background, ReadNullable{read_color});
  object.optional("shadow_size", settings.shadow_size, at_least_one);
  object.optional("shadow_filter", settings.shadow_filter, at_least_one);
  object.optional("denoise", settings.denoise, read_boolean);
  object.optional("multiple_scattering", settings.multiple_scattering, read_boolean);
  object.optional("temporal_antialiasing", settings.temporal_antialiasing, read_boolean);
  object.optional("firefly_clamp", settings.firefly_clamp, ReadNumber{0, 1e6});
  object.optional("hand_over", settings.hand_over, read_boolean);
  object.optional("target_fps", settings.target_fps, ReadInteger<std::int32_t>{0, 0x7fffffff});
  object.optional("warm_up", settings.warm_up, ReadInteger<std::int32_t>{0, 0x7fffffff});
  object.finish();
  if (!value.reading.failed()) out = std::move(settings);
}

void read_image_format(const Value& value, ImageFormat& out) {
  read_name(value, out, image_format_from_name, "\"png\", \"jpeg\" or \"exr\"");
}

void read_role(const Value& value, Role& out) {
  read_name(value, out, role_from_name, "\"driver\" or \"viewer\"");
}

void read_edits(const Value& value, Edits& out) {
  if (!value.json.is_array() || value.json.size() > kMostEdits)
    return value.fail("must be an array of at most " + std::to_string(kMostEdits) + " edits, not " +
                      in_words(value.json));
  for (std::size_t i = 0; i < value.json.size() && !value.reading.failed(); ++i) check_edit(value.element(i));
  if (!value.reading.failed()) out = value.json;
}

void read_change(ObjectReader& object, SessionPatch& out) {
  object.optional("edits", out.edits, read_edits);
  object.optional("camera", out.camera, read_camera);
  object.optional("settings", out.settings, read_settings);
  object.optional("playing", out.playing, read_boolean);
  object.optional("time_s", out.time_s, read_time);
  object.optional("scene", out.scene, read_scene_name);
  object.optional("width", out.width, read_pixels);
  object.optional("height", out.height, read_pixels);
}

}  // namespace lightwell::protocol
