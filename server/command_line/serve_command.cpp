#include "server/command_line/serve_command.h"

#include <cstdlib>
#include <limits>

#include "server/command_line/add_option.h"
#include "server/command_line/environment_options.h"
#include "server/command_line/settings_options.h"

namespace lightwell {

namespace {

constexpr long long kAnyInt = std::numeric_limits<int>::max();

// In MiB on the command line, in bytes inside.
void add_mebibytes(CLI::App& app, const std::string& name, std::uint64_t& target_bytes, const std::string& help) {
  const auto parse = [](const std::string& text) -> Result<std::uint64_t> {
    const Result<long long> mebibytes = parse_integer(text, 1, 1 << 20);
    if (!mebibytes) return mebibytes.error();
    return static_cast<std::uint64_t>(*mebibytes) << 20;
  };
  add_parsed(app, name, target_bytes, parse, "MIB", help, std::to_string(target_bytes >> 20));
}

void add_count(CLI::App& app, const std::string& name, std::uint64_t& target, const std::string& help) {
  add_integer(app, name, target, 1, 1'000'000'000, help);
}

void add_limit_options(CLI::App& app, ServeLimits& limits) {
  add_integer(app, "--max-size", limits.max_size_px, 16, kMaxPictureSide, "A picture's longer side in pixels");
  add_count(app, "--max-triangles", limits.max_triangles, "One uploaded or edited scene's triangles");
  add_mebibytes(app, "--max-texture-memory", limits.max_texture_bytes, "One uploaded scene's decoded textures");
  add_integer(app, "--max-samples", limits.max_samples, 1, 4096, "Directions per pixel of the indirect map");
  add_integer(app, "--max-spp-frames", limits.max_spp_frames, 1, kAnyInt, "Accumulated frames of one render request");
  add_mebibytes(app, "--max-upload", limits.max_upload_bytes, "One uploaded scene");
  add_mebibytes(app, "--max-upload-total", limits.max_scene_bytes, "All uploaded scenes together");
  add_integer(app, "--max-scenes", limits.max_scenes, 0, kAnyInt, "Uploaded scenes");
  add_integer(app, "--max-sequence-frames", limits.max_sequence_frames, 1, 1'000'000, "Frames of one sequence");
  add_mebibytes(app, "--max-sequence-disk", limits.max_sequence_bytes, "Files of all sequences");
  const auto seconds = [](const std::string& text) { return parse_number(text, 1.0, 1e9); };
  add_parsed(app, "--keep-sequences", limits.sequence_keep_s, seconds, "SECONDS",
             "A sequence that has ended is forgotten after this", "604800");
  add_integer(app, "--max-sessions", limits.max_sessions, 1, kAnyInt, "Sessions at a time");
  add_integer(app, "--max-connections", limits.max_connections, 1, kAnyInt, "Connections at a time");
  add_integer(app, "--max-viewers", limits.max_viewers_per_session, 1, kAnyInt, "Viewers of one session");
  add_integer(app, "--max-own-looks", limits.max_own_looks, 0, kAnyInt,
              "Viewers of a session with a camera or size of their own");
  add_parsed(app, "--session-idle", limits.session_idle_s, seconds, "SECONDS",
             "A session without viewers and requests ends after this", "600");
}

// Where the XDG base directory specification has state that outlives a program; empty where there is no home.
std::string default_data_dir() {
  const char* state = std::getenv("XDG_STATE_HOME");
  if (state && *state == '/') return std::string(state) + "/lightwell";
  const char* home = std::getenv("HOME");
  return home && *home == '/' ? std::string(home) + "/.local/state/lightwell" : std::string();
}

void add_access_options(CLI::App& app, ServeOptions& options) {
  AccessOptions& access = options.access;
  const auto read = [](const std::string& path) { return TokenList::read(path); };
  add_parsed(app, "--tokens", access.tokens, read, "FILE",
             "Serve only who has one of the file's bearer tokens; lines of SCOPE[,SCOPE] TOKEN, scopes view, drive, "
             "upload and admin");
  const auto add_token = [&access](const std::string& token) {
    if (const Status added = access.tokens.add(token, Scopes::all()); !added)
      throw CLI::ValidationError("--token", added.error().message());
  };
  app.add_option_function<std::string>("--token", add_token,
                                       "One token with all scopes; the environment hides it better from others")
      ->type_name("TOKEN")
      ->envname("LIGHTWELL_TOKEN");
  app.add_option("--tls-certificate", options.tls_certificate, "Speak TLS with this certificate chain (PEM)")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  app.add_option("--tls-key", options.tls_key, "The certificate's private key (PEM)")
      ->type_name("FILE")
      ->check(CLI::ExistingFile);
  app.get_option("--tls-certificate")->needs("--tls-key");
  app.get_option("--tls-key")->needs("--tls-certificate");
  const auto add_names = [&](const char* name, std::vector<std::string>& target, const char* kind, const char* help) {
    app.add_option(name, target, help)->type_name(kind)->expected(1)->take_all();
  };
  add_names("--allow-origin", access.allowed_origins, "ORIGIN",
            "A page from elsewhere that may use the API (CORS) and open streams; repeatable");
  add_names("--allow-host", access.allowed_hosts, "NAME",
            "A name this server goes by, for requests without tokens that a proxy forwards; repeatable");
  const auto number = [](const std::string& text) { return parse_number(text, 0.0, 1e6); };
  add_parsed(app, "--max-request-rate", access.requests_per_second, number, "N",
             "Requests a second of one client; 0: no limit", "100");
  add_parsed(app, "--request-burst", access.request_burst, number, "N", "Requests of one client at once", "400");
}

/// An option that takes one of these names. `standard` is what it is without.
template <class Value>
void add_one_of(CLI::App& app, const std::string& name, Value& target,
                const std::vector<std::pair<std::string, Value>>& values, const std::string& standard,
                const std::string& help) {
  std::string names;
  for (const auto& [known, value] : values) names += (names.empty() ? "" : "|") + known;
  const auto parse = [values, names](const std::string& text) -> Result<Value> {
    for (const auto& [known, value] : values)
      if (text == known) return value;
    return invalid_input("", "expected one of " + names + ", not \"" + text + "\"");
  };
  add_parsed(app, name, target, parse, names, help, standard);
}

}  // namespace

void add_serve_options(CLI::App& app, ServeOptions& options) {
  app.add_option("SCENE", options.scene, "A .glb or .gltf file, or builtin:NAME")->capture_default_str();
  app.option_defaults()->group("Network");
  app.add_option("--host", options.host, "The address to listen on")->capture_default_str();
  add_integer(app, "--port", options.port, 0, 65535, "The port to listen on; 0: any free one");
  app.add_option("--base-path", options.base_path, "The prefix that a proxy forwards")->type_name("/PATH");
  app.add_option("--web-client", options.web_client_dir, "Serve the viewer from this folder, not from the binary")
      ->check(CLI::ExistingDirectory);
  add_integer(app, "--quality", options.quality, 1, 100, "JPEG quality while the picture moves");
  app.add_flag("--video,!--no-video", options.video,
               "Send what moves as H.264 to who takes it, and make films of sequences, where libavcodec is there");
  add_parsed(
      app, "--reference-after", options.reference_after_s,
      [](const std::string& text) { return parse_number(text, 0.0, 1e6); }, "SECONDS",
      "A session that stands still for so long goes over into the method reference; 0: never", "10");
  add_device_options(app, options.device, options.tracer);
  add_settings_options(app, options.settings);
  app.option_defaults()->group("Operations");
  add_parsed(
      app, "--drain-delay", options.drain_delay_s,
      [](const std::string& text) { return parse_number(text, 0.0, 3600.0); }, "SECONDS",
      "Told to stop, serve on for so long while not ready, so that a balancer notices", "0");
  options.data_dir = default_data_dir();
  app.add_option(
         "--data", options.data_dir,
         "The folder that sequences and sessions are kept in; empty: no sequences, and sessions end with the server")
      ->capture_default_str()
      ->type_name("FOLDER");
  add_one_of<LogFormat>(app, "--log-format", options.log_format,
                        {{"text", LogFormat::kText}, {"json", LogFormat::kJson}}, "text",
                        "How standard error is written");
  add_one_of<LogLevel>(app, "--log-level", options.log_level,
                       {{"debug", LogLevel::kDebug},
                        {"info", LogLevel::kInfo},
                        {"warning", LogLevel::kWarning},
                        {"error", LogLevel::kError}},
                       "info", "The least that is written; debug: every request");
  app.option_defaults()->group("Light");
  add_environment_options(app, options.environment);
  app.option_defaults()->group("Access");
  add_access_options(app, options);
  app.option_defaults()->group("Limits");
  add_limit_options(app, options.limits);
}

}  // namespace lightwell
