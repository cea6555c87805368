// The server as one call: listens, loads, renders and streams until it is told to stop.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/image_io/environment_file.h"
#include "renderer/renderer.h"
#include "server/access/access_control.h"
#include "server/operations/log.h"

namespace lightwell {

/// What one server gives away at most. Whatever exceeds a limit gets an answer that names it.
struct ServeLimits {
  int max_size_px = 4096;                           // a picture's width and height
  std::uint64_t max_triangles = 8'000'000;          // one scene's, over all instances
  std::uint64_t max_texture_bytes = 2048ull << 20;  // one scene's, decoded
  int max_samples = 1024;                           // directions per pixel of the indirect map
  int max_spp_frames = 4096;                        // accumulated frames of one render request
  std::uint64_t max_upload_bytes = 256ull << 20;    // one .glb
  std::uint64_t max_scene_bytes = 1024ull << 20;    // all uploaded scenes together, as uploaded
  int max_scenes = 64;                              // uploaded scenes
  int max_sessions = 64;
  int max_connections = 4096;
  int max_viewers_per_session = 128;
  int max_own_looks = 4;  // viewers of a session with a camera or size of their own; its share of the time pays for it
  int max_sequence_frames = 10'000;                // of one sequence
  std::uint64_t max_sequence_bytes = 64ull << 30;  // files of all sequences; beyond, no new one is begun
  double sequence_keep_s = 7.0 * 86'400.0;         // one that has ended is forgotten after this
  double session_idle_s = 600.0;                   // a session without viewers or requests ends after this
};

/// What sessions, and pictures and sequences that are asked for, start with unless told otherwise: realtime with two
/// bounces and four rays a texel and frame; thesis, where it is chosen, is filtered and has small patches. Made to be
/// looked at, not to be the thesis. Three unseen frames halve the error of a picture that is asked for once.
inline Settings viewing_settings() {
  Settings settings;
  settings.method = Method::kRealtime;
  settings.samples = 64;
  settings.bounces = 2;
  settings.denoise = true;
  settings.patch = 2;
  settings.warm_up = 3;
  return settings;
}

struct ServeOptions {
  std::string scene = "builtin:atrium";    // a path to .glb or .gltf, or builtin:NAME; what the viewer opens with
  EnvironmentChoice environment;           // for `scene`; files are the operator's to name, no client can
  std::string host = "127.0.0.1";          // the address to listen on
  int port = 8080;                         // 0: any free port
  std::string device;                      // as gl::DeviceChoice::request
  std::string tracer;                      // as RendererOptions::tracer
  Settings settings = viewing_settings();  // of sessions, pictures and sequences that name none
  int quality = 80;                        // JPEG quality while the picture moves, 1..100; a still one ends at 95
  bool video = true;                       // where this build can encode it
  double reference_after_s = 10.0;         // still for so long, a session's picture is made by reference; 0: never
  std::string base_path;                   // "/lightwell" if a proxy forwards that prefix; empty: none
  AccessOptions access;                    // who may do what
  std::string tls_certificate;             // PEM, with its chain; empty: plain HTTP
  std::string tls_key;                     // PEM
  double drain_delay_s = 0.0;              // how long a stopping server serves on while it says that it is not ready
  std::string data_dir;                    // where sequences are kept; empty: there are none
  LogFormat log_format = LogFormat::kText;
  LogLevel log_level = LogLevel::kInfo;
  std::string web_client_dir;  // serves the viewer from this folder; empty: from the binary
  ServeLimits limits;
};

/// Serves until SIGINT or SIGTERM, then drains. Prints the address once the first picture can be had.
/// Returns the process's exit code: 0 drained, 1 the port is taken or the renderer failed, 3 the scene is refused,
/// 4 no device. Never throws.
int serve(const ServeOptions& options);

}  // namespace lightwell
