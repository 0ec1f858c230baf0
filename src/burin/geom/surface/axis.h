// SPDX-License-Identifier: Apache-2.0
// One parameter direction of a surface, cut into its polynomial pieces: where a parameter lies, and the
// matrices that turn the control points of a piece into Bezier points and into coefficients of powers.
// Internal to geom/surface.
#pragma once

#include <cstdint>
#include <vector>

namespace burin::geom::detail {

/// Up to this degree a piece may be held in powers; more powers amplify rounding more.
inline constexpr int kMaxPowerDegree = 5;
/// [degree]: bound of the sum of |coefficients of powers of x| in [-1, 1] for Bernstein coefficients of
/// magnitude up to 1: the factor by which powers amplify rounding.
inline constexpr double kPowerGrowth[kMaxPowerDegree + 1] = {1, 2, 3, 5, 6.5, 10.75};

class Axis {
 public:
  Axis(const std::vector<double>& knots, int degree);

  int degree() const { return degree_; }
  int pieces() const { return static_cast<int>(first_.size()); }
  double lo(int piece) const { return breaks_[static_cast<std::size_t>(piece)]; }
  double hi(int piece) const { return breaks_[static_cast<std::size_t>(piece) + 1]; }
  /// The first number above the piece that does not belong to it: hi, but for the last piece.
  double above(int piece) const { return piece + 1 < pieces() ? hi(piece) : above_end_; }
  /// Index of the first of the degree + 1 control points that act on the piece.
  int first_point(int piece) const { return first_[static_cast<std::size_t>(piece)]; }
  /// Piece with lo <= t < hi; the first or last one outside the domain; 0 when t is not a number.
  int piece(double t) const;

  /// (degree + 1)^2 numbers, row r: weights of the control points in Bezier point r (never negative, sum 1).
  /// `space` is used when there is no table.
  const double* bezier(int piece, std::vector<double>& space) const;
  /// The same for the coefficient of (t - middle)^r. Only for degree <= kMaxPowerDegree.
  const double* power(int piece, std::vector<double>& space) const;
  double middle(int piece) const { return 0.5 * lo(piece) + 0.5 * hi(piece); }

 private:
  int bucket(double t) const;
  void make_lookup();
  void make_bezier(int piece, double* out) const;
  void make_power(int piece, double* out) const;

  int degree_ = 0;
  std::vector<double> knots_, breaks_;
  std::vector<int> first_;
  double above_end_ = 0;
  double scale_ = 0;                    // buckets per unit of the parameter
  std::vector<std::int32_t> last_;      // per bucket: the last piece that starts in it or before it
  std::vector<double> bezier_, power_;  // tables, empty when they would be large
};

}  // namespace burin::geom::detail
