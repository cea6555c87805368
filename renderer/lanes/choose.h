// Which of the kernels of renderer/lanes/patch_light.h and view_triangles.h run on this processor.
#pragma once

#include <vector>

#include "renderer/lanes/patch_light.h"
#include "renderer/lanes/view_triangles.h"

namespace lightwell::lanes {

/// The widest first; never empty.
std::vector<const PatchKernels*> usable_patch_kernels();
std::vector<const ViewKernels*> usable_view_kernels();

/// The widest.
const PatchKernels& patch_kernels();
const ViewKernels& view_kernels();

}  // namespace lightwell::lanes
