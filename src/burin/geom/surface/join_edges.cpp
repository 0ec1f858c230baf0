// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/surface/join_edges.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "burin/geom/surface/evaluate.h"
#include "burin/geom/surface/modify.h"
#include "burin/geom/surface/rows.h"

namespace burin::geom::detail {
namespace {

constexpr int kMaxNodes = 4096;  // of one point query: a bound for curves that linger at a point
constexpr int kMinSamples = 33;  // of one comparison
constexpr int kMaxSamples = 513;
constexpr int kNewtonSteps = 40;
/// Of parameters in [0, 1]: half their rounding.
constexpr double kSameParameter = 1e-16;
/// A stretch shorter than this many tolerances is a touching point, not an edge.
constexpr double kShortest = 4;
/// Rounding of points that are evaluated twice in different ways, relative to their size.
constexpr double kRounding = 1e-10;
/// The same for parameters of knots that were found on the other curve.
constexpr double kPieceRounding = 1e-8;
/// More uneven projective maps (factors beyond a thousand) would spoil the weights.
constexpr double kLeastFraction = 1e-3;
/// A projective map replaces the plain linear one when it lowers the gap to this part.
constexpr double kBetter = 0.01;

double distance_to_box(const std::vector<HPoint>& points, Point3 p) {
  Box3 box;
  for (const HPoint& h : points) box.add(project(h));
  const double x = std::max({box.lo.x - p.x, p.x - box.hi.x, 0.0});
  const double y = std::max({box.lo.y - p.y, p.y - box.hi.y, 0.0});
  const double z = std::max({box.lo.z - p.z, p.z - box.hi.z, 0.0});
  return std::sqrt(x * x + y * y + z * z);
}

double polygon_length(const std::vector<HPoint>& points) {
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += distance(project(points[i - 1]), project(points[i]));
  return sum;
}

/// De Casteljau at the middle.
std::pair<std::vector<HPoint>, std::vector<HPoint>> halves(std::vector<HPoint> points) {
  const std::size_t n = points.size();
  std::vector<HPoint> left, right(n);
  for (std::size_t r = 0; r < n; ++r) {
    left.push_back(points.front());
    right[n - 1 - r] = points[n - 1 - r];
    for (std::size_t i = 0; i + 1 < n - r; ++i) points[i] = 0.5 * (points[i] + points[i + 1]);
  }
  return {std::move(left), std::move(right)};
}

/// Newton for the foot point, never farther than the start, inside [lo, hi].
double foot(const NurbsCurve& curve, Point3 p, double t, double lo, double hi) {
  double best = t, best_distance = distance(point(curve, t), p);
  for (int step = 0; step < kNewtonSteps; ++step) {
    const CurveDerivatives d = derivatives(curve, t);
    const Vec3 off = d.p - p;
    const double slope = dot(off, d.d1), flat = dot(d.d1, d.d1);
    if (!(flat > 0)) break;
    const double bent = flat + dot(off, d.d2);
    const double next = std::clamp(t - slope / (bent > 0.1 * flat ? bent : flat), lo, hi);
    const double there = distance(point(curve, next), p);
    if (there < best_distance) {
      best_distance = there;
      best = next;
    }
    if (std::abs(next - t) <= kSameParameter) break;
    t = next;
  }
  return best;
}

/// The foot nearest to p in [lo, hi], or nothing within the tolerance.
std::optional<double> near_in(const EdgeCurve& edge, Point3 p, double lo, double hi, double tolerance) {
  std::optional<double> best;
  double best_distance = 0;
  const double slack = tolerance / std::max(edge.length, tolerance);
  for (const double t : near_parameters(edge, p, tolerance)) {
    if (t < lo - slack || t > hi + slack) continue;
    const double d = distance(point(edge.curve, t), p);
    if (!best || d < best_distance) {
      best = std::clamp(t, lo, hi);
      best_distance = d;
    }
  }
  return best;
}

int samples_for(const EdgeCurve& a, const EdgeCurve& b) {
  const int spans = static_cast<int>(a.pieces.size() + b.pieces.size());
  return std::clamp(4 * spans * std::max(a.curve.degree, b.curve.degree) + 1, kMinSamples, kMaxSamples);
}

/// Largest distance of corresponding points, given up above `enough`.
double gap_of(const EdgeCurve& a, const EdgeCurve& b, const Match& m, double enough) {
  const int n = samples_for(a, b);
  double most = 0;
  // The middle first: most pairs that do not belong together end here.
  for (int k = 0; k < n && most <= enough; ++k) {
    const double f = double((k + n / 2) % n) / (n - 1);
    const double t = m.a0 + f * (m.a1 - m.a0);
    most = std::max(most, distance(point(a.curve, t), point(b.curve, m.b_at(t))));
  }
  return most;
}

/// Largest distance of the places, where the parameters only nearly correspond.
double place_gap(const EdgeCurve& a, const EdgeCurve& b, const Match& m) {
  const int n = samples_for(a, b);
  const double lo = std::min(m.b0, m.b1), hi = std::max(m.b0, m.b1);
  double most = 0;
  for (int k = 0; k < n; ++k) {
    const double t = m.a0 + (m.a1 - m.a0) * k / (n - 1);
    const Point3 p = point(a.curve, t);
    most = std::max(most, distance(point(b.curve, foot(b.curve, p, m.b_at(t), lo, hi)), p));
  }
  return most;
}

/// How much the quotient of the weights varies along the match, relative. b is bent by the map as the
/// surfaces will be.
double weight_variation(const EdgeCurve& a, const EdgeCurve& b, const Match& m) {
  double lo = 0, hi = 0;
  const int n = samples_for(a, b);
  for (int k = 0; k < n; ++k) {
    const double f = double(k) / (n - 1);
    const double factor = std::pow(1 + (m.alpha - 1) * f, b.curve.degree);
    const double wa = homogeneous_point(a.curve, m.a0 + f * (m.a1 - m.a0)).w;
    const double wb = factor * homogeneous_point(b.curve, m.b0 + (m.b1 - m.b0) * moebius(m.alpha, f)).w;
    const double quotient = wa / wb;
    lo = k == 0 ? quotient : std::min(lo, quotient);
    hi = k == 0 ? quotient : std::max(hi, quotient);
  }
  return (hi - lo) / lo;
}

/// One linear or projective map for the whole stretch, or nothing.
std::optional<Match> fit(const EdgeCurve& a, const EdgeCurve& b, Match m, double tolerance) {
  m.alpha = 1;
  m.gap_mm = gap_of(a, b, m, tolerance);
  const bool plain = m.gap_mm <= tolerance;
  if (!plain || m.gap_mm > kRounding * a.length) {
    const Point3 middle = point(a.curve, 0.5 * (m.a0 + m.a1));
    const auto at = near_in(b, middle, std::min(m.b0, m.b1), std::max(m.b0, m.b1), tolerance);
    if (!at && !plain) return {};
    const double f = at ? (*at - m.b0) / (m.b1 - m.b0) : 0.5;
    if (f > kLeastFraction && f < 1 - kLeastFraction) {
      Match bent = m;
      bent.alpha = f / (1 - f);
      bent.gap_mm = gap_of(a, b, bent, tolerance);
      if (bent.gap_mm <= tolerance && (!plain || bent.gap_mm < kBetter * m.gap_mm)) m = bent;
    }
  }
  if (m.gap_mm > tolerance) return {};
  if (m.gap_mm > kRounding * a.length) m.gap_mm = std::min(m.gap_mm, place_gap(a, b, m));
  m.exact = weight_variation(a, b, m) * a.length * (m.a1 - m.a0) <= tolerance;
  return m;
}

/// Parameters of a where a knot of a or of b lies, with both ends.
std::vector<double> breaks(const EdgeCurve& a, const EdgeCurve& b, const Match& m, double tolerance) {
  const double least = tolerance / std::max(a.length, tolerance);
  std::vector<double> all;
  for (const Knot& knot : inner_knots(a.curve.knots, a.curve.degree)) all.push_back(knot.value);
  for (const Knot& knot : inner_knots(b.curve.knots, b.curve.degree)) {
    if (const auto t = near_in(a, point(b.curve, knot.value), m.a0, m.a1, tolerance)) all.push_back(*t);
  }
  std::sort(all.begin(), all.end());
  std::vector<double> out{m.a0};
  for (const double t : all)
    if (t > out.back() + least && t < m.a1 - least) out.push_back(t);
  out.push_back(m.a1);
  return out;
}

/// Piecewise projective, as few pieces as possible from the left.
std::optional<std::vector<Match>> fit_pieces(const EdgeCurve& a, const EdgeCurve& b, const Match& whole,
                                             double tolerance) {
  const std::vector<double> at = breaks(a, b, whole, tolerance);
  std::vector<double> to{whole.b0};
  for (std::size_t i = 1; i + 1 < at.size(); ++i) {
    const double lo = std::min(to.back(), whole.b1), hi = std::max(to.back(), whole.b1);
    const auto t = near_in(b, point(a.curve, at[i]), lo, hi, tolerance);
    if (!t || *t == to.back() || *t == whole.b1) return {};
    to.push_back(*t);
  }
  to.push_back(whole.b1);
  std::vector<Match> pieces;
  for (std::size_t i = 0; i + 1 < at.size();) {
    std::optional<Match> best;
    std::size_t end = i;
    for (std::size_t j = i + 1; j < at.size(); ++j) {
      Match m;
      m.a0 = at[i], m.a1 = at[j], m.b0 = to[i], m.b1 = to[j];
      const auto fitted = fit(a, b, m, tolerance);
      if (!fitted || !fitted->exact) break;
      best = fitted;
      end = j;
    }
    if (!best) return {};
    pieces.push_back(*best);
    i = end;
  }
  return pieces;
}

/// Every point of the stretch of a within the tolerance of b's, and in order. The largest distance.
std::optional<double> same_places(const EdgeCurve& a, double a0, double a1, const EdgeCurve& b, double b0,
                                  double b1, double tolerance) {
  const int n = samples_for(a, b);
  double most = 0, last = b0;
  for (int k = 0; k < n; ++k) {
    const Point3 p = point(a.curve, a0 + (a1 - a0) * k / (n - 1));
    const double lo = std::min(last, b1), hi = std::max(last, b1);
    std::optional<double> t = foot(b.curve, p, last, lo, hi);
    if (distance(point(b.curve, *t), p) > tolerance) t = near_in(b, p, lo, hi, tolerance);
    if (!t) return {};
    most = std::max(most, distance(point(b.curve, *t), p));
    last = *t;
  }
  return most;
}

std::optional<Overlap> compare(const EdgeCurve& a, const EdgeCurve& b, const Match& stretch,
                               double tolerance) {
  const Point3 middle = point(a.curve, 0.5 * (stretch.a0 + stretch.a1));
  const double lo = std::min(stretch.b0, stretch.b1), hi = std::max(stretch.b0, stretch.b1);
  if (!near_in(b, middle, lo, hi, tolerance)) return {};
  const auto one = fit(a, b, stretch, tolerance);
  if (one && one->exact) return Overlap{{*one}};
  // Pieces mean cuts: only where they are the truth, not where noise fits better in parts.
  const double rounding = kPieceRounding * a.length;
  if (auto pieces = fit_pieces(a, b, stretch, std::min(tolerance, rounding)))
    return Overlap{std::move(*pieces)};
  if (one) return Overlap{{*one}};
  const auto there = same_places(a, stretch.a0, stretch.a1, b, stretch.b0, stretch.b1, tolerance);
  if (!there) return {};
  const auto back = same_places(b, stretch.b0, stretch.b1, a, stretch.a0, stretch.a1, tolerance);
  if (!back) return {};
  Match m = stretch;
  m.alpha = 1;
  m.exact = false;
  m.gap_mm = std::max(*there, *back);
  return Overlap{{m}};
}

struct Pair {
  double a = 0, b = 0;
};

/// Where an end of one curve lies on the other. Ascending in a.
std::vector<Pair> end_pairs(const EdgeCurve& a, const EdgeCurve& b, double tolerance) {
  std::vector<Pair> pairs;
  for (const double end : {0.0, 1.0}) {
    for (const double t : near_parameters(b, point(a.curve, end), tolerance)) pairs.push_back({end, t});
    for (const double t : near_parameters(a, point(b.curve, end), tolerance)) pairs.push_back({t, end});
  }
  // The same place found from both curves: ends are ends exactly.
  const double near_a = kShortest * tolerance / std::max(a.length, tolerance);
  const double near_b = kShortest * tolerance / std::max(b.length, tolerance);
  const auto to_end = [](double t, double near) { return t < near ? 0.0 : t > 1 - near ? 1.0 : t; };
  for (Pair& pair : pairs) pair = {to_end(pair.a, near_a), to_end(pair.b, near_b)};
  std::sort(pairs.begin(), pairs.end(), [](Pair x, Pair y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  const auto same = [](Pair x, Pair y) { return x.a == y.a && x.b == y.b; };
  pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
  return pairs;
}

}  // namespace

double Overlap::gap_mm() const {
  double most = 0;
  for (const Match& m : pieces) most = std::max(most, m.gap_mm);
  return most;
}

EdgeCurve edge_curve(const NurbsCurve& curve) {
  EdgeCurve edge;
  edge.curve = with_domain(curve, {0, 1});
  edge.box = bounds(edge.curve);
  Rows rows = rows_of(edge.curve);
  std::vector<double> values;
  for (const Knot& knot : inner_knots(rows.knots, rows.degree))
    values.insert(values.end(), static_cast<std::size_t>(rows.degree), knot.value);
  insert(rows, values);
  const int p = rows.degree;
  for (int first = 0; first + p < rows.count(); first += p) {
    const double lo = rows.knots[static_cast<std::size_t>(first + p)];
    const double hi = rows.knots[static_cast<std::size_t>(first + p + 1)];
    NurbsCurve piece{p,
                     std::vector<double>(static_cast<std::size_t>(p + 1), lo),
                     {rows.row(first), rows.row(first + p + 1)}};
    piece.knots.insert(piece.knots.end(), static_cast<std::size_t>(p + 1), hi);
    edge.length += polygon_length(piece.points);
    edge.pieces.push_back(std::move(piece));
  }
  return edge;
}

std::vector<double> near_parameters(const EdgeCurve& edge, Point3 p, double tolerance_mm) {
  struct Node {
    std::vector<HPoint> points;
    double lo, hi;
  };
  std::vector<double> found;
  const double same = kShortest * tolerance_mm / std::max(edge.length, tolerance_mm);
  const auto keep = [&](double t) {
    const double d = distance(point(edge.curve, t), p);
    if (d > tolerance_mm) return;
    for (double& other : found) {
      if (std::abs(other - t) > same) continue;
      if (d < distance(point(edge.curve, other), p)) other = t;
      return;
    }
    found.push_back(t);
  };
  int visited = 0;
  std::vector<Node> stack;
  for (const NurbsCurve& piece : edge.pieces) {
    stack.push_back({piece.points, piece.knots.front(), piece.knots.back()});
    while (!stack.empty() && ++visited <= kMaxNodes) {
      const Node node = std::move(stack.back());
      stack.pop_back();
      if (distance_to_box(node.points, p) > tolerance_mm) continue;
      const double middle = 0.5 * (node.lo + node.hi);
      if (polygon_length(node.points) <= kShortest * tolerance_mm ||
          !(middle > node.lo && middle < node.hi)) {
        keep(foot(edge.curve, p, middle, 0, 1));
        continue;
      }
      auto [left, right] = halves(node.points);
      stack.push_back({std::move(right), middle, node.hi});
      stack.push_back({std::move(left), node.lo, middle});
    }
    stack.clear();
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Overlap> overlaps(const EdgeCurve& a, const EdgeCurve& b, double tolerance_mm) {
  std::vector<Overlap> out;
  if (!a.box.grown(tolerance_mm).overlaps(b.box)) return out;
  const std::vector<Pair> pairs = end_pairs(a, b, tolerance_mm);
  // From every pair to those with the next greater a: a stretch has no end of either curve inside.
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    std::optional<double> next;
    for (std::size_t j = i + 1; j < pairs.size(); ++j) {
      if (!(pairs[j].a > pairs[i].a)) continue;
      if ((pairs[j].a - pairs[i].a) * a.length < kShortest * tolerance_mm) continue;
      if (next && pairs[j].a > *next) break;
      if (std::abs(pairs[j].b - pairs[i].b) * b.length < kShortest * tolerance_mm) continue;
      Match stretch;
      stretch.a0 = pairs[i].a, stretch.a1 = pairs[j].a, stretch.b0 = pairs[i].b, stretch.b1 = pairs[j].b;
      next = pairs[j].a;
      if (auto overlap = compare(a, b, stretch, tolerance_mm)) out.push_back(std::move(*overlap));
    }
  }
  return out;
}

}  // namespace burin::geom::detail
