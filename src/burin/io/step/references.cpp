// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/references.h"

#include <algorithm>
#include <cstdint>

namespace burin::io::step {

std::optional<References::Problem> References::check(std::size_t max_depth) {
  const std::size_t count = first_.size() - 1;
  // Entities without references have kept 0: their list is empty.
  for (std::size_t i = 1; i <= count; ++i) first_[i] = std::max(first_[i], first_[i - 1]);
  constexpr std::uint32_t kUnseen = 0, kOpen = 0xffffffff;  // else: depth + 1
  std::vector<std::uint32_t> state(count, kUnseen);
  struct Visit {
    std::size_t entity, next;
    std::uint32_t depth;
  };
  std::vector<Visit> stack;
  for (std::size_t root = 0; root < count; ++root) {
    if (state[root] != kUnseen) continue;
    stack.push_back({root, first_[root], 0});
    state[root] = kOpen;
    while (!stack.empty()) {
      Visit& visit = stack.back();
      if (visit.depth >= max_depth) return Problem{visit.entity, false};
      if (visit.next == first_[visit.entity + 1]) {
        const std::uint32_t depth = visit.depth + 1;
        state[visit.entity] = depth;
        stack.pop_back();
        if (!stack.empty()) stack.back().depth = std::max(stack.back().depth, depth);
        continue;
      }
      const std::size_t to = to_[visit.next++];
      if (state[to] == kOpen) return Problem{to, true};
      if (state[to] == kUnseen) {
        state[to] = kOpen;
        stack.push_back({to, first_[to], 0});
      } else {
        visit.depth = std::max(visit.depth, state[to]);
      }
    }
  }
  return std::nullopt;
}

}  // namespace burin::io::step
