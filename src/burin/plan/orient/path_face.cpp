// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/path_face.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/geom/point_tools.h"

namespace burin::orient::detail {
namespace {

using geom::Direction;
using geom::SurfaceDerivatives;

/// Where partial derivatives degenerate, curvatures and directions are taken this far inside, in widths of
/// the domain.
constexpr double kPulls[] = {1e-5, 1e-3, 1e-2};
/// A partial derivative this small against the face's size has no direction worth using; the sine of the
/// angle between the two likewise.
constexpr double kNoDirection = 1e-7;
/// Border samples of an untrimmed edge, and per side of a trim.
constexpr int kEdgeSamples = 256, kTrimSamples = 4;
/// Two edges that agree this well, relative to the size, are one seam.
constexpr double kSame = 1e-9;

}  // namespace

PathFace::PathFace(const DesignFace& face, double edge_mm)
    : surface_(face.surface),
      u_(surface_.domain(Direction::u)),
      v_(surface_.domain(Direction::v)),
      evaluator_(surface_),
      sign_(face.reversed ? -1 : 1),
      edge_(edge_mm),
      size_(geom::bounds(surface_).diagonal()) {
  for (const auto& loop : face.trims) {
    if (loop.size() >= 3) trims_.push_back(loop);
  }
  const geom::Box2 domain{{u_.lo, v_.lo}, {u_.hi, v_.hi}};
  if (trims_.empty()) window_ = domain;
  for (const auto& loop : trims_) {
    for (const Point2 p : loop) {
      window_.add(Point2{std::clamp(p.x, u_.lo, u_.hi), std::clamp(p.y, v_.lo, v_.hi)});
    }
  }
  const auto seam = [&](bool in_u) {
    constexpr int kPlaces = 8;
    for (int i = 0; i <= kPlaces; ++i) {
      const double x = static_cast<double>(i) / kPlaces;
      const double a = v_.lo + x * v_.length(), b = u_.lo + x * u_.length();
      const Point3 p = in_u ? evaluator_.point(u_.lo, a) : evaluator_.point(b, v_.lo);
      const Point3 q = in_u ? evaluator_.point(u_.hi, a) : evaluator_.point(b, v_.hi);
      if (distance(p, q) > kSame * size_) return false;
    }
    return true;
  };
  closed_u_ = seam(true);
  closed_v_ = seam(false);
  if (edge_ > 0) find_border();
}

void PathFace::find_border() {
  const auto line = [&](Point2 a, Point2 b, int samples) {
    Point3 last = evaluator_.point(a.x, a.y);
    for (int i = 1; i <= samples; ++i) {
      const Point2 p = lerp(a, b, static_cast<double>(i) / samples);
      const Point3 next = evaluator_.point(p.x, p.y);
      // A collapsed edge is a place within the surface, no border.
      if (distance(last, next) > kSame * size_) border_.emplace_back(last, next);
      last = next;
    }
  };
  if (trims_.empty()) {
    if (!closed_v_) {
      line({u_.lo, v_.lo}, {u_.hi, v_.lo}, kEdgeSamples);
      line({u_.lo, v_.hi}, {u_.hi, v_.hi}, kEdgeSamples);
    }
    if (!closed_u_) {
      line({u_.lo, v_.lo}, {u_.lo, v_.hi}, kEdgeSamples);
      line({u_.hi, v_.lo}, {u_.hi, v_.hi}, kEdgeSamples);
    }
  }
  for (const auto& loop : trims_) {
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      line(loop[j], loop[i], kTrimSamples);
    }
  }
}

bool PathFace::inside(Point2 uv) const {
  if (trims_.empty()) return true;
  bool in = false;
  for (const auto& loop : trims_) in ^= geom::inside_polygon(loop, uv);
  return in;
}

bool PathFace::kept(geom::SurfaceEvaluator& evaluator, Point2 uv) const {
  if (!inside(uv)) return false;
  if (!(edge_ > 0)) return true;
  const Point3 p = evaluator.point(uv.x, uv.y);
  // Rounding: the path at the distance itself is kept.
  const double least = edge_ - 1e-9 * size_;
  return std::none_of(border_.begin(), border_.end(),
                      [&](const auto& s) { return geom::distance_to_segment(p, s.first, s.second) < least; });
}

Point2 PathFace::pulled_inside(Point2 uv, double share) const {
  const double mu = 0.5 * (u_.lo + u_.hi), mv = 0.5 * (v_.lo + v_.hi);
  return {uv.x + share * u_.length() * (uv.x <= mu ? 1.0 : -1.0),
          uv.y + share * v_.length() * (uv.y <= mv ? 1.0 : -1.0)};
}

Point2 PathFace::wrapped(Point2 uv) const {
  const auto round = [](double x, geom::Interval d, bool closed) {
    if (!closed || (x >= d.lo && x <= d.hi)) return std::clamp(x, d.lo, d.hi);
    return d.lo + (x - d.lo) - std::floor((x - d.lo) / d.length()) * d.length();
  };
  return {round(uv.x, u_, closed_u_), round(uv.y, v_, closed_v_)};
}

Vec2 PathFace::coefficients(const SurfaceDerivatives& d, Vec3 tangent) {
  const double e = dot(d.du, d.du), f = dot(d.du, d.dv), g = dot(d.dv, d.dv);
  const double a = dot(tangent, d.du), b = dot(tangent, d.dv), det = e * g - f * f;
  if (!(det > 0)) return {};
  return {(a * g - b * f) / det, (b * e - a * f) / det};
}

Vec3 PathFace::normal(const SurfaceDerivatives& d, Point2 uv) const {
  const Vec3 n = geom::normal(d);
  return sign_ * (n == Vec3{} ? geom::normal(surface_, uv.x, uv.y) : n);
}

std::optional<CcPoint> PathFace::contact(geom::SurfaceEvaluator& evaluator, Point2 uv, Vec2 way) const {
  SurfaceDerivatives d = evaluator.derivatives(uv.x, uv.y);
  CcPoint at;
  at.c = d.p;
  at.n = normal(d, uv);
  if (at.n == Vec3{} || !geom::is_finite(at.n) || !geom::is_finite(at.c)) return std::nullopt;
  const double su = u_.length(), sv = v_.length();
  const auto regular = [&] {
    const Vec3 a = su * d.du, b = sv * d.dv;
    return norm(a) > kNoDirection * size_ && norm(b) > kNoDirection * size_ &&
           norm(cross(unit(a), unit(b))) > kNoDirection;
  };
  for (const double pull : kPulls) {
    if (regular()) break;
    const Point2 p = pulled_inside(uv, pull);
    d = evaluator.derivatives(p.x, p.y);
  }
  const Vec3 along = way.x * d.du + way.y * d.dv;
  at.f = unit(along - dot(along, at.n) * at.n);
  if (at.f == Vec3{} || !geom::is_finite(at.f)) return std::nullopt;
  if (!regular()) return at;
  const Vec3 n = sign_ * geom::normal(d);
  const double l = dot(d.duu, n), m = dot(d.duv, n), k = dot(d.dvv, n);
  const Vec2 f = coefficients(d, at.f), t = coefficients(d, at.t());
  const auto form = [&](Vec2 a, Vec2 b) {
    return l * a.x * b.x + m * (a.x * b.y + a.y * b.x) + k * a.y * b.y;
  };
  at.k_ff = form(f, f), at.k_ft = form(f, t), at.k_tt = form(t, t);
  if (!std::isfinite(at.k_ff + at.k_ft + at.k_tt)) at.k_ff = at.k_ft = at.k_tt = 0;
  return at;
}

std::vector<double> span_places(const std::vector<double>& knots, geom::Interval part, int per_span) {
  // More knots than this share places: it is only where one begins to look.
  constexpr std::size_t kMost = 2000;
  // Spans shorter than this share of the part are none.
  constexpr double kNoSpan = 1e-9;
  std::vector<double> ends{part.lo};
  for (const double k : knots) {
    if (k > ends.back() + kNoSpan * part.length() && k < part.hi - kNoSpan * part.length()) ends.push_back(k);
  }
  ends.push_back(part.hi);
  const std::size_t skip = 1 + ends.size() / kMost;
  std::vector<double> out{part.lo};
  for (std::size_t i = 0; i + 1 < ends.size();) {
    const std::size_t j = std::min(i + skip, ends.size() - 1);
    for (int k = 1; k <= per_span; ++k) out.push_back(ends[i] + (ends[j] - ends[i]) * k / per_span);
    i = j;
  }
  return out;
}

std::vector<std::vector<Node>> kept_runs(const PathFace& face, geom::SurfaceEvaluator& evaluator,
                                         std::vector<Node> nodes, const Between& between) {
  // Halvings until the end of a stretch is found to a millionth of the step between nodes.
  constexpr int kHalvings = 20;
  const auto end = [&](Node in, Node out) {
    for (int i = 0; i < kHalvings; ++i) {
      const std::optional<Node> m = between(in, out);
      if (!m) break;
      (face.kept(evaluator, m->uv) ? in : out) = *m;
    }
    return in;
  };
  std::vector<std::vector<Node>> runs;
  bool before = false;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool now = face.kept(evaluator, nodes[i].uv);
    if (now && !before) {
      runs.emplace_back();
      if (i > 0) runs.back().push_back(end(nodes[i], nodes[i - 1]));
    }
    if (!now && before) runs.back().push_back(end(nodes[i - 1], nodes[i]));
    if (now) runs.back().push_back(nodes[i]);
    before = now;
  }
  return runs;
}

bool has_length(const std::vector<CcPoint>& points, double size) {
  constexpr double kLeast = 1e-9;
  return points.size() >= 2 && std::any_of(points.begin(), points.end(), [&](const CcPoint& p) {
           return distance(p.c, points.front().c) > kLeast * size;
         });
}

namespace {

/// Nodes are put in for these shares of the chord and of the turn allowed (the spacing is then a third of
/// what is allowed), so that leaving out finds good places.
constexpr double kDenseChord = 0.1, kDenseTurn = 0.15, kSparse = 0.9;
/// One path; beyond this it becomes coarser than asked for.
constexpr std::size_t kMostNodes = 100'000;
constexpr int kMostHalvings = 20;

double cosine_turn(double turn) {
  return std::cos(std::clamp(turn, 1e-6, geom::kPi));
}

void refine(const Node& a, const Node& b, const Between& between, const PathOptions& o, int left,
            std::vector<Node>& out) {
  if (left <= 0 || out.size() >= kMostNodes) return;
  // A crease turns at once; nothing is won by coming nearer to it.
  constexpr double kLeastStep = 0.05;
  if (distance(a.cc.c, b.cc.c) <= kLeastStep * o.chord_mm) return;
  const std::optional<Node> m = between(a, b);
  if (!m) return;
  const double turn = cosine_turn(kDenseTurn * o.max_turn);
  const bool fine = geom::distance_to_segment(m->cc.c, a.cc.c, b.cc.c) <= kDenseChord * o.chord_mm &&
                    dot(a.cc.n, m->cc.n) >= turn && dot(m->cc.n, b.cc.n) >= turn &&
                    (o.max_step_mm <= 0 || distance(a.cc.c, b.cc.c) <= o.max_step_mm);
  if (fine) return;
  refine(a, *m, between, o, left - 1, out);
  out.push_back(*m);
  refine(*m, b, between, o, left - 1, out);
}

/// Whether the nodes between i and j may go.
bool spanned(const std::vector<Node>& nodes, std::size_t i, std::size_t j, const PathOptions& o) {
  const CcPoint &a = nodes[i].cc, &b = nodes[j].cc;
  if (o.max_step_mm > 0 && distance(a.c, b.c) > o.max_step_mm) return false;
  if (dot(a.n, b.n) < cosine_turn(kSparse * o.max_turn)) return false;
  for (std::size_t k = i + 1; k < j; ++k) {
    const CcPoint& m = nodes[k].cc;
    if (geom::distance_to_segment(m.c, a.c, b.c) > kSparse * o.chord_mm) return false;
    if (std::min(dot(a.n, m.n), dot(m.n, b.n)) < cosine_turn(kSparse * o.max_turn)) return false;
  }
  return true;
}

}  // namespace

std::vector<Node> refined(const std::vector<Node>& coarse, const Between& between,
                          const PathOptions& options) {
  PathOptions limits = options;
  const double step = options.max_step_mm > 0 ? options.max_step_mm : std::numeric_limits<double>::infinity();
  // Half the distance from the border: what lies nearer between two nodes does so by a 32nd of it at most.
  const double share = options.edge_mm > 0 ? 0.5 * options.edge_mm : step;
  const double fine = std::min(share, 0.35 * step);
  limits.max_step_mm = std::isfinite(fine) ? fine : 0;
  std::vector<Node> dense;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    if (i > 0) refine(coarse[i - 1], coarse[i], between, limits, kMostHalvings, dense);
    dense.push_back(coarse[i]);
  }
  return dense;
}

std::vector<CcPoint> thinned(const std::vector<Node>& dense, const PathOptions& options) {
  std::vector<CcPoint> out;
  if (dense.size() < 2) return out;
  out.push_back(dense.front().cc);
  // At most this many nodes are left out together, so that the work stays linear.
  constexpr std::size_t kMostSkipped = 64;
  for (std::size_t i = 0; i + 1 < dense.size();) {
    std::size_t j = i + 1;
    while (j + 1 < dense.size() && j - i < kMostSkipped && spanned(dense, i, j + 1, options)) ++j;
    out.push_back(dense[j].cc);
    i = j;
  }
  return out;
}

}  // namespace burin::orient::detail
