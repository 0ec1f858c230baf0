// SPDX-License-Identifier: Apache-2.0
// Lifting a tool path to where it cuts nothing it should not.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "burin/plan/cycle/cycle.h"
#include "burin/plan/cycle/obstacles.h"
#include "burin/plan/cycle/track.h"

namespace burin::cycle {

/// Part of a run of the tool between a plunge and a retract; each starts where the one before ended.
struct ChainPiece {
  TrackPiece track;
  MotionKind kind = MotionKind::cut;
  const Sheet* sheet = nullptr;
  int surface = -1, pass = -1;
  bool backwards = false;  ///< the tool goes against the direction of the surface parameters' curve
  double lift_max = 0;
};
using Chain = std::vector<ChainPiece>;

struct LiftPlace {
  int surface = -1, pass = -1;
  double height = 0;
  Point3 at;
};
struct LiftReport {
  std::vector<LiftPlace> places;  ///< one for each lifted stretch: its highest lift
  double gouge_max = 0;           ///< what was left below the tolerance
};

/// Scratch of one thread.
class LiftWorker {
 public:
  explicit LiftWorker(const Obstacles& obstacles) : probe(obstacles) {}
  /// A copy of the sheet that no other thread evaluates.
  const Sheet& own(const Sheet& sheet) {
    if (of_ != &sheet) copy_.emplace(sheet), of_ = &sheet;
    return *copy_;
  }
  Obstacles::Probe probe;

 private:
  const Sheet* of_ = nullptr;
  std::optional<Sheet> copy_;
};

/// Where the ball would cut deeper than `tolerance` the chain is raised to the no-gouge height (C2 along
/// every piece); where the path would turn back on itself, because the surface is bent more sharply than the
/// ball, the part that runs backwards is left out. One thread for each worker; the result does not depend on
/// their number.
void lift(Chain& chain, std::span<LiftWorker> workers, double radius, double tolerance, LiftReport& report);
/// All chains, as one after the other.
void lift(std::vector<Chain>& chains, const Obstacles& obstacles, unsigned threads, double radius,
          double tolerance, LiftReport& report);

}  // namespace burin::cycle
