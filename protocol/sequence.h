// Scripted frames: what POST /v1/sequences asks for, and what is told of it. sequence.cpp turns both into JSON and
// back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/messages.h"

namespace lightwell::protocol {

/// glTF's: an animation sampler's interpolation.
enum class KeyInterpolation { kStep, kLinear, kCubicSpline };

/// A property over time: a JSON pointer of the scene's object model, or of a free camera, and its values at ascending
/// times. Before the first key and after the last the value stands still. For cubic splines each key has three values:
/// in-tangent, value, out-tangent. Rotations (a pointer that ends in /rotation, 4 numbers) are interpolated on the
/// sphere.
struct Keyframes {
  std::string path;
  KeyInterpolation interpolation = KeyInterpolation::kLinear;
  std::vector<double> times_s;
  std::vector<std::vector<double>> values;  // all of one length; 1 is a plain number
  bool scalar = false;                      // the values were given, and are set, as numbers

  bool operator==(const Keyframes&) const = default;
};

/// POST /v1/sequences. Frame n shows the scene at n / fps seconds.
struct SequenceRequest {
  std::string scene;
  Edits edits = Edits::array();      // before everything
  std::vector<Keyframes> keyframes;  // edits over time
  CameraSpec camera;
  std::vector<Keyframes> camera_keyframes;  // of /eye, /target and /yfov; `camera` must be a free one then
  std::uint32_t first_frame = 0, last_frame = 0;
  double fps = 30.0;
  std::uint16_t width = 512, height = 512;
  SettingsSpec settings;  // without `view`
  std::vector<std::string> views{"final"};
  ImageFormat format = ImageFormat::kPng;
  std::uint32_t spp_frames = 1;

  bool operator==(const SequenceRequest&) const = default;
};

enum class SequenceState { kQueued, kRunning, kDone, kFailed, kCancelled };

/// A sequence as GET /v1/sequences/{id} gives it.
struct Sequence {
  std::string id;
  SequenceState state = SequenceState::kQueued;
  std::uint32_t frames_total = 0, frames_done = 0;
  std::uint64_t bytes = 0;         // of the finished files
  std::optional<Problem> problem;  // why it failed
  nlohmann::json request;          // as it is carried out, all settings given

  bool operator==(const Sequence&) const = default;
};

inline constexpr std::size_t kMostKeys = 10'000;      // of one property
inline constexpr std::size_t kMostKeyframes = 1'000;  // properties
inline constexpr std::size_t kMostViews = 16;

/// As codec.h's parse_* are.
Decoded<SequenceRequest> parse_sequence_request(std::string_view body);

nlohmann::json to_json(const Keyframes& keyframes);
nlohmann::json to_json(const SequenceRequest& request);
nlohmann::json to_json(const Sequence& sequence);

std::string_view name_of(KeyInterpolation interpolation);  // "STEP", "LINEAR", "CUBICSPLINE"
std::string_view name_of(SequenceState state);             // "queued", "running", "done", "failed", "cancelled"

}  // namespace lightwell::protocol
