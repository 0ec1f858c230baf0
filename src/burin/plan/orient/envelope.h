// SPDX-License-Identifier: Apache-2.0
// What is known of the goal over the yaw while its greatest value is looked for. docs/cspace.md
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
    double alpha = 0;    ///< no smaller tilt is allowed at this yaw
    double value = 0;    ///< of the goal there: no allowed tilt of this yaw has a greater one
    bool exact = false;  ///< alpha itself is allowed
    double gate = -std::numeric_limits<double>::infinity();  ///< sampled for values above this
    bool possible() const { return value != kNever; }
  };
  static constexpr double kNever = -std::numeric_limits<double>::infinity();

  /// Keeps references. `guess`: one more yaw to begin with.
  Envelope(const Setting& setting, const Goal& goal, const CcPoint& at, const Relaxation& known,
           std::optional<double> guess);

  /// The node of the greatest value above `gate` that is not exact.
  std::optional<std::size_t> open(double gate);
  /// More nodes where more than `found` may lie between two; false: nowhere.
  bool refine(double found);
  /// The node at the first guess.
  std::optional<std::size_t> guessed() const { return guessed_; }
  const Node& node(std::size_t i) const { return nodes_[i]; }

  /// The tilt that exact neighbours let expect there, nothing when there are none.
  std::optional<double> foretell(std::size_t i) const;
  /// No tilt below `alpha` is allowed there; exact: `alpha` itself is.
  void raise(std::size_t i, double alpha, bool exact);
  /// Nothing is allowed there up to `alpha`, beyond which values are `gate` at most.
  void exclude(std::size_t i, double alpha, double gate);
  /// The last place added to what is known, for all nodes that are not below `gate`.
  void learn(double gate);

 private:
  /// Only the end of the tilts is known: the greatest value that could be.
  Node fresh(double beta) const;
  /// What is known, as far as values above `gate` go.
  void look(Node& node, double gate) const;
  /// How great a value between nodes j and j + 1 may be: an estimate (docs/cspace.md); and at which yaw.
  double between(std::size_t j, double& beta) const;
  double by_tilts(std::size_t j) const;
  bool smooth(std::size_t j) const;
  bool exact(std::size_t j) const { return j < nodes_.size() && nodes_[j].exact; }

  const Setting& setting_;
  const Goal& goal_;
  const CcPoint& at_;
  const Relaxation& known_;
  std::vector<Node> nodes_;
  std::optional<std::size_t> guessed_;
};

}  // namespace burin::orient
