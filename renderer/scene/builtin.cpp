#include "renderer/scene/builtin.h"

#include <algorithm>

#include "renderer/scene/builtin/scene_builder.h"
#include "renderer/scene/builtin/scenes.h"

namespace lightwell {
namespace {

struct BuiltinScene {
  const char* name;
  Scene (*make)();
};

constexpr BuiltinScene kScenes[] = {
    {"atrium", builtin::make_atrium},
    {"cornell", builtin::make_cornell},
    {"helicopters", builtin::make_helicopters},
    {"venus", builtin::make_venus},
};

bool has_emission(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
    return m.emissive_strength > 0.0f && m.emissive_factor != glm::vec3(0.0f);
  });
}

bool has_light(const Scene& scene) {
  const auto lit = [&](const Node& node) { return node.light >= 0; };
  const Environment& sky = scene.environment;
  const bool sky_shines = sky.image || sky.zenith_radiance + sky.horizon_radiance + sky.ground_radiance != glm::vec3(0);
  return std::any_of(scene.nodes.begin(), scene.nodes.end(), lit) || (sky_shines && sky.strength > 0.0f);
}

}  // namespace

const std::vector<std::string>& builtin_scene_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const BuiltinScene& scene : kScenes) all.emplace_back(scene.name);
    return all;
  }();
  return names;
}

Result<Scene> builtin_scene(std::string_view name) {
  for (const BuiltinScene& scene : kScenes)
    if (name == scene.name) return scene.make();
  std::string known;
  for (const std::string& other : builtin_scene_names()) known += (known.empty() ? "" : ", ") + other;
  return Error{ErrorKind::kNotFound, "builtin:" + std::string(name), "no such built-in scene; there are " + known};
}

bool add_default_light(Scene& scene) {
  if (has_light(scene)) return false;
  // A neutral sky whose horizontal illuminance is about 3.3 lux (pi times its cosine-weighted mean radiance), and a sun
  // that brings about three times as much to the ground.
  scene.environment.zenith_radiance = {0.92f, 1.0f, 1.12f};
  scene.environment.horizon_radiance = {1.12f, 1.1f, 1.06f};
  // A grey floor under both would show about this.
  scene.environment.ground_radiance = {1.02f, 0.98f, 0.93f};
  // What glows by itself keeps the upper hand: a faint sky, so that what its light does not reach is not black.
  constexpr float kFaint = 0.15f;
  scene.environment.strength = has_emission(scene) ? kFaint : 1.0f;
  if (has_emission(scene)) return true;

  Light sun;
  sun.name = "default sun";
  sun.kind = LightKind::kDirectional;
  sun.color = {1.0f, 0.96f, 0.9f};
  sun.intensity = 13.0f;
  Node node;
  node.name = sun.name;
  node.light = static_cast<int>(scene.lights.size());
  node.local.rotation = builtin::look_along({-0.45f, -1.0f, -0.6f});
  scene.lights.push_back(sun);
  scene.roots.push_back(static_cast<int>(scene.nodes.size()));
  scene.nodes.push_back(node);
  return true;
}

}  // namespace lightwell
