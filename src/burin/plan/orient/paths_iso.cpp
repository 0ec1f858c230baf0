// SPDX-License-Identifier: Apache-2.0
// Paths along a parameter line: t runs along the path, s across (t, s are u, v or v, u).
#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/orient/path_family.h"

namespace burin::orient::detail {
namespace {

using geom::Direction;
using geom::Interval;
using geom::SurfaceDerivatives;

/// Places along a path at which the distance to the neighbour is looked at, and levels across, at least.
constexpr int kStations = 33, kLevels = 128;
/// Newton steps, and how near to the wanted place counts as there, relative to the face.
constexpr int kMostSteps = 20;
constexpr double kThere = 1e-10;
/// Intervals of a trimmed line that are shorter than this share of the domain are none.
constexpr double kNoInterval = 1e-9;

class IsoFamily final : public Family {
 public:
  IsoFamily(PathFace face, const PathOptions& options) : Family(std::move(face), options) {
    along_ = options.pattern == Pattern::iso_v ? Direction::v : Direction::u;
  }
  Result<void> prepare();

  std::vector<std::vector<CcPoint>> at(double w) const override;
  std::vector<PathFamily::Abreast> abreast(const std::vector<CcPoint>& from, double w,
                                           double w_to) const override;
  double extent() const override { return levels_.length(); }

 private:
  Point2 uv(double t, double s) const { return along_ == Direction::u ? Point2{t, s} : Point2{s, t}; }
  double t_of(Point2 p) const { return along_ == Direction::u ? p.x : p.y; }
  double s_of(Point2 p) const { return along_ == Direction::u ? p.y : p.x; }
  Interval t_range() const { return along_ == Direction::u ? face_.u() : face_.v(); }
  Interval s_range() const { return along_ == Direction::u ? face_.v() : face_.u(); }
  std::vector<Interval> intervals(double s) const;
  std::vector<Node> piece(geom::SurfaceEvaluator& evaluator, double s, Interval t) const;
  bool anything(geom::SurfaceEvaluator& evaluator, double s) const;
  double first_level(geom::SurfaceEvaluator& evaluator, double border, double middle) const;
  std::optional<double> locate(geom::SurfaceEvaluator& evaluator, Point3 c, double s, double hint) const;
  std::optional<double> meet(geom::SurfaceEvaluator& evaluator, const CcPoint& from, double t,
                             double s) const;

  Direction along_ = Direction::u;
  Levels levels_{{0, 1}, {1}};
};

/// Where the line at s runs inside the trims.
std::vector<Interval> IsoFamily::intervals(double s) const {
  const Interval all = t_range();
  if (face_.trims().empty()) return {all};
  std::vector<double> at;
  for (const auto& loop : face_.trims()) {
    for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
      const double sa = s_of(loop[j]), sb = s_of(loop[i]);
      // Half open, so that a corner on the line counts once.
      if ((sa > s) == (sb > s)) continue;
      const double x = (s - sa) / (sb - sa);
      at.push_back(std::clamp(t_of(loop[j]) + x * (t_of(loop[i]) - t_of(loop[j])), all.lo, all.hi));
    }
  }
  std::sort(at.begin(), at.end());
  std::vector<Interval> out;
  const double least = kNoInterval * all.length();
  for (std::size_t i = 0; i + 1 < at.size(); i += 2) {
    if (!(at[i + 1] - at[i] > least)) continue;
    if (!out.empty() && at[i] - out.back().hi <= least) {
      out.back().hi = at[i + 1];
    } else {
      out.push_back({at[i], at[i + 1]});
    }
  }
  return out;
}

bool IsoFamily::anything(geom::SurfaceEvaluator& evaluator, double s) const {
  for (const Interval part : intervals(s)) {
    for (int i = 0; i < kStations; ++i) {
      if (face_.kept(evaluator, uv(part.lo + part.length() * (i + 0.5) / kStations, s))) return true;
    }
  }
  return false;
}

/// The level nearest to the border at which something is far enough from it.
double IsoFamily::first_level(geom::SurfaceEvaluator& evaluator, double border, double middle) const {
  if (!face_.has_edge() || anything(evaluator, border)) return border;
  double out = border, in = middle;
  for (int i = 0; i < 40; ++i) {
    const double s = 0.5 * (out + in);
    (anything(evaluator, s) ? in : out) = s;
  }
  return in;
}

Result<void> IsoFamily::prepare() {
  auto evaluator = face_.evaluator();
  const geom::Box2 box = face_.window();
  Interval s = along_ == Direction::u ? Interval{box.lo.y, box.hi.y} : Interval{box.lo.x, box.hi.x};
  const double middle = 0.5 * (s.lo + s.hi);
  s = {first_level(evaluator, s.lo, middle), first_level(evaluator, s.hi, middle)};
  const Error nothing{ErrorCode::geometry,
                      "no paths on a face without area inside its trims and edge distance "
                      "(a face that is wider than twice the distance from its edges)",
                      {}};
  if (!(s.length() > 0)) return nothing;
  const int spans = static_cast<int>(geom::inner_knots(face_.surface().knots(other(along_)),
                                                       face_.surface().degree(other(along_)))
                                         .size()) +
                    1;
  const std::vector<double> levels =
      span_places(face_.surface().knots(other(along_)), s, std::max(1, kLevels / std::min(spans, kLevels)));
  std::vector<double> density;
  for (std::size_t i = 0; i + 1 < levels.size(); ++i) {
    const double level = 0.5 * (levels[i] + levels[i + 1]);
    double most = 0;
    for (const Interval part : intervals(level)) {
      for (int k = 0; k < kStations; ++k) {
        const Point2 p = uv(part.lo + part.length() * k / (kStations - 1), level);
        const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
        const Vec3 t = along_ == Direction::u ? d.du : d.dv, across = along_ == Direction::u ? d.dv : d.du;
        const Vec3 way = unit(t);
        most = std::max(most, norm(across - dot(across, way) * way));
      }
    }
    density.push_back(most);
  }
  levels_ = Levels(levels, density);
  if (!(levels_.length() > 0) || !std::isfinite(levels_.length())) return nothing;
  return {};
}

/// Nodes where the line starts to be looked at.
std::vector<Node> IsoFamily::piece(geom::SurfaceEvaluator& evaluator, double s, Interval t) const {
  std::vector<Node> nodes;
  const int per_span = std::max(2, face_.surface().degree(along_));
  for (const double x : span_places(face_.surface().knots(along_), t, per_span)) {
    const Point2 p = uv(x, s);
    const Vec2 way = along_ == Direction::u ? Vec2{1, 0} : Vec2{0, 1};
    if (const auto cc = face_.contact(evaluator, p, way)) nodes.push_back({p, way, *cc});
  }
  return nodes;
}

std::vector<std::vector<CcPoint>> IsoFamily::at(double w) const {
  auto evaluator = face_.evaluator();
  const double s = levels_.at(w);
  const Between between = [&](const Node& a, const Node& b) -> std::optional<Node> {
    Node m{lerp(a.uv, b.uv, 0.5), a.way, {}};
    const auto cc = face_.contact(evaluator, m.uv, m.way);
    if (!cc) return std::nullopt;
    m.cc = *cc;
    return m;
  };
  std::vector<std::vector<CcPoint>> pieces;
  for (const Interval part : intervals(s)) {
    std::vector<std::vector<Node>> runs{refined(piece(evaluator, s, part), between, options_)};
    if (face_.has_edge()) runs = kept_runs(face_, evaluator, std::move(runs.front()), between);
    for (const std::vector<Node>& run : runs) {
      std::vector<CcPoint> points = thinned(run, options_);
      if (has_length(points, face_.size())) pieces.push_back(std::move(points));
    }
  }
  return pieces;
}

/// The parameter of a contact on the line at s: Newton from the hint, then from the nearest of many places.
std::optional<double> IsoFamily::locate(geom::SurfaceEvaluator& evaluator, Point3 c, double s,
                                        double hint) const {
  const Interval range = t_range();
  const double there = kThere * face_.size() + 1e-3 * options_.chord_mm;
  const auto newton = [&](double t) -> std::optional<double> {
    for (int i = 0; i < kMostSteps; ++i) {
      const Point2 p = uv(t, s);
      const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
      if (distance(d.p, c) <= there) return t;
      const Vec3 along = along_ == Direction::u ? d.du : d.dv;
      const double length2 = dot(along, along);
      if (!(length2 > 0)) return std::nullopt;
      const double next = std::clamp(t + dot(c - d.p, along) / length2, range.lo, range.hi);
      if (next == t) return std::nullopt;
      t = next;
    }
    return std::nullopt;
  };
  if (const auto t = newton(hint)) return t;
  double best = range.lo, nearest = std::numeric_limits<double>::infinity();
  for (const double t : span_places(face_.surface().knots(along_), range, 8)) {
    const Point2 p = uv(t, s);
    const double d = distance(evaluator.point(p.x, p.y), c);
    if (d < nearest) nearest = d, best = t;
  }
  return newton(best);
}

/// The parameter at which the line at s meets the plane through the contact across its feed.
std::optional<double> IsoFamily::meet(geom::SurfaceEvaluator& evaluator, const CcPoint& from, double t,
                                      double s) const {
  const Interval range = t_range();
  const bool closed = face_.closed(along_);
  for (int i = 0; i < kMostSteps; ++i) {
    const Point2 p = face_.wrapped(uv(t, s));
    const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
    const double off = dot(d.p - from.c, from.f);
    if (std::abs(off) <= kThere * face_.size()) return t_of(p);
    const double slope = dot(along_ == Direction::u ? d.du : d.dv, from.f);
    const double step = -off / slope;
    if (!std::isfinite(step)) return std::nullopt;
    // At most a quarter of the line at once.
    const double most = 0.25 * range.length();
    const double next = t_of(p) + std::clamp(step, -most, most);
    t = closed ? next : std::clamp(next, range.lo, range.hi);
    if (!closed && t == t_of(p)) return std::nullopt;  // it would be met beyond the end
  }
  return std::nullopt;
}

std::vector<PathFamily::Abreast> IsoFamily::abreast(const std::vector<CcPoint>& from, double w,
                                                    double w_to) const {
  // One for either path: each stays in a span for several contacts.
  auto evaluator = face_.evaluator(), other_side = face_.evaluator();
  const double s = levels_.at(w), to = levels_.at(w_to);
  std::vector<PathFamily::Abreast> out(from.size());
  double here = t_range().lo;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto t = locate(evaluator, from[i].c, s, here);
    if (!t) continue;
    here = *t;
    const Point2 p = uv(here, s);
    const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
    // Along t, so far that s is reached.
    const Vec2 step = PathFace::coefficients(d, from[i].t());
    const double across = along_ == Direction::u ? step.y : step.x;
    const double along = along_ == Direction::u ? step.x : step.y;
    const double guess = across != 0 ? here + along / across * (to - s) : here;
    auto met = std::isfinite(guess) ? meet(other_side, from[i], guess, to) : std::nullopt;
    if (!met) met = meet(other_side, from[i], here, to);
    if (!met) continue;
    out[i] = met_at(face_, other_side, from[i], p, uv(*met, to));
  }
  return out;
}

}  // namespace

Result<std::unique_ptr<Family>> iso_family(PathFace face, const PathOptions& options) {
  auto family = std::make_unique<IsoFamily>(std::move(face), options);
  if (auto prepared = family->prepare(); !prepared) return prepared.error();
  return std::unique_ptr<Family>(std::move(family));
}

}  // namespace burin::orient::detail
