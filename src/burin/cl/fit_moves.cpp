// SPDX-License-Identifier: Apache-2.0
#include "burin/cl/fit_moves.h"

#include <array>
#include <cmath>
#include <optional>

#include "burin/geom/point_tools.h"

namespace burin::cl {
namespace {

using geom::Point3;
using geom::Vec3;

// The polyline that stands for the path takes this share of the tolerance; the moves take the rest.
constexpr double kFlatShare = 0.05;
// A piece of degree 5 halved this often is flat for any tolerance a file can hold.
constexpr int kMaxHalvings = 24;
// Longer arcs are cut in two: the centre of a half circle is still well determined by its chord.
constexpr double kMaxSweep = 3.1;

using Bezier = std::array<Point3, 6>;

Bezier bezier_of(const geom::QuinticPath& path, std::size_t i) {
  const geom::QuinticNode& a = path.nodes[i];
  const geom::QuinticNode& b = path.nodes[i + 1];
  const double h = b.t - a.t;
  // End derivatives of a Bezier curve of degree 5: d1 = 5 (P1 - P0) / h, d2 = 20 (P2 - 2 P1 + P0) / h^2.
  const Point3 a1 = a.p + (h / 5) * a.d1, b1 = b.p - (h / 5) * b.d1;
  return {a.p, a1, a1 + (h / 5) * a.d1 + (h * h / 20) * a.d2, b1 - (h / 5) * b.d1 + (h * h / 20) * b.d2,
          b1,  b.p};
}

bool flat(const Bezier& c, double tolerance) {
  for (std::size_t k = 1; k < 5; ++k)
    if (!(distance_to_segment(c[k], c[0], c[5]) <= tolerance)) return false;
  return true;
}

void flatten(const Bezier& c, double tolerance, int depth, std::vector<Point3>& out) {
  if (depth == 0 || flat(c, tolerance)) {
    if (out.empty() || out.back() != c[5]) out.push_back(c[5]);
    return;
  }
  Bezier left, right, work = c;
  for (std::size_t k = 0; k < 6; ++k) {
    left[k] = work[0];
    right[5 - k] = work[5 - k];
    for (std::size_t i = 0; i + 1 < 6 - k; ++i) work[i] = lerp(work[i], work[i + 1], 0.5);
  }
  flatten(left, tolerance, depth - 1, out);
  flatten(right, tolerance, depth - 1, out);
}

std::vector<Point3> polyline_of(const geom::QuinticPath& path, double tolerance) {
  std::vector<Point3> out{path.start()};
  for (std::size_t i = 0; i + 1 < path.nodes.size(); ++i)
    flatten(bezier_of(path, i), tolerance, kMaxHalvings, out);
  return out;
}

/// A plane of arcs: coordinates a, b in it and c along its normal, right-handed.
struct Frame {
  std::size_t a, b, c;
};
constexpr std::array<Frame, 3> kFrames = {Frame{0, 1, 2}, Frame{2, 0, 1}, Frame{1, 2, 0}};

Point3 from_frame(const Frame& f, double a, double b, double c) {
  Point3 p;
  set_component(p, f.a, a);
  set_component(p, f.b, b);
  set_component(p, f.c, c);
  return p;
}

class Fitter {
 public:
  Fitter(std::vector<Point3> points, double tolerance, const FitOptions& options)
      : points_(std::move(points)), tolerance_(tolerance), options_(options) {}

  FitMoves run() {
    std::size_t at = 0;
    while (at + 1 < points_.size()) {
      const std::size_t line = reach(at, [&](std::size_t end) { return line_error(at, end) <= tolerance_; });
      std::size_t end = line;
      std::optional<FittedMove> move;
      double error = line_error(at, line);
      if (options_.arcs) try_arcs(at, end, move, error);
      result_.moves.push_back(move ? *move : FittedMove{points_[end], 0, {}, {}});
      result_.deviation_mm = std::max(result_.deviation_mm, error);
      at = end;
    }
    return std::move(result_);
  }

 private:
  double line_error(std::size_t from, std::size_t to) const {
    double worst = 0;
    for (std::size_t k = from + 1; k < to && worst <= tolerance_; ++k)
      worst = std::max(worst, distance_to_segment(points_[k], points_[from], points_[to]));
    return worst;
  }

  /// The last vertex for which `fits` holds, by doubling and halving; at least the next one.
  template <class Fits>
  std::size_t reach(std::size_t from, const Fits& fits) const {
    const std::size_t last = points_.size() - 1;
    std::size_t good = from + 1, step = 1, bad = last + 1;
    while (good < last) {
      const std::size_t probe = std::min(good + step, last);
      if (!fits(probe)) {
        bad = probe;
        break;
      }
      good = probe;
      step *= 2;
    }
    while (good + 1 < bad) {
      const std::size_t mid = good + (bad - good) / 2;
      (fits(mid) ? good : bad) = mid;
    }
    return good;
  }

  void try_arcs(std::size_t at, std::size_t& end, std::optional<FittedMove>& move, double& error) const {
    for (const Frame& frame : kFrames) {
      // An arc through fewer than four vertices says nothing that chords do not; and it must beat the line
      // clearly.
      const std::size_t need = std::max(end + 1, at + 4);
      if (need >= points_.size() || !arc(frame, at, need)) continue;
      const std::size_t far =
          reach(at, [&](std::size_t to) { return to < need || arc(frame, at, to).has_value(); });
      if (far < need) continue;
      const auto found = arc(frame, at, far);
      if (!found) continue;
      move = found->move;
      error = found->error;
      end = far;
    }
  }

  struct Arc {
    FittedMove move;
    double error = 0;
  };

  /// The arc of that plane between two vertices whose sagitta lies in the middle of what all vertices between
  /// allow.
  std::optional<Arc> arc(const Frame& f, std::size_t from, std::size_t to) const {
    const Point3 p = points_[from], q = points_[to];
    const double ax = component(p, f.a), ay = component(p, f.b);
    const double dx = component(q, f.a) - ax, dy = component(q, f.b) - ay;
    const double chord = std::hypot(dx, dy);
    if (!(chord > tolerance_)) return std::nullopt;
    const auto sagitta = common_sagitta(f, from, to, ax, ay, dx / chord, dy / chord, chord);
    if (!sagitta) return std::nullopt;
    // Centre at (chord / 2, h) in the frame of the chord; the arc bulges to the side of the sagitta.
    const double h = (*sagitta * *sagitta - chord * chord / 4) / (2 * *sagitta);
    const double r = std::hypot(chord / 2, h);
    if (std::abs(*sagitta) > r || r < options_.min_radius_mm || r > options_.max_radius_mm)
      return std::nullopt;
    const double cx = ax + dx / 2 - dy / chord * h, cy = ay + dy / 2 + dx / chord * h;
    return checked(f, from, to, cx, cy, r, *sagitta < 0);
  }

  std::optional<double> common_sagitta(const Frame& f, std::size_t from, std::size_t to, double ax, double ay,
                                       double ex, double ey, double chord) const {
    double lo = -chord, hi = chord;
    for (std::size_t k = from + 1; k < to; ++k) {
      const double px = component(points_[k], f.a) - ax, py = component(points_[k], f.b) - ay;
      const double x = px * ex + py * ey, y = py * ex - px * ey;
      if (x <= 0 || x >= chord) return std::nullopt;  // beyond a half circle
      const double weight = 4 * x * (chord - x) / (chord * chord);
      // Circle through both ends and this vertex; for flat ones the parabola is exact enough.
      double s = y / weight;
      if (std::abs(y) > 1e-6 * chord) {
        const double h = (x * x + y * y - chord * x) / (2 * y);
        s = y > 0 ? h + std::hypot(chord / 2, h) : h - std::hypot(chord / 2, h);
      }
      lo = std::max(lo, s - tolerance_ / weight);
      hi = std::min(hi, s + tolerance_ / weight);
      if (lo > hi) return std::nullopt;
    }
    const double s = 0.5 * (lo + hi);
    if (std::abs(s) < 1e-9 * chord) return std::nullopt;
    return s;
  }

  std::optional<Arc> checked(const Frame& f, std::size_t from, std::size_t to, double cx, double cy, double r,
                             bool counter_clockwise) const {
    const double sign = counter_clockwise ? 1 : -1;
    const double start = std::atan2(component(points_[from], f.b) - cy, component(points_[from], f.a) - cx);
    const auto angle = [&](const Point3& p) {
      const double turn = sign * (std::atan2(component(p, f.b) - cy, component(p, f.a) - cx) - start);
      return turn < -1e-9 ? turn + 2 * geom::kPi : turn;
    };
    const double sweep = angle(points_[to]);
    if (!(sweep > 0) || sweep > kMaxSweep) return std::nullopt;
    const double c0 = component(points_[from], f.c), rise = component(points_[to], f.c) - c0;
    double worst = 0, before = 0, longest = 0;
    for (std::size_t k = from + 1; k <= to; ++k) {
      const Point3& p = points_[k];
      const double turn = k == to ? sweep : angle(p);
      if (turn < before || turn > sweep) return std::nullopt;
      const double radial = std::hypot(component(p, f.a) - cx, component(p, f.b) - cy) - r;
      const double axial = component(p, f.c) - (c0 + rise * turn / sweep);
      worst = std::max(worst, std::hypot(radial, axial));
      longest = std::max(longest, turn - before);
      before = turn;
    }
    // Between two vertices the arc leaves the chord by the sagitta r (1 - cos(turn / 2)).
    worst += r * longest * longest / 8;
    if (worst > tolerance_) return std::nullopt;
    const Point3 center = from_frame(f, cx, cy, c0);
    return Arc{{points_[to], r, center, sign * (from_frame(f, 0, 0, 1) - Point3{})}, worst};
  }

  std::vector<Point3> points_;
  double tolerance_;
  const FitOptions& options_;
  FitMoves result_;
};

}  // namespace

FitMoves fit_moves(const geom::QuinticPath& path, const FitOptions& options) {
  const double flat_mm = kFlatShare * options.tolerance_mm;
  FitMoves fit = Fitter(polyline_of(path, flat_mm), options.tolerance_mm - flat_mm, options).run();
  fit.deviation_mm += flat_mm;
  return fit;
}

void append(Program& program, const FitMoves& fit, std::uint32_t source) {
  for (const FittedMove& move : fit.moves) {
    if (move.radius == 0)
      program.add(Feed{Pose{move.to}}, source);
    else
      program.add(Arc{move.center, move.normal, move.radius, Pose{move.to}}, source);
  }
}

}  // namespace burin::cl
