// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/profile.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace burin::servo {
namespace {

struct Span {
  double begin, end, value;
};
/// A step function over [0, total]: value from `begin` to the next one's begin.
struct Step {
  double begin, value;
};

/// Smallest value of the spans over every place; they must cover [0, total].
std::vector<Step> lower_envelope(std::vector<Span>& spans, double total) {
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.begin < b.begin; });
  const auto higher = [](const Span& a, const Span& b) { return a.value > b.value; };
  std::priority_queue<Span, std::vector<Span>, decltype(higher)> open(higher);
  std::vector<Step> steps;
  std::size_t next = 0;
  double at = 0;
  while (at < total) {
    for (; next < spans.size() && spans[next].begin <= at; ++next) {
      const Span& span = spans[next];  // those that end before a lower one never show
      if (open.empty() || span.value < open.top().value || span.end > open.top().end) open.push(span);
    }
    while (!open.empty() && open.top().end <= at) open.pop();
    double until = next < spans.size() ? std::min(spans[next].begin, total) : total;
    if (!open.empty()) {
      if (steps.empty() || steps.back().value != open.top().value) steps.push_back({at, open.top().value});
      until = std::min(until, open.top().end);
    }
    at = until;
  }
  return steps;
}

/// A stretch of constant limits, u = v^2.
struct Level {
  double begin, end, u, a;
};

/// Both limits of every place widened by half of what is travelled in tau at that limit. Then, when the mean
/// motion is at a place, the whole window lies where the raw motion keeps that place's limits
/// (docs/servo.md).
std::vector<Level> widened(const std::vector<LimitSpan>& limits, double total, double tau) {
  std::vector<Span> speeds, accels;
  speeds.reserve(limits.size());
  accels.reserve(limits.size());
  for (const LimitSpan& l : limits) {
    const double by = 0.5 * tau * l.v;
    speeds.push_back({l.begin - by, l.end + by, l.v});
    accels.push_back({l.begin - by, l.end + by, l.a});
  }
  const std::vector<Step> v = lower_envelope(speeds, total), a = lower_envelope(accels, total);
  std::vector<Level> levels;
  levels.reserve(v.size() + a.size());
  double at = 0;
  for (std::size_t i = 0, k = 0; i < v.size() && k < a.size() && at < total;) {
    const double vi = i + 1 < v.size() ? v[i + 1].begin : total,
                 ak = k + 1 < a.size() ? a[k + 1].begin : total;
    const double end = std::min({vi, ak, total});
    if (end > at) levels.push_back({at, end, v[i].value * v[i].value, a[k].value});
    at = end;
    if (vi <= end) ++i;
    if (ak <= end) ++k;
  }
  return levels;
}

/// Knot of the phase plane: between knots u = v^2 is linear in s (constant acceleration).
struct Knot {
  double s, u;
};

/// Highest u(s) from rest to rest with |du/ds| <= 2 a below the levels.
std::vector<Knot> phase_plane(const std::vector<Level>& levels) {
  const std::size_t n = levels.size();
  std::vector<double> u(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) {  // forward: reachable
    const double gain = 2 * levels[i].a * (levels[i].end - levels[i].begin);
    u[i + 1] = i + 1 == n ? 0 : std::min({u[i] + gain, levels[i].u, levels[i + 1].u});
  }
  for (std::size_t i = n; i-- > 0;)  // backward: can slow down in time
    u[i] = std::min(u[i], u[i + 1] + 2 * levels[i].a * (levels[i].end - levels[i].begin));
  std::vector<Knot> knots;
  knots.reserve(n + 1);
  knots.push_back({0, 0});
  for (std::size_t i = 0; i < n; ++i) {
    const Level& l = levels[i];
    const double slope = 2 * l.a, rise = (l.end - l.begin) * slope;
    // Inside a level: up, along, down again.
    const double top = std::min(l.u, 0.5 * (u[i] + u[i + 1] + rise));
    const double up = l.begin + (top - u[i]) / slope, down = l.end - (top - u[i + 1]) / slope;
    if (top > u[i] && top > u[i + 1]) {
      knots.push_back({std::clamp(up, l.begin, l.end), top});
      if (down > up) knots.push_back({std::clamp(down, l.begin, l.end), top});
    } else if (top > u[i] && up < l.end) {
      knots.push_back({std::max(up, l.begin), top});
    } else if (top > u[i + 1] && down > l.begin) {
      knots.push_back({std::min(down, l.end), top});
    }
    knots.push_back({l.end, u[i + 1]});
  }
  return knots;
}

/// Lowers tops until each is held for tau seconds: between speeding up and slowing down the mean's jerk would
/// otherwise be twice what each alone gives.
class Chopper {
 public:
  Chopper(double tau, std::size_t n) : tau_(tau) { out_.reserve(n + n / 4 + 4); }

  void add(const Knot& k) {
    if (!out_.empty() && k.u < out_.back().u) descend(k);
    out_.push_back(k);
  }
  std::vector<Knot> take() { return std::move(out_); }

 private:
  /// The plateau at the end of out_ ends in a fall to k: if it is a top, cuts it.
  void descend(const Knot& k) {
    const Knot right = out_.back();
    const double fall = (k.s - right.s) / (right.u - k.u);  // ds per unit of u lost
    for (;;) {
      std::size_t first = out_.size() - 1;  // where the plateau begins
      while (first > 0 && out_[first - 1].u == out_[first].u) --first;
      const Knot left = out_[first];
      const double level = left.u, end = right.s + fall * (right.u - level);
      const bool top = first > 0 && out_[first - 1].u < level;
      if (!top || end - left.s >= tau_ * std::sqrt(level)) return close(left, end);
      // Lower: at most down to the knot before or to k.
      const Knot before = out_[first - 1];
      const double floor = std::max(before.u, k.u);
      const double rise = (left.s - before.s) / (level - before.u);
      const double found = level_between(left.s, end, rise + fall, level, floor);
      out_.resize(first);
      if (found > floor) return close({left.s - rise * (level - found), found}, end + fall * (level - found));
      if (floor > before.u) {  // k's level: the plateau may go on after k
        out_.push_back({left.s - rise * (level - floor), floor});
        return;
      }
    }
  }

  /// The plateau from `left` to `end` is final.
  void close(const Knot& left, double end) {
    while (!out_.empty() && out_.back().s >= left.s) out_.pop_back();
    out_.push_back(left);
    if (end > left.s) out_.push_back({end, left.u});
  }

  /// Level in (floor, level] at which the plateau takes tau seconds; floor when there is none. `widening`: of
  /// the plateau per unit of u lost.
  double level_between(double begin, double end, double widening, double level, double floor) const {
    // w - k v^2 = tau v, w: width at u = 0.
    const double w = end - begin + widening * level;
    const double v = 2 * w / (tau_ + std::sqrt(tau_ * tau_ + 4 * widening * w));
    return v * v > floor ? std::min(v * v, level) : floor;
  }

  double tau_;
  std::vector<Knot> out_;
};

}  // namespace

std::vector<RawKnot> raw_profile(const std::vector<LimitSpan>& spans, double total, double tau) {
  const std::vector<Level> levels = widened(spans, total, tau);
  if (levels.empty()) return {};
  const std::vector<Knot> plane = phase_plane(levels);
  Chopper chopper(tau, plane.size());
  for (const Knot& k : plane) chopper.add(k);
  const std::vector<Knot> knots = chopper.take();
  std::vector<RawKnot> raw;
  raw.reserve(knots.size());
  double t = 0;
  for (const Knot& k : knots) {
    const double v = std::sqrt(std::max(k.u, 0.0));
    if (!raw.empty()) {
      const double ds = k.s - raw.back().s, sum = v + raw.back().v;
      if (!(ds > 0) || !(sum > 0)) continue;
      t += 2 * ds / sum;
    }
    raw.push_back({t, k.s, v});
  }
  return raw;
}

std::vector<ProfilePiece> smooth_profile(const std::vector<RawKnot>& raw, double total, double tau) {
  std::vector<ProfilePiece> out;
  if (raw.size() < 2) return {{0, total, 0, 0, 0}};
  const std::size_t n = raw.size();
  out.reserve(2 * n + 1);
  const auto slope = [&raw, n](std::size_t next) {  // acceleration before knot `next`
    if (next == 0 || next >= n) return 0.0;
    return (raw[next].v - raw[next - 1].v) / (raw[next].t - raw[next - 1].t);
  };
  const double end_time = raw.back().t + tau;
  const double apart = 1e-12 * (end_time + 1);  // breaks closer than the rounding of time are one
  std::size_t lead = 1, lag = 0;                // next knots of the window's two ends
  ProfilePiece p;
  while (p.time < end_time - apart) {
    while (lead < n && raw[lead].t <= p.time + apart) ++lead;
    while (lag < n && raw[lag].t + tau <= p.time + apart) ++lag;
    const double a1 = slope(lead), a0 = slope(lag);
    const double next = std::min(lead < n ? raw[lead].t : end_time, lag < n ? raw[lag].t + tau : end_time);
    p.j = (a1 - a0) / tau;
    if (lead == lag && a1 == 0 && lead < n) {  // the whole window in one steady part: no rounding gathers
      p.a = 0;
      p.v = raw[lead].v;
    }
    out.push_back(p);
    const double d = next - p.time;
    p.s += d * (p.v + d * (p.a / 2 + d * p.j / 6));
    p.v += d * (p.a + d * p.j / 2);
    p.a += d * p.j;
    p.time = next;
  }
  // What rounding left of the way is spread over all of it.
  const double scale = p.s > 0 ? total / p.s : 1;
  for (ProfilePiece& q : out) {
    q.s *= scale;
    q.v *= scale;
    q.a *= scale;
    q.j *= scale;
  }
  out.push_back({end_time, total, 0, 0, 0});
  return out;
}

}  // namespace burin::servo
