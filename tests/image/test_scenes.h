// Scenes whose light is known in closed form, and a renderer to look at them with.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "renderer/renderer.h"
#include "renderer/scene/scene.h"

namespace lightwell::testing {

/// One renderer for the whole test program: the software device by the native tracer where it is built in.
Renderer& shared_renderer();

/// A Lambert material: no specular lobe at all.
Material lambert(glm::vec3 albedo, glm::vec3 emission = glm::vec3(0.0f));

/// 1 nit from everywhere.
void add_white_sky(Scene& scene);

/// Builds scenes from quads.
class SceneMaker {
 public:
  int material(const Material& material);
  /// A parallelogram with its front to cross(edge_u, edge_v); `textured`: with the unit square as its uv.
  void quad(glm::vec3 corner, glm::vec3 edge_u, glm::vec3 edge_v, int material, bool textured = false);
  /// Triangles with the normals of their faces.
  void triangles(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices, int material);
  /// A disk of `segments` triangles with its front to `normal`.
  void disk(glm::vec3 center, glm::vec3 normal, float radius, int segments, int material);
  /// A sphere of flat faces, seen from inside or from outside; its corners lie at `radius`.
  void sphere(glm::vec3 center, float radius, int segments, bool from_inside, int material);
  /// All six sides of a box, seen from inside.
  void room(glm::vec3 low, glm::vec3 high, int material);
  void directional(glm::vec3 direction, float lux);
  void point(glm::vec3 position, float candela);
  void spot(glm::vec3 position, glm::vec3 direction, float candela, float outer_angle);
  Scene take() { return std::move(scene_); }
  Scene& scene() { return scene_; }

 private:
  void add(Primitive primitive, int material);
  void add_light(const Light& light, glm::vec3 position, glm::vec3 direction);
  Scene scene_;
};

/// The method thesis with 64 samples and an indirect map as wide as the pictures here.
Settings thesis_settings(int bounces);

/// A camera at `eye` looking at `target`.
PlacedCamera look_at(glm::vec3 eye, glm::vec3 target, float yfov = 0.6f);

/// A parallel camera at `eye` that sees a square of `width_m`.
PlacedCamera look_parallel(glm::vec3 eye, glm::vec3 target, float width_m);

/// Scene-referred pixels of one frame.
struct Pixels {
  glm::ivec2 size_px;
  std::vector<float> rgb;
  glm::vec3 at(int x, int y) const;
  glm::vec3 center() const { return at(size_px.x / 2, size_px.y / 2); }
  glm::vec3 mean() const;
};

/// Renders `frames` accumulated frames; a refusal fails the test.
Pixels render(const Scene& scene, const PlacedCamera& camera, const Settings& settings, glm::ivec2 size_px = {32, 32},
              int frames = 1);

}  // namespace lightwell::testing
