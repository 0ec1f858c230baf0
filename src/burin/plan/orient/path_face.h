// SPDX-License-Identifier: Apache-2.0
// One design face as the path families see it: contacts with normals on the tool's side and curvatures,
// whether a place lies within the trims, how far it is from the border. Internal to paths.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "burin/geom/surface/evaluate.h"
#include "burin/plan/orient/paths.h"

namespace burin::orient::detail {

using geom::Point2;
using geom::Point3;
using geom::Vec2;
using geom::Vec3;

/// A contact with its parameters.
struct Node {
  Point2 uv;
  Vec2 way;  ///< direction of the path in (u, v)
  CcPoint cc;
};

class PathFace {
 public:
  PathFace(const DesignFace& face, double edge_mm);

  const geom::NurbsSurface& surface() const { return surface_; }
  geom::Interval u() const { return u_; }
  geom::Interval v() const { return v_; }
  bool closed(geom::Direction d) const { return d == geom::Direction::u ? closed_u_ : closed_v_; }
  double sign() const { return sign_; }
  double size() const { return size_; }
  /// Box of the trims, the domain when there are none.
  geom::Box2 window() const { return window_; }
  const std::vector<std::vector<Point2>>& trims() const { return trims_; }
  bool inside(Point2 uv) const;
  /// inside() and at least edge_mm from the border.
  bool kept(geom::SurfaceEvaluator& evaluator, Point2 uv) const;
  bool has_edge() const { return edge_ > 0; }

  geom::SurfaceEvaluator evaluator() const { return evaluator_; }
  /// Nothing where no normal or no direction exists.
  std::optional<CcPoint> contact(geom::SurfaceEvaluator& evaluator, Point2 uv, Vec2 way) const;
  Vec3 normal(const geom::SurfaceDerivatives& d, Point2 uv) const;
  /// Back into the domain: round where it is closed, else to its end.
  Point2 wrapped(Point2 uv) const;
  /// Coefficients of a tangent vector in (Su, Sv), by least squares.
  static Vec2 coefficients(const geom::SurfaceDerivatives& d, Vec3 tangent);

 private:
  Point2 pulled_inside(Point2 uv, double share) const;
  void find_border();

  geom::NurbsSurface surface_;
  geom::Interval u_, v_;
  geom::SurfaceEvaluator evaluator_;
  double sign_ = 1, edge_ = 0, size_ = 0;
  bool closed_u_ = false, closed_v_ = false;
  std::vector<std::vector<Point2>> trims_;
  geom::Box2 window_;
  std::vector<std::pair<Point3, Point3>> border_;
};

/// The node between two neighbours on the path; nothing: no further refinement there.
using Between = std::function<std::optional<Node>(const Node&, const Node&)>;
/// `per_span` parameters to each span of the knots in `part`, both ends included; long knot vectors: to
/// several spans together.
std::vector<double> span_places(const std::vector<double>& knots, geom::Interval part, int per_span);
/// The stretches of a path that are kept(), their ends found by halving.
std::vector<std::vector<Node>> kept_runs(const PathFace& face, geom::SurfaceEvaluator& evaluator,
                                         std::vector<Node> nodes, const Between& between);
/// At least two points, and not all in one place.
bool has_length(const std::vector<CcPoint>& points, double size);
/// Puts nodes between those of a path until there are more than enough for the options' limits (and, where a
/// distance from the border is to be kept, until the stretches in between cannot miss it by much).
std::vector<Node> refined(const std::vector<Node>& coarse, const Between& between,
                          const PathOptions& options);
/// Leaves out what the limits do not need: a polyline within chord_mm of the path.
std::vector<CcPoint> thinned(const std::vector<Node>& dense, const PathOptions& options);

}  // namespace burin::orient::detail
