#include "renderer/scene/gltf/document.h"

#include <nlohmann/json.hpp>

#include "renderer/scene/gltf/extensions.h"
#include "renderer/scene/gltf/json_text.h"
#include "renderer/scene/gltf/schema.h"

namespace lightwell::gltf {
namespace {

using nlohmann::json;

void check_version(const json& document) {
  const json& asset = document.at("asset");
  const auto version = asset.at("version").get<std::string>();
  if (!version.starts_with("2."))
    fail("asset/version", "glTF " + in_quotes(version) + " is not supported, only 2.0", ErrorKind::kUnsupported);
  const auto least = asset.value("minVersion", std::string("2.0"));
  if (least != "2.0")
    fail("asset/minVersion", "a reader of glTF " + in_quotes(least) + " is needed; this one knows 2.0",
         ErrorKind::kUnsupported);
}

std::span<const std::byte> read_buffer(const json& buffer, bool is_first, std::span<const std::byte> binary,
                                       AssetFiles& files, Document& document, const std::string& where) {
  std::span<const std::byte> bytes;
  if (const auto uri = buffer.find("uri"); uri != buffer.end()) {
    document.owned.push_back(files.fetch(uri->get_ref<const std::string&>(), join(where, "uri")));
    bytes = document.owned.back();
  } else if (is_first && !binary.empty()) {
    bytes = binary;
  } else {
    fail(where, "has neither a URI nor the file's binary chunk");
  }
  const auto length = buffer.at("byteLength").get<std::size_t>();
  if (bytes.size() < length)
    fail(where, "should have " + std::to_string(length) + " bytes but has " + std::to_string(bytes.size()));
  return bytes.first(length);
}

/// Moves an array out of the document.
json take_array(json& document, const char* name) {
  const auto member = document.find(name);
  if (member == document.end()) return json::array();
  json array = std::move(*member);
  document.erase(member);
  return array;
}

void read_buffers(json& root, std::span<const std::byte> binary, AssetFiles& files, Document& document) {
  const json buffers = take_array(root, "buffers");
  for (std::size_t i = 0; i < buffers.size(); ++i)
    document.buffers.push_back(read_buffer(buffers[i], i == 0, binary, files, document, join("buffers", i)));
}

void read_image_sources(json& root, Document& document) {
  const json images = take_array(root, "images");
  for (std::size_t i = 0; i < images.size(); ++i) {
    const json& image = images[i];
    if (image.contains("uri") == image.contains("bufferView"))
      fail(join("images", i), "must have either a URI or a buffer view");
    if (image.value("uri", "none") == "") fail(join(join("images", i), "uri"), "is empty");
    document.images.push_back({image.value("name", ""), image.value("uri", ""), image.value("bufferView", kNone)});
  }
}

/// glTF lets these members be absent, tinygltf 2.7 takes that for an error. Gives the accessors without a buffer view,
/// which are given the first one for the time being.
std::vector<std::size_t> fill_gaps(json& root, Warnings& warnings) {
  if (const auto skins = root.find("skins"); skins != root.end())
    for (json& skin : *skins) skin.emplace("inverseBindMatrices", kNone);

  if (const auto animations = root.find("animations"); animations != root.end()) {
    for (std::size_t i = 0; i < animations->size(); ++i) {
      json& channels = (*animations)[i]["channels"];
      json targeted = json::array();
      for (json& channel : channels)
        if (channel["target"].contains("node")) targeted.push_back(std::move(channel));
      if (targeted.size() < channels.size())
        warnings.add(join("animations", i), "channels that target no node are left out");
      channels = std::move(targeted);
    }
  }

  std::vector<std::size_t> without_view;
  if (const auto accessors = root.find("accessors"); accessors != root.end())
    for (std::size_t i = 0; i < accessors->size(); ++i)
      if ((*accessors)[i].emplace("bufferView", 0).second) without_view.push_back(i);
  return without_view;
}

tinygltf::Model read_model(json root, Warnings& warnings) {
  const std::vector<std::size_t> without_view = fill_gaps(root, warnings);
  const std::string text = root.dump();
  root = nullptr;

  tinygltf::TinyGLTF reader;
  reader.SetFsCallbacks({nullptr, nullptr, nullptr, nullptr, nullptr});
  tinygltf::Model model;
  std::string error, warning;
  const bool read = reader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                               static_cast<unsigned int>(text.size()), "", tinygltf::REQUIRE_VERSION);
  while (!error.empty() && error.back() == '\n') error.pop_back();
  // Some of what it complains of it skips without failing; the schema has left nothing that may be skipped.
  if (!read || !error.empty()) fail("json", error.empty() ? "cannot be understood" : readable(error, 200));
  for (const std::size_t i : without_view) model.accessors[i].bufferView = kNone;
  return model;
}

}  // namespace

Document read_document(std::string_view text, std::span<const std::byte> binary, AssetFiles& files,
                       const LoadLimits& limits, Warnings& warnings) {
  json root = parse_json(text);
  apply_schema(root);
  check_version(root);
  check_extensions(root.value("extensionsUsed", std::vector<std::string>()),
                   root.value("extensionsRequired", std::vector<std::string>()), warnings);
  if (const auto nodes = root.find("nodes"); nodes != root.end() && nodes->size() > limits.max_nodes)
    fail("nodes", std::to_string(nodes->size()) + " are more than the " + std::to_string(limits.max_nodes) + " allowed",
         ErrorKind::kTooLarge);
  Document document;
  read_buffers(root, binary, files, document);
  read_image_sources(root, document);
  document.model = read_model(std::move(root), warnings);
  return document;
}

std::span<const std::byte> bytes_of_view(const Document& document, int buffer_view, const std::string& where) {
  const std::vector<tinygltf::BufferView>& views = document.model.bufferViews;
  const tinygltf::BufferView& view = at(views, buffer_view, join(where, "bufferView"));
  const std::string view_path = join("bufferViews", static_cast<std::size_t>(buffer_view));
  const std::span<const std::byte> buffer = at(document.buffers, view.buffer, join(view_path, "buffer"));
  // Offsets and lengths are below 2^31, so that their sums do not overflow.
  if (view.byteOffset + view.byteLength > buffer.size())
    fail(view_path, "bytes " + std::to_string(view.byteOffset) + " to " +
                        std::to_string(view.byteOffset + view.byteLength) + " are not in a buffer of " +
                        std::to_string(buffer.size()));
  return buffer.subspan(view.byteOffset, view.byteLength);
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto extension = extensions.find(name);
  return extension == extensions.end() ? nullptr : &extension->second;
}

double number_or(const tinygltf::Value& object, const char* name, double fallback) {
  return object.Has(name) ? object.Get(name).GetNumberAsDouble() : fallback;
}

int index_or(const tinygltf::Value& object, const char* name, int fallback) {
  return object.Has(name) ? object.Get(name).GetNumberAsInt() : fallback;
}

}  // namespace lightwell::gltf
