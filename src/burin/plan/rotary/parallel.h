// SPDX-License-Identifier: Apache-2.0
// Work on independent elements on all cores. Private to plan/rotary.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace burin::rotary {

/// Calls visit(i) for 0 <= i < count, in any order and at the same time: each call may only write what is its
/// own, so that the result does not depend on the number of threads.
template <class Visit>
void for_each_index(std::size_t count, Visit&& visit) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) visit(i);
                    });
}

}  // namespace burin::rotary
