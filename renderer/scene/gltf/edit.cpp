#include "renderer/scene/gltf/edit.h"

#include <array>
#include <string>

#include "renderer/scene/gltf/object_model/operations.h"

namespace lightwell {
namespace {

using namespace object_model;

Error in_edit(std::size_t index, Error error) {
  error.what = "edit " + std::to_string(index) + ": " + error.what;
  return error;
}

/// An operation's own price: properties that an animation may drive are looked for in all channels.
std::size_t price(const Scene& scene) {
  std::size_t channels = 0;
  for (const Animation& animation : scene.animations)
    channels += animation.channels.size() + animation.light_channels.size();
  return 1000 + 4 * channels;
}

Status apply_one(Editing& editing, const Json& json) {
  const Result<Operation> operation = read_operation(json);
  if (!operation) return operation.error();
  const Status affordable = editing.spend(price(editing.scene), operation->path.text());
  return affordable ? apply(editing, *operation) : affordable;
}

/// A patch may not make a scene larger than it may be; one that is already may still be edited.
Status check_triangles(const Scene& before, const Editing& after) {
  const std::uint64_t triangles = count_triangles(after.scene), most = after.limits.max_triangles;
  if (triangles <= most || triangles <= count_triangles(before)) return Done{};
  return Error{ErrorKind::kTooLarge, "",
               "the patch makes it " + std::to_string(triangles) + " triangles; the most is " + std::to_string(most)};
}

Json describe_all(const ObjectKind& kind, const Scene& scene) {
  Json array = Json::array();
  for (std::size_t i = 0; i < kind.count(scene); ++i) array.push_back(describe(kind, scene, i));
  return array;
}

Json describe_names(const ObjectKind& kind, const Scene& scene) {
  Json array = Json::array();
  for (std::size_t i = 0; i < kind.count(scene); ++i) array.push_back({{"name", kind.name(scene, i)}});
  return array;
}

Json describe_meshes(const Scene& scene) {
  Json meshes = describe_names(object_model::meshes(), scene);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    Json primitives = Json::array();
    for (const Primitive& primitive : scene.meshes[i]->primitives)
      primitives.push_back(primitive.material < 0 ? Json::object() : Json{{"material", primitive.material}});
    meshes[i]["primitives"] = std::move(primitives);
  }
  return meshes;
}

/// A channel's target, as glTF's core and KHR_animation_pointer write it.
Json target_of(const AnimationChannel& channel) {
  constexpr std::array<const char*, 4> kPaths{"translation", "rotation", "scale", "weights"};
  return {{"node", channel.node}, {"path", kPaths[static_cast<std::size_t>(channel.property)]}};
}

Json target_of(const LightChannel& channel) {
  const char* property = channel.property == LightChannel::Property::kColor ? "/color" : "/intensity";
  const std::string pointer = lights().pointer + '/' + std::to_string(channel.light) + property;
  return {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

Json describe_animations(const Scene& scene) {
  Json animations = Json::array();
  for (const Animation& animation : scene.animations) {
    Json channels = Json::array();
    for (const AnimationChannel& channel : animation.channels) channels.push_back({{"target", target_of(channel)}});
    for (const LightChannel& channel : animation.light_channels) channels.push_back({{"target", target_of(channel)}});
    animations.push_back({{"name", animation.name}, {"channels", std::move(channels)}});
  }
  return animations;
}

}  // namespace

Status apply_edits(Scene& scene, const nlohmann::json& patch, const EditLimits& limits, std::size_t* refused) {
  if (refused) *refused = patch.size();
  if (!patch.is_array()) return invalid_input("", "a JSON Patch is an array, not " + in_words(patch));
  if (patch.size() > limits.max_operations)
    return Error{ErrorKind::kTooLarge, "", "a patch has at most " + std::to_string(limits.max_operations) + " edits"};
  Editing editing(scene, limits);
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const Status applied = apply_one(editing, patch[i]);
    if (applied) continue;
    if (refused) *refused = i;
    return in_edit(i, applied.error());
  }
  const Status small_enough = check_triangles(scene, editing);
  if (small_enough) scene = std::move(editing.scene);
  return small_enough;
}

nlohmann::json describe_scene(const Scene& scene) {
  Json model{{"scene", 0},
             {"scenes", describe_all(scenes(), scene)},
             {"nodes", describe_all(nodes(), scene)},
             {"materials", describe_all(materials(), scene)},
             {"cameras", describe_all(cameras(), scene)},
             {"meshes", describe_meshes(scene)},
             {"skins", describe_names(skins(), scene)},
             {"textures", describe_names(textures(), scene)},
             {"animations", describe_animations(scene)}};
  model[Json::json_pointer(lights().pointer)] = describe_all(lights(), scene);
  model[Json::json_pointer(environment().pointer)] = describe(environment(), scene, 0);
  return model;
}

}  // namespace lightwell
