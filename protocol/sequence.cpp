#include "protocol/sequence.h"

#include <algorithm>
#include <set>

#include "protocol/codec.h"
#include "protocol/names.h"
#include "protocol/read_values.h"

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostComponents = 64;  // of one value: morph weights have the most
constexpr std::uint32_t kLastFrame = 999'999;

void read_interpolation(const Value& value, KeyInterpolation& out) {
  for (const auto known : {KeyInterpolation::kStep, KeyInterpolation::kLinear, KeyInterpolation::kCubicSpline})
    if (value.json == name_of(known)) {
      out = known;
      return;
    }
  value.fail("must be \"STEP\", \"LINEAR\" or \"CUBICSPLINE\", not " + in_words(value.json));
}

/// A number, or an array of numbers.
void read_key_value(const Value& value, std::vector<double>& out) {
  if (value.json.is_array()) return ReadArray{1, kMostComponents, read_any_number}(value, out);
  double number = 0.0;
  read_any_number(value, number);
  if (!value.reading.failed()) out = {number};
}

void check_keys(const Value& value, const Keyframes& keys) {
  const std::size_t per_key = keys.interpolation == KeyInterpolation::kCubicSpline ? 3 : 1;
  const std::size_t wanted = per_key * keys.times_s.size();
  if (keys.values.size() != wanted)
    return value.member("values").fail("must have " + std::to_string(wanted) + " elements, not " +
                                       std::to_string(keys.values.size()));
  for (std::size_t i = 1; i < keys.times_s.size(); ++i)
    if (keys.times_s[i] <= keys.times_s[i - 1])
      return value.member("times_s").element(i).fail("must be later than the one before");
  for (std::size_t i = 1; i < keys.values.size(); ++i)
    if (keys.values[i].size() != keys.values[0].size() ||
        value.member("values").element(i).json.is_number() != keys.scalar)
      return value.member("values").element(i).fail("must be of the same kind as the first one");
}

void read_keyframes(const Value& value, Keyframes& out) {
  Keyframes keys;
  ObjectReader object(value);
  object.required("path", keys.path, ReadString{1, kLongestPath});
  object.with_default("interpolation", keys.interpolation, read_interpolation);
  object.required("times_s", keys.times_s, ReadArray{1, kMostKeys, read_time});
  object.required("values", keys.values, ReadArray{1, 3 * kMostKeys, read_key_value});
  object.finish();
  if (value.reading.failed()) return;
  if (!keys.path.starts_with('/')) return value.member("path").fail("must begin with /");
  keys.scalar = value.member("values").element(0).json.is_number();
  check_keys(value, keys);
  if (!value.reading.failed()) out = std::move(keys);
}

void check_camera(const Value& value, const SequenceRequest& request) {
  if (!request.camera_keyframes.empty() && !std::holds_alternative<FreeCamera>(request.camera))
    return value.member("camera_keyframes").fail("needs a camera with eye and target to begin with");
  for (std::size_t i = 0; i < request.camera_keyframes.size(); ++i) {
    const Keyframes& keys = request.camera_keyframes[i];
    const Value place = value.member("camera_keyframes").element(i);
    const bool is_point = keys.path == "/eye" || keys.path == "/target";
    if (!is_point && keys.path != "/yfov")
      return place.member("path").fail("must be /eye, /target or /yfov, not " + in_words(keys.path));
    if (keys.scalar == is_point || keys.values[0].size() != (is_point ? 3u : 1u))
      return place.member("values").fail(is_point ? "must be arrays of 3 numbers" : "must be numbers");
  }
}

void check_no_path_twice(const Value& value, const char* member, const std::vector<Keyframes>& all) {
  std::set<std::string_view> paths;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!paths.insert(all[i].path).second)
      return value.member(member).element(i).member("path").fail("has keyframes already");
}

void read_sequence_request(const Value& value, SequenceRequest& out) {
  constexpr ReadInteger<std::uint32_t> read_frame{0, kLastFrame};
  ObjectReader object(value);
  object.required("scene", out.scene, read_scene_name);
  object.with_default("edits", out.edits, read_edits);
  object.with_default("keyframes", out.keyframes, ReadArray{0, kMostKeyframes, read_keyframes});
  object.with_default("camera", out.camera, read_camera);
  object.with_default("camera_keyframes", out.camera_keyframes, ReadArray{0, 3, read_keyframes});
  object.with_default("first_frame", out.first_frame, read_frame);
  object.required("last_frame", out.last_frame, read_frame);
  object.with_default("fps", out.fps, ReadNumber{0.001, 1000});
  object.with_default("width", out.width, read_pixels);
  object.with_default("height", out.height, read_pixels);
  object.with_default("settings", out.settings, read_settings);
  object.with_default("views", out.views, ReadArray{1, kMostViews, read_token});
  object.with_default("format", out.format, read_image_format);
  object.with_default("spp_frames", out.spp_frames, ReadInteger<std::uint32_t>{1, 4096});
  object.finish();
  if (value.reading.failed()) return;
  if (out.last_frame < out.first_frame) return value.member("last_frame").fail("must not be before first_frame");
  if (out.settings.view) return value.member("settings").member("view").fail("views says which views are rendered");
  check_camera(value, out);
  if (!out.keyframes.empty()) check_no_path_twice(value, "keyframes", out.keyframes);
  if (!out.camera_keyframes.empty()) check_no_path_twice(value, "camera_keyframes", out.camera_keyframes);
}

}  // namespace

std::string_view name_of(KeyInterpolation interpolation) {
  switch (interpolation) {
    case KeyInterpolation::kStep:
      return "STEP";
    case KeyInterpolation::kLinear:
      return "LINEAR";
    case KeyInterpolation::kCubicSpline:
      break;
  }
  return "CUBICSPLINE";
}

std::string_view name_of(SequenceState state) {
  switch (state) {
    case SequenceState::kQueued:
      return "queued";
    case SequenceState::kRunning:
      return "running";
    case SequenceState::kDone:
      return "done";
    case SequenceState::kFailed:
      return "failed";
    case SequenceState::kCancelled:
      break;
  }
  return "cancelled";
}

Decoded<SequenceRequest> parse_sequence_request(std::string_view body) {
  const Decoded<Json> json = parse_json(body);
  if (!json) return json.problem();
  Reading reading(UnknownMembers::kRefused);
  SequenceRequest request;
  read_sequence_request(Value{*json, {}, reading}, request);
  if (reading.failed()) return reading.problem();
  return request;
}

Json to_json(const Keyframes& keyframes) {
  Json values = Json::array();
  for (const auto& value : keyframes.values)
    if (keyframes.scalar)
      values.push_back(value.front());
    else
      values.push_back(value);
  return {{"path", keyframes.path},
          {"interpolation", name_of(keyframes.interpolation)},
          {"times_s", keyframes.times_s},
          {"values", std::move(values)}};
}

Json to_json(const SequenceRequest& request) {
  const auto keyframes_json = [](const std::vector<Keyframes>& all) {
    Json array = Json::array();
    for (const Keyframes& keys : all) array.push_back(to_json(keys));
    return array;
  };
  return {{"scene", request.scene},
          {"edits", request.edits},
          {"keyframes", keyframes_json(request.keyframes)},
          {"camera", to_json(request.camera)},
          {"camera_keyframes", keyframes_json(request.camera_keyframes)},
          {"first_frame", request.first_frame},
          {"last_frame", request.last_frame},
          {"fps", request.fps},
          {"width", request.width},
          {"height", request.height},
          {"settings", to_json(request.settings)},
          {"views", request.views},
          {"format", name_of(request.format)},
          {"spp_frames", request.spp_frames}};
}

Json to_json(const Sequence& sequence) {
  Json object{{"id", sequence.id},
              {"state", name_of(sequence.state)},
              {"frames_total", sequence.frames_total},
              {"frames_done", sequence.frames_done},
              {"bytes", sequence.bytes},
              {"request", sequence.request}};
  if (sequence.problem) object["problem"] = to_json(*sequence.problem);
  return object;
}

}  // namespace lightwell::protocol
