// A frame of a built-in scene as the thesis shows its own: square, through the scene's camera.
#pragma once

#include "renderer/renderer.h"

namespace lightwell {

/// The scene must have a camera of its own.
FrameRequest square_frame(const Scene& scene, double time_s, int side_px, const Settings& settings);

/// A side of the indirect map that is meant for pictures of 512 x 512, for a picture of another size.
int scaled_indirect_side(int indirect_side_px, int side_px);

/// Sides of pictures for which every scaled indirect map is of a size that Settings takes.
constexpr int kLeastSide_px = 32, kMostSide_px = 4096;

}  // namespace lightwell
