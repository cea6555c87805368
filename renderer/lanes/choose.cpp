#include "renderer/lanes/choose.h"

namespace lightwell::lanes {

extern const PatchKernels kPlainPatchKernels;
extern const ViewKernels kPlainViewKernels;
#if defined(__x86_64__)
extern const PatchKernels kAvx2PatchKernels, kAvx512PatchKernels;
extern const ViewKernels kAvx2ViewKernels, kAvx512ViewKernels;
#endif

#if defined(__x86_64__)
namespace {

// The widest first.
template <class Kernels>
std::vector<const Kernels*> usable(const Kernels& plain, const Kernels& avx2, const Kernels& avx512) {
  std::vector<const Kernels*> usable;
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) usable.push_back(&avx512);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) usable.push_back(&avx2);
  usable.push_back(&plain);
  return usable;
}

}  // namespace

std::vector<const PatchKernels*> usable_patch_kernels() {
  return usable(kPlainPatchKernels, kAvx2PatchKernels, kAvx512PatchKernels);
}
std::vector<const ViewKernels*> usable_view_kernels() {
  return usable(kPlainViewKernels, kAvx2ViewKernels, kAvx512ViewKernels);
}
#else
std::vector<const PatchKernels*> usable_patch_kernels() {
  return {&kPlainPatchKernels};
}
std::vector<const ViewKernels*> usable_view_kernels() {
  return {&kPlainViewKernels};
}
#endif

const PatchKernels& patch_kernels() {
  static const PatchKernels& widest = *usable_patch_kernels().front();
  return widest;
}

const ViewKernels& view_kernels() {
  static const ViewKernels& widest = *usable_view_kernels().front();
  return widest;
}

}  // namespace lightwell::lanes
