// SPDX-License-Identifier: Apache-2.0
// Step-size interference (Suh & Lee 2.1): as few CL points as the tolerance allows.
//   A step from A to B, contacts P_j between: error = max |dist(P_j, AB) - R|. Above the line that is the
//   overcut of eq. 2 (the ends included: R (1 - sqrt(1 - (N.H)^2)) is R - dist of the end's contact from the
//   line), below it the undercut of eq. 3, here from the segment and for every contact, not only the middle
//   one.
#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/point_tools.h"
#include "burin/plan/rotary/center_path.h"
#include "burin/plan/rotary/sweep.h"

namespace burin::rotary {
namespace {

using geom::Point3;
using geom::Vec3;

/// Centres of neighbours further apart than this many times sqrt(R tolerance) are a jump, unless the contact
/// moves straight: resolve_tsi sets places closer than sqrt(R tolerance).
constexpr double kJump = 4;
/// Steps of bisection for the end of a step between two dense places: to a thousandth of their distance.
constexpr int kBisections = 10;
/// Rounds about a closed path for a better start.
constexpr int kRounds = 3;

/// A place on the path: index of the dense place before, and the part of the way to the next one.
struct Spot {
  std::size_t i = 0;
  double f = 0;
};
bool operator<(Spot a, Spot b) {
  return a.i != b.i ? a.i < b.i : a.f < b.f;
}

/// The dense path, unrolled for closed ones: index i means place i % size.
class Way {
 public:
  Way(const CenterPath& path, double radius, double tolerance)
      : places_(path.places), closed_(path.closed), radius_(radius), tolerance_(tolerance) {
    const std::size_t n = places_.size();
    const double far = kJump * std::sqrt(radius * tolerance);
    for (std::size_t i = 0; i < n; ++i) {
      const Place &a = at(i), &b = at(i + 1);
      const Vec3 way = b.center - a.center;
      const double length = norm(way);
      const Contact middle{lerp(a.contact.p, b.contact.p, 0.5), detail::turned(a.contact.n, b.contact.n, 0.5),
                           0, 0};
      const double off = distance(middle.p + radius * middle.n, lerp(a.center, b.center, 0.5));
      // A contact half-way that belongs to the centre half-way: the ball rolls, and may stop anywhere.
      rolls_.push_back(off <= 0.25 * tolerance);
      const bool straight = angle_along(a, b, way) && off <= 1e-3 * tolerance;
      jumps_.push_back(length > far && !straight);
    }
    forced_.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      if (closed_ ? jumps_[i] : i + 1 < n && jumps_[i]) forced_[i] = forced_[(i + 1) % n] = 1;
    }
    keep_deepest();
  }

  std::size_t size() const { return places_.size(); }
  bool closed() const { return closed_; }
  const Place& at(std::size_t i) const { return places_[i % places_.size()]; }
  bool forced(std::size_t i) const { return forced_[i % places_.size()] != 0; }
  bool rolls(std::size_t i) const { return rolls_[i % places_.size()] != 0; }
  bool jumps(std::size_t i) const { return jumps_[i % places_.size()] != 0; }
  Place place(Spot s) const {
    if (s.f <= 0) return at(s.i);
    Place p = at(s.i);
    const Place& q = at(s.i + 1);
    p.contact.p = lerp(p.contact.p, q.contact.p, s.f);
    p.contact.n = detail::turned(p.contact.n, q.contact.n, s.f);
    p.contact.u = between(p.contact.u, q.contact.u, s.f);
    p.contact.w += s.f * (q.contact.w - p.contact.w);
    p.center = p.contact.p + radius_ * p.contact.n;
    if (q.state == State::moved) p.state = q.state;
    p.excess_mm = std::max(p.excess_mm, q.excess_mm);
    return p;
  }
  /// Largest error over the contacts from a to b; stops above `limit`.
  double error(Spot a, Spot b, double limit) const {
    const Point3 from = place(a).center, to = place(b).center;
    double worst = std::max(off(place(a).contact.p, from, to), off(place(b).contact.p, from, to));
    const std::size_t last = b.f > 0 ? b.i : b.i - 1;
    for (std::size_t i = a.i + 1; i <= last && worst <= limit; ++i) {
      worst = std::max(worst, off(at(i).contact.p, from, to));
    }
    return worst;
  }
  bool within(Spot a, Spot b) const { return error(a, b, tolerance_) <= tolerance_; }

 private:
  double off(Point3 contact, Point3 from, Point3 to) const {
    return std::abs(distance_to_segment(contact, from, to) - radius_);
  }
  static double between(double a, double b, double f) {
    // u runs round: from 0.99 to 0.01 it goes on through 1.
    if (b - a > 0.5) b -= 1;
    if (a - b > 0.5) b += 1;
    const double u = a + f * (b - a);
    return u < 0 ? u + 1 : u > 1 ? u - 1 : u;
  }
  static bool angle_along(const Place& a, const Place& b, Vec3 way) {
    const double length = norm(way);
    constexpr double kStraight = 1e-4;  // radians
    return length > 0 && detail::angle_between(a.contact.n, b.contact.n) < kStraight &&
           std::abs(dot(a.contact.n, way)) < kStraight * length;
  }
  /// Of each run of moved places the one that leaves most: it must stand in the list.
  void keep_deepest() {
    const std::size_t n = places_.size();
    for (std::size_t i = 0; i < n;) {
      if (places_[i].state != State::moved) {
        ++i;
        continue;
      }
      std::size_t deepest = i, end = i;
      for (; end < n && places_[end].state == State::moved; ++end) {
        if (places_[end].excess_mm > places_[deepest].excess_mm) deepest = end;
      }
      if (places_[deepest].excess_mm > tolerance_) forced_[deepest] = 1;
      i = end;
    }
  }

  const std::vector<Place>& places_;
  bool closed_;
  double radius_, tolerance_;
  std::vector<std::uint8_t> rolls_, jumps_, forced_;
};

/// The farthest dense place, at most `end`, that a step from `a` reaches; then the spot between it and the
/// next.
class Stepper {
 public:
  explicit Stepper(const Way& way) : way_(way) {}

  /// Precondition: a before end. The result lies after a.
  Spot next(Spot a, std::size_t end) {
    const std::size_t first = a.i + 1;
    if (first >= end) return {end, 0};
    // Galloping: about as far as the step before.
    std::size_t good = first, bad = end + 1, stride = std::max<std::size_t>(1, last_ / 2);
    while (good < end) {
      const std::size_t probe = std::min(good + stride, end);
      if (way_.within(a, {probe, 0})) {
        good = probe;
        stride *= 2;
      } else {
        bad = probe;
        break;
      }
    }
    while (bad - good > 1 && bad <= end) {
      const std::size_t middle = good + (bad - good) / 2;
      (way_.within(a, {middle, 0}) ? good : bad) = middle;
    }
    good = beyond(a, good, end);
    last_ = good - a.i;
    if (good >= end) return {end, 0};
    return refined(a, good);
  }

 private:
  /// Errors do not only grow: past a wave of the path a longer step may hold again.
  std::size_t beyond(Spot a, std::size_t good, std::size_t end) const {
    const std::size_t n = good - a.i;
    std::size_t best = good;
    for (const double factor : {1.1, 1.25, 1.5, 2.0}) {
      const std::size_t probe = a.i + std::size_t(std::ceil(factor * double(n)));
      if (probe > end) break;
      if (probe > best && way_.within(a, {probe, 0})) best = probe;
    }
    return best;
  }
  Spot refined(Spot a, std::size_t good) const {
    if (!way_.rolls(good)) return {good, 0};
    double lo = 0, hi = 1;
    for (int k = 0; k < kBisections; ++k) {
      const double middle = 0.5 * (lo + hi);
      (way_.within(a, {good, middle}) ? lo : hi) = middle;
    }
    return {good, lo};
  }

  const Way& way_;
  std::size_t last_ = 1;
};

/// Spots from `from` to dense place `to`, both included.
std::vector<Spot> greedy(const Way& way, Spot from, std::size_t to) {
  Stepper stepper(way);
  std::vector<Spot> spots{from};
  while (spots.back() < Spot{to, 0}) {
    const Spot a = spots.back();
    std::size_t end = a.i + 1;
    if (!(way.jumps(a.i) && a.f == 0)) {
      while (end < to && !way.forced(end)) ++end;
    }
    spots.push_back(stepper.next(a, end));
  }
  return spots;
}

/// A closed way without places that must stand: the orbit of longest steps runs round a few times; from the
/// spot on it from which fewest steps close the ring they are taken.
std::vector<Spot> closed_greedy(const Way& way) {
  const std::size_t n = way.size();
  Stepper stepper(way);
  std::vector<Spot> orbit{{0, 0}};
  while (orbit.back().i < kRounds * n) orbit.push_back(stepper.next(orbit.back(), orbit.back().i + n));
  std::size_t best = 0, fewest = std::numeric_limits<std::size_t>::max();
  for (std::size_t k = 0, e = 0; k < orbit.size() && orbit[k].i < (kRounds - 1) * n; ++k) {
    const Spot round{orbit[k].i + n, orbit[k].f};
    while (e < orbit.size() && orbit[e] < round) ++e;
    if (e < orbit.size() && e - k < fewest) {
      fewest = e - k;
      best = k;
    }
  }
  std::vector<Spot> spots(orbit.begin() + std::ptrdiff_t(best),
                          orbit.begin() + std::ptrdiff_t(best + fewest));
  return spots;
}

/// Procedure 1 of the paper: a step that is not good is halved, along the way.
class Halving {
 public:
  Halving(const Way& way, double tolerance) : way_(way), tolerance_(tolerance) {
    length_.push_back(0);
    const std::size_t last = way.closed() ? way.size() : way.size() - 1;
    for (std::size_t i = 1; i <= last; ++i) {
      length_.push_back(length_.back() + distance(way.at(i - 1).center, way.at(i).center));
    }
    halve({0, 0}, {last, 0}, 0);
  }
  std::size_t steps = 0, splits = 0;

 private:
  Spot middle(Spot a, Spot b) const {
    const double wanted = 0.5 * (length_at(a) + length_at(b));
    const auto it = std::upper_bound(length_.begin(), length_.end(), wanted);
    const std::size_t i = std::min(std::size_t(it - length_.begin()), length_.size() - 1) - 1;
    const double l = length_[i + 1] - length_[i];
    const double f = l > 0 ? std::clamp((wanted - length_[i]) / l, 0.0, 1.0) : 0;
    if (way_.rolls(i)) return {i, f};
    const Spot before{i, 0}, after{i + 1, 0};
    return (f < 0.5 && a < before) || !(after < b) ? before : after;
  }
  double length_at(Spot s) const {
    return s.f > 0 ? length_[s.i] + s.f * (length_[s.i + 1] - length_[s.i]) : length_[s.i];
  }
  void halve(Spot a, Spot b, int depth) {
    constexpr int kDeepest = 40;
    const bool whole_turn = way_.closed() && a.i == 0 && a.f == 0 && b.i == way_.size();
    const bool none_between = b.i == a.i || (b.i == a.i + 1 && b.f == 0);
    if (!whole_turn && (none_between || depth > kDeepest || way_.error(a, b, tolerance_) <= tolerance_)) {
      ++steps;
      return;
    }
    ++splits;
    const Spot m = middle(a, b);
    halve(a, m, depth + 1);
    halve(m, b, depth + 1);
  }

  const Way& way_;
  double tolerance_;
  std::vector<double> length_;
};

/// What is left at places that were dropped is said by the nearer one of those that stay.
void hand_over_excess(const Way& way, const std::vector<Spot>& spots, std::vector<Place>& points) {
  for (std::size_t k = 0; k < spots.size(); ++k) {
    const std::size_t next = (k + 1) % spots.size();
    if (next == 0 && !way.closed()) break;
    const std::size_t end = next == 0 ? spots[0].i + way.size() : spots[next].i;
    for (std::size_t i = spots[k].i + 1; i <= end; ++i) {
      const Place& dropped = way.at(i);
      if (dropped.excess_mm <= 0) continue;
      const bool nearer =
          distance(dropped.center, points[k].center) <= distance(dropped.center, points[next].center);
      double& kept = points[nearer ? k : next].excess_mm;
      kept = std::max(kept, dropped.excess_mm);
    }
  }
}

}  // namespace

SsiResult thin(const CenterPath& path, double radius, double tolerance_mm) {
  SsiResult result;
  if (path.places.size() < 2) {
    result.points = path.places;
    result.at.assign(path.places.size(), 0);
    result.halving_points = path.places.size();
    return result;
  }
  const Way way(path, radius, tolerance_mm);
  std::vector<Spot> spots;
  if (!path.closed) {
    spots = greedy(way, {0, 0}, way.size() - 1);
  } else {
    std::size_t start = 0;
    while (start < way.size() && !way.forced(start)) ++start;
    if (start == way.size()) {
      spots = closed_greedy(way);
    } else {
      spots = greedy(way, {start, 0}, start + way.size());
      spots.pop_back();
    }
  }
  for (const Spot s : spots) {
    result.points.push_back(way.place(s));
    result.at.push_back(static_cast<double>(s.i) + s.f);
  }
  for (std::size_t k = 0; k < spots.size(); ++k) {
    const bool last = k + 1 == spots.size();
    if (last && !path.closed) break;
    const Spot to = last ? Spot{spots[0].i + way.size(), spots[0].f} : spots[k + 1];
    if (to.i == spots[k].i + 1 && to.f == 0 && way.jumps(spots[k].i)) continue;
    result.error_max_mm =
        std::max(result.error_max_mm, way.error(spots[k], to, std::numeric_limits<double>::infinity()));
  }
  hand_over_excess(way, spots, result.points);
  const Halving halving(way, tolerance_mm);
  result.split = halving.splits;
  result.halving_points = halving.steps + (path.closed ? 0 : 1);
  return result;
}

}  // namespace burin::rotary
