// The server held against the document that describes it.
#include <set>

#include "protocol/openapi_document.h"
#include "tests/integration/data_folder.h"
#include "tests/integration/glb_writer.h"
#include "tests/integration/server_fixture.h"

namespace lightwell::test {
namespace {

ServeOptions options_with_folder(const std::filesystem::path& folder) {
  ServeOptions options = test_options();
  options.data_dir = folder.string();
  return options;
}

/// Its folder is a base before that of the server, so that it goes after it.
class OpenApiTest : private DataFolder, public ServerTest {
 protected:
  OpenApiTest() : ServerTest(options_with_folder(DataFolder::path())) {
    const json request{{"scene", "cornell"}, {"width", 8}, {"height", 8}, {"last_frame", 0}};
    sequence_ = json::parse(ask("POST", "/v1/sequences", request).body)["id"];
    while (ask("GET", "/v1/sequences/" + sequence_ + "/archive").status != 200)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  const json document_ = json::parse(protocol::openapi_document());

  /// A path with values for its parameters that exist on this server.
  std::string concrete(std::string path) const {
    const std::pair<std::string, std::string> values[] = {
        {"{file}", "index.html"},
        {"{name}", "cornell"},
        {"{id}", path.starts_with("/v1/sequences") ? sequence_ : session_},
        {"{number}", "0"}};
    for (const auto& [name, value] : values)
      if (const auto at = path.find(name); at != std::string::npos) path.replace(at, name.size(), value);
    return path;
  }

  const std::string session_ = make_session();
  std::string sequence_;
};

std::set<std::string> methods_of(const json& path_item) {
  std::set<std::string> methods;
  for (const auto& [key, value] : path_item.items()) {
    std::string method = key;
    for (char& c : method) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (value.is_object() && value.contains("responses")) methods.insert(method);
  }
  if (methods.contains("GET")) methods.insert("HEAD");
  return methods;
}

std::set<std::string> words_of(const std::string& list) {
  std::set<std::string> words;
  for (std::size_t at = 0; at < list.size();) {
    const auto end = std::min(list.find(", ", at), list.size());
    words.insert(list.substr(at, end - at));
    at = end + 2;
  }
  return words;
}

TEST_F(OpenApiTest, TellsTheSettingsThatTheServerBeginsWith) {
  const json begun = json::parse(ask("GET", "/v1/sessions/" + session_).body)["settings"];
  const json& properties = document_["components"]["schemas"]["Settings"]["properties"];
  for (const auto& [name, value] : begun.items()) {
    ASSERT_TRUE(properties.at(name).contains("default")) << name;
    const json& told = properties.at(name)["default"];
    if (told.is_number())
      EXPECT_NEAR(told.get<double>(), value.get<double>(), 1e-6) << name;
    else
      EXPECT_EQ(told, value) << name;
  }
}

TEST_F(OpenApiTest, IsServed) {
  const Answer answer = ask("GET", "/v1/openapi.json");
  EXPECT_EQ(answer.field("Content-Type"), "application/json");
  EXPECT_EQ(json::parse(answer.body), document_);
}

TEST_F(OpenApiTest, EveryPathTakesTheMethodsItSays) {
  for (const auto& [path, item] : document_["paths"].items()) {
    const Answer answer = ask("OPTIONS", concrete(path));
    EXPECT_EQ(answer.status, 405) << path;
    EXPECT_EQ(words_of(answer.field("Allow")), methods_of(item)) << path;
  }
}

TEST_F(OpenApiTest, EveryGetAnswersAsItSays) {
  for (const auto& [path, item] : document_["paths"].items()) {
    if (!item.contains("get") || path.ends_with("/stream")) continue;
    const Answer answer = ask("GET", concrete(path));
    const json& responses = item["get"]["responses"];
    ASSERT_TRUE(responses.contains(std::to_string(answer.status))) << path << answer.body;
    if (answer.status == 501) continue;  // a build without an encoder
    const std::string type = answer.field("Content-Type");
    EXPECT_TRUE(responses["200"]["content"].contains(type.substr(0, type.find(';')))) << path << ": " << type;
  }
}

TEST_F(OpenApiTest, EveryExampleOfARequestIsAnsweredAsItSays) {
  int sent = 0;
  for (const auto& [path, item] : document_["paths"].items()) {
    for (const auto& [method, operation] : item.items()) {
      if (!operation.is_object() || !operation.contains("requestBody")) continue;
      const json& content = operation["requestBody"]["content"];
      if (!content.contains("application/json")) continue;
      const json examples = content["application/json"].value("examples", json::object());
      for (const auto& [name, example] : examples.items()) {
        std::string upper = method;
        for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        const Answer answer = ask(upper, concrete(path), example["value"]);
        EXPECT_TRUE(operation["responses"].contains(std::to_string(answer.status)))
            << upper << " " << path << " " << name << ": " << answer.status << " " << answer.body;
        ++sent;
      }
    }
  }
  EXPECT_GT(sent, 3);
}

}  // namespace
}  // namespace lightwell::test
