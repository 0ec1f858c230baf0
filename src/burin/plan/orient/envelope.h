// SPDX-License-Identifier: Apache-2.0
// An upper bound of the goal over the yaw, from the places of the part that are known to stand in the way;
// sampled where it matters. docs/cspace.md
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "burin/plan/orient/relaxation.h"

namespace burin::orient {

class Envelope {
 public:
  struct Node {
    double beta = 0;
    double alpha = 0;  ///< no smaller tilt is allowed at this yaw
    double value = 0;  ///< of the goal there: no allowed tilt of this yaw has a greater one
    bool exact = false;
    bool possible() const { return value != kNever; }
  };
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  /// Keeps references.
  Envelope(const Setting& setting, const Goal& goal, const CcPoint& at, const Relaxation& known);

  /// Samples more finely where more than `found` and than all samples may lie between two of them.
  void refine(double found);
  /// The node of the greatest value, nothing when none is possible.
  std::optional<std::size_t> top() const;
  const Node& node(std::size_t i) const { return nodes_[i]; }
  std::size_t size() const { return nodes_.size(); }

  /// No tilt below `alpha` is allowed there; exact: `alpha` itself is.
  void raise(std::size_t i, double alpha, bool exact);
  void exclude(std::size_t i) { nodes_[i].value = kNever; }
  /// The last place added to what is known, for all nodes that could still be better than `found`.
  void learn(double found);

 private:
  Node sample(double beta, double from) const;
  /// How great a value between nodes j and j + 1 may be: an estimate (docs/cspace.md), `enough` when no more
  /// than that.
  double between(std::size_t j, double enough) const;
  double by_tilts(std::size_t j) const;

  const Setting& setting_;
  const Goal& goal_;
  const CcPoint& at_;
  const Relaxation& known_;
  std::vector<Node> nodes_;
};

}  // namespace burin::orient
