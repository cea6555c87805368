// Edits of a scene: JSON Patch (RFC 6902) whose paths are glTF 2.0 object-model pointers.
#pragma once

#include <nlohmann/json.hpp>

#include "renderer/error.h"
#include "renderer/scene/scene.h"

namespace lightwell {

/// Applies a JSON Patch to `scene`, all or nothing: on an error the scene is as it was and the error's `where` is
/// the pointer that failed. Paths are glTF object-model pointers as KHR_animation_pointer uses them:
///   /nodes/3/translation, /materials/0/pbrMetallicRoughness/baseColorFactor,
///   /extensions/KHR_lights_punctual/lights/0/intensity, /cameras/0/perspective/yfov
/// A node, material, light, mesh or camera may be named instead of numbered: /nodes/rotor/rotation.
/// Ops: replace and test on properties; add and remove on nodes (`/nodes/-`, with `children` or a parent given by
/// `/nodes/3/children/-`), lights and materials; indices of what follows a removed element move down as in RFC 6902,
/// and every reference to them moves along; references to the removed element become none.
Status apply_edits(Scene& scene, const nlohmann::json& patch);

/// The scene's object model as glTF JSON (nodes, materials, lights, cameras, animations' names; no binary data),
/// for clients that want to know what can be edited.
nlohmann::json describe_scene(const Scene& scene);

}  // namespace lightwell
