// A scene while a patch is applied to it, and what keeps its references right when elements come and go.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "renderer/error.h"
#include "renderer/scene/gltf/edit.h"
#include "renderer/scene/scene.h"

namespace lightwell::object_model {

/// The copy that a patch works on; it becomes the scene when the whole patch has gone through.
struct Editing {
  explicit Editing(const Scene& original, const EditLimits& edit_limits) : scene(original), limits(edit_limits) {}

  /// Counts elementary steps. Refuses (kTooLarge) once a patch has taken more than a second or so of them, so that a
  /// small patch of a large scene cannot take for ever.
  Status spend(std::size_t steps, const std::string& where);

  /// A mesh that nobody else sees; copied from the shared one at most once for each patch.
  Mesh& mesh_for_writing(std::size_t mesh);

  Scene scene;
  EditLimits limits;

 private:
  std::vector<std::shared_ptr<Mesh>> own_meshes_;  // null: still shared
  std::uint64_t steps_ = 0;
};

// The nodes' hierarchy. `parent`, `children` and `roots` stay consistent.

/// Makes `children` the children of `node`. A root that becomes a child is no root any more; a child that is dropped
/// has no place in the scene until something names it again. Refuses a child that has another parent, occurs twice,
/// or is `node` or above it.
Status set_children(Editing& editing, std::size_t node, const std::vector<int>& children, const std::string& where);

/// Makes `roots` the scene's. Refuses a node that has a parent or occurs twice.
Status set_roots(Editing& editing, const std::vector<int>& roots, const std::string& where);

// Animations: what a user sets stays as it was put. An animation that lost its last channel has no duration any more;
// others keep theirs, so that what is left keeps its rhythm.

void stop_animating(Scene& scene, std::size_t node, AnimatedProperty property);
void stop_animating(Scene& scene, std::size_t light, LightChannel::Property property);

// Elements that come and go: what refers to a later element moves along, what refers to a removed one refers to none.

void insert_node(Editing& editing, std::size_t index);  // a new root
void insert_material(Editing& editing, std::size_t index);
void insert_light(Editing& editing, std::size_t index);
void insert_camera(Editing& editing, std::size_t index);

/// Refuses a node that is the joint of a skin. Its children stay, but have no place in the scene.
Status erase_node(Editing& editing, std::size_t index, const std::string& where);
Status erase_material(Editing& editing, std::size_t index, const std::string& where);
Status erase_light(Editing& editing, std::size_t index, const std::string& where);
Status erase_camera(Editing& editing, std::size_t index, const std::string& where);

}  // namespace lightwell::object_model
