// A light helicopter of 380 triangles: nose towards +Z, 4.4 m of rotor radius, its origin in the cabin below the mast.
#pragma once

#include "renderer/scene/builtin/scene_builder.h"

namespace lightwell::builtin {

/// Materials of one helicopter.
struct HelicopterPaint {
  int hull, glass, metal, blades;
};

/// Lowest point of the skids below the origin.
constexpr float kHelicopterSkid = 1.42f;

/// A new helicopter at `local`, its rotors turning by `main_turning` and `tail_turning`, whose durations are one turn.
/// Gives the node to fly it by.
int add_helicopter(SceneBuilder& scene, std::string name, const HelicopterPaint& paint, const Transform& local,
                   Animation& main_turning, Animation& tail_turning);

}  // namespace lightwell::builtin
