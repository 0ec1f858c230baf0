// SPDX-License-Identifier: Apache-2.0
// The kernels for any processor.
#include "burin/plan/orient/scene_kernels.h"

#define BURIN_KERNELS any
#include "burin/plan/orient/scene_kernels.inc"

namespace burin::orient::detail {

const SceneKernels& scene_kernels_any() {
  return any::kKernels;
}

}  // namespace burin::orient::detail
