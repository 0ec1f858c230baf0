// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/smooth.h"

#include <algorithm>
#include <cmath>

#include "burin/plan/orient/layers.h"

namespace burin::orient {
namespace {

constexpr double kDegree = geom::kPi / 180;
constexpr double kYawStep = 5 * kDegree;
// Tilts over the first allowed one are taken from a row that is the same for all layers, so that a tilt can
// be kept from one to the next: each this share steeper than the one before.
constexpr double kTiltRatio = 1.1;
constexpr int kTilts = 3, kSteepTilts = 2;
// The steeper ones stand this many places apart.
constexpr int kSteepStride = 4;
// A choice with less than this share of the best value is taken only where the others are few.
constexpr double kLeastShare = 0.1;
constexpr std::size_t kFew = 24;
// Axes beyond their speed: in the first round the time lost counts, then whatever avoids it is better.
constexpr double kOverspeed = 1000;
// Rounds of refinement about the path found: yaws at these steps, each way.
constexpr double kRefine[] = {1.25 * kDegree, 0.3 * kDegree};
constexpr int kRefineYaws = 5;
// Sweeps that ease accelerations, to and fro; a change has to bring the share down by this much of itself.
constexpr int kSweeps = 60;
constexpr double kWorthwhile = 1e-3;

/// A stretch of points that have allowed angles.
class Stretch {
 public:
  Stretch(const Setting& setting, const Goal& goal, const std::vector<CcPoint>& points,
          const std::vector<Optimum>& best, const SmoothOptions& options, Scene::Memory& memory,
          std::size_t first, std::size_t count)
      : setting_(setting),
        goal_(goal),
        points_(points),
        best_(best),
        memory_(memory),
        motion_(options.machine, options.feed_mm_min),
        turn_weight_(options.turn_weight),
        first_(first),
        count_(count) {
    for (std::size_t i = 0; i + 1 < count; ++i) ways_.push_back(geom::distance(at(i).c, at(i + 1).c));
  }

  /// The chosen angles, one a point.
  std::vector<Choice> run() {
    for (std::size_t i = 0; i < count_; ++i) layers_.push_back(coarse(i));
    choose(1);
    for (const double step : kRefine) {
      for (std::size_t i = 0; i < count_; ++i) layers_[i] = fine(i, step);
      choose(kOverspeed);
    }
    ease();
    return chosen_;
  }

 private:
  const CcPoint& at(std::size_t i) const { return points_[first_ + i]; }
  const Optimum& best(std::size_t i) const { return best_[first_ + i]; }
  /// Of the contact, on both sides of a point.
  double way_of(std::size_t i) const {
    return 0.5 * ((i > 0 ? ways_[i - 1] : 0) + (i + 1 < count_ ? ways_[i] : 0));
  }

  void choose(double overspeed_weight) {
    const std::vector<std::size_t> way =
        cheapest_way(layers_, ways_, {&motion_, turn_weight_, overspeed_weight});
    chosen_.clear();
    for (std::size_t i = 0; i < count_; ++i) chosen_.push_back(layers_[i][way[i]]);
  }

  /// Adds the angles to the layer when they are allowed and not there yet.
  void add(Layer& layer, std::size_t i, const Angles& angles) {
    if (!setting_.range.contains(angles)) return;
    for (const Choice& choice : layer)
      if (choice.angles == angles) return;
    if (cause_at(setting_, at(i), angles, memory_) != Cause::none) return;
    layer.push_back(choice(i, angles));
  }

  Choice choice(std::size_t i, const Angles& angles) const {
    Choice choice;
    choice.angles = angles;
    choice.value = goal_.value(at(i), angles);
    const double most = best(i).value;
    const double share = std::isinf(most) ? (std::isinf(choice.value) ? 1 : 0)
                         : most > 0       ? choice.value / most
                                          : 1;
    choice.loss = std::max(0.0, 1 - share) * way_of(i);
    choice.pose = pose(at(i), angles, setting_.scene->mill());
    choice.rotary = motion_.rotary(choice.pose);
    return choice;
  }

  /// The first tilt of the common row above `tilt`, and its place.
  double row(int place) const {
    const double first = std::max(setting_.range.alpha_lo, 0.1 * kDegree);
    return first * std::pow(kTiltRatio, place);
  }
  int place_above(double tilt) const {
    if (tilt < row(0)) return 0;
    return static_cast<int>(std::floor(std::log(tilt / row(0)) / std::log(kTiltRatio))) + 1;
  }

  void add_tilts(Layer& layer, std::size_t i, double beta, bool steep) {
    const Scene::FirstFree first = first_allowed(setting_, at(i), beta, setting_.range.alpha_lo, memory_);
    if (!first.found) return;
    add(layer, i, {first.alpha, beta});
    int place = place_above(first.alpha);
    for (int k = 0; k < kTilts; ++k, ++place) add(layer, i, {row(place), beta});
    for (int k = 0; steep && k < kSteepTilts; ++k) add(layer, i, {row(place += kSteepStride), beta});
  }

  Layer coarse(std::size_t i) {
    Layer layer;
    layer.push_back(choice(i, best(i).angles));
    const AngleRange& range = setting_.range;
    const int lo = static_cast<int>(std::ceil(range.beta_lo / kYawStep - 1e-9));
    const int hi = static_cast<int>(std::floor(range.beta_hi / kYawStep + 1e-9));
    for (int k = lo; k <= hi; ++k)
      add_tilts(layer, i, std::clamp(k * kYawStep, range.beta_lo, range.beta_hi), true);
    // What suits the neighbours best may suit here.
    for (const std::size_t other : {i - 1, i + 1})
      if (other < count_)
        add(layer, i, best(other).angles), add_tilts(layer, i, best(other).angles.beta, false);
    thin(layer, best(i).value);
    return layer;
  }

  /// Poor choices cost time and are hardly ever taken.
  static void thin(Layer& layer, double most) {
    const auto poor = [&](const Choice& choice) { return choice.value < kLeastShare * most; };
    const auto good = static_cast<std::size_t>(
        std::count_if(layer.begin(), layer.end(), [&](const Choice& choice) { return !poor(choice); }));
    if (good >= kFew) layer.erase(std::remove_if(layer.begin() + 1, layer.end(), poor), layer.end());
  }

  /// About what is chosen, and about the middle of what the neighbours have.
  Layer fine(std::size_t i, double step) {
    const Angles here = chosen_[i].angles;
    Layer layer{chosen_[i]};
    const Angles& before = chosen_[i > 0 ? i - 1 : i].angles;
    const Angles& after = chosen_[i + 1 < count_ ? i + 1 : i].angles;
    const Angles middle{0.5 * (before.alpha + after.alpha), 0.5 * (before.beta + after.beta)};
    add(layer, i, before), add(layer, i, after), add(layer, i, middle);
    for (int k = -kRefineYaws; k <= kRefineYaws; ++k) {
      const double beta = here.beta + k * step;
      if (beta < setting_.range.beta_lo || beta > setting_.range.beta_hi) continue;
      const Scene::FirstFree first = first_allowed(setting_, at(i), beta, setting_.range.alpha_lo, memory_);
      if (!first.found) continue;
      add(layer, i, {first.alpha, beta});
      for (const double alpha : {here.alpha, before.alpha, after.alpha, middle.alpha})
        if (alpha > first.alpha) add(layer, i, {alpha, beta});
    }
    return layer;
  }

  /// Where the rotary axes would have to change their speed faster than they can, angles move to the middle
  /// of their neighbours' as long as that is allowed and helps: a second difference goes down where it stands
  /// out and is spread over its neighbourhood.
  void ease() {
    if (motion_.axes() == 0 || count_ < 3) return;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      bool any = false;
      const auto at_point = [&](std::size_t i) {
        if (share_about(i, chosen_[i]) > 1) any |= eased(i);
      };
      for (std::size_t i = 0; i < count_; ++i) at_point(i);
      for (std::size_t i = count_; i-- > 0;) at_point(i);
      if (!any) return;
    }
  }

  /// Larger of the shares of acceleration at the point and beside it, and of speed next to it, with `here` in
  /// its place.
  double share_about(std::size_t i, const Choice& here) const {
    const auto choice = [&](std::size_t k) -> const Choice& { return k == i ? here : chosen_[k]; };
    double share = 0;
    for (std::size_t k = i > 0 ? i - 1 : i; k <= i + 1; ++k) {
      if (k == 0 || k + 1 >= count_) continue;
      const Shares there = shares_along(motion_, {choice(k - 1).pose, choice(k).pose, choice(k + 1).pose});
      share = std::max({share, there.acceleration, there.speed});
    }
    return share;
  }

  bool eased(std::size_t i) {
    const Angles& before = chosen_[i > 0 ? i - 1 : i].angles;
    const Angles& after = chosen_[i + 1 < count_ ? i + 1 : i].angles;
    const Angles here = chosen_[i].angles;
    const Angles middle{0.5 * (before.alpha + after.alpha), 0.5 * (before.beta + after.beta)};
    Layer tries;
    for (const double share : {0.25, 0.5, 1.0}) {
      const Angles to{here.alpha + share * (middle.alpha - here.alpha),
                      here.beta + share * (middle.beta - here.beta)};
      add(tries, i, to);
      const Scene::FirstFree first = first_allowed(setting_, at(i), to.beta, to.alpha, memory_);
      if (first.found) add(tries, i, {first.alpha, to.beta});
    }
    double least = (1 - kWorthwhile) * share_about(i, chosen_[i]);
    bool better = false;
    for (const Choice& choice : tries) {
      const double share = share_about(i, choice);
      if (share < least) least = share, chosen_[i] = choice, better = true;
    }
    return better;
  }

  const Setting& setting_;
  const Goal& goal_;
  const std::vector<CcPoint>& points_;
  const std::vector<Optimum>& best_;
  Scene::Memory& memory_;
  AxisMotion motion_;
  double turn_weight_;
  std::size_t first_, count_;
  std::vector<double> ways_;
  std::vector<Layer> layers_;
  std::vector<Choice> chosen_;
};

double turn_between(const cl::Pose& a, const cl::Pose& b) {
  return std::atan2(norm(cross(a.axis, b.axis)), dot(a.axis, b.axis));
}

}  // namespace

SmoothPath smooth_path(const Setting& setting, const Goal& goal, const std::vector<CcPoint>& points,
                       const std::vector<Optimum>& best, const SmoothOptions& options,
                       Scene::Memory& memory) {
  SmoothPath path;
  path.points.resize(points.size());
  const AxisMotion motion(options.machine, options.feed_mm_min);
  std::size_t found = 0;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t end = first;
    while (end < points.size() && best[end].found) ++end;
    if (end == first) {
      ++first;
      continue;
    }
    const std::vector<Choice> chosen =
        Stretch(setting, goal, points, best, options, memory, first, end - first).run();
    std::vector<cl::Pose> poses;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      path.points[first + i] = {true, chosen[i].angles, chosen[i].value};
      const double most = best[first + i].value;
      if (most > 0 && !std::isinf(most)) path.value_loss += 1 - chosen[i].value / most;
      poses.push_back(chosen[i].pose);
      ++found;
      if (i == 0) continue;
      path.turn += turn_between(poses[i - 1], poses[i]);
      path.turn_before +=
          turn_between(pose(points[first + i - 1], best[first + i - 1].angles, setting.scene->mill()),
                       pose(points[first + i], best[first + i].angles, setting.scene->mill()));
    }
    const Shares shares = shares_along(motion, poses);
    path.speed_share = std::max(path.speed_share, shares.speed);
    path.acceleration_share = std::max(path.acceleration_share, shares.acceleration);
    first = end;
  }
  if (found > 0) path.value_loss /= static_cast<double>(found);
  return path;
}

}  // namespace burin::orient
