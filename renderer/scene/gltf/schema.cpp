#include "renderer/scene/gltf/schema.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "renderer/scene/gltf/diagnostics.h"

namespace lightwell::gltf {
namespace {

using nlohmann::json;

enum class Kind : std::uint8_t {
  kIndex,      // a whole number from 0 to 2^31 - 1: indices, counts, offsets, enumerations
  kIndices,    // an array of them
  kIndexMap,   // an object of them
  kIndexMaps,  // an array of such objects
  kNumber,
  kNumbers,  // an array of numbers
  kBool,
  kString,
  kStrings,
  kObject,
  kObjects,  // an array of objects
};

constexpr bool kRequired = true, kOptional = false;

struct Property {
  std::string_view name;
  Kind kind;
  bool required = kOptional;
  std::size_t length = 0;                  // of kNumbers: exactly as many, 0 for any; of kObjects: at most as many
  std::span<const Property> members = {};  // of kObject and kObjects
};

constexpr Property object(std::string_view name, std::span<const Property> members, bool required = kOptional) {
  return {name, Kind::kObject, required, 0, members};
}

// tinygltf spends up to 2 kB on an object. These limits keep a small file of empty objects from filling the memory.
constexpr std::size_t kManyObjects = 1 << 20, kFewObjects = 1 << 16;

constexpr Property objects(std::string_view name, std::span<const Property> members, bool required = kOptional,
                           std::size_t most = kManyObjects) {
  return {name, Kind::kObjects, required, most, members};
}

constexpr Property numbers(std::string_view name, std::size_t length) {
  return {name, Kind::kNumbers, kOptional, length, {}};
}

constexpr Property kTextureTransform[] = {
    numbers("offset", 2), {"rotation", Kind::kNumber}, numbers("scale", 2), {"texCoord", Kind::kIndex}};
constexpr Property kTextureExtensions[] = {object("KHR_texture_transform", kTextureTransform)};
constexpr Property kTextureInfo[] = {{"index", Kind::kIndex, kRequired},
                                     {"texCoord", Kind::kIndex},
                                     {"scale", Kind::kNumber},
                                     {"strength", Kind::kNumber},
                                     object("extensions", kTextureExtensions)};

constexpr Property kEmissiveStrength[] = {{"emissiveStrength", Kind::kNumber}};
constexpr Property kIor[] = {{"ior", Kind::kNumber}};
constexpr Property kSpecular[] = {{"specularFactor", Kind::kNumber},
                                  object("specularTexture", kTextureInfo),
                                  numbers("specularColorFactor", 3),
                                  object("specularColorTexture", kTextureInfo)};
constexpr Property kTransmission[] = {{"transmissionFactor", Kind::kNumber},
                                      object("transmissionTexture", kTextureInfo)};
constexpr Property kVolume[] = {{"thicknessFactor", Kind::kNumber},
                                object("thicknessTexture", kTextureInfo),
                                {"attenuationDistance", Kind::kNumber},
                                numbers("attenuationColor", 3)};
constexpr Property kClearcoat[] = {{"clearcoatFactor", Kind::kNumber},
                                   object("clearcoatTexture", kTextureInfo),
                                   {"clearcoatRoughnessFactor", Kind::kNumber},
                                   object("clearcoatRoughnessTexture", kTextureInfo),
                                   object("clearcoatNormalTexture", kTextureInfo)};
constexpr Property kSheen[] = {numbers("sheenColorFactor", 3),
                               object("sheenColorTexture", kTextureInfo),
                               {"sheenRoughnessFactor", Kind::kNumber},
                               object("sheenRoughnessTexture", kTextureInfo)};
constexpr Property kMaterialExtensions[] = {object("KHR_materials_emissive_strength", kEmissiveStrength),
                                            object("KHR_materials_unlit", {}),
                                            object("KHR_materials_ior", kIor),
                                            object("KHR_materials_specular", kSpecular),
                                            object("KHR_materials_transmission", kTransmission),
                                            object("KHR_materials_volume", kVolume),
                                            object("KHR_materials_clearcoat", kClearcoat),
                                            object("KHR_materials_sheen", kSheen)};
constexpr Property kMetallicRoughness[] = {numbers("baseColorFactor", 4),
                                           object("baseColorTexture", kTextureInfo),
                                           {"metallicFactor", Kind::kNumber},
                                           {"roughnessFactor", Kind::kNumber},
                                           object("metallicRoughnessTexture", kTextureInfo)};
constexpr Property kMaterial[] = {{"name", Kind::kString},
                                  object("pbrMetallicRoughness", kMetallicRoughness),
                                  object("normalTexture", kTextureInfo),
                                  object("occlusionTexture", kTextureInfo),
                                  object("emissiveTexture", kTextureInfo),
                                  numbers("emissiveFactor", 3),
                                  {"alphaMode", Kind::kString},
                                  {"alphaCutoff", Kind::kNumber},
                                  {"doubleSided", Kind::kBool},
                                  object("extensions", kMaterialExtensions)};
constexpr Property kSampler[] = {
    {"magFilter", Kind::kIndex}, {"minFilter", Kind::kIndex}, {"wrapS", Kind::kIndex}, {"wrapT", Kind::kIndex}};
constexpr Property kTexture[] = {{"name", Kind::kString}, {"sampler", Kind::kIndex}, {"source", Kind::kIndex}};
constexpr Property kImage[] = {{"name", Kind::kString}, {"uri", Kind::kString}, {"bufferView", Kind::kIndex}};

constexpr Property kBuffer[] = {{"uri", Kind::kString}, {"byteLength", Kind::kIndex, kRequired}};
constexpr Property kBufferView[] = {{"buffer", Kind::kIndex, kRequired},
                                    {"byteOffset", Kind::kIndex},
                                    {"byteLength", Kind::kIndex, kRequired},
                                    {"byteStride", Kind::kIndex}};
constexpr Property kSparseIndices[] = {
    {"bufferView", Kind::kIndex, kRequired}, {"byteOffset", Kind::kIndex}, {"componentType", Kind::kIndex, kRequired}};
constexpr Property kSparseValues[] = {{"bufferView", Kind::kIndex, kRequired}, {"byteOffset", Kind::kIndex}};
constexpr Property kSparse[] = {{"count", Kind::kIndex, kRequired},
                                object("indices", kSparseIndices, kRequired),
                                object("values", kSparseValues, kRequired)};
constexpr Property kAccessor[] = {
    {"bufferView", Kind::kIndex}, {"byteOffset", Kind::kIndex},       {"componentType", Kind::kIndex, kRequired},
    {"normalized", Kind::kBool},  {"count", Kind::kIndex, kRequired}, {"type", Kind::kString, kRequired},
    object("sparse", kSparse)};
constexpr Property kPrimitive[] = {{"attributes", Kind::kIndexMap, kRequired},
                                   {"indices", Kind::kIndex},
                                   {"material", Kind::kIndex},
                                   {"mode", Kind::kIndex},
                                   {"targets", Kind::kIndexMaps}};
constexpr Property kMesh[] = {
    {"name", Kind::kString}, objects("primitives", kPrimitive, kRequired), numbers("weights", 0)};
constexpr Property kSkin[] = {
    {"name", Kind::kString}, {"inverseBindMatrices", Kind::kIndex}, {"joints", Kind::kIndices, kRequired}};

constexpr Property kNodeLight[] = {{"light", Kind::kIndex, kRequired}};
constexpr Property kInstancing[] = {{"attributes", Kind::kIndexMap, kRequired}};
constexpr Property kVisibility[] = {{"visible", Kind::kBool}};
constexpr Property kNodeExtensions[] = {object("KHR_lights_punctual", kNodeLight),
                                        object("EXT_mesh_gpu_instancing", kInstancing),
                                        object("KHR_node_visibility", kVisibility)};
constexpr Property kNode[] = {{"name", Kind::kString},
                              {"camera", Kind::kIndex},
                              {"children", Kind::kIndices},
                              {"skin", Kind::kIndex},
                              numbers("matrix", 16),
                              {"mesh", Kind::kIndex},
                              numbers("rotation", 4),
                              numbers("scale", 3),
                              numbers("translation", 3),
                              numbers("weights", 0),
                              object("extensions", kNodeExtensions)};

constexpr Property kPerspective[] = {{"aspectRatio", Kind::kNumber},
                                     {"yfov", Kind::kNumber, kRequired},
                                     {"zfar", Kind::kNumber},
                                     {"znear", Kind::kNumber, kRequired}};
constexpr Property kOrthographic[] = {{"xmag", Kind::kNumber, kRequired},
                                      {"ymag", Kind::kNumber, kRequired},
                                      {"zfar", Kind::kNumber, kRequired},
                                      {"znear", Kind::kNumber, kRequired}};
constexpr Property kCamera[] = {{"name", Kind::kString},
                                {"type", Kind::kString, kRequired},
                                object("perspective", kPerspective),
                                object("orthographic", kOrthographic)};
constexpr Property kSpot[] = {{"innerConeAngle", Kind::kNumber}, {"outerConeAngle", Kind::kNumber}};
constexpr Property kLight[] = {{"name", Kind::kString},      {"type", Kind::kString, kRequired}, numbers("color", 3),
                               {"intensity", Kind::kNumber}, {"range", Kind::kNumber},           object("spot", kSpot)};
constexpr Property kLights[] = {objects("lights", kLight, kRequired, kFewObjects)};

constexpr Property kTarget[] = {{"node", Kind::kIndex}, {"path", Kind::kString, kRequired}};
constexpr Property kChannel[] = {{"sampler", Kind::kIndex, kRequired}, object("target", kTarget, kRequired)};
constexpr Property kAnimationSampler[] = {
    {"input", Kind::kIndex, kRequired}, {"output", Kind::kIndex, kRequired}, {"interpolation", Kind::kString}};
constexpr Property kAnimation[] = {{"name", Kind::kString},
                                   objects("channels", kChannel, kRequired),
                                   objects("samplers", kAnimationSampler, kRequired)};

constexpr Property kAsset[] = {{"version", Kind::kString, kRequired}, {"minVersion", Kind::kString}};
constexpr Property kScene[] = {{"name", Kind::kString}, {"nodes", Kind::kIndices}};
constexpr Property kDocumentExtensions[] = {object("KHR_lights_punctual", kLights)};
constexpr Property kDocument[] = {object("asset", kAsset, kRequired),
                                  {"extensionsUsed", Kind::kStrings},
                                  {"extensionsRequired", Kind::kStrings},
                                  objects("accessors", kAccessor),
                                  objects("animations", kAnimation, kOptional, kFewObjects),
                                  objects("buffers", kBuffer, kOptional, kFewObjects),
                                  objects("bufferViews", kBufferView),
                                  objects("cameras", kCamera, kOptional, kFewObjects),
                                  objects("images", kImage, kOptional, kFewObjects),
                                  objects("materials", kMaterial, kOptional, kFewObjects),
                                  objects("meshes", kMesh),
                                  objects("nodes", kNode),
                                  objects("samplers", kSampler, kOptional, kFewObjects),
                                  {"scene", Kind::kIndex},
                                  objects("scenes", kScene, kOptional, kFewObjects),
                                  objects("skins", kSkin, kOptional, kFewObjects),
                                  objects("textures", kTexture, kOptional, kFewObjects),
                                  object("extensions", kDocumentExtensions)};

void require(bool holds, const json& value, const std::string& where, std::string_view what) {
  if (!holds)
    fail(where, "must be " + std::string(what) + ", not " +
                    in_quotes(value.is_structured() ? value.type_name() : value.dump()));
}

void check_index(json& value, const std::string& where) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  // JSON does not tell 3 from 3.0.
  if (value.is_number_float() && value.get<double>() == std::floor(value.get<double>()) &&
      std::abs(value.get<double>()) <= 9e15)
    value = static_cast<std::int64_t>(value.get<double>());
  require(value.is_number_integer(), value, where, "a whole number");
  if (value.is_number_unsigned() ? value.get<std::uint64_t>() > kMost : value.get<std::int64_t>() > kMost)
    fail(where, value.dump() + " is more than " + std::to_string(kMost), ErrorKind::kTooLarge);
  require(value.get<std::int64_t>() >= 0, value, where, "0 or more");
}

void check_number(json& value, const std::string& where) {
  require(value.is_number(), value, where, "a number");
  value = value.get<double>();  // whole numbers too, which may be larger than tinygltf's int
}

void check_members(json& value, std::span<const Property> members, const std::string& where);

/// Applies `check` to all elements of an array.
template <class Check>
void check_array(json& value, const std::string& where, std::string_view what, Check check) {
  require(value.is_array(), value, where, "an array of " + std::string(what));
  for (std::size_t i = 0; i < value.size(); ++i) check(value[i], join(where, i));
}

void check_index_map(json& value, const std::string& where) {
  require(value.is_object(), value, where, "an object");
  for (auto& [name, index] : value.items()) check_index(index, join(where, name));
}

void check_string(json& value, const std::string& where) {
  require(value.is_string(), value, where, "a string");
}

void check(json& value, const Property& property, const std::string& where) {
  switch (property.kind) {
    case Kind::kIndex:
      return check_index(value, where);
    case Kind::kIndices:
      return check_array(value, where, "whole numbers", check_index);
    case Kind::kIndexMap:
      return check_index_map(value, where);
    case Kind::kIndexMaps:
      return check_array(value, where, "objects", check_index_map);
    case Kind::kNumber:
      return check_number(value, where);
    case Kind::kNumbers:
      check_array(value, where, "numbers", check_number);
      if (property.length > 0 && value.size() != property.length)
        fail(where, "must have " + std::to_string(property.length) + " numbers, not " + std::to_string(value.size()));
      return;
    case Kind::kBool:
      return require(value.is_boolean(), value, where, "true or false");
    case Kind::kString:
      return check_string(value, where);
    case Kind::kStrings:
      return check_array(value, where, "strings", check_string);
    case Kind::kObject:
      return check_members(value, property.members, where);
    case Kind::kObjects:
      if (value.is_array() && value.size() > property.length)
        fail(where, std::to_string(value.size()) + " are more than the " + std::to_string(property.length) + " allowed",
             ErrorKind::kTooLarge);
      return check_array(value, where, "objects", [&property](json& element, const std::string& path) {
        check_members(element, property.members, path);
      });
  }
}

/// Checks the members that `value` is known to have, and forgets all others.
void check_members(json& value, std::span<const Property> members, const std::string& where) {
  require(value.is_object(), value, where, "an object");
  json known = json::object();
  for (const Property& property : members) {
    const auto member = value.find(property.name);
    if (member == value.end()) {
      if (property.required) fail(where, "has no '" + std::string(property.name) + "'");
      continue;
    }
    check(*member, property, join(where, property.name));
    known.emplace(property.name, std::move(*member));
  }
  value = std::move(known);
}

}  // namespace

void apply_schema(json& document) {
  check_members(document, kDocument, "");
}

}  // namespace lightwell::gltf
