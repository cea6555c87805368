#include <algorithm>
#include <charconv>

#include "protocol/names.h"
#include "protocol/sequence.h"
#include "server/http/event_stream.h"
#include "server/sequences/film_stream.h"
#include "server/sequences/zip_stream.h"
#include "server/services.h"
#include "server/video/video_encoder.h"

namespace lightwell {
namespace {

using http::Request;
using http::Response;
using protocol::make_problem;
using protocol::Problem;
using protocol::Sequence;
using protocol::SequenceState;

constexpr std::uint64_t kMaxJsonBytes = 1u << 20;
constexpr int kMostFilms = 4;  // made at the same time: each holds pictures

Response refuse(int status, const std::string& detail) {
  return http::problem_response(make_problem(status, detail));
}

Response no_such_sequence() {
  return refuse(404, "there is no such sequence");
}

std::string quoted(const std::string& text) {
  return '"' + text + '"';
}

/// What the id is made of is all that the pictures depend on, so it is the tag of everything that never changes.
Response sequence_response(const Services& services, int status, const Sequence& sequence) {
  Response response = http::json_response(status, protocol::to_json(sequence));
  response.headers = {{"Location", services.options.base_path + "/v1/sequences/" + sequence.id},
                      {"ETag", quoted(sequence.id)},
                      {"Cache-Control", "no-store"}};
  return response;
}

Response submit(const Services& services, std::string_view body) {
  const auto request = protocol::parse_sequence_request(body);
  if (!request) return http::problem_response(request.problem());
  if (!services.render_loop.is_ready()) return refuse(503, "the shaders are being compiled");
  const SourceFacts facts = services.render_loop.ready().get();
  const auto submitted =
      services.sequences->submit(*request, "Lightwell " LIGHTWELL_VERSION ", " + facts.device + ", " + facts.tracer);
  if (!submitted) return http::problem_response(submitted.problem());
  return sequence_response(services, submitted->begun ? 202 : 200, submitted->sequence);
}

Response list(const Services& services) {
  nlohmann::json all = nlohmann::json::array();
  for (const Sequence& sequence : services.sequences->list()) all.push_back(protocol::to_json(sequence));
  return http::json_response(200, {{"sequences", std::move(all)}});
}

Response get(const Services& services, const std::string& id) {
  const auto sequence = services.sequences->find(id);
  return sequence ? sequence_response(services, 200, *sequence) : no_such_sequence();
}

Response cancel(const Services& services, const std::string& id) {
  services.sequences->cancel(id);
  return get(services, id);
}

Response remove(const Services& services, const std::string& id) {
  if (!services.sequences->remove(id)) return no_such_sequence();
  return {204, {}, {}, {}};
}

/// The view asked for; empty: the first.
protocol::Decoded<std::string> view_of(const Request& request) {
  std::string view;
  for (const auto& [name, value] : request.query) {
    if (name != "view") return make_problem(422, "the only parameter known here is view", "/" + name);
    view = value;
  }
  return view;
}

bool shows(const FrameFile& file, const std::string& view) {
  return file.name.find("." + view + ".") != std::string::npos;
}

Problem no_such_view(const std::string& view) {
  return make_problem(422, "the sequence has no view \"" + view + "\" in a file of its own", "/view");
}

/// The finished file of a frame that shows the view asked for, or why there is none.
protocol::Decoded<FrameFile> find_file(const Services& services, const Sequence& sequence, const Request& request) {
  const std::string& text = request.path_parameters[1];
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  const std::uint32_t first = sequence.request.value("first_frame", 0u);
  if (!is_number || number < first || number - first >= sequence.frames_total)
    return make_problem(404, "the sequence has no frame \"" + text + "\"");
  const std::vector<FrameFile> files = services.sequences->files(sequence.id, number);
  if (files.empty()) return make_problem(409, "frame " + std::to_string(number) + " is not finished yet");
  const auto view = view_of(request);
  if (!view) return view.problem();
  for (const FrameFile& file : files)
    if (view->empty() || shows(file, *view)) return file;
  return no_such_view(*view);
}

Response get_frame(const Services& services, const Request& request) {
  const auto sequence = services.sequences->find(request.path_parameters[0]);
  if (!sequence) return no_such_sequence();
  const auto file = find_file(services, *sequence, request);
  if (!file) return http::problem_response(file.problem());
  const std::string tag = quoted(sequence->id + "-" + file->name);
  http::Fields fields{{"ETag", tag}, {"Cache-Control", "private, max-age=31536000, immutable"}};
  if (request.if_none_match == tag) return {304, {}, {}, std::move(fields)};
  Result<std::string> bytes = services.sequences->folder().read(sequence->id, file->name);
  if (!bytes) return refuse(404, "the frame's file is gone");
  const auto format = protocol::image_format_from_name(sequence->request.value("format", std::string("png")));
  const auto type = protocol::media_type_of(format.value_or(protocol::ImageFormat::kPng));
  return {200, std::string(type), std::move(bytes).value(), std::move(fields)};
}

Problem not_done(const Sequence& sequence) {
  return make_problem(409, "the sequence is not done: " + std::to_string(sequence.frames_done) + " of " +
                               std::to_string(sequence.frames_total) + " frames are finished");
}

Response get_archive(const Services& services, const Request& request) {
  const auto sequence = services.sequences->find(request.path_parameters[0]);
  if (!sequence) return no_such_sequence();
  if (sequence->state != SequenceState::kDone) return http::problem_response(not_done(*sequence));
  const std::string tag = quoted(sequence->id + "-zip");
  http::Fields fields{{"ETag", tag},
                      {"Cache-Control", "private, max-age=31536000, immutable"},
                      {"Content-Disposition", "attachment; filename=\"" + sequence->id + ".zip\""}};
  if (request.if_none_match == tag) return {304, {}, {}, std::move(fields)};
  std::vector<FrameFile> files = services.sequences->files(sequence->id);
  const std::uint64_t bytes = zip_bytes(files);
  if (bytes > kLargestZip || files.size() > kMostZipEntries)
    return refuse(413, "the sequence's " + std::to_string(sequence->bytes) +
                           " bytes do not fit into a ZIP; fetch its frames one by one");
  auto stream = std::make_shared<ZipStream>(services.sequences->folder().path(sequence->id, ""), std::move(files));
  return {200, "application/zip", {}, std::move(fields), std::move(stream), bytes};
}

/// The frames that a film is made of, or why there can be none.
protocol::Decoded<FilmFrames> film_frames(const Services& services, const Sequence& sequence, const Request& request) {
  const auto asked = protocol::parse_sequence_request(protocol::json_text(sequence.request));
  if (!asked) return asked.problem();
  if (asked->format == protocol::ImageFormat::kExr)
    return make_problem(422, "the sequence's frames are EXR, which no display shows; ask for one in png");
  const glm::ivec2 size_px(asked->width, asked->height);
  if (!VideoEncoder::takes(size_px))
    return make_problem(422, "a film has even sides and at most 36,864 blocks of 16 x 16 pixels; these frames have " +
                                 std::to_string(size_px.x) + " x " + std::to_string(size_px.y) + " pixels");
  auto view = view_of(request);
  if (!view) return view.problem();
  if (view->empty()) *view = asked->views.front();
  if (std::find(asked->views.begin(), asked->views.end(), *view) == asked->views.end()) return no_such_view(*view);
  if (sequence.state != SequenceState::kDone) return not_done(sequence);
  FilmFrames frames{services.sequences->folder(), sequence.id, {}, size_px, asked->fps};
  for (const FrameFile& file : services.sequences->files(sequence.id))
    if (shows(file, *view)) frames.files.push_back(file.name);
  return frames;
}

/// A place among the films being made, given back with the last copy; null if there is none.
std::shared_ptr<void> take_place(std::atomic<int>& films) {
  if (++films <= kMostFilms) return {&films, [](std::atomic<int>* all) { --*all; }};
  --films;
  return nullptr;
}

Response get_video(const Services& services, const Request& request) {
  const auto sequence = services.sequences->find(request.path_parameters[0]);
  if (!sequence) return no_such_sequence();
  auto frames = film_frames(services, *sequence, request);
  if (!frames) return http::problem_response(frames.problem());
  if (!services.options.video || !can_encode_video())
    return refuse(501, "this server was built, or runs, without an H.264 encoder; fetch the frames, or the archive");
  const std::string tag = quoted(sequence->id + "-" + frames->files.front() + "-mp4");
  http::Fields fields{{"ETag", tag},
                      {"Cache-Control", "private, max-age=31536000, immutable"},
                      {"Content-Disposition", "attachment; filename=\"" + sequence->id + ".mp4\""}};
  if (request.if_none_match == tag) return {304, {}, {}, std::move(fields)};
  std::shared_ptr<void> place = take_place(services.films);
  if (!place) return refuse(503, std::to_string(kMostFilms) + " films are being made, as many as may be");
  auto film = std::make_shared<FilmStream>(std::move(frames).value(), services.long_workers, std::move(place));
  return {200, "video/mp4", {}, std::move(fields), std::move(film), 0};
}

/// Each time the sequence gets on, all that is known of it.
Response get_events(const Services& services, const std::string& id) {
  if (!services.sequences->find(id)) return no_such_sequence();
  const auto look = [&services, id]() -> std::optional<http::Event> {
    const auto sequence = services.leaving ? std::nullopt : services.sequences->find(id);
    if (!sequence) return {};
    const bool goes_on = sequence->state == SequenceState::kQueued || sequence->state == SequenceState::kRunning;
    return http::Event{std::string(protocol::name_of(sequence->state)),
                       protocol::json_text(protocol::to_json(*sequence)), !goes_on};
  };
  const auto listen = [&services, id](std::function<void()> wake) { return services.sequences->listen(id, wake); };
  return {
      200, "text/event-stream", {}, {{"Cache-Control", "no-store"}}, std::make_shared<http::EventStream>(look, listen),
      0};
}

}  // namespace

void add_sequence_routes(http::RouteTable& table, const Services& services) {
  using enum http::Effort;
  const auto add = [&](const char* method, const char* path, Scope scope, http::Effort effort, auto handler) {
    table.add({method, path, scope, effort, 0, {}, [&services, handler](const Request& request) {
                 if (!services.sequences) return refuse(503, "this server was given no folder for sequences (--data)");
                 return handler(services, request);
               }});
  };
  const auto by_id = [](Response (*answer)(const Services&, const std::string&)) {
    return
        [answer](const Services& given, const Request& request) { return answer(given, request.path_parameters[0]); };
  };
  table.add({"POST",
             "/v1/sequences",
             Scope::kDrive,
             kLong,
             kMaxJsonBytes,
             {"application/json"},
             [&services](const Request& request) {
               if (!services.sequences) return refuse(503, "this server was given no folder for sequences (--data)");
               return submit(services, request.body);
             }});
  add("GET", "/v1/sequences", Scope::kView, kQuick, [](const Services& given, const Request&) { return list(given); });
  add("GET", "/v1/sequences/{id}", Scope::kView, kQuick, by_id(get));
  add("DELETE", "/v1/sequences/{id}", Scope::kDrive, kQuick, by_id(remove));
  add("POST", "/v1/sequences/{id}/cancel", Scope::kDrive, kQuick, by_id(cancel));
  add("GET", "/v1/sequences/{id}/frames/{number}", Scope::kView, kQuick, get_frame);
  add("GET", "/v1/sequences/{id}/archive", Scope::kView, kQuick, get_archive);
  add("GET", "/v1/sequences/{id}/video", Scope::kView, kQuick, get_video);
  add("GET", "/v1/sequences/{id}/events", Scope::kView, kQuick, by_id(get_events));
}

}  // namespace lightwell
