// What the OpenAPI document shows as refusals, and servers that are asked for them.
#pragma once

#include <map>
#include <regex>

#include "protocol/openapi_document.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {

/// A server of its own for a few questions.
class Asked {
 public:
  explicit Asked(ServeOptions options = test_options(), MakePictureSource source = nullptr, FrameEncoders encode = {})
      : studio(std::make_shared<FakeStudio>()),
        server(options, source ? std::move(source) : fake_source(studio), std::move(encode)) {}

  Asked& until_ready() {
    server.ready().wait();
    while (ask("GET", "/v1/scenes").status == 503) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return *this;
  }
  Answer ask(const std::string& method, const std::string& target, const std::string& body = {},
             const std::string& type = "application/json", const std::string& fields = {}) const {
    return test::ask(server.port(), method, target, body, type, fields);
  }
  Answer render(const json& change) const {
    json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}};
    request.update(change);
    return ask("POST", "/v1/render", request.dump());
  }
  Answer raw(const std::string& text) const {
    Line line(server.port());
    line.send(text);
    return read_answer(line);
  }
  std::string session(const std::string& scene = "cornell") const {
    const json request{{"scene", scene}, {"width", 8}, {"height", 8}};
    return json::parse(ask("POST", "/v1/sessions", request.dump()).body)["id"];
  }
  static std::string handshake(const std::string& session) {
    return "GET /v1/sessions/" + session +
           "/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
           "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  }

  std::shared_ptr<FakeStudio> studio;
  RunningServer server;
};

using Answers = std::map<std::string, Answer>;  // by the example's name

void ask_for_sequences(Answers& answers);
void ask_for_films(Answers& answers);
/// Files, tables and the device, which are there no more.
void ask_for_what_is_gone(Answers& answers);

/// With every number and every quoted word replaced: what may differ from case to case.
inline std::string shape_of(const std::string& detail) {
  const std::string words = std::regex_replace(detail, std::regex("\"[^\"]*\""), "\"...\"");
  return std::regex_replace(words, std::regex("[0-9]+"), "N");
}

/// All examples of problems in the document, by their names: with the problem as `value`, and where a client's words
/// alone lead to it those as `x-asked`.
inline std::map<std::string, json> documented() {
  std::map<std::string, json> examples;
  const auto collect = [&](const auto& self, const json& value) -> void {
    if (!value.is_structured()) return;
    if (value.is_object() && value.contains("application/problem+json")) {
      for (const auto& [name, example] : value["application/problem+json"]["examples"].items())
        EXPECT_TRUE(examples.emplace(name, example).second) << name << " twice";
    }
    for (const auto& member : value) self(self, member);
  };
  collect(collect, json::parse(protocol::openapi_document()));
  return examples;
}

/// Whether an answer is the problem of an example, save for its numbers and quoted words.
inline void expect_problem(const std::string& name, const json& given, const json& example) {
  EXPECT_EQ(given["status"], example["status"]) << name;
  EXPECT_EQ(given["title"], example["title"]) << name;
  EXPECT_EQ(shape_of(given.value("detail", "")), shape_of(example["detail"])) << name;
  EXPECT_EQ(shape_of(given.value("pointer", "")), shape_of(example.value("pointer", ""))) << name;
}

}  // namespace lightwell::test
