// SPDX-License-Identifier: Apache-2.0
// The kernels for processors with AVX2: the only file compiled for them (see CMakeLists.txt).
#include "burin/plan/rotary/reach_kernels.h"

#ifdef __AVX2__
#define BURIN_KERNELS avx2
#include "burin/plan/rotary/reach_kernels.inc"
#endif

namespace burin::rotary::detail {

const ReachKernels& reach_kernels_avx2() {
#ifdef __AVX2__
  if (__builtin_cpu_supports("avx2")) return avx2::kKernels;
#endif
  return reach_kernels_any();
}

}  // namespace burin::rotary::detail
