// Everything that travels, as plain values; README.md describes it and codec.h turns it into bytes and back.
// Names that belong to the renderer (methods, views, estimators, tone maps) travel as strings; the server checks them,
// and the renderer's ranges, against the renderer. What is checked here is said at each member.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "protocol/decoded.h"

namespace lightwell::protocol {

inline constexpr std::string_view kSubprotocol = "lightwell.v1";
inline constexpr int kProtocolVersion = 1;

using Vector3 = std::array<double, 3>;

/// The scene's first camera, else a camera that shows all of it; null on the wire.
struct DefaultCamera {
  bool operator==(const DefaultCamera&) const = default;
};

/// One of the scene's own cameras. Whether it exists is checked by the server.
struct SceneCamera {
  std::uint32_t index = 0;
  bool operator==(const SceneCamera&) const = default;
};

/// A perspective camera at `eye` looking at `target`, +Y up. The two points differ.
struct FreeCamera {
  Vector3 eye{0, 0, 0};
  Vector3 target{0, 0, -1};
  double yfov = 0.8;            // radians, in (0, 3.14]
  std::optional<double> znear;  // metres, above 0

  bool operator==(const FreeCamera&) const = default;
};

using CameraSpec = std::variant<DefaultCamera, SceneCamera, FreeCamera>;

/// SettingsSpec::bounces of "inf": paths end by chance alone.
constexpr std::int32_t kEndlessBounces = -1;

/// How a picture is made; what is absent keeps its value (in a patch) or has the renderer's default. For the two
/// members that null has a meaning for, the outer optional says "given" and the inner one "not null".
struct SettingsSpec {
  std::optional<std::string> method;
  std::optional<std::int32_t> samples;        // 1 or more
  std::optional<std::int32_t> bounces;        // 0 or more, or kEndlessBounces
  std::optional<std::int32_t> indirect_size;  // pixels, 1 or more
  std::optional<std::string> estimator;
  std::optional<std::string> view;
  std::optional<std::int32_t> view_index;       // 0 or more
  std::optional<std::int32_t> patch;            // pixels of the indirect map, 1 or more
  std::optional<std::int32_t> triangle_groups;  // 1 or more
  std::optional<double> normal_threshold;       // a cosine
  std::optional<double> depth_threshold;        // a share, 0 or more
  std::optional<std::string> similarity;
  std::optional<bool> trace_missed;
  std::optional<bool> brute_force;
  std::optional<std::optional<double>> exposure_ev;  // null: automatic
  std::optional<std::string> tone_map;
  std::optional<std::uint32_t> seed;
  std::optional<std::optional<Vector3>> background;  // linear nit, not negative; null: the environment
  std::optional<std::int32_t> shadow_size;           // pixels, 1 or more
  std::optional<std::int32_t> shadow_filter;         // pixels, 1 or more
  std::optional<bool> denoise;
  std::optional<bool> multiple_scattering;
  std::optional<bool> temporal_antialiasing;
  std::optional<double> firefly_clamp;  // times the mean, 0 or more
  std::optional<bool> hand_over;
  std::optional<std::int32_t> target_fps;  // 0 or more
  std::optional<std::int32_t> warm_up;     // frames, 0 or more

  bool operator==(const SettingsSpec&) const = default;
};

/// A JSON Patch: an array of RFC 6902 operations, already checked for their shape (see read_edits in read_values.h).
using Edits = nlohmann::json;

enum class ImageFormat { kPng, kJpeg, kExr };

/// POST /v1/render.
struct RenderRequest {
  std::string scene;  // a scene name
  double time_s = 0.0;
  Edits edits = Edits::array();
  CameraSpec camera;
  std::uint16_t width = 512;  // pixels, 1 or more
  std::uint16_t height = 512;
  SettingsSpec settings;
  ImageFormat format = ImageFormat::kPng;
  std::uint32_t spp_frames = 1;  // frames with different seeds in the picture, 1..4096

  bool operator==(const RenderRequest&) const = default;
};

/// POST /v1/sessions.
struct SessionRequest {
  std::string scene;
  CameraSpec camera;
  SettingsSpec settings;
  std::uint16_t width = 1280;
  std::uint16_t height = 720;
  bool playing = true;
  double time_s = 0.0;
  std::optional<double> idle_s;  // it ends after so long without viewers and requests; none: the server's own time

  bool operator==(const SessionRequest&) const = default;
};

/// PATCH /v1/sessions/{id}, and what an input carries: what is absent stays as it is.
struct SessionPatch {
  std::optional<Edits> edits;
  std::optional<CameraSpec> camera;
  std::optional<SettingsSpec> settings;
  std::optional<bool> playing;
  std::optional<double> time_s;
  std::optional<std::string> scene;
  std::optional<std::uint16_t> width, height;

  bool operator==(const SessionPatch&) const = default;
};

/// The query of GET /v1/sessions/{id}/frame; what is absent is the session's own.
struct FrameQuery {
  ImageFormat format = ImageFormat::kJpeg;
  std::optional<std::uint16_t> width, height;
  std::optional<std::string> view;

  bool operator==(const FrameQuery&) const = default;
};

/// One line of GET /v1/scenes.
struct SceneEntry {
  std::string name;
  bool builtin = false;
  std::uint64_t triangles = 0;
  double duration_s = 0.0;  // after which the animations repeat; 0 if none
  std::vector<std::string> cameras;
  bool animated = false;

  bool operator==(const SceneEntry&) const = default;
};

/// The box round a scene, world space, metres.
struct Bounds {
  Vector3 min{0, 0, 0}, max{0, 0, 0};
  bool operator==(const Bounds&) const = default;
};

/// A light as it stands at the session's time.
struct LightEntry {
  std::uint32_t index = 0;  // /extensions/KHR_lights_punctual/lights/{index}
  std::string name;
  std::string kind;                                         // "directional", "point" or "spot"
  std::uint32_t node = 0;                                   // /nodes/{node}
  Vector3 position{0, 0, 0};                                // world space, metres
  Vector3 direction{0, 0, -1};                              // world space, unit, the way it shines
  Vector3 color{1, 1, 1};                                   // linear
  double intensity = 1.0;                                   // lux for a directional light, candela for the others
  std::optional<std::array<double, 16>> parent_from_world;  // column by column; given if the node has a parent

  bool operator==(const LightEntry&) const = default;
};

/// A session as GET, POST and PATCH of /v1/sessions give it.
struct Session {
  std::string id;
  std::string scene;
  std::uint16_t width = 0, height = 0;
  CameraSpec camera;      // as it was asked for
  SettingsSpec settings;  // all members given
  bool playing = true;
  double time_s = 0.0;
  std::uint64_t revision = 0;
  std::uint32_t viewers = 0;
  double idle_s = 0.0;  // as in the request

  bool operator==(const Session&) const = default;
};

enum class Role {
  kDriver,  // may send inputs
  kViewer,  // only watches; its inputs are refused
};

// From a client.

struct Hello {
  std::vector<std::string> codecs;  // in the order of preference, at least one; unknown ones are not an error
  std::uint16_t width = 0, height = 0;
  double device_pixel_ratio = 1.0;  // (0, 16]
  Role role = Role::kDriver;
  std::optional<std::string> resume;  // the token of an earlier welcome

  bool operator==(const Hello&) const = default;
};

struct Input {
  std::uint32_t seq = 0;  // ascending, from 1
  SessionPatch change;

  bool operator==(const Input&) const = default;
};

/// A viewer's own look at the session: what is absent is the driver's. All absent: the driver's pictures again.
struct Look {
  std::uint32_t seq = 0;  // ascending, from 1
  std::optional<CameraSpec> camera;
  std::optional<std::uint16_t> width, height;

  bool shares_pictures() const { return !camera && !width && !height; }
  bool operator==(const Look&) const = default;
};

struct Ack {
  std::uint32_t frame = 0;                                  // the frame's id
  std::optional<double> received_ms, decoded_ms, shown_ms;  // the client's clock
  std::uint32_t queue = 0;                                  // frames waiting to be shown
  std::optional<double> held_ms;                            // how long the client kept this to itself: nobody looked

  bool operator==(const Ack&) const = default;
};

/// The client has trouble with video: it goes on with JPEG alone.
struct Demotion {
  std::string reason;  // for the server's log, at most 256 bytes
  bool operator==(const Demotion&) const = default;
};

struct Ping {
  double t = 0.0;
  bool operator==(const Ping&) const = default;
};

using ClientMessage = std::variant<Hello, Input, Look, Ack, Demotion, Ping>;

// From the server.

struct Limits {
  std::uint32_t max_width = 0, max_height = 0;
  std::uint32_t max_samples = 0;
  std::uint64_t max_upload_bytes = 0;

  bool operator==(const Limits&) const = default;
};

struct Welcome {
  std::string session;
  Role role = Role::kDriver;  // as granted
  std::string codec;          // as chosen
  int protocol = kProtocolVersion;
  std::string resume;
  std::string scene;
  std::vector<SceneEntry> scenes;
  SettingsSpec settings;  // all members given
  CameraSpec camera;      // as it was asked for
  bool playing = true;
  double time_s = 0.0;
  std::string device;
  Limits limits;
  std::vector<std::string> methods;  // what this server can do
  std::vector<std::string> codecs;   // what it can send pictures as
  Bounds bounds;
  FreeCamera view;  // the camera in world space, however it was asked for
  std::vector<LightEntry> lights;

  bool operator==(const Welcome&) const = default;
};

/// What changed; what is absent did not.
struct StateUpdate {
  std::optional<std::uint32_t> seq;  // the input that caused it
  std::optional<std::string> scene;
  std::optional<std::vector<SceneEntry>> scenes;
  std::optional<SettingsSpec> settings;
  std::optional<CameraSpec> camera;
  std::optional<bool> playing;
  std::optional<double> time_s;
  std::optional<Bounds> bounds;
  std::optional<FreeCamera> view;
  std::optional<std::vector<LightEntry>> lights;

  bool operator==(const StateUpdate&) const = default;
};

/// What moves by itself, as it stands in the frame that follows.
struct PoseUpdate {
  std::uint32_t frame = 0;
  FreeCamera view;
  std::vector<LightEntry> lights;

  bool operator==(const PoseUpdate&) const = default;
};

struct StageEntry {
  std::string name;
  double ms = 0.0;
  bool operator==(const StageEntry&) const = default;
};

struct Stats {
  double fps = 0.0;
  double render_ms = 0.0;
  double encode_ms = 0.0;
  std::vector<StageEntry> stages;
  std::uint64_t rays = 0;
  std::uint64_t triangles = 0;
  double exposure_ev = 0.0;
  std::uint32_t accumulated = 1;  // frames in the picture while refining
  double clamped_share = 0.0;     // of the indirect light, what the firefly clamp took away, 0 to 1
  std::string method;             // what the picture was made by, the session's or `reference`
  double time_s = 0.0;

  bool operator==(const Stats&) const = default;
};

struct ErrorMessage {
  Problem problem;
  std::optional<std::uint32_t> seq;  // of the input that was refused

  bool operator==(const ErrorMessage&) const = default;
};

struct Pong {
  double t = 0.0;
  bool operator==(const Pong&) const = default;
};

struct Bye {
  std::string reason;
  bool reconnect = false;

  bool operator==(const Bye&) const = default;
};

using ServerMessage = std::variant<Welcome, StateUpdate, PoseUpdate, Stats, ErrorMessage, Pong, Bye>;

/// WebSocket close codes.
enum class CloseCode : std::uint16_t {
  kDraining = 1001,
  kBadMessage = 4000,
  kSessionEnded = 4001,
  kTooSlow = 4002,
  kNotAllowed = 4003,
};

}  // namespace lightwell::protocol
