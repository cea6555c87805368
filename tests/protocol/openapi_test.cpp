// openapi.json against the codec: what the document shows as an example is read, what it lists is what is known.
#include "protocol/openapi_document.h"

#include <gtest/gtest.h>

#include <set>

#include "protocol/codec.h"
#include "protocol/sequence.h"

namespace lightwell::protocol {
namespace {

using Json = nlohmann::json;

const Json& document() {
  static const Json parsed = Json::parse(openapi_document());
  return parsed;
}

/// Calls `visit(json, pointer)` on every object of the document.
template <class Visit>
void for_each_object(const Json& json, const std::string& pointer, const Visit& visit) {
  if (json.is_object()) visit(json, pointer);
  if (!json.is_structured()) return;
  for (const auto& [name, member] : json.items())
    for_each_object(member, pointer + '/' + escape_pointer_token(name), visit);
}

std::set<std::string> names_of(const Json& object) {
  std::set<std::string> names;
  for (const auto& [name, member] : object.items()) names.insert(name);
  return names;
}

Json schema(const std::string& name) {
  return document().at("components").at("schemas").at(name);
}

Json examples_of_body(const std::string& path, const std::string& method) {
  return document()["paths"][path][method]["requestBody"]["content"]["application/json"]["examples"];
}

template <class T>
void expect_examples_are_read(const std::string& path, const std::string& method,
                              Decoded<T> (*parse)(std::string_view)) {
  const Json examples = examples_of_body(path, method);
  ASSERT_FALSE(examples.empty());
  for (const auto& [name, example] : examples.items()) {
    const Decoded<T> parsed = parse(example["value"].dump());
    EXPECT_TRUE(parsed.ok()) << path << ' ' << name << ": " << to_json(parsed.problem());
  }
}

TEST(OpenApi, IsOfItsVersion) {
  EXPECT_EQ(document().at("openapi"), "3.1.0");
  EXPECT_EQ(document().at("info").at("version"), LIGHTWELL_VERSION);
}

TEST(OpenApi, EveryReferenceLeadsSomewhere) {
  std::set<std::string> used;
  for_each_object(document(), "", [&](const Json& object, const std::string& pointer) {
    if (!object.contains("$ref")) return;
    const std::string target = object["$ref"].get<std::string>();
    ASSERT_TRUE(target.starts_with("#/")) << pointer;
    EXPECT_TRUE(document().contains(Json::json_pointer(target.substr(1)))) << pointer << ": " << target;
    used.insert(target);
  });
  for_each_object(document(), "", [&](const Json& object, const std::string&) {
    if (!object.contains("security") || !object["security"].is_array()) return;
    for (const Json& requirement : object["security"])
      for (const auto& [name, scopes] : requirement.items()) used.insert("#/components/securitySchemes/" + name);
  });
  for (const auto& [kind, components] : document()["components"].items())
    for (const auto& [name, component] : components.items())
      EXPECT_TRUE(used.contains("#/components/" + kind + '/' + name)) << name << " is used by nothing";
}

TEST(OpenApi, OperationsHaveANameOfTheirOwnAndEveryParameterOfTheirPath) {
  std::set<std::string> names;
  for (const auto& [path, item] : document()["paths"].items()) {
    const auto parameters = std::count(path.begin(), path.end(), '{');
    EXPECT_EQ(item.value("parameters", Json::array()).size(), static_cast<std::size_t>(parameters)) << path;
    for (const char* method : {"get", "put", "post", "patch", "delete"}) {
      if (!item.contains(method)) continue;
      EXPECT_TRUE(names.insert(item[method].at("operationId").get<std::string>()).second) << path;
      EXPECT_TRUE(item[method].at("responses").contains("default")) << path << ": other refusals";
    }
  }
}

TEST(OpenApi, ExamplesOfRequestsAreRead) {
  expect_examples_are_read<RenderRequest>("/v1/render", "post", parse_render_request);
  expect_examples_are_read<SessionRequest>("/v1/sessions", "post", parse_session_request);
  expect_examples_are_read<SequenceRequest>("/v1/sequences", "post", parse_sequence_request);
  expect_examples_are_read<SessionPatch>("/v1/sessions/{id}", "patch", parse_session_patch);
}

TEST(OpenApi, ExamplesOfProblemsAreWhatIsWritten) {
  std::size_t count = 0;
  for_each_object(document(), "", [&](const Json& object, const std::string& pointer) {
    if (!object.contains("application/problem+json")) return;
    for (const auto& [name, example] : object["application/problem+json"]["examples"].items()) {
      const Json& value = example["value"];
      const Problem problem = make_problem(value.at("status"), value.at("detail"), value.value("pointer", ""));
      EXPECT_EQ(to_json(problem), value) << pointer << '/' << name;
      ++count;
    }
  });
  EXPECT_GT(count, 20u);
}

TEST(OpenApi, RefusalsOfEveryStatusAreShown) {
  std::set<int> statuses;
  for_each_object(document(), "", [&](const Json& object, const std::string&) {
    if (object.contains("detail") && object.contains("status") && object["status"].is_number())
      statuses.insert(object["status"].get<int>());
  });
  for (const int status : {400, 403, 404, 405, 408, 409, 411, 413, 415, 422, 429, 501, 503})
    EXPECT_TRUE(statuses.contains(status)) << status;
}

TEST(OpenApi, ListsEverySettingAndNoOther) {
  SettingsSpec all;
  all.method = all.estimator = all.view = all.tone_map = "x";
  all.samples = all.bounces = all.indirect_size = all.shadow_size = all.shadow_filter = 1;
  all.view_index = all.patch = all.triangle_groups = all.target_fps = all.warm_up = 1;
  all.normal_threshold = all.depth_threshold = all.firefly_clamp = 0.5;
  all.similarity = "x";
  all.trace_missed = true;
  all.brute_force = true;
  all.exposure_ev.emplace();
  all.background.emplace();
  all.seed = 0u;
  all.denoise = all.multiple_scattering = all.temporal_antialiasing = all.hand_over = true;
  EXPECT_EQ(names_of(schema("Settings")["properties"]), names_of(to_json(all)));
}

TEST(OpenApi, ListsEveryMemberOfWhatIsWritten) {
  SessionPatch patch;
  patch.edits.emplace(Edits::array());
  patch.camera.emplace();
  patch.settings.emplace();
  patch.playing = true;
  patch.time_s = 0.0;
  patch.scene = "a";
  patch.width = patch.height = 1;
  EXPECT_EQ(names_of(schema("SessionPatch")["properties"]), names_of(to_json(patch)));
  SessionRequest session;
  session.idle_s = 1.0;  // the server's own time is not written
  EXPECT_EQ(names_of(schema("SessionRequest")["properties"]), names_of(to_json(session)));
  EXPECT_EQ(names_of(schema("RenderRequest")["properties"]), names_of(to_json(RenderRequest{})));
  EXPECT_EQ(names_of(schema("Session")["properties"]), names_of(to_json(Session{})));
  EXPECT_EQ(names_of(schema("SequenceRequest")["properties"]), names_of(to_json(SequenceRequest{})));
  EXPECT_EQ(names_of(schema("Keyframes")["properties"]), names_of(to_json(Keyframes{})));
  Sequence sequence;
  sequence.problem.emplace();
  EXPECT_EQ(names_of(schema("Sequence")["properties"]), names_of(to_json(sequence)));
  EXPECT_EQ(names_of(schema("SceneEntry")["properties"]), names_of(to_json(SceneEntry{})));
  EXPECT_EQ(names_of(schema("SceneList")["properties"]), names_of(to_json(std::span<const SceneEntry>())));
}

TEST(OpenApi, DefaultsAreThoseOfTheStructs) {
  for (const auto& [name, written] :
       {std::pair{"RenderRequest", to_json(RenderRequest{})}, std::pair{"SessionRequest", to_json(SessionRequest{})}}) {
    const Json properties = schema(name)["properties"];
    for (const auto& [member, property] : properties.items()) {
      if (!property.contains("default")) continue;
      EXPECT_EQ(property["default"], written.at(member)) << name << ' ' << member;
    }
  }
}

}  // namespace
}  // namespace lightwell::protocol
