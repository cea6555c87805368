// Every refusal within a stream that the OpenAPI document shows is one that the server gives, in those words.
#include "server/data/database.h"
#include "server/session/session.h"
#include "server/video/video_encoder.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/refusals_fixture.h"

namespace lightwell::test {
namespace {

/// What a stream heard before its end, or before the error that was waited for.
struct Refused {
  json error, bye;
  int code = 0;
};
using Refusals = std::map<std::string, Refused>;  // by the name in the document

class Stream {
 public:
  explicit Stream(const Asked& asked, const std::string& session = {},
                  const test::WebSocketClient::Options& options = {})
      : client_(asked.server.port(), session.empty() ? asked.session() : session, options) {}

  Stream& hello(const json& more = json::object()) {
    welcome = client_.hello(more);
    return *this;
  }
  StreamClient& client() { return client_; }

  Refused error() { return {client_.next_text("error"), nullptr, 0}; }
  /// The same, of one who takes every picture on the way.
  Refused error_of_watcher() {
    while (const auto heard = client_.next()) {
      if (heard->frame) client_.ack(heard->frame->frame);
      if (heard->text.is_object() && heard->text["type"] == "error") return {heard->text, nullptr, 0};
    }
    return {};
  }
  Refused end() {
    Refused refused;
    while (const auto heard = client_.next()) {
      if (!heard->text.is_object()) continue;
      if (heard->text["type"] == "error") refused.error = heard->text;
      if (heard->text["type"] == "bye") refused.bye = heard->text;
    }
    refused.code = client_.socket().close_code();
    return refused;
  }

  json welcome;

 private:
  StreamClient client_;
};

void break_the_rules_of_inputs(Refusals& refused) {
  ServeOptions options = test_options();
  options.limits.max_own_looks = 1;
  Asked asked(options);
  const std::string session = asked.until_ready().session();
  Stream driver(asked, session), viewer(asked, session), other(asked, session);
  driver.hello();
  viewer.hello({{"role", "viewer"}});
  other.hello({{"role", "viewer"}});
  const json look{{"type", "look"}, {"seq", 1}, {"width", 32}, {"height", 32}};
  driver.client().send(look);
  refused["look_of_the_driver"] = driver.error();
  driver.client().input(1, {{"playing", 1}});
  refused["bad_member"] = driver.error();
  driver.client().input(1, {{"edits", json::array({{{"op", "remove"}, {"path", "/nodes/99"}}})}});
  refused["bad_edit"] = driver.error();
  driver.client().input(1, {{"playing", false}});
  refused["seq_descends"] = driver.error();
  viewer.client().input(1, {{"playing", false}});
  refused["input_of_a_viewer"] = viewer.error();
  viewer.client().send(look);
  viewer.client().send(look);  // its number is used up: the first is through
  viewer.error();
  other.client().send(look);
  refused["too_many_looks"] = other.error();
  asked.studio->throwing = true;
  driver.client().input(2, {{"time_s", 1}});
  refused["picture_failed"] = driver.error();
  asked.studio->throwing = false;
  asked.studio->lost = true;
  driver.client().input(3, {{"time_s", 2}});
  refused["device_lost"] = driver.error();
  asked.studio->lost = false;
}

void say_what_nobody_may(Refusals& refused) {
  Asked asked;
  asked.until_ready();
  const auto told = [&](const char* name, const auto& say) {
    Stream stream(asked);
    say(stream);
    refused[name] = stream.end();
  };
  const json hello{{"type", "hello"}, {"codecs", {"h264"}}, {"width", 64}, {"height", 64}, {"role", "driver"}};
  told("no_jpeg", [&](Stream& stream) { stream.client().send(hello); });
  told("not_a_hello", [](Stream& stream) { stream.client().send({{"type", "ping"}, {"t", 1}}); });
  told("binary", [](Stream& stream) { stream.client().socket().send_binary("bytes"); });
  told("not_json", [](Stream& stream) { stream.client().socket().send_text("{{}"); });
  told("unknown_type", [](Stream& stream) { stream.client().send({{"type", "shout"}}); });
  told("unknown_frame", [](Stream& stream) { stream.hello().client().ack(1'000'000); });
  told("no_hello", [](Stream&) {});
}

/// Asks without reading: answers fill the sockets' buffers, then the server's own. Its goodbye is looked for some time
/// after that, before the server has given up on it.
Refused ask_and_not_read(const Asked& asked, std::chrono::milliseconds before_reading) {
  test::WebSocketClient::Options options;
  options.receive_buffer_bytes = 4096;
  Stream deaf(asked, {}, options);
  deaf.hello();
  std::string pings;
  const std::string ping = R"({"type":"ping","t":1})";
  for (int i = 0; i < 400'000; ++i)
    pings += std::string{'\x81', static_cast<char>(0x80 | ping.size()), 0, 0, 0, 0} + ping;
  std::thread sender([&] { deaf.client().socket().send_raw(pings); });
  std::this_thread::sleep_for(before_reading);
  Refused refused;
  while (const auto message = deaf.client().socket().receive())  // tens of thousands of answers
    if (message->bytes.find("\"bye\"") != std::string::npos) refused.bye = json::parse(message->bytes);
  refused.code = deaf.client().socket().close_code();
  sender.join();
  return refused;
}

void do_not_listen(Refusals& refused) {
  Asked asked;
  const std::string session = asked.until_ready().session();
  Stream lazy(asked, session);
  refused["not_acknowledged"] = lazy.hello().end();
  for (const int before_reading_ms : {500, 2000, 4500, 7000}) {  // slow machines fill their buffers later
    refused["flood"] = ask_and_not_read(asked, std::chrono::milliseconds(before_reading_ms));
    if (refused["flood"].code == 4000) break;
  }
}

void lose_the_session(Refusals& refused) {
  const DataFolder folder;
  ServeOptions options = test_options();
  options.data_dir = folder.path().string();
  Asked asked(options);
  asked.until_ready();
  const std::string session = asked.session();
  Stream ended(asked), first(asked, session), drained(asked);
  ended.hello();
  drained.hello();
  asked.ask("DELETE", "/v1/sessions/" + ended.welcome["session"].get<std::string>());
  refused["session_ended"] = ended.end();
  first.hello();
  Stream second(asked, session);
  second.hello({{"resume", first.welcome["resume"]}});
  refused["resumed"] = first.end();
  Database database(folder.path() / "sessions.sqlite");
  Statement(database, "UPDATE sessions SET server = 'another' WHERE id = ?1").bind(session).run();
  refused["taken_up"] = second.end();
  std::thread drainer([&] { asked.server.drain(test::kPatience); });
  refused["draining"] = drained.end();
  drainer.join();
}

/// Encoders that fail after some pictures: of JPEG until something changes, of video for the whole stream.
void lose_the_encoders(Refusals& refused) {
  Asked without_jpeg(test_options(), nullptr, encoders_with_fault("jpeg@3"));
  const std::string still = without_jpeg.until_ready().session();
  Stream stream(without_jpeg, still);
  refused["not_encoded"] = stream.hello().error_of_watcher();
  stream.client().input(1, {{"time_s", 1}});
  EXPECT_TRUE(stream.client().next_frame());  // the session goes on
  if (!can_encode_video()) return;
  Asked without_video(test_options(), nullptr, encoders_with_fault("video@3"));
  const std::string playing = without_video.until_ready().session("helicopters");
  Stream moving(without_video, playing);
  EXPECT_EQ(moving.hello({{"codecs", {"h264", "jpeg"}}}).welcome["codec"], "h264");
  refused["video_lost"] = moving.error_of_watcher();
  const auto is_jpeg = [](const auto& frame) { return frame.codec == protocol::FrameCodec::kJpeg; };
  EXPECT_TRUE(moving.client().frame_where(is_jpeg));
}

/// An input that comes between the session's end and its streams' is seldom seen over a line: here it is made.
void input_as_the_session_ends(Refusals& refused) {
  const ServeLimits limits;
  SceneStore scenes(limits);
  scenes.add_builtin_scenes();
  Metrics metrics;
  const auto none = [] { return std::vector<std::string>(); };
  const SessionSurroundings surroundings{
      {scenes, limits, Settings()},    metrics,           [] {}, [] { return std::string(); }, none, none,
      [](const auto&, const auto&) {}, [](const auto&) {}};
  protocol::SessionRequest request;
  request.scene = "cornell";
  auto state = make_session_state(request, surroundings.rules, std::chrono::steady_clock::now());
  ASSERT_TRUE(state.ok());
  const auto session = std::make_shared<Session>("a", std::move(state).value(), surroundings, 60.0);
  const auto viewer = std::make_shared<Viewer>(session, true);  // not one of those that the session tells of its end
  viewer->received_text(
      R"({"type":"hello","codecs":["jpeg"],"width":64,"height":64,"device_pixel_ratio":1,"role":"driver","resume":null})");
  ASSERT_TRUE(std::holds_alternative<net::TextMessage>(viewer->next()));
  session->end(protocol::CloseCode::kSessionEnded, "the session was ended", true);
  viewer->received_text(R"({"type":"input","seq":1,"playing":false})");
  const net::Outgoing answer = viewer->next();
  ASSERT_TRUE(std::holds_alternative<net::TextMessage>(answer));
  refused["session_ending"].error = json::parse(std::get<net::TextMessage>(answer).text);
}

TEST(Refusals, InAStreamAreThoseOfTheDocument) {
  Refusals all;
  for (const auto& provoke : {break_the_rules_of_inputs, say_what_nobody_may, do_not_listen, lose_the_session,
                              lose_the_encoders, input_as_the_session_ends})
    provoke(all);
  const json document = json::parse(protocol::openapi_document());
  json shown = document["paths"]["/v1/sessions/{id}/stream"]["get"]["x-refusals-in-the-stream"];
  if (!can_encode_video()) shown.erase("video_lost");
  for (const auto& [name, example] : shown.items()) {
    ASSERT_TRUE(all.contains(name)) << name << " is shown, and not provoked";
    const Refused& given = all[name];
    if (example.contains("problem")) {
      ASSERT_TRUE(given.error.is_object()) << name;
      expect_problem(name, given.error["problem"], example["problem"]);
    }
    EXPECT_EQ(given.error.is_object() && given.error.contains("seq"), example.contains("seq")) << name;
    EXPECT_EQ(given.code, example.value("code", 0)) << name;
    if (!example.contains("bye")) continue;
    ASSERT_TRUE(given.bye.is_object()) << name;
    EXPECT_EQ(shape_of(given.bye["reason"]), shape_of(example["bye"])) << name;
    EXPECT_EQ(given.bye["reconnect"], example["reconnect"]) << name;
  }
  EXPECT_EQ(all.size(), shown.size());
}

}  // namespace
}  // namespace lightwell::test
