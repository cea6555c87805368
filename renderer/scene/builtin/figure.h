// A draped standing figure after the classical type of the Aphrodite of Melos, made from stacked cross-sections.
// It stands on y = 0, is 1.8 m high, faces +Z and rests on its right leg, the left knee forward.
#pragma once

#include "renderer/scene/builtin/mesh_builder.h"

namespace lightwell::builtin {

/// Head, torso and the stumps of the arms; the part below the hips is open and hidden by the drapery.
MeshBuilder figure_body();

/// The cloth around the hips and legs, with a rolled upper edge.
MeshBuilder figure_drapery();

}  // namespace lightwell::builtin
