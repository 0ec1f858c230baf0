// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/motion_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "burin/geom/point_tools.h"
#include "burin/verify/sample_grid.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Of what stands a window's width off, this share.
constexpr double kFarShare = 0.002;

/// The tool at one moment, part frame.
struct Placed {
  Point3 center;
  Vec3 axis;
};

class Check {
 public:
  Check(const SampledDesign& design, const std::vector<CheckedMove>& moves,
        const kinematics::Kinematics& machine, const BallEndTool& tool, const MotionCheckOptions& options)
      : design_(design), moves_(moves), machine_(machine), tool_(tool), options_(options) {
    for (const DesignSample& s : design.samples) bounds_.add(s.p);
    reach_ = reach();
    ball_.assign(design.samples.size(), std::numeric_limits<float>::infinity());
    body_.assign(design.samples.size(), 0.0F);
  }

  MotionCheckReport run() {
    std::vector<std::uint32_t> all(design_.samples.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
    const SampleGrid grid(design_.samples, all, std::max(0.25 * tool_.radius, 4 * design_.spacing_mm));
    // What stands farther from the ball's way than a small window is looked for again with wider ones, by
    // itself.
    double window = std::min(options_.window_mm, 0.25 * tool_.radius);
    for_each_step(options_.motion_mm, false, [&](const Placed& a, const Placed& b, std::size_t move) {
      sweep_ball(grid, a, b, move, window);
    });
    if (!tool_.cylinders.empty())
      for_each_step(options_.motion_mm, true, [&](const Placed& a, const Placed& b, std::size_t move) {
        sweep_body(grid, a, b, move);
      });
    while (window < options_.window_mm) {
      window = std::min(options_.window_mm, 4 * window);
      std::vector<std::uint32_t> rest;
      for (std::size_t i = 0; i < ball_.size(); ++i)
        if (std::isinf(ball_[i]) && design_.samples[i].machined)
          rest.push_back(static_cast<std::uint32_t>(i));
      if (rest.empty()) break;
      const SampleGrid left(design_.samples, rest, std::max(window, 4 * design_.spacing_mm));
      // What stands that high need not be known to the micrometre.
      const double bend_mm = std::max(options_.motion_mm, kFarShare * window);
      for_each_step(bend_mm, false, [&](const Placed& a, const Placed& b, std::size_t move) {
        if (moves_[move].cutting) sweep_ball(left, a, b, move, window);
      });
    }
    return report();
  }

 private:
  /// Straight steps from which the true motion is bent by less than motion_mm, as far as the part reaches.
  template <class Step>
  void for_each_step(double bend_mm, bool bodies, Step&& step) const {
    for (std::size_t m = 1; m < moves_.size(); ++m) {
      const kinematics::Joints &from = moves_[m - 1].to, &to = moves_[m].to;
      const int count = steps(from, to, bend_mm, bodies);
      Placed a = placed(from, to, 0);
      for (int k = 1; k <= count; ++k) {
        const Placed b = placed(from, to, static_cast<double>(k) / count);
        step(a, b, m);
        a = b;
      }
    }
  }

  /// How far from the rotary axes things can happen: the part's corners, and what the ball touches beside
  /// them.
  double reach() const {
    double most = 0;
    for (int i = 0; i < machine_.rotary_count(); ++i) {
      const model::Axis& axis = machine_.rotary_axis(i);
      for (int corner = 0; corner < 8; ++corner) {
        const Point3 p{corner & 1 ? bounds_.hi.x : bounds_.lo.x, corner & 2 ? bounds_.hi.y : bounds_.lo.y,
                       corner & 4 ? bounds_.hi.z : bounds_.lo.z};
        const Vec3 v = p - axis.point;
        const bool table = axis.side == model::AxisSide::table;
        // A head turns the tool about a point that goes with it.
        most = std::max(most, table ? norm(v - dot(v, axis.direction) * axis.direction)
                                    : machine_.machine().pivot_length + bounds_.diagonal());
      }
    }
    return most + 2 * tool_.radius;
  }

  Placed placed(const kinematics::Joints& from, const kinematics::Joints& to, double t) const {
    kinematics::Joints j;
    for (std::size_t i = 0; i < 3; ++i) j.linear[i] = from.linear[i] + t * (to.linear[i] - from.linear[i]);
    for (std::size_t i = 0; i < 2; ++i) j.rotary[i] = from.rotary[i] + t * (to.rotary[i] - from.rotary[i]);
    const cl::Pose pose = machine_.forward(j);
    return {pose.tip + tool_.radius * pose.axis, pose.axis};
  }

  /// A point of the tool at distance r from the rotary axis goes along an arc: sagitta r turn^2 / 8, and with
  /// a linear travel s during the turn at most s turn / 4 more (the chord's middle turned against it). Parts
  /// of the tool beyond the part do not matter.
  int steps(const kinematics::Joints& from, const kinematics::Joints& to, double bend_mm, bool bodies) const {
    double turn = 0, travel = 0;
    for (std::size_t i = 0; i < 2; ++i) turn += std::abs(to.rotary[i] - from.rotary[i]);
    for (std::size_t i = 0; i < 3; ++i) travel = std::hypot(travel, to.linear[i] - from.linear[i]);
    const double bend = reach_ * turn * turn / 8 + travel * turn / 4;
    double count = std::ceil(std::sqrt(bend / bend_mm));
    // Cylinders are looked at in places: between them a wall of radius r is missed by h^2 / (8 r).
    double least = std::numeric_limits<double>::infinity();
    for (const ToolCylinder& c : tool_.cylinders) least = std::min(least, c.radius);
    if (bodies && !std::isinf(least))
      count = std::max(count, std::ceil((travel + reach_ * turn) / std::sqrt(8 * least * bend_mm)));
    return static_cast<int>(std::clamp(count, 1.0, 1e6));
  }

  void sweep_ball(const SampleGrid& grid, const Placed& a, const Placed& b, std::size_t move, double window) {
    const double within = tool_.radius + window;
    geom::Box3 box;
    box.add(a.center);
    box.add(b.center);
    const bool cutting = moves_[move].cutting;
    grid.query(
        box.grown(within),
        [&](Point3 p, double half) { return distance_to_segment(p, a.center, b.center) <= within + half; },
        [&](const SampleGrid::Item& item) {
          const double d = distance_to_segment(item.p, a.center, b.center) - tool_.radius;
          if (d > window) return;
          if (-d > out_.ball.mm) out_.ball = {-d, item.p, move};
          if (!cutting && d > 0) return;  // passing by leaves nothing cut
          ball_[item.index] = std::min(ball_[item.index], static_cast<float>(d));
        });
  }

  /// The place in the middle of the step stands for it.
  void sweep_body(const SampleGrid& grid, const Placed& a, const Placed& b, std::size_t move) {
    const Point3 center = lerp(a.center, b.center, 0.5);
    const Vec3 axis = unit(a.axis + b.axis);
    for (const ToolCylinder& c : tool_.cylinders) {
      const double top = std::min(c.to, c.from + reach_along(center, axis));
      const Point3 low = center + c.from * axis, high = center + top * axis;
      geom::Box3 box;
      box.add(low);
      box.add(high);
      Finding& worst = c.holder ? out_.holder : out_.shank;
      grid.query(
          box.grown(c.radius),
          [&](Point3 p, double half) { return distance_to_segment(p, low, high) <= c.radius + half; },
          [&](const SampleGrid::Item& item) {
            const Vec3 from = item.p - center;
            const double h = dot(from, axis);
            if (h <= c.from || h >= c.to) return;
            const double depth = std::min({c.radius - norm(from - h * axis), h - c.from, c.to - h});
            if (depth <= 0) return;
            if (depth > worst.mm) worst = {depth, item.p, move};
            body_[item.index] = std::max(body_[item.index], static_cast<float>(depth));
          });
    }
  }

  /// No sample is farther along the axis than this.
  double reach_along(Point3 center, Vec3) const {
    const Point3 middle = lerp(bounds_.lo, bounds_.hi, 0.5);
    return geom::distance(center, middle) + 0.5 * bounds_.diagonal();
  }

  MotionCheckReport report() {
    out_.deviation_mm.resize(ball_.size());
    for (std::size_t i = 0; i < ball_.size(); ++i) {
      const double d = std::min(static_cast<double>(ball_[i]), options_.window_mm);
      if (design_.samples[i].machined && d > out_.excess_max_mm) {
        out_.excess_max_mm = d;
        out_.excess_at = design_.samples[i].p;
      }
      out_.deviation_mm[i] =
          body_[i] > 0 ? std::min(static_cast<float>(d), -body_[i]) : static_cast<float>(d);
    }
    double least = tool_.radius;
    for (const ToolCylinder& c : tool_.cylinders) least = std::min(least, c.radius);
    out_.bound_mm = design_.spacing_mm * design_.spacing_mm / (4 * least) + options_.motion_mm;
    return std::move(out_);
  }

  const SampledDesign& design_;
  const std::vector<CheckedMove>& moves_;
  const kinematics::Kinematics& machine_;
  const BallEndTool& tool_;
  const MotionCheckOptions& options_;
  geom::Box3 bounds_;
  double reach_ = 0;
  std::vector<float> ball_, body_;
  MotionCheckReport out_;
};

}  // namespace

SampledDesign sample_mesh(const geom::Mesh& mesh, const std::vector<bool>& machined, double spacing_mm,
                          std::size_t max_samples) {
  SampledDesign design;
  design.spacing_mm = spacing_mm;
  // Rows from the corner opposite to the shortest side towards it, so that slivers cost no more than their
  // area; the triangle's own corners, where gouges are deepest, are among them.
  const auto each = [&](std::size_t t, auto&& row) {
    const auto& tri = mesh.triangles[t];
    std::array<Point3, 3> c{mesh.vertices[tri[0]], mesh.vertices[tri[1]], mesh.vertices[tri[2]]};
    const auto opposite = [&](std::size_t i) { return distance(c[(i + 1) % 3], c[(i + 2) % 3]); };
    std::size_t apex = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (opposite(i) < opposite(apex)) apex = i;
    const Point3 p = c[apex], q = c[(apex + 1) % 3], r = c[(apex + 2) % 3];
    const double rows =
        std::max(1.0, std::ceil(std::max(distance(p, q), distance(p, r)) / design.spacing_mm));
    for (double i = 0; i <= rows; ++i) {
      const Point3 from = lerp(p, q, i / rows), to = lerp(p, r, i / rows);
      row(from, to, std::ceil(distance(from, to) / design.spacing_mm));
    }
  };
  for (;;) {
    double count = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      each(t, [&count](Point3, Point3, double parts) { count += parts + 1; });
    if (count <= static_cast<double>(max_samples) ||
        count <= 4.01 * static_cast<double>(mesh.triangles.size()))
      break;
    design.spacing_mm *= 1.25;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool wanted = machined.empty() || machined[t];
    each(t, [&](Point3 from, Point3 to, double parts) {
      for (double i = 0; i <= parts; ++i)
        design.samples.push_back({parts > 0 ? lerp(from, to, i / parts) : from, wanted});
    });
  }
  return design;
}

double MotionCheckReport::gouge_max_mm() const {
  return std::max({ball.mm, shank.mm, holder.mm});
}

MotionCheckReport check_motion(const SampledDesign& design, const std::vector<CheckedMove>& moves,
                               const kinematics::Kinematics& machine, const BallEndTool& tool,
                               const MotionCheckOptions& options) {
  return Check(design, moves, machine, tool, options).run();
}

}  // namespace burin::verify
