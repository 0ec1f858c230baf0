// SPDX-License-Identifier: Apache-2.0
#include "burin/job/curve_path.h"

#include <cmath>
#include <limits>

#include "burin/geom/surface/evaluate.h"

namespace burin::job {
namespace {

// A span halved this often is shorter than any servo step.
constexpr int kMaxHalvings = 16;

geom::QuinticNode node_at(const geom::NurbsCurve& curve, double t, geom::Side side) {
  const geom::CurveDerivatives d = geom::derivatives(curve, t, side);
  return {t, d.p, d.d1, d.d2};
}

/// Whether the quintic between two nodes follows the curve.
bool follows(const geom::NurbsCurve& curve, const geom::QuinticNode& a, const geom::QuinticNode& b,
             double tolerance) {
  const geom::QuinticPath piece{{a, b}};
  for (const double x : {0.2, 0.35, 0.5, 0.65, 0.8}) {
    const geom::Point3 exact = geom::point(curve, a.t + x * (b.t - a.t));
    if (!(distance(geom::evaluate_piece(piece, 0, x).p, exact) <= tolerance)) return false;
  }
  return true;
}

void add_span(const geom::NurbsCurve& curve, const geom::QuinticNode& b, double tolerance, int halvings,
              geom::QuinticPath& path) {
  const geom::QuinticNode a = path.nodes.back();
  if (halvings > 0 && !follows(curve, a, b, tolerance)) {
    add_span(curve, node_at(curve, 0.5 * (a.t + b.t), geom::Side::right), tolerance, halvings - 1, path);
    add_span(curve, b, tolerance, halvings - 1, path);
    return;
  }
  path.nodes.push_back(b);
}

CurvePiece finish(geom::QuinticPath path) {
  CurvePiece piece;
  for (const geom::QuinticNode& node : path.nodes)
    piece.parameter.nodes.push_back(
        {node.t, {node.t, std::numeric_limits<double>::quiet_NaN(), 0}, {1, 0, 0}, {}});
  piece.path = std::move(path);
  return piece;
}

}  // namespace

std::vector<CurvePiece> curve_path(const geom::NurbsCurve& curve, double tolerance_mm) {
  std::vector<CurvePiece> pieces;
  const geom::Interval domain = curve.domain();
  std::vector<geom::Knot> stops = geom::inner_knots(curve.knots, curve.degree);
  stops.push_back({domain.hi, curve.degree});
  geom::QuinticPath path{{node_at(curve, domain.lo, geom::Side::right)}};
  for (const geom::Knot& knot : stops) {
    add_span(curve, node_at(curve, knot.value, geom::Side::left), tolerance_mm, kMaxHalvings, path);
    if (curve.degree - knot.multiplicity >= 2) continue;  // C2 here
    pieces.push_back(finish(std::move(path)));
    path = {{node_at(curve, knot.value, geom::Side::right)}};
  }
  return pieces;
}

}  // namespace burin::job
