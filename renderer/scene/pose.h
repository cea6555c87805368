// A scene at one moment: animations applied, hierarchy multiplied out, joints' matrices and morph weights found.
// What the renderer draws and traces is a Pose; it never looks at nodes.
#pragma once

#include "renderer/scene/deformed_shape.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// One primitive placed in the world.
struct Instance {
  std::shared_ptr<const Primitive> primitive;  // shares ownership of its mesh; its address identifies the geometry
  glm::mat4 world_from_object{1.0f};           // identity for skinned primitives
  int material = -1;
  int node = -1;
  int primitive_index = 0;  // within its mesh; (node, primitive_index) names the instance over time
  std::shared_ptr<const DeformedShape> deformed;  // null: rigid
};

/// An instance's vertices in its own space, on the processor.
inline std::span<const glm::vec3> positions_of(const Instance& instance) {
  return positions_of(*instance.primitive, instance.deformed.get());
}

struct PlacedLight {
  Light light;  // animated values
  glm::vec3 position_ws{0.0f};
  glm::vec3 direction_ws{0.0f, 0.0f, -1.0f};  // unit, the way the light shines
  int node = -1;
  int index = -1;  // in Scene::lights
};

struct PlacedCamera {
  Camera camera;
  glm::mat4 world_from_view{1.0f};  // rigid: scale removed
  int node = -1;
};

struct Pose {
  std::vector<Instance> instances;
  std::vector<PlacedLight> lights;
  std::vector<PlacedCamera> cameras;  // in the order of their nodes
  // Of all instances, world space; equal when there are none. Skins and morph targets may stay well within.
  glm::vec3 bounds_min{0.0f}, bounds_max{0.0f};
};

/// The scene at `time_s` seconds (animations repeat; a negative time counts as 0).
/// Hidden nodes and all below them are left out, save their cameras, whose numbers must not change.
Pose pose_at(const Scene& scene, double time_s);

/// Seconds after which all animations repeat: the longest duration; 0 if nothing moves.
double animation_duration_s(const Scene& scene);

/// A camera that shows all of `pose` from above and the front, for a scene that brings none.
PlacedCamera frame_camera(const Pose& pose, float aspect_ratio);

/// World matrices of all nodes with animations applied; cycles and missing indices are errors of the loader, not
/// checked here.
std::vector<glm::mat4> world_from_nodes(const Scene& scene, double time_s);

}  // namespace lightwell
