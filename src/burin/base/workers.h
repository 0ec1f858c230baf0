// SPDX-License-Identifier: Apache-2.0
// Numbered tasks spread over threads and, where there are several, over processes (MPI ranks). Every rank
// runs the same program and asks for the same tasks in the same order; afterwards every rank has all results.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace burin {

class Workers {
 public:
  using Task = std::function<std::string(std::size_t task)>;

  virtual ~Workers() = default;
  /// The bytes that body(i) gives, for i from 0 to count - 1. body must depend on i (and on what every rank
  /// has alike) only; it is called on any thread of any rank. What it throws is thrown here, on every rank.
  virtual std::vector<std::string> map(std::size_t count, const Task& body) = 0;
};

/// Threads of this process; 0: as many as the machine has.
class LocalWorkers final : public Workers {
 public:
  explicit LocalWorkers(unsigned threads) : threads_(threads) {}
  std::vector<std::string> map(std::size_t count, const Task& body) override;

 private:
  unsigned threads_;
};

}  // namespace burin
