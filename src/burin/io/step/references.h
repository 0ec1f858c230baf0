// SPDX-License-Identifier: Apache-2.0
// References between the entities of a file as a graph. Inside of this folder only.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace burin::io::step {

/// Entities 0 .. count - 1 and whom they refer to.
class References {
 public:
  explicit References(std::size_t count) : first_(count + 1, 0) {}
  /// In the order of `from`.
  void add(std::size_t from, std::size_t to) {
    to_.push_back(to);
    first_[from + 1] = to_.size();
  }

  struct Problem {
    std::size_t entity = 0;
    bool circle = false;  ///< else a chain longer than allowed
  };
  /// The first entity that reaches itself, or from which a chain of more than `max_depth` references starts:
  /// readers follow references by recursion.
  std::optional<Problem> check(std::size_t max_depth);

 private:
  std::vector<std::size_t> first_, to_;
};

}  // namespace burin::io::step
