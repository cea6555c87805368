#include "tests/image/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#ifdef LIGHTWELL_WITH_EMBREE
#include "renderer/scene/bounds.h"
#include "renderer/tracing/embree/embree_tracer.h"
#endif
#include "renderer/tracing/tracer.h"

namespace lightwell::testing {

Renderer& shared_renderer() {
  static const std::unique_ptr<Renderer> renderer = [] {
    RendererOptions options;
#ifdef LIGHTWELL_WITH_EMBREE
    options.make_native_tracer = [] { return make_embree_tracer(); };
#endif
    return std::make_unique<Renderer>(options);
  }();
  return *renderer;
}

Material lambert(glm::vec3 albedo, glm::vec3 emission) {
  Material material;
  material.base_color_factor = glm::vec4(albedo, 1.0f);
  material.metallic_factor = 0.0f;
  material.specular_factor = 0.0f;
  material.emissive_factor = emission;
  return material;
}

void add_white_sky(Scene& scene) {
  scene.environment.zenith_radiance = scene.environment.horizon_radiance = scene.environment.ground_radiance =
      glm::vec3(1.0f);
}

int SceneMaker::material(const Material& material) {
  scene_.materials.push_back(material);
  return static_cast<int>(scene_.materials.size()) - 1;
}

void SceneMaker::add(Primitive primitive, int material) {
  primitive.material = material;
  fill_bounds(primitive);
  auto mesh = std::make_shared<Mesh>();
  mesh->primitives.push_back(std::move(primitive));
  Node node;
  node.mesh = static_cast<int>(scene_.meshes.size());
  scene_.meshes.push_back(std::move(mesh));
  scene_.roots.push_back(static_cast<int>(scene_.nodes.size()));
  scene_.nodes.push_back(std::move(node));
}

void SceneMaker::quad(glm::vec3 corner, glm::vec3 edge_u, glm::vec3 edge_v, int material, bool textured) {
  Primitive primitive;
  primitive.positions = {corner, corner + edge_u, corner + edge_u + edge_v, corner + edge_v};
  primitive.normals.assign(4, glm::normalize(glm::cross(edge_u, edge_v)));
  primitive.tangents.assign(4, glm::vec4(glm::normalize(edge_u), 1.0f));
  primitive.indices = {0, 1, 2, 0, 2, 3};
  if (textured) primitive.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  add(std::move(primitive), material);
}

void SceneMaker::triangles(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices,
                           int material) {
  Primitive primitive;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const glm::vec3 a = positions[indices[t]], b = positions[indices[t + 1]], c = positions[indices[t + 2]];
    const glm::vec3 area_normal = glm::cross(b - a, c - a);
    const float length = glm::length(area_normal);
    for (const glm::vec3& p : {a, b, c}) {
      primitive.indices.push_back(static_cast<std::uint32_t>(primitive.positions.size()));
      primitive.positions.push_back(p);
      primitive.normals.push_back(length > 0.0f ? area_normal / length : glm::vec3(0, 1, 0));
      primitive.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
    }
  }
  add(std::move(primitive), material);
}

void SceneMaker::disk(glm::vec3 center, glm::vec3 normal, float radius, int segments, int material) {
  const glm::vec3 x =
      glm::normalize(glm::cross(std::abs(normal.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), normal));
  const glm::vec3 y = glm::cross(glm::normalize(normal), x);
  std::vector<glm::vec3> positions{center};
  std::vector<std::uint32_t> indices;
  for (int i = 0; i < segments; ++i) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(segments);
    positions.push_back(center + radius * (std::cos(angle) * x + std::sin(angle) * y));
    const auto first = static_cast<std::uint32_t>(i + 1), next = static_cast<std::uint32_t>((i + 1) % segments + 1);
    indices.insert(indices.end(), {0, first, next});
  }
  triangles(positions, indices, material);
}

void SceneMaker::sphere(glm::vec3 center, float radius, int segments, bool from_inside, int material) {
  const int rings = segments / 2;
  std::vector<glm::vec3> positions;
  for (int ring = 0; ring <= rings; ++ring)
    for (int i = 0; i < segments; ++i) {
      const float theta = std::numbers::pi_v<float> * static_cast<float>(ring) / static_cast<float>(rings);
      const float phi = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(segments);
      positions.push_back(center + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                      std::sin(theta) * std::sin(phi)));
    }
  std::vector<std::uint32_t> indices;
  const auto triangle = [&](int a, int b, int c) {
    for (const int corner : {a, from_inside ? c : b, from_inside ? b : c})
      indices.push_back(static_cast<std::uint32_t>(corner));
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < segments; ++i) {
      const int a = ring * segments + i, b = ring * segments + (i + 1) % segments;
      if (ring > 0) triangle(a, b, a + segments);
      if (ring + 1 < rings) triangle(b, b + segments, a + segments);
    }
  triangles(positions, indices, material);
}

void SceneMaker::room(glm::vec3 low, glm::vec3 high, int material) {
  const glm::vec3 size = high - low;
  const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  quad(low, z, x, material);     // floor, facing up
  quad(high, -x, -z, material);  // ceiling: cross(-x, -z) points down
  quad(low, x, y, material);     // back, facing +z
  quad(high, -y, -x, material);  // front, facing -z
  quad(low, y, z, material);     // left, facing +x
  quad(high, -z, -y, material);  // right, facing -x
}

void SceneMaker::add_light(const Light& light, glm::vec3 position, glm::vec3 direction) {
  const glm::vec3 up = std::abs(direction.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  Node node;
  node.matrix = glm::inverse(glm::lookAt(position, position + direction, up));
  node.light = static_cast<int>(scene_.lights.size());
  scene_.lights.push_back(light);
  scene_.roots.push_back(static_cast<int>(scene_.nodes.size()));
  scene_.nodes.push_back(std::move(node));
}

void SceneMaker::directional(glm::vec3 direction, float lux) {
  Light light;
  light.kind = LightKind::kDirectional;
  light.intensity = lux;
  add_light(light, glm::vec3(0.0f), glm::normalize(direction));
}

void SceneMaker::point(glm::vec3 position, float candela) {
  Light light;
  light.kind = LightKind::kPoint;
  light.intensity = candela;
  add_light(light, position, glm::vec3(0, 0, -1));
}

void SceneMaker::spot(glm::vec3 position, glm::vec3 direction, float candela, float outer_angle) {
  Light light;
  light.kind = LightKind::kSpot;
  light.intensity = candela;
  light.outer_cone_angle = outer_angle;
  light.inner_cone_angle = 0.9f * outer_angle;
  add_light(light, position, glm::normalize(direction));
}

Settings thesis_settings(int bounces) {
  Settings settings;
  settings.bounces = bounces;
  settings.samples = 64;
  settings.indirect_size = 32;
  return settings;
}

PlacedCamera look_at(glm::vec3 eye, glm::vec3 target, float yfov) {
  const glm::vec3 direction = glm::normalize(target - eye);
  const glm::vec3 up = std::abs(direction.y) > 0.9f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  PlacedCamera camera;
  camera.camera.yfov = yfov;
  camera.camera.znear = 0.01f;
  camera.world_from_view = glm::inverse(glm::lookAt(eye, target, up));
  return camera;
}

PlacedCamera look_parallel(glm::vec3 eye, glm::vec3 target, float width_m) {
  PlacedCamera camera = look_at(eye, target);
  camera.camera.perspective = false;
  camera.camera.xmag = camera.camera.ymag = 0.5f * width_m;
  camera.camera.znear = 0.0f;
  camera.camera.zfar = 100.0f;
  return camera;
}

glm::vec3 Pixels::at(int x, int y) const {
  const std::size_t first =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px.x) + static_cast<std::size_t>(x));
  return {rgb[first], rgb[first + 1], rgb[first + 2]};
}

glm::vec3 Pixels::mean() const {
  glm::dvec3 sum(0.0);
  for (int y = 0; y < size_px.y; ++y)
    for (int x = 0; x < size_px.x; ++x) sum += glm::dvec3(at(x, y));
  return glm::vec3(sum / static_cast<double>(size_px.x * size_px.y));
}

Pixels render(const Scene& scene, const PlacedCamera& camera, const Settings& settings, glm::ivec2 size_px,
              int frames) {
  Renderer& renderer = shared_renderer();
  const auto view = renderer.make_view();
  FrameRequest request;
  request.camera = camera;
  request.size_px = size_px;
  request.settings = settings;
  request.want_linear = true;
  request.accumulate = frames > 1;
  Pixels pixels{size_px, {}};
  for (int frame = 0; frame < frames; ++frame) {
    Result<Frame> result = renderer.render(scene, request, *view);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message());
    if (!result) return pixels;
    pixels.rgb = std::move(result->linear_rgb);
  }
  for (const std::string& message : renderer.context().take_debug_messages()) ADD_FAILURE() << "GL: " << message;
  const bool is_signed = settings.view == ViewKind::kPosition || settings.view == ViewKind::kDirection;
  const auto bad = std::find_if(pixels.rgb.begin(), pixels.rgb.end(),
                                [&](float value) { return !std::isfinite(value) || (value < 0.0f && !is_signed); });
  EXPECT_TRUE(bad == pixels.rgb.end()) << "a pixel holds " << *bad;
  return pixels;
}

}  // namespace lightwell::testing
