// SPDX-License-Identifier: Apache-2.0
// In which order, and from which start points, things are cut: short rapids under precedence. Knows points
// only. Internal to the laser planner.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/geom/vec.h"

namespace burin::laser::detail {

/// One way of cutting an item: where the beam comes down and where it leaves.
struct Way {
  geom::Point2 in, out;
  /// The way that does the same backwards; its own index when there is none (closed paths).
  std::uint32_t reverse = 0;
};

struct OrderItem {
  std::vector<Way> ways;               ///< at least one
  std::uint32_t parent = 0xffffffffu;  ///< must be cut after this item; kNoParent: none
};

struct Visit {
  std::uint32_t item = 0;
  std::uint32_t way = 0;
  bool operator==(const Visit&) const = default;
};

/// Every item once, each before its parent, starting near `from`. The parents must form a forest. The sum of
/// the rapids (out to the next in) is at most that of nearest neighbour, improved by 2-opt and Or-opt moves
/// that keep the precedence and by choosing the ways best for the order. Deterministic; the work is bounded.
std::vector<Visit> order_items(const std::vector<OrderItem>& items, geom::Point2 from);

/// Rapids of a tour: from `from` to the first in, and from every out to the next in.
double rapids_of(const std::vector<OrderItem>& items, const std::vector<Visit>& tour, geom::Point2 from);

/// Greedy: always the nearest item that may be cut now (no item it contains is left), by its nearest way.
std::vector<Visit> nearest_neighbour(const std::vector<OrderItem>& items, geom::Point2 from);

}  // namespace burin::laser::detail
