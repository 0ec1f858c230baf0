// SPDX-License-Identifier: Apache-2.0
// The kernels for any processor.
#include "burin/plan/rotary/reach_kernels.h"

#define BURIN_KERNELS any
#include "burin/plan/rotary/reach_kernels.inc"

namespace burin::rotary::detail {

const ReachKernels& reach_kernels_any() {
  return any::kKernels;
}

}  // namespace burin::rotary::detail
