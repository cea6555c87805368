// Puts a Scene together: materials, meshes, nodes, lights, cameras and keyframes, each by one call.
#pragma once

#include <functional>
#include <initializer_list>
#include <string>

#include "renderer/scene/builtin/mesh_builder.h"
#include "renderer/scene/scene.h"

namespace lightwell::builtin {

/// Rotation that turns -Z towards `direction` with +Y as near to `up` as can be: for lights and cameras.
glm::quat look_along(const glm::vec3& direction, const glm::vec3& up = {0.0f, 1.0f, 0.0f});

/// Smooth keyframes of a closed motion: `keys` equal spans over the animation's duration, cubic, the last key equal to
/// the first. `value(phase)` is asked for 0 <= phase < 1 and must be smooth and periodic.
void animate_translation(Animation& animation, int node, int keys, const std::function<glm::vec3(float phase)>& value);
void animate_rotation(Animation& animation, int node, int keys, const std::function<glm::quat(float phase)>& value);

/// One full turn about a node's own `axis` per duration, after `first`, in quarter turns; negative `turns` go
/// clockwise.
void animate_spin(Animation& animation, int node, const glm::vec3& axis, int turns, const glm::quat& first);

/// A part of a mesh: triangles and the material they are made of.
struct Part {
  const MeshBuilder& triangles;
  int material;
};

class SceneBuilder {
 public:
  explicit SceneBuilder(std::string name) { scene_.name = std::move(name); }

  /// A rough dielectric of linear colour `albedo`.
  int material(std::string name, const glm::vec3& albedo, float roughness = 0.9f, float metallic = 0.0f);
  /// A black body that emits `radiance_nit`.
  int emitter(std::string name, const glm::vec3& radiance_nit);
  /// A rough dielectric whose colour is `picture`, repeated every `width_m` metres where uv is in metres.
  int material(std::string name, Image picture, float width_m, float roughness);
  Material& material(int index) { return scene_.materials[static_cast<std::size_t>(index)]; }

  int mesh(std::string name, std::initializer_list<Part> parts);

  int node(std::string name, const Transform& local = {}, int parent = -1);
  /// A node that shows `mesh`.
  int mesh_node(std::string name, int mesh, const Transform& local = {}, int parent = -1);
  /// A node that shows a new mesh of `parts`.
  int mesh_node(std::string name, std::initializer_list<Part> parts, const Transform& local = {}, int parent = -1);
  int light_node(const Light& light, const Transform& local, int parent = -1);
  /// A perspective camera at `eye` looking at `target`; `yfov` in radians.
  int camera_node(std::string name, const glm::vec3& eye, const glm::vec3& target, float yfov, int parent = -1);

  /// A new animation; the reference holds until the next one is made.
  Animation& animation(std::string name, float duration_s);

  Environment& environment() { return scene_.environment; }

  Scene finish() && { return std::move(scene_); }

 private:
  Scene scene_;
};

}  // namespace lightwell::builtin
