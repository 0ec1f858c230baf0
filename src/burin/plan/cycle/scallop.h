// SPDX-License-Identifier: Apache-2.0
// The cusp that two neighbouring paths leave, from the true positions of the ball.
#pragma once

#include <optional>
#include <vector>

#include "burin/plan/cycle/track.h"

namespace burin::cycle {

/// Height that stands for "the balls do not meet at all".
inline constexpr double kNoOverlap = 1e30;

struct Cusp {
  double height = 0;     ///< over the surface with its stock; negative: below it
  double side_step = 0;  ///< distance on the surface between the paths
  double s = 0;          ///< parameter of the nearest place of the path before
  /// The surface is bent towards the tool more sharply than the ball: the centres do not follow the contacts,
  /// the ball will be lifted, and the height says nothing of what it leaves.
  bool too_tight = false;
};

/// One path over the whole region: a graph for each stretch that lies inside it, and its exact tool path.
struct Pass {
  std::vector<Graph> graphs;  ///< ascending in t, disjoint
  Track track;                ///< of all graphs, one after the other
  bool valley = false;        ///< runs along one, where the ball touches both flanks
  /// Where the path crosses valleys: the track between them without the parts in which the ball does not fit,
  /// up to the crease at `until`. Empty: it crosses none.
  struct Section {
    double until = 0;
    Track track;
  };
  std::vector<Section> fitting;
  /// What of t is cut: the sheet may go on beyond what is machined. Nothing: all.
  std::optional<geom::Interval> kept;
  std::optional<geom::Interval> inner;  ///< of that, what lies on the surface

  bool covers(double t) const;
  double w_at(double t) const;  ///< of the graph that holds t, or the nearest one
};

/// What lies before a path: another path, or a single point (a collapsed border).
struct Before {
  Before(const Pass& pass, double radius) : path(&pass) {
    if (pass.fitting.empty()) sections.push_back({0, NearestCentre(pass.track, radius)});
    for (const Pass::Section& s : pass.fitting) sections.push_back({s.until, NearestCentre(s.track, radius)});
  }
  Before(double t, double w) : pole(true), pole_t(t), pole_w(w) {}

  /// The centres that count for a ball at t: those on the same flank of a valley.
  const NearestCentre& centres(double t) const {
    for (const Section& s : sections)
      if (t < s.until) return s.centres;
    return sections.back().centres;
  }

  struct Section {
    double until = 0;  ///< the crease behind it
    NearestCentre centres;
  };
  std::vector<Section> sections;
  const Pass* path = nullptr;
  bool pole = false;
  double pole_t = 0, pole_w = 0;
};

/// Between the path before and the ball at (t, w). `slope`: dw/dt of the new path there; when it is not known
/// yet the direction of the old path counts. The cusp is where the sphere about the new centre, cut by the
/// plane across the new path, meets the tube about the old path. `ends`: at the ends of the paths also what
/// stands on the edge of the surface beyond the end of the shorter one.
/// `side`: of t, where t is on a crease.
Cusp cusp(const Sheet& sheet, const Before& before, double t, double w, std::optional<double> slope,
          bool ends, geom::Side side = geom::Side::right);

/// Height left at a surface point by a single ball.
double height_over(const Sheet& sheet, const Contact& at, Point3 centre);
double height_at(const Sheet& sheet, double t, double w, Point3 centre);

}  // namespace burin::cycle
