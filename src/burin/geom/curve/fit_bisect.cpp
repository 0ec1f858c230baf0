// SPDX-License-Identifier: Apache-2.0
// The baseline: the procedure of Park (2004) as Park & Ahn (2007), 4.2.1 give it. A polygon of the offset
// curve within 0.2 delta, then recursive halving with the optimal single biarc within 0.8 delta of the
// polygon's points.
#include <algorithm>
#include <cmath>

#include "burin/geom/curve/fit_internal.h"

namespace burin::geom::fit {

namespace {

constexpr double kPolygonShare = 0.2;  // a: delta_1 = a delta
constexpr double kBiarcShare = 0.8;    // b: delta_2 = b delta
constexpr int kMaxHalvings = 40;

class Bisection {
 public:
  /// `d`: the offset whose polygon is fitted; 0 where the offset curve is singular.
  Bisection(const Target& target, double d) : target_(target), path_(*target.path), d_(d) {}

  std::optional<FittedPiece> run() {
    make_polygon();
    if (!halve(0, polygon_.size() - 1, 0)) return std::nullopt;
    return std::move(piece_);
  }

 private:
  Sample vertex(double tau) const {
    const PointTangent c = path_.at(tau);
    return {c.point + d_ * right(c.tangent), c.tangent, tau, 0};
  }

  /// Step 2: halved until the offset curve's middle is within delta_1 of the chord (and the direction known).
  void make_polygon() {
    polygon_.push_back(vertex(0));
    constexpr int kFirst = 2;
    for (int i = 1; i <= kFirst * static_cast<int>(path_.pieces.size()); ++i) {
      const Sample from = polygon_.back();
      refine(from, vertex(static_cast<double>(i) / kFirst), 0);
    }
  }
  void refine(const Sample& a, const Sample& b, int depth) {
    const Sample m = vertex(0.5 * (a.tau + b.tau));
    const Vec2 chord = b.p - a.p;
    const double length = norm(chord);
    const double height = length > 0 ? std::abs(cross(chord, m.p - a.p)) / length : distance(m.p, a.p);
    const bool flat = height <= kPolygonShare * target_.tolerance && dot(a.t, b.t) > 0.5;
    if (flat || depth >= kMaxHalvings || polygon_.size() > kMaxSegments) {
      polygon_.push_back(b);
      return;
    }
    refine(a, m, depth + 1);
    refine(m, b, depth + 1);
  }

  /// Step 3 for the polygon's vertices first .. last.
  bool halve(std::size_t first, std::size_t last, int depth) {
    if (accept(first, last)) return true;
    if (piece_.runs.size() >= kMaxSegments || depth >= kMaxHalvings) return false;
    std::size_t middle = (first + last) / 2;
    if (middle == first) {
      // A single edge: the polygon gets a vertex (its indices behind shift).
      const Sample m = vertex(0.5 * (polygon_[first].tau + polygon_[last].tau));
      polygon_.insert(polygon_.begin() + static_cast<std::ptrdiff_t>(last), m);
      middle = last;
      ++last;
    }
    const std::size_t before = polygon_.size();
    if (!halve(first, middle, depth + 1)) return false;
    const std::size_t shift = polygon_.size() - before;
    return halve(middle + shift, last + shift, depth + 1);
  }

  /// The optimal single biarc for the vertices, if it is within delta_2 and certified.
  bool accept(std::size_t first, std::size_t last) {
    const Sample& a = polygon_[first];
    const Sample& b = polygon_[last];
    Biarc biarc;
    double deviation = 0;
    if (!best_biarc(a.p, a.t, b.p, b.t, &a, &b, 0, biarc, deviation)) return false;
    if (deviation > kBiarcShare * target_.tolerance) return false;
    // Back to the path's side: concentric arcs.
    for (Arc& arc : biarc) {
      if (!(1 - d_ * arc.k > 0)) return false;
      arc.k = arc.k / (1 - d_ * arc.k);
      arc.a = arc.a - d_ * right(arc.ta);
      arc.b = arc.b - d_ * right(arc.tb);
    }
    biarc[0].a = path_.point(a.tau);
    biarc[1].b = path_.point(b.tau);
    const double middle =
        parameter_on_normal(path_, 0, biarc[1].a, biarc[1].ta, 0.5 * (a.tau + b.tau), a.tau, b.tau);
    if (middle < 0) return false;
    std::vector<Run> runs{{biarc[0], a.tau, middle}, {biarc[1], middle, b.tau}};
    const Deviation bound = certify(target_, runs);
    if (!(bound.bound() <= target_.tolerance)) return false;
    piece_.deviation.lo = std::min(piece_.deviation.lo, bound.lo);
    piece_.deviation.hi = std::max(piece_.deviation.hi, bound.hi);
    piece_.runs.insert(piece_.runs.end(), runs.begin(), runs.end());
    return true;
  }

  const Target& target_;
  const Path& path_;
  const double d_;
  std::vector<Sample> polygon_;
  FittedPiece piece_;
};

}  // namespace

std::optional<FittedPiece> fit_bisect(const Target& target) {
  return Bisection(target, target.singular.ranges.empty() ? target.d : 0.0).run();
}

}  // namespace burin::geom::fit
