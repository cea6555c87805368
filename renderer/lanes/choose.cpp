#include "renderer/lanes/choose.h"

namespace lightwell::lanes {

extern const PatchKernels kPlainPatchKernels;
#if defined(__x86_64__)
extern const PatchKernels kAvx2PatchKernels, kAvx512PatchKernels;
#endif

std::vector<const PatchKernels*> usable_patch_kernels() {
  std::vector<const PatchKernels*> usable;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) usable.push_back(&kAvx512PatchKernels);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) usable.push_back(&kAvx2PatchKernels);
#endif
  usable.push_back(&kPlainPatchKernels);
  return usable;
}

const PatchKernels& patch_kernels() {
  static const PatchKernels& widest = *usable_patch_kernels().front();
  return widest;
}

}  // namespace lightwell::lanes
