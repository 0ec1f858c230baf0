// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/rotary/sweep.h"

#include <algorithm>
#include <cmath>

namespace burin::rotary {

using geom::Point2;
using geom::Point3;
using geom::Vec2;
using geom::Vec3;

bool SweptSection::uniform() const {
  if (stations.size() < 2) return true;
  // Rates that differ by rounding only (stations written with a few decimals) are one.
  constexpr double kSameRate = 1e-9;
  const double rate =
      (stations.back().turn - stations.front().turn) / (stations.back().x - stations.front().x);
  for (std::size_t i = 1; i < stations.size(); ++i) {
    const double own = (stations[i].turn - stations[i - 1].turn) / (stations[i].x - stations[i - 1].x);
    if (std::abs(own - rate) > kSameRate * (1 + std::abs(rate))) return false;
  }
  return true;
}

double SweptSection::turn_at(double x) const {
  if (stations.empty()) return 0;
  if (x <= stations.front().x) return stations.front().turn;
  if (x >= stations.back().x) return stations.back().turn;
  const auto after = std::upper_bound(stations.begin(), stations.end(), x,
                                      [](double value, const Station& s) { return value < s.x; });
  const Station &a = *(after - 1), &b = *after;
  return a.turn + (b.turn - a.turn) * ((x - a.x) / (b.x - a.x));
}

namespace detail {
namespace {

/// Normals closer than this are one (radians): far below what moves a ball of 100 mm by a nanometre.
constexpr double kSameNormal = 1e-10;

/// Steps of a turn about an edge: half a turn of a ball of 1 m within a nanometre takes fewer.
constexpr double kMostTurns = 100000;

/// From a to b, positive to the left.
double angle_of(Vec2 a, Vec2 b) {
  return std::atan2(cross(a, b), dot(a, b));
}

Vec2 rotated(Vec2 v, double cosine, double sine) {
  return {v.x * cosine - v.y * sine, v.x * sine + v.y * cosine};
}

/// Steps for a piece whose centre path bends: from second differences, then tried at the middles.
std::size_t steps_on(const Sweep& sweep, std::size_t piece, double radius, double density, double rate) {
  constexpr int kProbe = 12;
  const auto center = [&](double f) { return center_of(sweep.lift(sweep.at(piece, f), 0, 0, rate), radius); };
  double bend = 0;  // |d2 C / df2|
  Point3 a = center(0), b = center(1.0 / kProbe);
  for (int i = 2; i <= kProbe; ++i) {
    const Point3 c = center(double(i) / kProbe);
    bend = std::max(bend, norm((c - b) - (b - a)) * kProbe * kProbe);
    a = b;
    b = c;
  }
  constexpr std::size_t kMost = 1u << 20;  // a piece of a section; more cannot be meant
  const double wanted = std::ceil(std::sqrt(bend / (8 * density)));
  std::size_t n = wanted < double(kMost) ? std::max<std::size_t>(1, std::size_t(wanted)) : kMost;
  for (; n < kMost; n *= 2) {
    double worst = 0;
    const std::size_t stride = std::max<std::size_t>(1, n / 64);
    for (std::size_t i = 0; i < n; i += stride) {
      const Point3 from = center(double(i) / double(n)), to = center(double(i + 1) / double(n));
      worst = std::max(worst, distance(center((double(i) + 0.5) / double(n)), lerp(from, to, 0.5)));
    }
    if (worst <= density) break;
  }
  return n;
}

std::size_t steps_of(const Sweep& sweep, std::size_t piece, double radius, double density, double longest) {
  std::size_t n = steps_on(sweep, piece, radius, density, 0);
  if (!sweep.rates().empty()) {
    n = std::max(n, steps_on(sweep, piece, radius, density, sweep.rates().front()));
    n = std::max(n, steps_on(sweep, piece, radius, density, sweep.rates().back()));
  }
  const double by_length = std::ceil(sweep.piece_length(piece) / longest);
  return by_length < 1e9 ? std::max(n, std::size_t(by_length)) : std::size_t(1e9);
}

/// From the end of one piece to the start of the next: 0 where the normal stays, 1 at a concave corner (one
/// normal, then the other), else the steps in which the ball turns about the edge.
std::size_t fan_steps(const Sweep& sweep, const SectionPoint& a, const SectionPoint& b, double radius,
                      double density) {
  double angle = angle_of(a.t, b.t);
  if (std::abs(angle) < kSameNormal) return 0;
  if (angle < 0) return 1;
  for (const double rate : sweep.rates()) {
    angle = std::max(angle, angle_between(sweep.lift(a, 0, 0, rate).n, sweep.lift(b, 0, 0, rate).n));
  }
  // Sagitta of the centre's arc: R step^2 / 8.
  const double steps = std::ceil(angle / std::sqrt(8 * density / radius));
  return steps < kMostTurns ? std::max<std::size_t>(1, std::size_t(steps)) : std::size_t(kMostTurns);
}

}  // namespace

Sweep::Sweep(const SweptSection& swept) : swept_(&swept) {
  starts_.push_back(0);
  for (const geom::Segment& s : swept.section.segments) starts_.push_back(starts_.back() + length_of(s));
  for (std::size_t i = 1; i < swept.stations.size(); ++i) {
    const Station &a = swept.stations[i - 1], &b = swept.stations[i];
    rates_.push_back((b.turn - a.turn) / (b.x - a.x));
  }
  std::sort(rates_.begin(), rates_.end());
  rates_.erase(std::unique(rates_.begin(), rates_.end()), rates_.end());
}

SectionPoint Sweep::at(std::size_t piece, double f) const {
  const geom::Segment& seg = swept_->section.segments[piece];
  SectionPoint p;
  p.c = point_on(seg, f);
  p.s = f >= 1 ? starts_[piece + 1] : starts_[piece] + f * piece_length(piece);
  if (seg.is_line()) {
    p.t = unit(seg.b - seg.a);
  } else {
    const Vec2 r = unit(p.c - seg.center);
    p.t = seg.radius > 0 ? left(r) : right(r);
    p.curvature = 1 / seg.radius;
  }
  return p;
}

SectionPoint Sweep::at_length(double s, bool after) const {
  s = std::clamp(s, 0.0, length());
  auto it = after ? std::upper_bound(starts_.begin(), starts_.end(), s)
                  : std::lower_bound(starts_.begin(), starts_.end(), s);
  std::size_t piece = it == starts_.begin() ? 0 : std::size_t(it - starts_.begin()) - 1;
  piece = std::min(piece, pieces() - 1);
  const double l = piece_length(piece);
  return at(piece, l > 0 ? std::clamp((s - starts_[piece]) / l, 0.0, 1.0) : 0.0);
}

double Sweep::rate(double x, bool after) const {
  const std::vector<Station>& st = swept_->stations;
  std::size_t i = 1;
  while (i + 1 < st.size() && (after ? st[i].x <= x : st[i].x < x)) ++i;
  return (st[i].turn - st[i - 1].turn) / (st[i].x - st[i - 1].x);
}

Contact Sweep::lift(const SectionPoint& p, double x, double rate) const {
  return lift(p, x, swept_->turn_at(x), rate);
}

Contact Sweep::lift(const SectionPoint& p, double x, double turn, double rate) const {
  const double cosine = std::cos(turn), sine = std::sin(turn);
  const Vec2 place = rotated({p.c.x, p.c.y}, cosine, sine);
  const Vec2 outwards = rotated(right(p.t), cosine, sine);
  Contact contact;
  contact.p = {x, place.x, place.y};
  contact.n = unit(Vec3{rate * dot(p.t, Vec2{p.c.x, p.c.y}), outwards.x, outwards.y});
  contact.u = length() > 0 ? p.s / length() : 0;
  contact.w = x_max() > x_min() ? (x - x_min()) / (x_max() - x_min()) : 0;
  return contact;
}

Contact lift(const Sweep& sweep, const RingNode& node, double x, double turn, double rate) {
  Contact c = sweep.lift(node.a, x, turn, rate);
  if (node.f > 0) c.n = turned(c.n, sweep.lift(node.b, x, turn, rate).n, node.f);
  return c;
}

std::size_t count_ring_nodes(const Sweep& sweep, double ball_radius, double density, double longest,
                             std::size_t limit) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < sweep.pieces() && count <= limit; ++i) {
    const SectionPoint a = sweep.at(i, 1), b = sweep.at((i + 1) % sweep.pieces(), 0);
    count += steps_of(sweep, i, ball_radius, density, longest) + fan_steps(sweep, a, b, ball_radius, density);
  }
  return count;
}

std::vector<RingNode> ring_nodes(const Sweep& sweep, double ball_radius, double density, double longest) {
  std::vector<RingNode> nodes;
  for (std::size_t i = 0; i < sweep.pieces(); ++i) {
    const std::size_t n = steps_of(sweep, i, ball_radius, density, longest);
    for (std::size_t k = 0; k < n; ++k) nodes.push_back({sweep.at(i, double(k) / double(n)), {}, 0});
    const SectionPoint a = sweep.at(i, 1), b = sweep.at((i + 1) % sweep.pieces(), 0);
    const std::size_t fan = fan_steps(sweep, a, b, ball_radius, density);
    if (fan == 0) continue;  // smooth: the next piece brings the point
    nodes.push_back({a, {}, 0});
    for (std::size_t k = 1; k < fan; ++k) nodes.push_back({a, b, double(k) / double(fan)});
  }
  return nodes;
}

Vec3 turned(Vec3 a, Vec3 b, double f) {
  const double angle = angle_between(a, b);
  const double s = std::sin(angle);
  if (s < 1e-9) return unit(a + f * (b - a));  // the circle is not distinguishable from its chord
  return unit((std::sin((1 - f) * angle) / s) * a + (std::sin(f * angle) / s) * b);
}

void append_fan(std::vector<Contact>& points, const Contact& to, double ball_radius, double density) {
  if (points.empty()) {
    points.push_back(to);
    return;
  }
  const Contact from = points.back();
  const double angle = angle_between(from.n, to.n);
  if (angle < kSameNormal) return;
  // Sagitta of the centre's arc: R step^2 / 8.
  const double step = std::sqrt(8 * density / ball_radius);
  const double wanted = std::ceil(angle / step);
  const int n = wanted < kMostTurns ? std::max(1, int(wanted)) : int(kMostTurns);
  for (int k = 1; k < n; ++k) {
    Contact c = to;
    c.n = turned(from.n, to.n, double(k) / n);
    points.push_back(c);
  }
  points.push_back(to);
}

}  // namespace detail
}  // namespace burin::rotary
