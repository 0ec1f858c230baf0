// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/swept_distance.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace burin::rotary {
namespace {

using geom::Point2;
using geom::Point3;

// Below 2^-40 of a stretch nothing is gained.
constexpr int kMaxDepth = 40;

Point2 turned_back(Point3 c, double turn) {
  const double k = std::cos(turn), s = std::sin(turn);
  return {c.y * k + c.z * s, c.z * k - c.y * s};
}

}  // namespace

SweptDistance::SweptDistance(const SweptSection& swept, double accuracy_mm)
    : swept_(swept), accuracy_(accuracy_mm) {
  pieces_.reserve(swept.section.segments.size());
  for (const geom::Segment& s : swept.section.segments) {
    const geom::Box2 box = bounds_of(s);
    const Point2 middle = lerp(box.lo, box.hi, 0.5);
    const double r = 0.5 * std::hypot(box.width(), box.height());
    pieces_.push_back({middle, r});
    radius_ = std::max(radius_, std::hypot(middle.x, middle.y) + r);
  }
}

/// One centre: the pieces of the section that matter, and the least that was found.
struct SweptDistance::Query {
  const SweptDistance& of;
  Point3 c;
  double best2;  ///< upper bound of the least F
  std::vector<std::uint32_t> near;

  double f(double x, double turn) const {
    const Point2 p = turned_back(c, turn);
    double best = 2 * std::sqrt(best2);
    for (const std::uint32_t i : near) {
      const Piece& piece = of.pieces_[i];
      if (distance(p, piece.center) - piece.radius >= best) continue;
      best = std::min(best, nearest_on(of.swept_.section.segments[i], p).distance);
    }
    return (x - c.x) * (x - c.x) + best * best;
  }

  /// What is enough: nothing below this is looked for.
  double floor2() const {
    const double low = std::max(0.0, std::sqrt(best2) - of.accuracy_);
    return low * low;
  }

  /// Over a stretch of one twist; fa and fb at its ends.
  void search(const Station& a, double fa, const Station& b, double fb, double rate, int level) {
    const double h = b.x - a.x;
    const double bend = (2 + 2 * rate * rate * std::hypot(c.y, c.z) * of.radius_) * h * h / 2;
    double low = std::min(fa, fb);
    if (bend > 0) {
      const double s = std::clamp(0.5 - (fb - fa) / (2 * bend), 0.0, 1.0);
      low = std::min(low, (1 - s) * fa + s * fb - s * (1 - s) * bend);
    }
    if (low >= floor2()) return;
    if (level == kMaxDepth) {
      best2 = std::min(best2, std::max(0.0, low));
      return;
    }
    const Station m{0.5 * (a.x + b.x), 0.5 * (a.turn + b.turn)};
    const double fm = f(m.x, m.turn);
    best2 = std::min(best2, fm);
    // The half with the lower end first: what it finds cuts off the other.
    if (fa < fb) {
      search(a, fa, m, fm, rate, level + 1);
      search(m, fm, b, fb, rate, level + 1);
    } else {
      search(m, fm, b, fb, rate, level + 1);
      search(a, fa, m, fm, rate, level + 1);
    }
  }
};

double SweptDistance::least(Point3 c, double high, double guess) const {
  const std::vector<Station>& stations = swept_.stations;
  const double from = std::max(stations.front().x, c.x - high), to = std::min(stations.back().x, c.x + high);
  Query query{*this, c, high * high, {}};
  if (from <= to) {
    double least_turn = swept_.turn_at(from), most_turn = least_turn;
    const auto note = [&](double turn) {
      least_turn = std::min(least_turn, turn);
      most_turn = std::max(most_turn, turn);
    };
    std::vector<Station> stops{{from, least_turn}};
    for (const Station& s : stations)
      if (s.x > from && s.x < to) stops.push_back(s);
    if (to > from) stops.push_back({to, swept_.turn_at(to)});
    if (guess > from && guess < to) {
      const auto at =
          std::find_if(stops.begin(), stops.end(), [&](const Station& s) { return s.x >= guess; });
      if (at->x > guess) stops.insert(at, {guess, swept_.turn_at(guess)});
    }
    for (const Station& s : stops) note(s.turn);
    // Seen from the section the centre goes along an arc; from its middle it is never farther than this.
    const double move = 0.5 * (most_turn - least_turn) * std::hypot(c.y, c.z);
    const Point2 middle = turned_back(c, 0.5 * (least_turn + most_turn));
    for (std::uint32_t i = 0; i < pieces_.size(); ++i)
      if (distance(middle, pieces_[i].center) - pieces_[i].radius - move <= high) query.near.push_back(i);
    std::vector<double> f(stops.size());
    for (std::size_t i = 0; i < stops.size(); ++i) {
      f[i] = query.f(stops[i].x, stops[i].turn);
      query.best2 = std::min(query.best2, f[i]);
    }
    for (std::size_t i = 1; i < stops.size(); ++i) {
      const double rate = (stops[i].turn - stops[i - 1].turn) / (stops[i].x - stops[i - 1].x);
      query.search(stops[i - 1], f[i - 1], stops[i], f[i], rate, 0);
    }
  }
  // Beside an end its face may be nearer than its rim.
  const Station* end = c.x < stations.front().x  ? &stations.front()
                       : c.x > stations.back().x ? &stations.back()
                                                 : nullptr;
  if (end != nullptr && winding_number(swept_.section, turned_back(c, end->turn)) != 0)
    query.best2 = std::min(query.best2, (c.x - end->x) * (c.x - end->x));
  return std::sqrt(query.floor2());
}

}  // namespace burin::rotary
