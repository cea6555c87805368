#include <numbers>

#include "renderer/scene/gltf/object_model/fields.h"

namespace lightwell::object_model {
namespace {

const auto light_at = [](auto& scene, std::size_t i) -> auto& {
  return scene.lights[i];
};

template <class Access>
Property light_field(std::string path, Access access, Range range = {}) {
  return field(light_at, std::move(path), access, range);
}

auto stops(LightChannel::Property animated) {
  return [animated](Scene& scene, std::size_t light) { stop_animating(scene, light, animated); };
}

Status check_light(const Scene& scene, std::size_t i, const std::string& where) {
  const Light& light = scene.lights[i];
  if (light.inner_cone_angle < light.outer_cone_angle) return Done{};
  return invalid_input(where, "spot/innerConeAngle (" + in_words(write_value(light.inner_cone_angle)) +
                                  ") must be less than spot/outerConeAngle (" +
                                  in_words(write_value(light.outer_cone_angle)) + ')');
}

/// A property of spot lights alone; of others it is kept, but not shown.
Property of_spot(Property property) {
  property.get = [get = property.get](const Scene& scene, std::size_t i) {
    return scene.lights[i].kind == LightKind::kSpot ? get(scene, i) : std::nullopt;
  };
  return property;
}

/// KHR_lights_punctual has no default for the type: it is always written.
Property type() {
  Property property = light_field("/type", &Light::kind);
  property.standard = nullptr;
  return property;
}

}  // namespace

const ObjectKind& lights() {
  static const ObjectKind kind = [] {
    const Range half_turn{0.0, std::numbers::pi / 2 + 1e-6};
    ObjectKind lights;
    lights.singular = "light";
    lights.pointer = "/extensions/KHR_lights_punctual/lights";
    lights.properties = {
        light_field("/name", &Light::name),
        type(),
        followed_by(light_field("/color", &Light::color, kNotNegative), stops(LightChannel::Property::kColor)),
        followed_by(light_field("/intensity", &Light::intensity, kNotNegative),
                    stops(LightChannel::Property::kIntensity)),
        absent_at_standard(light_field("/range", &Light::range_m, kPositive)),
        of_spot(light_field("/spot/innerConeAngle", &Light::inner_cone_angle, half_turn)),
        of_spot(light_field("/spot/outerConeAngle", &Light::outer_cone_angle, half_turn)),
    };
    lights.count = [](const Scene& scene) { return scene.lights.size(); };
    lights.name = [](const Scene& scene, std::size_t i) -> const std::string& { return scene.lights[i].name; };
    lights.insert = insert_light;
    lights.erase = erase_light;
    lights.most = &EditLimits::max_lights;
    lights.check = check_light;
    return lights;
  }();
  return kind;
}

}  // namespace lightwell::object_model
