#include "renderer/scene/gltf/object_model/fields.h"

namespace lightwell::object_model {
namespace {

const auto environment_of = [](auto& scene, std::size_t) -> auto& {
  return scene.environment;
};

template <class Access>
Property environment_field(std::string path, Access access, Range range) {
  return field(environment_of, std::move(path), access, range);
}

}  // namespace

const ObjectKind& environment() {
  static const ObjectKind kind = [] {
    ObjectKind environment;
    environment.singular = "environment";
    environment.pointer = "/extensions/LIGHTWELL_environment";
    environment.is_single = true;
    environment.properties = {
        environment_field("/zenith", &Environment::zenith_radiance, kNotNegative),
        environment_field("/horizon", &Environment::horizon_radiance, kNotNegative),
        environment_field("/ground", &Environment::ground_radiance, kNotNegative),
        environment_field("/strength", &Environment::strength, kNotNegative),
        environment_field("/rotation", &Environment::rotation, Range{}),
    };
    environment.count = [](const Scene&) { return std::size_t{1}; };
    return environment;
  }();
  return kind;
}

}  // namespace lightwell::object_model
