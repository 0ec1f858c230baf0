// SPDX-License-Identifier: Apache-2.0
// The kernels for processors with AVX2: the only file compiled for them (see CMakeLists.txt).
#include "burin/plan/orient/scene_kernels.h"

#ifdef __AVX2__
#define BURIN_KERNELS avx2
#include "burin/plan/orient/scene_kernels.inc"
#endif

namespace burin::orient::detail {

const SceneKernels& scene_kernels_avx2() {
#ifdef __AVX2__
  if (__builtin_cpu_supports("avx2")) return avx2::kKernels;
#endif
  return scene_kernels_any();
}

}  // namespace burin::orient::detail
