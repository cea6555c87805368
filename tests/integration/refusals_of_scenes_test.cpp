// Every reason for which a file or an edit is refused that the OpenAPI document shows is one that the server gives.
// That it shows all there are is check_refusals.py's to say.
#include <functional>

#include "renderer/scene/gltf/load_gltf.h"
#include "tests/integration/refusals_fixture.h"
#include "tests/unit/gltf_builder.h"

namespace lightwell::test {
namespace {

const char* const kGlb = "model/gltf-binary";

std::string text_of(const ByteVector& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string glb_of(const json& root) {
  return text_of(make_glb(root.dump(), {}));
}

std::string from_base64(const std::string& text) {
  std::string bytes;
  std::uint32_t bits = 0, count = 0;
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (const char digit : text.substr(0, text.find('='))) {
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(digit));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return bytes;
}

const json& shown_of_files() {
  static const json document = json::parse(protocol::openapi_document());
  return document["paths"]["/v1/scenes/{name}"]["put"]["x-refusals-of-files"];
}

const json& shown_of_edits() {
  static const json document = json::parse(protocol::openapi_document());
  return document["components"]["schemas"]["Edits"]["x-refusals"];
}

/// `count` of the same value, beside what `name` has already.
json with_many(const std::string& name, const json& value, std::size_t count) {
  json file = shown_of_files()["file"];
  for (std::size_t i = 0; i < count; ++i) file[name].push_back(value);
  return file;
}

/// Five textures of one file, each of whose uses counts as its bytes.
std::string file_of_large_images() {
  GltfBuilder builder = GltfBuilder::triangle();
  ByteVector png = one_pixel_png();
  png.resize(1'000'000);
  const int view = builder.add_view(std::span<const std::byte>(png));
  for (int i = 0; i < 5; ++i) {
    builder.add("images", {{"bufferView", view}, {"mimeType", "image/png"}});
    builder.add("textures", {{"source", i}});
    builder.add("materials", {{"normalTexture", {{"index", i}}}});
  }
  return text_of(builder.glb());
}

/// Those that would be too large for the document, by their names in it.
const std::map<std::string, std::function<std::string()>> kLargeFiles{
    {"values", [] { return glb_of(with_many("extras", 0, 8'000'001)); }},
    {"objects", [] { return glb_of(with_many("materials", json::object(), 70'000)); }},
    {"nodes", [] { return glb_of(with_many("nodes", json::object(), 99'997)); }},
    {"encoded_images", file_of_large_images},
};

json many_edits(const json& edit, std::size_t count) {
  return json(std::vector<json>(count, edit));
}

const std::map<std::string, std::function<json()>> kLargeEdits{
    {"as_many",
     [] {
       return many_edits(
           {{"op", "add"}, {"path", "/extensions/KHR_lights_punctual/lights/-"}, {"value", {{"type", "point"}}}}, 1001);
     }},
    {"work",
     [] {
       return many_edits({{"op", "test"}, {"path", "/nodes/body/name"}, {"value", "body"}}, 4096);
     }},
    {"triangles",
     [] {
       return many_edits({{"op", "add"}, {"path", "/nodes/-"}, {"value", {{"mesh", 0}}}}, 98);
     }},
};

TEST(Refusals, OfFilesAreThoseOfTheDocument) {
  ServeOptions options = test_options();
  Asked usual(options);
  options.limits.max_upload_bytes = 64u << 20;  // so that eight million values get there
  Asked patient(options);
  usual.until_ready();
  patient.until_ready();
  const json& shown = shown_of_files();
  const Answer whole = usual.ask("PUT", "/v1/scenes/whole", glb_of(shown["file"]), kGlb);
  EXPECT_EQ(whole.status, 201) << whole.body;
  for (const auto& [name, example] : shown["refusals"].items()) {
    std::string file;
    if (example.contains("change"))
      file = glb_of(shown["file"].patch(example["change"]));
    else if (example.contains("bytes"))
      file = from_base64(example["bytes"]);
    else
      file = kLargeFiles.at(name)();
    const Asked& asked = file.size() < options.limits.max_upload_bytes / 16 ? usual : patient;
    expect_problem(name, problem(asked.ask("PUT", "/v1/scenes/broken", file, kGlb)), example["problem"]);
    EXPECT_EQ(asked.ask("GET", "/v1/scenes/broken").status, 404) << name << " has left a trace";
  }
}

TEST(Refusals, OfEditsAreThoseOfTheDocument) {
  ServeOptions options = test_options();
  options.limits.max_triangles = 100;
  Asked asked(options);
  asked.until_ready();
  const json& file = shown_of_files()["file"];
  EXPECT_EQ(asked.ask("PUT", "/v1/scenes/example", glb_of(file), kGlb).status, 201);
  EXPECT_EQ(asked.ask("PUT", "/v1/scenes/large", glb_of(with_many("nodes", json::object(), 30'000)), kGlb).status, 201);
  for (const auto& [name, example] : shown_of_edits().items()) {
    const bool is_large = !example.contains("edits");
    json request{{"scene", name == "work" ? "large" : "example"}, {"width", 8}, {"height", 8}};
    request["edits"] = is_large ? kLargeEdits.at(name)() : example["edits"];
    expect_problem(name, problem(asked.ask("POST", "/v1/render", request.dump())), example["problem"]);
  }
}

}  // namespace
}  // namespace lightwell::test
