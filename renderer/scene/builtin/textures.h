// Pictures made in code: tileable, sRGB, seeded, the same on every machine.
#pragma once

#include "renderer/scene/scene.h"

namespace lightwell::builtin {

/// Flagstones in a running bond, `columns` x `rows` of them (rows even, to tile), each a little lighter or darker than
/// `albedo` (linear), with darker joints `joint` times a stone's width wide.
Image flagstones(int size_px, int columns, int rows, const glm::vec3& albedo, float joint);

/// Hand-trowelled plaster: `albedo` (linear) with soft clouds of `contrast` (0.05: five percent up and down).
Image plaster(int size_px, const glm::vec3& albedo, float contrast);

}  // namespace lightwell::builtin
