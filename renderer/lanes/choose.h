// Which of the kernels of renderer/lanes/patch_light.h run on this processor.
#pragma once

#include <vector>

#include "renderer/lanes/patch_light.h"

namespace lightwell::lanes {

/// The widest first; never empty.
std::vector<const PatchKernels*> usable_patch_kernels();

/// The widest.
const PatchKernels& patch_kernels();

}  // namespace lightwell::lanes
