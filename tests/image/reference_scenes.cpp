#include "tests/image/reference_scenes.h"

namespace lightwell::testing {

Settings reference_settings(int bounces) {
  Settings settings;
  settings.method = Method::kReference;
  settings.bounces = bounces;
  return settings;
}

Scene with_white_sky(SceneMaker maker) {
  Scene scene = maker.take();
  add_white_sky(scene);
  return scene;
}

Scene varied_room(float scale) {
  SceneMaker maker;
  const auto surface = [&](glm::vec3 color, float metallic, float roughness) {
    Material material;
    material.base_color_factor = glm::vec4(color, 1.0f);
    material.metallic_factor = metallic;
    material.roughness_factor = roughness;
    return maker.material(material);
  };
  const int wall = maker.material(lambert(glm::vec3(0.7f)));
  const auto quad = [&](glm::vec3 corner, glm::vec3 u, glm::vec3 v, int material) {
    maker.quad(scale * corner, scale * u, scale * v, material);
  };
  quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, surface({0.8f, 0.6f, 0.3f}, 1.0f, 0.3f));  // floor
  quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, wall);
  quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, surface({0.5f, 0.5f, 0.6f}, 0.0f, 0.4f));
  quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, wall);
  quad({1, -1, 1}, {0, 2, 0}, {0, 0, -2}, wall);
  quad({-0.4f, 0.8f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, maker.material(lambert(glm::vec3(0), glm::vec3(6.0f))));
  maker.spot(scale * glm::vec3(0.7f, 0.7f, 0.7f), {-0.6f, -0.7f, -0.5f}, 2.0f * scale * scale, 0.6f);
  Scene scene = maker.take();
  scene.environment.horizon_radiance = {0.6f, 0.7f, 1.0f};
  scene.environment.zenith_radiance = {0.3f, 0.4f, 1.0f};
  return scene;
}

PlacedCamera before_varied_room(float scale) {
  PlacedCamera camera = look_at(glm::vec3(0, 0, 3.0f) * scale, glm::vec3(0.0f), 0.6f);
  camera.camera.znear *= scale;
  return camera;
}

}  // namespace lightwell::testing
