// SPDX-License-Identifier: Apache-2.0
// Branch and bound over the yaw: the most promising yaw is asked whether it comes near the best found; what
// stands in the way there lowers the bounds of other yaws; where it does, the yaws beside it are looked
// through.
#include <algorithm>
#include <array>
#include <cmath>

#include "burin/plan/orient/envelope.h"
#include "burin/plan/orient/initial.h"

namespace burin::orient {
namespace {

// Yaws asked at one contact point before the best found is taken.
constexpr int kMostAsked = 400;
// Yaws that come within this share of the best are found exactly, for the curves through them.
constexpr double kMargin = 0.04;
// Share of a foretold tilt at which what blocks below it is looked for.
constexpr double kShort = 0.03;
// Narrow allowed sets are looked for at steps of yaw of this (rad) where they would be better by this share,
// and followed until steps are smaller than kNarrowest.
constexpr double kBetween = 1 * geom::kPi / 180;
constexpr double kWorth = 0.003;
// A quarter of kBetween beside a smooth optimum the goal is lower by less than this share.
constexpr double kSmoothFall = 1e-3;
constexpr double kNarrowest = 1e-4;
// What the next contact point gets.
constexpr std::size_t kKeptWitnesses = 40;

class OptimalSearch {
 public:
  OptimalSearch(const Setting& setting, const Goal& goal, const CcPoint& at, Scene::Memory& memory,
                Relaxation& known)
      : setting_(setting), goal_(goal), at_(at), memory_(memory), known_(known) {}

  void run(Optimum& best, std::optional<double> guess) {
    Envelope envelope(setting_, goal_, at_, known_, guess);
    if (envelope.guessed()) ask(envelope, *envelope.guessed(), best);
    for (int asked = 0; asked < kMostAsked;) {
      const auto open = envelope.open(gate(best));
      if (open) {
        ++asked;
        ask(envelope, *open, best);
      } else if (!best.found || !envelope.refine(best.value)) {
        break;
      }
    }
    look_between(best);
    if (!best.found && best.cause == Cause::none) best.cause = most();
  }

 private:
  /// Allowed sets narrower than the envelope's steps: yaws between those, as far as the witnesses do not rule
  /// out that they are better by more than what is found nearby anyway.
  void look_between(Optimum& best) {
    const AngleRange& range = setting_.range;
    const double width = range.beta_hi - range.beta_lo;
    const int steps = static_cast<int>(std::ceil(width / kBetween));
    for (int k = 1; k < steps; ++k) try_yaw(range.beta_lo + k * width / steps, kWorth, best);
    // Where the goal falls away on a side, a wall is near: to where it ends the better side.
    if (!best.found || (is_near_best(best.angles.beta - kBetween / 4, best) &&
                        is_near_best(best.angles.beta + kBetween / 4, best)))
      return;
    for (double step = kBetween / 2; best.found && step > kNarrowest; step /= 2) {
      const double worth = kOptimumShare / 2;
      while (try_yaw(best.angles.beta - step, worth, best) || try_yaw(best.angles.beta + step, worth, best))
        continue;
    }
  }
  /// The first allowed tilt of a yaw, as far as it gives a value above `least`; what stands in the way is
  /// learnt.
  std::optional<Scene::FirstFree> above(double least, double beta) {
    const AngleRange& range = setting_.range;
    const Relaxation::Reach reach = known_.blocked_from(beta, range.alpha_lo, range.alpha_hi);
    if (reach.covered || !(goal_.value(at_, {reach.alpha, beta}) > least)) return std::nullopt;
    Setting near = setting_;
    if (least > Envelope::kNever)
      near.range.alpha_hi =
          std::max(reach.alpha, goal_.tilt_of(at_, least, beta, range.alpha_lo, range.alpha_hi));
    const Scene::FirstFree free = first_allowed(near, at_, beta, reach.alpha, memory_);
    if (free.witness) known_.add(*free.witness);
    if (free.found) return free;
    count(free.cause);
    return std::nullopt;
  }
  bool in_range(double beta) const {
    return setting_.range.beta_lo <= beta && beta <= setting_.range.beta_hi;
  }
  /// Whether a yaw beside the best is nearly as good, as everywhere where the goal is smooth.
  bool is_near_best(double beta, const Optimum& best) {
    return !in_range(beta) || above((1 - kSmoothFall) * best.value, beta);
  }
  /// Whether the yaw gives a value better by more than the share `worth`, which is then taken.
  bool try_yaw(double beta, double worth, Optimum& best) {
    if (!in_range(beta)) return false;
    const double least = best.found ? (1 + worth) * best.value : Envelope::kNever;
    const auto free = above(least, beta);
    return free && take({free->alpha, beta}, free->cause, least, best);
  }
  /// Whether the value of the angles is above `least`; they are then the best.
  bool take(const Angles& angles, Cause cause, double least, Optimum& best) const {
    const double value = goal_.value(at_, angles);
    if (!(value > least)) return false;
    best.found = true;
    best.angles = angles;
    best.value = value;
    best.cause = cause;
    return true;
  }

  static double gate(const Optimum& best) {
    return best.found ? (1 - kMargin) * best.value : Envelope::kNever;
  }
  void count(Cause cause) { ++causes_[static_cast<std::size_t>(cause)]; }
  Cause most() const {
    // Known places may have answered everything.
    std::size_t best = known_.size();
    for (std::size_t i = 0; i < known_.size(); ++i)
      if (best == known_.size() || known_.uses(i) > known_.uses(best)) best = i;
    const auto most = std::max_element(causes_.begin(), causes_.end());
    if (*most > 0) return static_cast<Cause>(most - causes_.begin());
    return best < known_.size() ? setting_.scene->body()[known_.witness(best).piece].cause : Cause::none;
  }

  void ask(Envelope& envelope, std::size_t i, Optimum& best) {
    if (beyond_limits(envelope, i)) return;
    const double beta = envelope.node(i).beta, lo = setting_.range.alpha_lo, hi = setting_.range.alpha_hi;
    double from = envelope.node(i).alpha;
    Setting near = setting_;
    if (best.found) {
      // Only as far as it matters; and what blocks there first: it stands well inside the tool and speaks for
      // many tilts and yaws, one at the end of what is blocked lies on the tool's edge and speaks for few.
      double to = std::max(from, goal_.tilt_of(at_, gate(best), beta, lo, hi));
      near.range.alpha_hi = to;
      // Beside yaws that came near the best this one will as well: just below where they say.
      const auto foretold = envelope.foretell(i);
      if (foretold) to = std::min(to, std::max(from, (1 - kShort) * *foretold));
      if (blocked_up_to(envelope, i, to, to == near.range.alpha_hi, best)) return;
      from = envelope.node(i).alpha;
    }
    const Scene::FirstFree free = first_allowed(near, at_, beta, from, memory_);
    if (free.found) {
      take({free.alpha, beta}, free.cause, best.found ? best.value : Envelope::kNever, best);
      envelope.raise(i, free.alpha, true);
    } else {
      count(free.cause);
      envelope.exclude(i, near.range.alpha_hi, gate(best));
    }
    if (free.witness && known_.add(*free.witness)) envelope.learn(gate(best));
  }

  /// all: nothing beyond `to` matters. True: the yaw is done with.
  bool blocked_up_to(Envelope& envelope, std::size_t i, double to, bool all, const Optimum& best) {
    const Envelope::Node& node = envelope.node(i);
    if (to <= kNoTilt || to <= node.alpha) return false;
    const Scene::FirstFree there = setting_.scene->first_free(at_, node.beta, to, to, memory_);
    if (there.found || !there.witness || !known_.add(*there.witness)) return false;
    const Relaxation::Reach reach = known_.blocked_from(node.beta, node.alpha, to);
    const bool done = reach.covered && all;
    if (done) {
      count(there.cause);
      envelope.exclude(i, to, gate(best));
    } else {
      envelope.raise(i, reach.alpha, false);
    }
    envelope.learn(gate(best));
    return done;
  }

  /// The machine is asked first: it costs no test.
  bool beyond_limits(Envelope& envelope, std::size_t i) {
    if (setting_.limits->unlimited()) return false;
    const double beta = envelope.node(i).beta, from = envelope.node(i).alpha, to = setting_.range.alpha_hi;
    const double kept = first_within(setting_, at_, beta, from, to);
    if (kept == from) return false;
    const double alpha = kept > to ? kept : after(beta, kept, to);
    if (alpha > to) {
      count(Cause::limit);
      envelope.exclude(i, to, Envelope::kNever);
    } else {
      envelope.raise(i, alpha, false);
    }
    return true;
  }

  double after(double beta, double from, double to) const {
    const Relaxation::Reach reach = known_.blocked_from(beta, from, to);
    return reach.covered ? std::nextafter(to, 10.0) : reach.alpha;
  }

  const Setting& setting_;
  const Goal& goal_;
  const CcPoint& at_;
  Scene::Memory& memory_;
  Relaxation& known_;
  std::array<int, 5> causes_{};
};

void keep(const Relaxation& known, std::size_t inherited, const Optimum& best, Experience& experience) {
  std::vector<std::size_t> order;
  for (std::size_t i = inherited; i < known.size(); ++i) order.push_back(i);
  std::vector<std::size_t> old;
  for (std::size_t i = 0; i < inherited; ++i)
    if (known.uses(i) > 0) old.push_back(i);
  std::stable_sort(old.begin(), old.end(),
                   [&](std::size_t a, std::size_t b) { return known.uses(a) > known.uses(b); });
  order.insert(order.end(), old.begin(), old.end());
  if (order.size() > kKeptWitnesses) order.resize(kKeptWitnesses);
  std::vector<Witness> kept;
  for (const std::size_t i : order) kept.push_back(known.witness(i));
  experience.witnesses = std::move(kept);
  experience.has_angles = best.found;
  if (best.found) experience.angles = best.angles;
}

}  // namespace

Optimum find_optimal(const Setting& setting, const Goal& goal, const CcPoint& at, Scene::Memory& memory,
                     Experience& experience) {
  const std::uint64_t before = memory.tests;
  Relaxation known(*setting.scene, at);
  for (const Witness& witness : experience.witnesses) known.add(witness);
  const std::size_t inherited = known.size();

  Optimum best;
  const Initial initial = initial_solution(setting, at, known, memory);
  best.found = best.initial_found = initial.found;
  best.cause = initial.cause;
  if (initial.found) {
    best.angles = best.initial = initial.angles;
    best.value = best.initial_value = goal.value(at, initial.angles);
  }
  if (!initial.at_corner) {
    const std::optional<double> guess =
        experience.has_angles ? std::optional<double>(experience.angles.beta) : std::nullopt;
    OptimalSearch(setting, goal, at, memory, known).run(best, guess);
    if (best.found && (best.cause == Cause::none || best.angles == best.initial))
      best.cause = cause_beyond(setting, at, best.angles, known, memory);
  }
  keep(known, inherited, best, experience);
  best.tests = static_cast<std::uint32_t>(memory.tests - before);
  return best;
}

}  // namespace burin::orient
