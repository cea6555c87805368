// Edits of a scene: JSON Patch (RFC 6902) whose paths are glTF 2.0 object-model pointers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// What a patch may make of a scene; what the scene has already is never refused.
struct EditLimits {
  std::size_t max_operations = 4096;  // in one patch
  std::size_t max_nodes = 100'000;
  std::size_t max_materials = 10'000;
  std::size_t max_lights = 1'000;
  std::size_t max_cameras = 1'000;
  std::uint64_t max_triangles = 8'000'000;  // over all instances
};

/// Applies a JSON Patch to `scene`, all or nothing: on an error the scene is as it was, the error's `where` is the
/// pointer that failed and its `what` says which edit it was. Paths are glTF object-model pointers as
/// KHR_animation_pointer uses them:
///   /nodes/3/translation, /materials/0/pbrMetallicRoughness/baseColorFactor,
///   /extensions/KHR_lights_punctual/lights/0/intensity, /cameras/0/perspective/yfov,
///   /meshes/0/primitives/1/material, /scenes/0/nodes/-, /extensions/LIGHTWELL_environment/zenith
/// A node, material, light, mesh, camera, skin or texture may be named instead of numbered, in a path and in a value:
/// /nodes/rotor/rotation. A name that several have, and one that looks like a number, must be numbered.
///
/// Properties (each that describe_scene can write) always exist, with glTF's value where none was given: `add` and
/// `replace` both set one, `remove` gives it back that value. `test` compares numbers as the 32-bit floats they are
/// kept as. An object may be given as a whole (`/materials/0`, `/materials/0/normalTexture`): members left out get
/// glTF's values, `extras` are ignored. An element of an array may be named by its index; only a list
/// (`/nodes/3/children`, `/scenes/0/nodes`) takes and loses elements. `move` and `copy` are refused.
///
/// Ranges are glTF's; numbers are finite and at most 1e15. Rotations are made unit. A node that has a matrix gets
/// translation, rotation and scale in its place when one of those is set.
///
/// An edit of a property that an animation drives takes it out of that animation: what a user put somewhere stays
/// there.
///
/// Nodes, materials, lights and cameras may be added (`/nodes/-`, or before another: `/nodes/3`) and removed. As in RFC
/// 6902 the indices of what follows move, and every reference to them moves along; references to what was removed
/// become none. A new node is a root; `/nodes/3/children/-` makes it a child of node 3. A child that is taken from its
/// parent, or whose parent is removed, stays in /nodes but has no place in the scene, as in glTF, until it is made a
/// child or a root again. The joints of a skin cannot be removed.
///
/// `refused`, if given, is set on an error: to the index of the edit that failed, or to patch.size() if it was no
/// single one.
Status apply_edits(Scene& scene, const nlohmann::json& patch, const EditLimits& limits = {},
                   std::size_t* refused = nullptr);

/// The scene's object model as glTF JSON (scenes, nodes, materials, lights, cameras, the environment; of meshes, skins,
/// textures and animations the names, materials and targets; no binary data), for clients that want to know what can be
/// edited. As in glTF, properties that have glTF's value are left out.
nlohmann::json describe_scene(const Scene& scene);

}  // namespace lightwell
