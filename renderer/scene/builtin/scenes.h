// The built-in scenes, one function and one source file each.
#pragma once

#include "renderer/scene/scene.h"

namespace lightwell::builtin {

/// The Cornell box at 2 m: 32 triangles, still.
Scene make_cornell();

}  // namespace lightwell::builtin
