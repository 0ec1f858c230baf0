// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace burin::servo {
namespace {

using geom::Vec3;

/// Speeds that differ by less are one cell; cells crossed in less than so many periods too.
constexpr double kSameSpeed = 1.1;
constexpr double kMergePeriods = 3;
constexpr int kMaxDepth = 12;
/// Junctions whose jerk at the commanded feed is less than this share of the limit are left to the check.
constexpr double kNotable = 0.02;
/// Largest turn of the tangent within a cell, rad: the axes' shares change with the direction.
constexpr double kMaxTurn = 0.3;

/// Largest turn of the path within a chord, rad. Beyond, a chord jumps over bends, and which ones changes
/// with every change of the profile.
constexpr double kChordTurn = 0.5;

double largest(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

double chord_speed(double curvature, const Limits& limits) {
  // Chord of a circle: eps = rho - sqrt(rho^2 - (vT/2)^2), so (vT)^2 = 8 eps rho - 4 eps^2. A circle smaller
  // than eps is within it anyway; the 2 % leave room for a curvature that changes within the chord.
  constexpr double kMargin = 0.98;
  const double eps = kMargin * limits.chord_error_mm;
  if (!(curvature > 0)) return std::numeric_limits<double>::infinity();
  const double rho = std::max(1 / curvature, eps);
  const double chord = std::min(std::sqrt(8 * eps * rho - 4 * eps * eps), kChordTurn / curvature);
  return chord / limits.period_s;
}

/// Speed that the derivatives at one place allow, without anything else.
double own_speed(const ArcDerivatives& d, double feed, const Limits& limits) {
  double v = std::min(feed, chord_speed(geom::norm(d.d2), limits));
  const double bend = largest(d.d2), rate = largest(d.d3);
  if (bend * v * v > limits.accel_mm_s2) v = std::sqrt(limits.accel_mm_s2 / bend);
  if (rate * v * v * v > limits.jerk_mm_s3) v = std::cbrt(limits.jerk_mm_s3 / rate);
  return std::max(v, safe_speed(limits));
}

void add(double (&to)[3], const Vec3& v) {
  to[0] = std::max(to[0], std::abs(v.x));
  to[1] = std::max(to[1], std::abs(v.y));
  to[2] = std::max(to[2], std::abs(v.z));
}

void add(Cell& cell, const ArcDerivatives& d) {
  add(cell.d1, d.d1);
  add(cell.d2, d.d2);
  add(cell.d3, d.d3);
  cell.curvature = std::max(cell.curvature, geom::norm(d.d2));
}

double cell_speed(const Cell& c, const Limits& limits) {
  return own_speed({{}, {c.d2[0], c.d2[1], c.d2[2]}, {c.d3[0], c.d3[1], c.d3[2]}}, c.feed, limits);
}

/// Smallest and largest components of vectors.
struct Range {
  Vec3 lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  void add(const Vec3& v) {
    lo = {std::min(lo.x, v.x), std::min(lo.y, v.y), std::min(lo.z, v.z)};
    hi = {std::max(hi.x, v.x), std::max(hi.y, v.y), std::max(hi.z, v.z)};
  }
  Vec3 width() const { return hi - lo; }
};

/// Builds the cells of a run from left to right.
class CellMaker {
 public:
  CellMaker(const Track& track, const Limits& limits) : track_(track), limits_(limits) {}

  void piece(std::size_t i);
  void between(const Junction& joint, double key, double feed);
  std::vector<Cell> take();

 private:
  /// Pieces that are crossed in less than a period, taken together: what the setpoints see of them is how
  /// much tangent and curvature change over the group, not what happens inside one.
  struct Group {
    Cell cell;
    Range tangent, bend;
    bool open = false;
  };

  void divide(double x0, double x1, const ArcDerivatives& a, const ArcDerivatives& b, int depth);
  void put(const Cell& cell);
  void to_group(double length, const ArcDerivatives* d, int count);
  void close_group();
  Cell group_cell() const;

  const Track& track_;
  const Limits& limits_;
  std::vector<Cell> cells_;
  Group group_;
  const Piece* piece_ = nullptr;
  double feed_ = 0;
};

void CellMaker::piece(std::size_t i) {
  piece_ = &track_.pieces[i];
  feed_ = track_.feed[i];
  const ArcDerivatives d[3] = {arc_derivatives(*piece_, 0), arc_derivatives(*piece_, 0.5),
                               arc_derivatives(*piece_, 1)};
  double v = feed_;
  for (const ArcDerivatives& at : d) v = std::min(v, own_speed(at, feed_, limits_));
  if (piece_->length < v * limits_.period_s) return to_group(piece_->length, d, 3);
  close_group();
  const bool line =
      piece_->length * geom::norm(d[1].d2) < 1e-12 && piece_->length * geom::norm(d[0].d2) < 1e-12;
  if (line) return divide(0, 1, d[0], d[2], kMaxDepth);
  if (piece_->length < kMergePeriods * v * limits_.period_s) return divide(0, 1, d[0], d[2], kMaxDepth);
  const ArcDerivatives a = arc_derivatives(*piece_, 0.25), b = arc_derivatives(*piece_, 0.75);
  divide(0, 0.25, d[0], a, 0);
  divide(0.25, 0.5, a, d[1], 0);
  divide(0.5, 0.75, d[1], b, 0);
  divide(0.75, 1, b, d[2], 0);
}

void CellMaker::divide(double x0, double x1, const ArcDerivatives& a, const ArcDerivatives& b, int depth) {
  const double mid = 0.5 * (x0 + x1);
  const ArcDerivatives m = arc_derivatives(*piece_, mid);
  Cell cell;
  cell.length = x0 == 0 && x1 == 1 ? piece_->length : arc_length(*piece_, x0, x1);
  const double v[3] = {own_speed(a, feed_, limits_), own_speed(m, feed_, limits_),
                       own_speed(b, feed_, limits_)};
  const double low = std::min({v[0], v[1], v[2]}), high = std::max({v[0], v[1], v[2]});
  const bool turned = geom::dot(a.d1, b.d1) < std::cos(kMaxTurn);
  if (depth < kMaxDepth && (high > kSameSpeed * low || turned) && cell.length > low * limits_.period_s) {
    divide(x0, mid, a, m, depth + 1);
    return divide(mid, x1, m, b, depth + 1);
  }
  cell.key0 = piece_->start + x0 * piece_->length;
  cell.key1 = piece_->start + x1 * piece_->length;
  cell.feed = feed_;
  add(cell, a);
  add(cell, m);
  add(cell, b);
  put(cell);
}

bool same_line(const Cell& a, const Cell& b) {
  if (a.curvature * (a.length + b.length) > 1e-12 || b.curvature * (a.length + b.length) > 1e-12)
    return false;
  for (int k = 0; k < 3; ++k)
    if (std::abs(a.d1[k] - b.d1[k]) > 1e-9) return false;
  return true;
}

/// Appends, or lengthens the last cell where that changes little.
void CellMaker::put(const Cell& cell) {
  if (!cells_.empty()) {
    Cell& last = cells_.back();
    const double v = cell_speed(cell, limits_), w = last.length > 0 ? cell_speed(last, limits_) : 0;
    const bool small = last.length + cell.length <= kMergePeriods * limits_.period_s * std::min(v, w) &&
                       std::max(v, w) <= kSameSpeed * std::min(v, w);
    if (last.length > 0 && last.feed == cell.feed && (small || same_line(last, cell))) {
      last.key1 = cell.key1;
      last.length += cell.length;
      last.curvature = std::max(last.curvature, cell.curvature);
      for (int k = 0; k < 3; ++k) {
        last.d1[k] = std::max(last.d1[k], cell.d1[k]);
        last.d2[k] = std::max(last.d2[k], cell.d2[k]);
        last.d3[k] = std::max(last.d3[k], cell.d3[k]);
        last.bend[k] = std::max(last.bend[k], cell.bend[k]);
      }
      return;
    }
  }
  cells_.push_back(cell);
}

void CellMaker::to_group(double length, const ArcDerivatives* d, int count) {
  if (group_.open && group_.cell.feed != feed_) close_group();
  if (!group_.open) {
    group_ = {};
    group_.open = true;
    group_.cell.key0 = piece_->start;
    group_.cell.feed = feed_;
  }
  group_.cell.key1 = piece_->start + piece_->length;
  group_.cell.length += length;
  for (int i = 0; i < count; ++i) {
    add(group_.cell.d1, d[i].d1);
    add(group_.cell.d2, d[i].d2);
    group_.tangent.add(d[i].d1);
    group_.bend.add(d[i].d2);
    group_.cell.curvature = std::max(group_.cell.curvature, geom::norm(d[i].d2));
  }
  const Cell cell = group_cell();
  if (cell.length >= cell_speed(cell, limits_) * limits_.period_s) close_group();
}

Cell CellMaker::group_cell() const {
  Cell cell = group_.cell;
  const Vec3 turned = group_.tangent.width() / cell.length;
  add(cell.d2, turned);
  cell.curvature = std::max(cell.curvature, geom::norm(turned));
  add(cell.d3, group_.bend.width() / cell.length);
  return cell;
}

void CellMaker::close_group() {
  if (!group_.open) return;
  group_.open = false;
  Cell cell = group_cell();
  if (cell.length < cell_speed(cell, limits_) * limits_.period_s) {
    // Still shorter than a step: to the setpoints its curvature changes at once.
    cell = group_.cell;
    add(cell.bend, group_.bend.width());
  }
  put(cell);
}

void CellMaker::between(const Junction& joint, double key, double feed) {
  Cell point;
  const double t = limits_.period_s;
  double jerk = 0;
  for (int k = 0; k < 3; ++k) {
    point.turn[k] = joint.turn[k];
    point.bend[k] = joint.bend[k];
    jerk = std::max(jerk, joint.turn[k] * feed / (t * t) + joint.bend[k] * feed * feed / t);
  }
  if (jerk < kNotable * limits_.jerk_mm_s3) return;
  close_group();
  point.key0 = point.key1 = key;
  point.feed = feed;
  add(point, arc_derivatives(*piece_, 1));
  std::fill(point.d3, point.d3 + 3, 0.0);
  cells_.push_back(point);
}

std::vector<Cell> CellMaker::take() {
  close_group();
  return std::move(cells_);
}

/// Speed v <= v where cubic v^3 + square v^2 + linear v <= room. The left side is convex: Newton from above.
double solve_cubic(double v, double cubic, double square, double linear, double room) {
  if (((cubic * v + square) * v + linear) * v <= room) return v;
  if (linear > 0) v = std::min(v, room / linear);
  if (square > 0) v = std::min(v, std::sqrt(room / square));
  if (cubic > 0) v = std::min(v, std::cbrt(room / cubic));
  for (int i = 0; i < 20; ++i) {
    const double f = ((cubic * v + square) * v + linear) * v - room;
    const double slope = (3 * cubic * v + 2 * square) * v + linear;
    if (!(f > 1e-9 * room) || !(slope > 0)) break;
    v -= f / slope;
  }
  return v;
}

}  // namespace

std::vector<Cell> make_cells(const Track& track, const TrackRun& run, const Limits& limits) {
  CellMaker maker(track, limits);
  for (std::size_t i = run.first; i < run.end; ++i) {
    if (i > run.first)
      maker.between(track.junctions[i - 1], track.pieces[i].start,
                    std::min(track.feed[i - 1], track.feed[i]));
    maker.piece(i);
  }
  return maker.take();
}

CellLimit cell_limit(const Cell& cell, const Limits& limits, double tau, double reserve) {
  const double t = limits.period_s, jerk = limits.jerk_mm_s3, accel = limits.accel_mm_s2;
  const double nominal = std::min(accel, jerk * tau);
  double v = std::min(cell.feed, chord_speed(cell.curvature, limits));
  for (int k = 0; k < 3; ++k) {
    if (cell.d1[k] > 0) v = std::min(v, limits.axis_velocity_mm_s / cell.d1[k]);
    v = std::min(v, 4 * limits.chord_error_mm / (t * std::max(cell.turn[k], 1e-300)));
    v = solve_cubic(v, cell.d3[k], cell.bend[k] / t,
                    cell.turn[k] / (t * t) + 3 * cell.d2[k] * reserve * nominal,
                    jerk - reserve * std::min(cell.d1[k], 1.0) * nominal / tau);
    v = solve_cubic(v, 0, cell.d2[k], cell.turn[k] / t,
                    accel - reserve * std::min(cell.d1[k], 1.0) * nominal);
  }
  v = std::min(std::max(v * cell.slow, safe_speed(limits)), cell.feed);
  double a = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double used = cell.turn[k] * v / t;
    const double jerk_left = jerk - (cell.d3[k] * v + cell.bend[k] / t) * v * v - used / t;
    const double accel_left = accel - cell.d2[k] * v * v - used;
    const double per_jerk = 3 * cell.d2[k] * v + cell.d1[k] / tau;
    if (per_jerk > 0) a = std::min(a, jerk_left / per_jerk);
    if (cell.d1[k] > 0) a = std::min(a, accel_left / cell.d1[k]);
  }
  constexpr double kLeast = 0.05;  // of the reserve: a place that leaves nothing must still be left
  a = std::max(std::isfinite(a) ? a : nominal, kLeast * reserve * nominal);
  return {v, a * cell.soft};
}

}  // namespace burin::servo
