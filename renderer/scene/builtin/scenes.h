// The built-in scenes, one function and one source file each.
#pragma once

#include "renderer/scene/scene.h"

namespace lightwell::builtin {

/// The default: a vaulted hall at the foot of a light well, the sun crossing it in a minute.
Scene make_atrium();

/// The Cornell box at 2 m: 32 triangles, still.
Scene make_cornell();

/// Three helicopters over a landing place between two coloured walls: 1522 triangles; scene, light and camera move.
Scene make_helicopters();

/// A draped figure among two helicopters: 3284 triangles; scene, light and camera move.
Scene make_venus();

}  // namespace lightwell::builtin
