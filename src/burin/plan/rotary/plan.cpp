// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <memory>

#include "burin/base/parallel.h"
#include "burin/base/text.h"
#include "burin/geom/vec.h"
#include "burin/plan/rotary/links.h"
#include "burin/plan/rotary/path_plan.h"
#include "burin/plan/rotary/rotary.h"
#include "burin/plan/rotary/uncut.h"

namespace burin::rotary {
namespace {

using model::BallTool;

Error error(ErrorCode code, const std::string& message) {
  return Error{code, message, {}};
}

Result<void> check(const Part& part, const BallTool& tool, const RotaryOptions& o) {
  if (auto ok = model::validate(tool); !ok) return ok.error();
  if (part.mesh.triangles.empty())
    return error(ErrorCode::geometry, "the part has no triangles (a closed mesh)");
  if (!(o.tolerance_mm > 0) || !std::isfinite(o.tolerance_mm))
    return error(ErrorCode::usage, "tolerance " + format_shortest(o.tolerance_mm) + " mm (above 0)");
  if (!(o.safety_mm > 0))
    return error(ErrorCode::usage, "safety " + format_shortest(o.safety_mm) + " mm (above 0)");
  if (!(o.clearance >= 0) || !(o.lean >= 0) || o.lean > geom::kPi / 2)
    return error(ErrorCode::usage, "clearance or lean angle (0 or more, lean up to 90 degrees)");
  if (!(o.theta_max > o.theta_min))
    return error(ErrorCode::usage, "limits of the rotary axis (the upper above the lower)");
  if (!(o.feed_mm_min > 0))
    return error(ErrorCode::usage, "feed " + format_shortest(o.feed_mm_min) + " (above 0)");
  if (tool.radius >= part.radius_max)
    return error(ErrorCode::geometry, "the ball's radius " + format_shortest(tool.radius) +
                                          " mm is not smaller than the part's " +
                                          format_fixed(part.radius_max, 3) + " mm (a smaller tool)");
  return {};
}

/// The tool with what it sweeps on its way up along its axis: no part of it is narrower than what is below.
BallTool lifting(const BallTool& tool, double far) {
  BallTool out = tool;
  out.shank_radius = std::max(tool.radius, tool.shank_radius);
  double radius = 0;
  for (model::HolderPiece& piece : out.holder) radius = piece.radius = std::max(radius, piece.radius);
  if (!out.holder.empty()) out.holder.back().height += far;
  return out;
}

// Places that are looked at to say what would fit.
constexpr std::size_t kSample = 200;

/// Whether every place of the sample that the bare tool reaches is reached with this shank length.
bool fits(const geom::Mesh& mesh, BallTool tool, double length, const std::vector<geom::Point3>& centers) {
  tool.shank_length = length;
  const ReachIndex reach(mesh, tool);
  return std::all_of(centers.begin(), centers.end(),
                     [&](const geom::Point3& c) { return !reach.reachable(c).empty(); });
}

// Distances from a swept part are short by at most this share of the tolerance.
constexpr double kDesignShare = 0.005;

/// The first ring of a uniform sweep that no end of the part is near: the others are the same, turned and
/// moved.
class SweptRing {
 public:
  SweptRing(const Shared& shared, const std::vector<ContactPath>& paths) : shared_(shared) {
    if (shared.options.pattern != Pattern::rings || !shared.part.swept || !shared.part.swept->uniform())
      return;
    const auto own = std::find_if(paths.begin(), paths.end(), [&](const auto& p) { return inner(p); });
    if (own == paths.end()) return;
    x_ = own->points.front().p.x;
    base_ = place_path(shared, *own);
  }
  bool holds_for(const ContactPath& path) const { return base_ && inner(path); }
  PathBase at(const ContactPath& path) const {
    const double x = path.points.front().p.x;
    const SweptSection& swept = *shared_.part.swept;
    return swept_along(*base_, swept.turn_at(x) - swept.turn_at(x_), x - x_,
                       (x - x_) / (shared_.part.x_max - shared_.part.x_min));
  }

 private:
  /// A ball that touches the ring has its centre within R of it, and sees R farther.
  bool inner(const ContactPath& path) const {
    if (path.points.empty()) return false;
    const double x = path.points.front().p.x, sees = 2 * shared_.tool.radius;
    return x - sees >= shared_.part.x_min && x + sees <= shared_.part.x_max;
  }
  const Shared& shared_;
  std::optional<PathBase> base_;
  double x_ = 0;
};

class Planner {
 public:
  Planner(const Part& part, const BallTool& tool, const RotaryOptions& options, Diagnostics& diagnostics)
      : part_(part), tool_(tool), options_(options), diagnostics_(diagnostics) {}

  Result<RotaryPlan> run() {
    PatternOptions pattern;
    pattern.pattern = options_.pattern;
    pattern.ball_radius = tool_.radius;
    pattern.scallop = options_.scallop;
    pattern.side_step = options_.side_step;
    pattern.density_mm = std::min(pattern.density_mm, options_.tolerance_mm / 20);
    auto paths = make_paths(part_, pattern, diagnostics_);
    if (!paths) return paths.error();
    const geom::MeshIndex mesh(part_.mesh);
    const BodyIndex body(part_.mesh);
    const ReachIndex reach(part_.mesh, tool_);
    const double far =
        4 * (std::max(part_.radius_max, options_.stock_radius) + options_.safety_mm) + tool_.shank_length;
    const ReachIndex lift(part_.mesh, lifting(tool_, far));
    std::unique_ptr<SectionAxis> section;
    if (options_.tai == Tai::section)
      section = std::make_unique<SectionAxis>(part_.mesh, part_.corner_normals, tool_.radius);
    std::unique_ptr<SweptDistance> design;
    if (part_.swept)
      design = std::make_unique<SweptDistance>(*part_.swept, kDesignShare * options_.tolerance_mm);
    const Shared shared{part_, tool_, options_, mesh, body, reach, lift, design.get(), section.get()};
    follow(shared, paths->paths);
    plan_.quality.scallop_mm = paths->scallop_max;
    plan_.quality.side_step_min_mm = paths->side_step_min;
    plan_.quality.side_step_max_mm = paths->side_step_max;
    if (plan_.counts.cl_points == 0) return nothing_reachable();
    report();
    return std::move(plan_);
  }

 private:
  void follow(const Shared& shared, const std::vector<ContactPath>& paths) {
    Linker linker(shared, plan_);
    // Some at once: what does not depend on where the tool comes from, without holding all of it.
    constexpr std::size_t kBatch = 16;
    // Rings away from the ends of a uniform sweep see the same part: they are placed once.
    const SweptRing first(shared, paths);
    std::vector<PathBase> bases;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      if (i % kBatch == 0) {
        bases.assign(std::min(kBatch, paths.size() - i), {});
        // Paths side by side, or else the points of each.
        const unsigned threads = shared.threads(), inner = bases.size() < threads ? threads : 1;
        parallel_for(bases.size(), threads, [&](std::size_t k, std::size_t) {
          const ContactPath& own = paths[i + k];
          bases[k] = first.holds_for(own) ? first.at(own) : place_path(shared, own);
          add_nodes(shared, bases[k], inner);
        });
      }
      PathPlan path = plan_path(shared, paths[i], std::move(bases[i % kBatch]), linker.at());
      RotaryCounts& c = plan_.counts;
      RotaryQuality& q = plan_.quality;
      c.tsi += path.tsi;
      c.planned_contacts += paths[i].points.size();
      c.ssi_split += path.ssi_split;
      c.halving_points += path.halving_points;
      q.ssi_max_mm = std::max(q.ssi_max_mm, path.ssi_mm);
      q.gouge_max_mm = std::max(q.gouge_max_mm, path.gouge_mm);
      q.excess_max_mm = std::max(q.excess_max_mm, path.excess_mm);
      uncut_.insert(uncut_.end(), path.uncut.begin(), path.uncut.end());
      linker.add(std::move(path), i);
    }
    linker.finish();
    count();
  }

  void count() {
    RotaryCounts& c = plan_.counts;
    for (const RotaryPoint& p : plan_.points) {
      ++c.contact_points;
      if (p.initial_interferes) ++c.tai;
      if (p.place.state == State::moved) ++c.moved;
      if (p.place.state == State::unreachable) ++c.unreachable;
    }
    for (const Leg& leg : plan_.legs) {
      if (leg.kind != LegKind::cut) continue;
      c.cl_points += leg.poses.size();
      turning(leg.poses);
    }
  }

  /// Turning of one cut, and its changes of direction by more than a degree.
  void turning(const std::vector<AxisPose>& poses) {
    constexpr double kReversal = geom::kPi / 180;
    RotaryQuality& q = plan_.quality;
    int direction = 0;
    double extreme = poses.front().theta;
    for (std::size_t i = 1; i < poses.size(); ++i) {
      const double t = poses[i].theta, step = std::abs(t - poses[i - 1].theta);
      q.axis_turn_total += step;
      q.axis_step_max = std::max(q.axis_step_max, step);
      const double from = t - extreme;
      if (std::abs(from) > kReversal && from * direction <= 0) {
        if (direction != 0) ++plan_.counts.axis_reversals;
        direction = from > 0 ? 1 : -1;
      }
      if (from * direction > 0) extreme = t;
    }
  }

  // --- what could not be done

  void report() {
    const double worst = uncut_excess(plan_, uncut_, tool_.radius);
    RotaryQuality& q = plan_.quality;
    q.excess_max_mm = std::max({q.excess_max_mm, worst, q.ssi_max_mm});
    if (plan_.counts.unreachable == 0) return;
    std::string places;
    int shown = 0;
    for (const RotaryPoint& p : plan_.points) {
      if (p.place.state != State::unreachable || shown == 3) continue;
      const geom::Point3 at = p.place.contact.p;
      places += (shown++ > 0 ? "; " : "") + format_fixed(at.x, 3) + ", " + format_fixed(at.y, 3) + ", " +
                format_fixed(at.z, 3);
    }
    diagnostics_.left_out(
        "unreachable", std::to_string(plan_.counts.unreachable) + " of " +
                           std::to_string(plan_.counts.contact_points) +
                           " contact points are not reached by any angle of the tool axis and are not cut; "
                           "up to " +
                           format_fixed(worst, 3) + " mm is left there (first at " + places + ")");
  }

  std::vector<geom::Point3> sample(const ReachIndex& bare) const {
    std::vector<geom::Point3> out;
    const std::size_t stride = std::max<std::size_t>(1, plan_.points.size() / kSample);
    for (std::size_t i = 0; i < plan_.points.size(); i += stride)
      if (!bare.reachable(plan_.points[i].place.center).empty()) out.push_back(plan_.points[i].place.center);
    return out;
  }

  Error nothing_reachable() const {
    BallTool bare = tool_;
    bare.holder.clear();
    const ReachIndex reach(part_.mesh, bare);
    const std::vector<geom::Point3> centers = sample(reach);
    if (tool_.holder.empty() || centers.empty())
      return error(ErrorCode::geometry,
                   "no contact point is reached by any angle of the tool axis (a smaller tool, or a thinner "
                   "shank)");
    // A holder that begins beyond the part's whole width never meets it.
    double low = tool_.shank_length, high = std::max(low, 0.0) + 2 * part_.radius_max + tool_.radius;
    if (!fits(part_.mesh, tool_, high, centers))
      return error(ErrorCode::geometry,
                   "the holder meets the part at every contact point (a slimmer holder)");
    for (int i = 0; i < 12 && high - low > 0.05; ++i) {
      const double middle = (low + high) / 2;
      (fits(part_.mesh, tool_, middle, centers) ? high : low) = middle;
    }
    return error(ErrorCode::geometry, "the holder meets the part at every contact point with a shank of " +
                                          format_shortest(tool_.shank_length) + " mm (a shank_length of " +
                                          format_fixed(std::ceil(high * 10) / 10, 1) + " mm or more)");
  }

  const Part& part_;
  const BallTool& tool_;
  const RotaryOptions& options_;
  Diagnostics& diagnostics_;
  RotaryPlan plan_;
  std::vector<geom::Point3> uncut_;
};

}  // namespace

Result<RotaryPlan> plan(const Part& part, const BallTool& tool, const RotaryOptions& options,
                        Diagnostics& diagnostics) {
  if (auto ok = check(part, tool, options); !ok) return ok.error();
  return Planner(part, tool, options, diagnostics).run();
}

}  // namespace burin::rotary
