// SPDX-License-Identifier: Apache-2.0
// Walks a tool's path with a MillSearch: runs of pieces whose swept bounds are clear of all triangles are
// passed over as a whole. Internal to verify. mm. docs/verify-mill.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "burin/base/result.h"
#include "burin/verify/mill_search.h"
#include "burin/verify/path.h"

namespace burin::verify {

/// One straight piece of a tool's way.
struct Step {
  Stretch stretch;
  std::uint32_t move = 0;
  std::size_t piece = 0;
};
Step step_of(const ToolPath& path, std::size_t piece);

/// Pieces of one tool that are looked at together, each block by itself, so that what is found does not
/// depend on the number of threads. A move is never divided between two.
struct Block {
  std::size_t tool = 0, begin = 0, end = 0;
};
std::vector<Block> blocks_of(const CheckedPath& path);

/// A place of all steps from begin to end, and how far any place of a piece of the tool with this span is
/// from where it is then.
struct Around {
  Placed mean;
  double slack = 0;
};
Around around(const Step* begin, const Step* end, double span);

class MillWalk {
 public:
  /// Calls each(step, front) for the steps, in their order, in which something can be deeper than the floor
  /// that the search was last reset to; `front`: where in the tree.
  template <class Each>
  void run(const std::vector<Step>& steps, MillSearch& search, const Each& each) {
    if (!steps.empty()) range(steps.data(), steps.data() + steps.size(), search.root(), 0, search, each);
  }

 private:
  template <class Each>
  void range(const Step* begin, const Step* end, const MillSearch::Front& front, std::size_t level,
             MillSearch& search, const Each& each) {
    if (front.empty()) return;
    if (end - begin == 1) return each(*begin, front);
    if (fronts_.size() <= level) fronts_.resize(level + 1);
    const auto [mean, slack] = around(begin, end, search.span());
    MillSearch::Front narrowed = std::move(fronts_[level]);
    search.narrow(mean, slack, front, narrowed);
    const Step* middle = begin + (end - begin) / 2;
    range(begin, middle, narrowed, level + 1, search, each);
    range(middle, end, narrowed, level + 1, search, each);
    fronts_[level] = std::move(narrowed);
  }

  std::vector<MillSearch::Front> fronts_;  ///< of each level: their memory is used again
};

}  // namespace burin::verify
