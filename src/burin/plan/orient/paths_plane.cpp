// SPDX-License-Identifier: Apache-2.0
// Paths in parallel planes: level lines of the height over a plane, found on a grid of the face (marching
// squares: every piece and loop that is wider than a cell), put onto the surface by Newton steps.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>

#include "burin/plan/orient/path_family.h"

namespace burin::orient::detail {
namespace {

using geom::Direction;
using geom::SurfaceDerivatives;

/// Cells in each direction, at least (more where there are more spans).
constexpr int kCells = 64;
constexpr int kMostCells = 400;
/// Steps of w, and how steep to the plane a face may stand before its paths' distances are no longer counted
/// in full (tan of 87 degrees: such places are better cut in another direction).
constexpr std::size_t kLevels = 256;
constexpr double kLeastSlope = 0.05;
/// A plane that touches the face has no direction there: sine of the angle between plane and face.
constexpr double kTouches = 1e-6;
constexpr int kMostSteps = 20;
constexpr double kThere = 1e-10;
/// Two ends of pieces on a seam are one place, relative to the size.
constexpr double kSame = 1e-7;

std::vector<double> grid_lines(const std::vector<double>& knots, int degree, geom::Interval part) {
  const int spans = static_cast<int>(geom::inner_knots(knots, degree).size()) + 1;
  const int per_span = std::max(2, (kCells + spans - 1) / spans);
  std::vector<double> lines = span_places(knots, part, per_span);
  if (lines.size() <= static_cast<std::size_t>(kMostCells)) return lines;
  lines.resize(kMostCells + 1);
  for (int i = 0; i <= kMostCells; ++i) {
    lines[static_cast<std::size_t>(i)] = part.lo + part.length() * i / kMostCells;
  }
  return lines;
}

class PlaneFamily final : public Family {
 public:
  PlaneFamily(PathFace face, const PathOptions& options)
      : Family(std::move(face), options), up_(geom::unit(options.plane_normal)) {}
  Result<void> prepare();

  std::vector<std::vector<CcPoint>> at(double w) const override;
  std::vector<PathFamily::Abreast> abreast(const std::vector<CcPoint>& from, double w,
                                           double w_to) const override;
  double extent() const override { return levels_.length(); }

 private:
  using Line = std::vector<Point2>;
  std::size_t index(std::size_t i, std::size_t j) const { return i + j * us_.size(); }
  double over(Point3 p) const { return dot(p - Point3{}, up_); }
  std::vector<Line> trace(geom::SurfaceEvaluator& evaluator, double level) const;
  Point2 crossing(geom::SurfaceEvaluator& evaluator, std::size_t edge, double level) const;
  std::optional<Point2> settle(geom::SurfaceEvaluator& evaluator, Point2 p, double level) const;
  std::optional<Node> node(geom::SurfaceEvaluator& evaluator, Point2 p, Vec2 chord) const;
  std::vector<Node> nodes(geom::SurfaceEvaluator& evaluator, const Line& line, double level) const;
  std::vector<Node> with_trim_crossings(geom::SurfaceEvaluator& evaluator, std::vector<Node> nodes,
                                        double level) const;
  std::optional<Point2> locate(geom::SurfaceEvaluator& evaluator, Point3 c, Point2 hint) const;
  std::optional<Point2> meet(geom::SurfaceEvaluator& evaluator, const CcPoint& from, Point2 p,
                             double level) const;
  void join_across_seams(std::vector<std::vector<CcPoint>>& pieces) const;

  Vec3 up_;
  std::vector<double> us_, vs_;
  std::vector<Point3> points_;
  std::vector<double> heights_;
  Levels levels_{{0, 1}, {1}};
};

Result<void> PlaneFamily::prepare() {
  const Error nothing{
      ErrorCode::geometry,
      "no plane cuts through the face (plane_normal across a face that is wider than twice the "
      "distance from its edges)",
      {}};
  if (up_ == Vec3{}) return nothing;
  auto evaluator = face_.evaluator();
  const geom::Box2 box = face_.window();
  if (!(box.width() > 0 && box.height() > 0)) return nothing;
  const geom::NurbsSurface& s = face_.surface();
  us_ = grid_lines(s.knots_u, s.degree_u, {box.lo.x, box.hi.x});
  vs_ = grid_lines(s.knots_v, s.degree_v, {box.lo.y, box.hi.y});
  points_.resize(us_.size() * vs_.size());
  std::vector<double> slopes(points_.size());
  std::vector<char> kept(points_.size());
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (std::size_t j = 0; j < vs_.size(); ++j) {
    for (std::size_t i = 0; i < us_.size(); ++i) {
      const Point2 p{us_[i], vs_[j]};
      const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
      points_[index(i, j)] = d.p;
      const Vec3 n = face_.normal(d, p);
      slopes[index(i, j)] = norm(up_ - dot(up_, n) * n);
      kept[index(i, j)] = face_.kept(evaluator, p);
    }
  }
  for (const Point3& p : points_) heights_.push_back(over(p));
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (kept[k]) lo = std::min(lo, heights_[k]), hi = std::max(hi, heights_[k]);
  }
  if (!face_.has_edge()) {
    for (const auto& loop : face_.trims()) {
      for (const Point2 p : loop) {
        const double h = over(evaluator.point(p.x, p.y));
        lo = std::min(lo, h), hi = std::max(hi, h);
      }
    }
  }
  if (!(hi - lo > kSame * face_.size())) return nothing;
  std::vector<double> levels(kLevels + 1), density(kLevels, 1);
  for (std::size_t i = 0; i <= kLevels; ++i) levels[i] = lo + (hi - lo) * static_cast<double>(i) / kLevels;
  for (std::size_t j = 0; j + 1 < vs_.size(); ++j) {
    for (std::size_t i = 0; i + 1 < us_.size(); ++i) {
      const std::size_t corner[] = {index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)};
      double low = hi, high = lo, slope = 1;
      bool any = false;
      for (const std::size_t k : corner) {
        any = any || kept[k];
        low = std::min(low, heights_[k]), high = std::max(high, heights_[k]);
        slope = std::min(slope, slopes[k]);
      }
      if (!any) continue;
      const auto bin = [&](double h) {
        return static_cast<std::size_t>(std::clamp((h - lo) / (hi - lo), 0.0, 1.0) * (kLevels - 1e-9));
      };
      for (std::size_t b = bin(low); b <= bin(high); ++b) {
        density[b] = std::max(density[b], 1 / std::max(slope, kLeastSlope));
      }
    }
  }
  levels_ = Levels(levels, density);
  if (!std::isfinite(levels_.length())) return nothing;
  return {};
}

/// Even edges run in u from node edge / 2, odd ones in v. Illinois' rule on the edge.
Point2 PlaneFamily::crossing(geom::SurfaceEvaluator& evaluator, std::size_t edge, double level) const {
  const std::size_t from = edge / 2, to = edge % 2 == 0 ? from + 1 : from + us_.size();
  const Point2 a{us_[from % us_.size()], vs_[from / us_.size()]},
      b{us_[to % us_.size()], vs_[to / us_.size()]};
  double xa = 0, xb = 1, fa = heights_[from] - level, fb = heights_[to] - level;
  if (fa == 0) return a;
  if (fb == 0) return b;
  Point2 p = a;
  for (int i = 0; i < 60; ++i) {
    const double x = (xa * fb - xb * fa) / (fb - fa);
    p = lerp(a, b, x);
    const double f = over(evaluator.point(p.x, p.y)) - level;
    if (std::abs(f) <= kThere * face_.size()) break;
    if ((f < 0) == (fb < 0)) {
      fa *= 0.5;
    } else {
      xa = xb, fa = fb;
    }
    xb = x, fb = f;
  }
  return p;
}

std::vector<PlaneFamily::Line> PlaneFamily::trace(geom::SurfaceEvaluator& evaluator, double level) const {
  // The crossed edges and their neighbours, in the order of the cells: at most two a crossed edge.
  struct Links {
    std::size_t to[2] = {0, 0};
    int count = 0;
    bool done = false;
  };
  std::unordered_map<std::size_t, Links> links;
  std::vector<std::size_t> order;
  const auto connect = [&](std::size_t a, std::size_t b) {
    for (const auto& [x, y] : {std::pair{a, b}, std::pair{b, a}}) {
      Links& l = links[x];
      if (l.count == 0) order.push_back(x);
      if (l.count < 2) l.to[l.count++] = y;
    }
  };
  const auto above = [&](std::size_t k) { return heights_[k] >= level; };
  for (std::size_t j = 0; j + 1 < vs_.size(); ++j) {
    for (std::size_t i = 0; i + 1 < us_.size(); ++i) {
      const std::size_t c[] = {index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)};
      const std::size_t e[] = {2 * c[0], 2 * c[1] + 1, 2 * c[3], 2 * c[0] + 1};
      const bool s[] = {above(c[0]), above(c[1]), above(c[2]), above(c[3])};
      std::size_t hit[4];
      std::size_t count = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        if (s[k] != s[(k + 1) % 4]) hit[count++] = e[k];
      }
      if (count == 2) connect(hit[0], hit[1]);
      if (count == 4) {
        const Point3 middle = evaluator.point(0.5 * (us_[i] + us_[i + 1]), 0.5 * (vs_[j] + vs_[j + 1]));
        const bool with_first = (over(middle) >= level) == s[0];
        connect(hit[0], with_first ? hit[1] : hit[3]);
        connect(hit[2], with_first ? hit[3] : hit[1]);
      }
    }
  }
  std::vector<Line> lines;
  const auto follow = [&](std::size_t start) {
    Line line;
    std::size_t at = start;
    for (;;) {
      Links& l = links[at];
      l.done = true;
      line.push_back(crossing(evaluator, at, level));
      std::size_t next = at;
      for (int k = 0; k < l.count; ++k) {
        if (!links[l.to[k]].done) next = l.to[k];
      }
      if (next == at) break;
      at = next;
    }
    // A loop comes back to where it began.
    const Links& last = links[at];
    for (int k = 0; k < last.count && line.size() > 2; ++k) {
      if (last.to[k] == start) {
        line.push_back(line.front());
        break;
      }
    }
    lines.push_back(std::move(line));
  };
  for (const std::size_t e : order) {
    if (!links[e].done && links[e].count == 1) follow(e);
  }
  for (const std::size_t e : order) {
    if (!links[e].done) follow(e);
  }
  return lines;
}

/// Onto the level, straight up the slope.
std::optional<Point2> PlaneFamily::settle(geom::SurfaceEvaluator& evaluator, Point2 p, double level) const {
  for (int i = 0; i < kMostSteps; ++i) {
    const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
    const double off = over(d.p) - level;
    if (std::abs(off) <= kThere * face_.size()) return p;
    const Vec3 n = geom::normal(d);
    const Vec3 slope = up_ - dot(up_, n) * n;
    const Vec2 way = PathFace::coefficients(d, slope / dot(slope, slope));
    const Point2 next = face_.wrapped(p - off * way);
    if (!std::isfinite(next.x + next.y) || next == p) return std::nullopt;
    p = next;
  }
  return std::nullopt;
}

/// The path runs so that t points up: f = up x n.
std::optional<Node> PlaneFamily::node(geom::SurfaceEvaluator& evaluator, Point2 p, Vec2 chord) const {
  const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
  const Vec3 n = face_.normal(d, p);
  Node made{p, {}, {}};
  made.way = face_.sign() * Vec2{dot(up_, d.dv), -dot(up_, d.du)};
  if (norm(cross(up_, n)) < kTouches || made.way == Vec2{}) made.way = chord;
  const auto cc = face_.contact(evaluator, p, made.way);
  if (!cc) return std::nullopt;
  made.cc = *cc;
  return made;
}

std::vector<Node> PlaneFamily::nodes(geom::SurfaceEvaluator& evaluator, const Line& line,
                                     double level) const {
  std::vector<Node> out;
  double with = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vec2 chord = line[std::min(i + 1, line.size() - 1)] - line[i > 0 ? i - 1 : 0];
    const auto made = node(evaluator, line[i], chord);
    if (!made) continue;
    if (!out.empty() && distance(out.back().cc.c, made->cc.c) <= kThere * face_.size()) continue;
    if (!out.empty()) with += dot(made->cc.c - out.back().cc.c, made->cc.f + out.back().cc.f);
    out.push_back(*made);
  }
  if (with < 0) std::reverse(out.begin(), out.end());
  return face_.trims().empty() ? out : with_trim_crossings(evaluator, std::move(out), level);
}

/// A node between any two crossings of the trims, so that no narrow cut-out is stepped over.
std::vector<Node> PlaneFamily::with_trim_crossings(geom::SurfaceEvaluator& evaluator, std::vector<Node> nodes,
                                                   double level) const {
  std::vector<Node> out;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (k > 0) {
      const Point2 a = nodes[k - 1].uv;
      const Vec2 ab = nodes[k].uv - a;
      std::vector<double> at;
      for (const auto& loop : face_.trims()) {
        for (std::size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
          const Vec2 side = loop[i] - loop[j], to = loop[j] - a;
          const double det = cross(ab, side);
          if (det == 0) continue;
          const double x = cross(to, side) / det, y = cross(to, ab) / det;
          if (x > 0 && x < 1 && y >= 0 && y < 1) at.push_back(x);
        }
      }
      std::sort(at.begin(), at.end());
      for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        const auto p = settle(evaluator, a + 0.5 * (at[i] + at[i + 1]) * ab, level);
        const auto made = p ? node(evaluator, *p, ab) : std::nullopt;
        if (made) out.push_back(*made);
      }
    }
    out.push_back(nodes[k]);
  }
  return out;
}

void PlaneFamily::join_across_seams(std::vector<std::vector<CcPoint>>& pieces) const {
  if (!face_.closed(Direction::u) && !face_.closed(Direction::v)) return;
  for (std::size_t i = 0; i < pieces.size();) {
    bool joined = false;
    for (std::size_t j = 0; j < pieces.size() && !joined; ++j) {
      if (i == j || distance(pieces[i].back().c, pieces[j].front().c) > kSame * face_.size()) continue;
      pieces[i].insert(pieces[i].end(), pieces[j].begin() + 1, pieces[j].end());
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
      if (j < i) --i;
      joined = true;
    }
    if (!joined) ++i;
  }
}

std::vector<std::vector<CcPoint>> PlaneFamily::at(double w) const {
  auto evaluator = face_.evaluator();
  const double level = levels_.at(w);
  const Between between = [&](const Node& a, const Node& b) -> std::optional<Node> {
    const auto p = settle(evaluator, lerp(a.uv, b.uv, 0.5), level);
    if (!p) return std::nullopt;
    auto m = node(evaluator, *p, b.uv - a.uv);
    // Newton may end on another piece.
    const double apart = distance(a.cc.c, b.cc.c);
    if (!m || distance(m->cc.c, a.cc.c) > 2 * apart || distance(m->cc.c, b.cc.c) > 2 * apart) {
      return std::nullopt;
    }
    return m;
  };
  std::vector<std::vector<CcPoint>> pieces;
  for (const Line& line : trace(evaluator, level)) {
    std::vector<std::vector<Node>> runs{refined(nodes(evaluator, line, level), between, options_)};
    if (face_.has_edge() || !face_.trims().empty()) {
      runs = kept_runs(face_, evaluator, std::move(runs.front()), between);
    }
    for (const std::vector<Node>& run : runs) {
      std::vector<CcPoint> points = thinned(run, options_);
      if (has_length(points, face_.size())) pieces.push_back(std::move(points));
    }
  }
  join_across_seams(pieces);
  return pieces;
}

std::optional<Point2> PlaneFamily::locate(geom::SurfaceEvaluator& evaluator, Point3 c, Point2 hint) const {
  const double there = kThere * face_.size() + 1e-3 * options_.chord_mm;
  const auto newton = [&](Point2 p) -> std::optional<Point2> {
    for (int i = 0; i < kMostSteps; ++i) {
      const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
      if (distance(d.p, c) <= there) return p;
      const Point2 next = face_.wrapped(p + PathFace::coefficients(d, c - d.p));
      if (!std::isfinite(next.x + next.y) || next == p) return std::nullopt;
      p = next;
    }
    return std::nullopt;
  };
  if (const auto p = newton(hint)) return p;
  std::size_t best = 0;
  for (std::size_t k = 1; k < points_.size(); ++k) {
    if (distance(points_[k], c) < distance(points_[best], c)) best = k;
  }
  return newton({us_[best % us_.size()], vs_[best / us_.size()]});
}

/// Where the level meets the plane through the contact across its feed.
std::optional<Point2> PlaneFamily::meet(geom::SurfaceEvaluator& evaluator, const CcPoint& from, Point2 p,
                                        double level) const {
  for (int i = 0; i < kMostSteps; ++i) {
    const SurfaceDerivatives d = evaluator.derivatives(p.x, p.y);
    const double a = dot(d.p - from.c, from.f), b = over(d.p) - level;
    if (std::max(std::abs(a), std::abs(b)) <= kThere * face_.size()) return p;
    const double a1 = dot(d.du, from.f), a2 = dot(d.dv, from.f), b1 = dot(d.du, up_), b2 = dot(d.dv, up_);
    const double det = a1 * b2 - a2 * b1;
    Vec2 step{(a2 * b - a * b2) / det, (a * b1 - a1 * b) / det};
    if (!std::isfinite(step.x + step.y)) return std::nullopt;
    const double most =
        std::max(std::abs(step.x) / face_.u().length(), std::abs(step.y) / face_.v().length());
    if (most > 0.25) step = (0.25 / most) * step;  // at most a quarter of the face at once
    const Point2 next = face_.wrapped(p + step);
    if (next == p) return std::nullopt;
    p = next;
  }
  return std::nullopt;
}

std::vector<PathFamily::Abreast> PlaneFamily::abreast(const std::vector<CcPoint>& from, double w,
                                                      double w_to) const {
  // One for either path: each stays in a span for several contacts.
  auto evaluator = face_.evaluator(), other_side = face_.evaluator();
  const double to = levels_.at(w_to), apart = to - levels_.at(w);
  std::vector<PathFamily::Abreast> out(from.size());
  Point2 here{us_[us_.size() / 2], vs_[vs_.size() / 2]};
  for (std::size_t i = 0; i < from.size(); ++i) {
    const auto p = locate(evaluator, from[i].c, here);
    if (!p) continue;
    here = *p;
    const SurfaceDerivatives d = evaluator.derivatives(p->x, p->y);
    const double rise = dot(from[i].t(), up_);
    const Vec2 step = PathFace::coefficients(d, (apart / std::max(rise, kLeastSlope)) * from[i].t());
    const auto q = meet(other_side, from[i], face_.wrapped(here + step), to);
    if (q) out[i] = met_at(face_, other_side, from[i], *p, *q);
  }
  return out;
}

}  // namespace

Result<std::unique_ptr<Family>> plane_family(PathFace face, const PathOptions& options) {
  auto family = std::make_unique<PlaneFamily>(std::move(face), options);
  if (auto prepared = family->prepare(); !prepared) return prepared.error();
  return std::unique_ptr<Family>(std::move(family));
}

}  // namespace burin::orient::detail
