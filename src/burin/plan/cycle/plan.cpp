// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <deque>
#include <new>
#include <set>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/plan/cycle/cycle.h"
#include "burin/plan/cycle/order.h"

namespace burin::cycle {
namespace {

using geom::Direction;

std::string mm(double value) {
  return format_fixed(value, 3);
}

Result<void> check(const geom::Composite& composite, Point3 start, const PlanOptions& o) {
  const auto usage = [](std::string message) { return Error{ErrorCode::usage, std::move(message), {}}; };
  const auto finite = [](double x) { return std::isfinite(x); };
  if (composite.surfaces.empty())
    return Error{ErrorCode::geometry, "there is no surface to machine (at least one)", {}};
  if (!(o.tool_diameter > 0 && finite(o.tool_diameter)))
    return usage("the tool diameter D must be positive (mm, e.g. 6)");
  const double radius = 0.5 * o.tool_diameter;
  if (!(o.scallop > 0 && finite(o.scallop)))
    return usage("the scallop height S must be positive (mm, e.g. 0.01)");
  if (!(o.scallop < radius))
    return usage("the scallop height S = " + format_shortest(o.scallop) +
                 " is not below the tool's radius (less than " + format_shortest(radius) + ")");
  if (!(finite(o.stock) && radius + o.stock > 0))
    return usage("the stock L must be a number above minus the tool's radius (e.g. 0)");
  if (o.side_step && !(*o.side_step > 0 && finite(*o.side_step)))
    return usage("the side step M must be positive (mm, or left out)");
  if (!(o.tolerance_mm > 0 && finite(o.tolerance_mm)))
    return usage("the tolerance must be positive (mm, e.g. 0.01)");
  if (!(o.path_mm > 0 && finite(o.path_mm))) return usage("path_mm must be positive (mm, e.g. 1e-6)");
  if (o.max_paths == 0) return usage("at least one path must be allowed (max_paths > 0)");
  if (!finite(o.safety_z)) return usage("the safety height W must be a number (mm)");
  if (!is_finite(start)) return usage("the start must be a point (three numbers, mm)");
  return {};
}

Motion straight(MotionKind kind, Point3 from, Point3 to) {
  Motion motion;
  motion.kind = kind;
  motion.path = geom::straight(from, to);
  return motion;
}

/// One surface planned in one direction.
struct SheetPlan {
  Along along = Along::u;
  std::vector<Chain> chains;
  std::vector<PairFigures> pairs;
  std::size_t paths = 0;
  double length = 0;  ///< cut, links and the ways over the safety height
};

class SurfacePlanner {
 public:
  SurfacePlanner(const geom::Composite& composite, const std::vector<Trim>& trims, const PlanOptions& options,
                 Diagnostics& diagnostics)
      : composite_(composite),
        options_(options),
        diagnostics_(diagnostics),
        radius_(0.5 * options.tool_diameter) {
    for (const geom::JoinedSurface& s : composite.surfaces) regions_.emplace_back(s, trims);
    // The cusp is found from the path: a thousandth of it must not be the path's error.
    path_mm_ = std::min(options.path_mm, 1e-3 * options.scallop);
  }

  Result<SurfacePlan> run(Point3 start) {
    SurfacePlan plan;
    std::vector<Chain> chains;
    std::size_t steep = 0;
    for (std::size_t i = 0; i < composite_.surfaces.size(); ++i) {
      const double sign = side_that_looks_up(composite_.surfaces[i].surface);
      if (sign == 0) {
        ++steep;
        diagnostics_.left_out("surface_steep",
                              "surface " + std::to_string(i + 1) +
                                  " is vertical or degenerate everywhere and is not machined "
                                  "(its normal would have to look up somewhere)");
        continue;
      }
      Result<SheetPlan> s = best_plan(i, sign);
      if (!s) return s.error();
      take(*s, i, plan, chains);
    }
    if (steep == composite_.surfaces.size())
      return Error{ErrorCode::geometry,
                   "no surface has a side that looks up (the normal must have a part along +Z in the middle)",
                   {}};
    if (chains.empty())
      return Error{ErrorCode::geometry,
                   "nothing is left to machine inside the trimming loops (at least one path)",
                   {}};
    const double highest = lift_all(chains, plan);
    if (highest > options_.safety_z + 1e-9)
      return Error{ErrorCode::usage,
                   "the safety height W = " + mm(options_.safety_z) +
                       " lies below the highest place of the tool's tip, " + mm(highest) +
                       " (W of at least that would be accepted)",
                   {}};
    assemble(chains, start, plan);
    return plan;
  }

 private:
  Result<SheetPlan> best_plan(std::size_t i, double sign) {
    if (options_.along != Along::automatic)
      return plan_sheet(i, sign, options_.along == Along::u ? Direction::u : Direction::v);
    Result<SheetPlan> u = plan_sheet(i, sign, Direction::u);
    Result<SheetPlan> v = plan_sheet(i, sign, Direction::v);
    if (!u) return v;
    if (!v) return u;
    // A direction that leaves too much somewhere is only taken when the other leaves more.
    const double left_u = most_left(*u), left_v = most_left(*v), allowed = kAbove * options_.scallop;
    if (std::max(left_u, left_v) > allowed) return left_v < left_u ? std::move(v) : std::move(u);
    return v->length < u->length ? std::move(v) : std::move(u);
  }

  // What a path may leave before it is said (I2 promises two per cent).
  static constexpr double kAbove = 1.03;
  static double most_left(const SheetPlan& plan) {
    double most = 0;
    for (const PairFigures& f : plan.pairs) most = std::max(most, f.scallop_max);
    return most;
  }

  Result<SheetPlan> plan_sheet(std::size_t index, double sign, Direction along) {
    const Region& region = regions_[index];
    SheetPlan out;
    out.along = along == Direction::u ? Along::u : Along::v;
    sheets_.emplace_back(composite_.surfaces[index].surface, along, sign, radius_, options_.stock);
    const Sheet& sheet = sheets_.back();
    const PassTask task = task_of(sheet, region);
    if (!(task.t.length() > 0 && task.w.length() > 0)) return out;
    Result<Passes> passes =
        options_.method == Method::iso_parametric ? iso_parametric(sheet, task) : iso_scallop(sheet, task);
    if (!passes) return passes.error();
    out.pairs = passes->pairs;
    out.paths = passes->passes.size();
    std::vector<Stretch> parts = stretches(*passes, region, along);
    out.chains = order(sheet, static_cast<int>(index), std::move(parts), out.pairs, region, path_mm_);
    for (const Chain& c : out.chains) {
      for (const ChainPiece& p : c) out.length += geom::length(p.track.tip);
      out.length += std::abs(options_.safety_z - c.front().track.tip.start().z) +
                    std::abs(options_.safety_z - c.back().track.tip.end().z);
    }
    return out;
  }

  PassTask task_of(const Sheet& sheet, const Region& region) const {
    PassTask task;
    const bool u = sheet.along() == Direction::u;
    task.t = u ? region.u_range() : region.v_range();
    task.w = u ? region.v_range() : region.u_range();
    task.scallop = options_.scallop;
    task.side_step = options_.side_step;
    task.tight_step = std::sqrt(8 * radius_ * options_.scallop);
    task.path_mm = path_mm_;
    task.max_paths = options_.max_paths;
    // A loop is touched by the line through its outermost point in that point only: the first path lies
    // nearly half a step inside, from where it covers the point.
    constexpr double kInset = 0.45;
    const double tm = 0.5 * (task.t.lo + task.t.hi);
    if (task.w.lo > sheet.w_range().lo) task.w.lo += kInset * first_step(sheet, task, tm, task.w.lo);
    if (task.w.hi < sheet.w_range().hi) task.w.hi -= kInset * first_step(sheet, task, tm, task.w.hi);
    return task;
  }

  void take(SheetPlan& s, std::size_t index, SurfacePlan& plan, std::vector<Chain>& chains) {
    if (chains.empty()) plan.along = s.along;
    if (s.chains.empty())
      diagnostics_.left_out("surface_empty",
                            "surface " + std::to_string(index + 1) +
                                " has nothing inside its trimming loops and is not machined");
    plan.paths += s.paths;
    if (const double left = most_left(s); left > kAbove * options_.scallop)
      diagnostics_.info("scallop_above",
                        "surface " + std::to_string(index + 1) + ": up to " + format_fixed(left, 4) +
                            " mm are left somewhere, above S = " + format_shortest(options_.scallop) +
                            " (I1 keeps it; or a smaller S, or a smaller tool)");
    for (std::size_t k = 0; k < s.pairs.size(); ++k) {
      const PairFigures& f = s.pairs[k];
      // Nowhere between these two does the ball fit the surface, so that nothing is known.
      if (f.scallop_min == kNoOverlap) continue;
      plan.figures.push_back({static_cast<int>(index), static_cast<int>(k) + 1, f.scallop_min, f.scallop_max,
                              f.side_step_max, f.last, f.side_step_binds});
    }
    for (Chain& c : s.chains) chains.push_back(std::move(c));
  }

  // Returns the highest place that the tool must clear.
  double lift_all(std::vector<Chain>& chains, SurfacePlan& plan) {
    // Cells this flat are told apart from the tolerance without a closer look.
    const Obstacles obstacles(composite_, regions_, radius_, options_.stock, 0.25 * options_.tolerance_mm);
    LiftReport report;
    double highest = obstacles.top();
    for (Chain& c : chains) {
      lift(c, obstacles, radius_, options_.tolerance_mm, report);
      for (const ChainPiece& p : c)
        for (const geom::QuinticNode& n : p.track.tip.nodes) highest = std::max(highest, n.p.z);
    }
    plan.gouge_max_mm = report.gouge_max;
    std::set<std::pair<int, int>> lifted;
    for (const Chain& c : chains)
      for (const ChainPiece& p : c) {
        if (!(p.lift_max > 0)) continue;
        plan.lift_max_mm = std::max(plan.lift_max_mm, p.lift_max);
        if (p.pass >= 0) lifted.insert({p.surface, p.pass});
      }
    plan.lifted = lifted.size();
    describe(report, lifted);
    return highest;
  }

  void describe(const LiftReport& report, const std::set<std::pair<int, int>>& lifted) {
    for (int i = 0; i < static_cast<int>(composite_.surfaces.size()); ++i) {
      const LiftPlace* most = nullptr;
      for (const LiftPlace& p : report.places)
        if (p.surface == i && (most == nullptr || p.height > most->height)) most = &p;
      if (most == nullptr) continue;
      const auto count =
          std::count_if(lifted.begin(), lifted.end(), [i](const auto& l) { return l.first == i; });
      Warning w;
      w.code = "lifted";
      w.message = "surface " + std::to_string(i + 1) + ": " + std::to_string(count) +
                  " paths were lifted where the ball would have gouged, at most by " + mm(most->height) +
                  " mm at X" + mm(most->at.x) + " Y" + mm(most->at.y) + " Z" + mm(most->at.z);
      w.position_mm = {most->at.x, most->at.y, most->at.z};
      diagnostics_.add(std::move(w));
    }
  }

  /// Appends, and adds the length to its sum.
  static void put(Motion motion, SurfacePlan& plan) {
    double& sum = motion.kind == MotionKind::rapid ? plan.rapid_mm
                  : motion.kind == MotionKind::cut ? plan.cut_mm
                                                   : plan.link_mm;
    sum += geom::length(motion.path);
    plan.motions.push_back(std::move(motion));
  }

  void assemble(std::vector<Chain>& chains, Point3 at, SurfacePlan& plan) const {
    for (Chain& c : chains) {
      const Point3 first = c.front().track.tip.start();
      const Point3 over{first.x, first.y, options_.safety_z};
      for (Motion& m : approach(at, over, options_.safety_z)) put(std::move(m), plan);
      if (first != over) put(straight(MotionKind::plunge, over, first), plan);
      for (ChainPiece& p : c) {
        Motion m;
        m.kind = p.kind;
        m.path = std::move(p.track.tip);
        m.uv = std::move(p.track.uv);
        m.surface = p.surface;
        m.pass = p.pass;
        m.lift_max = p.lift_max;
        at = m.path.end();
        put(std::move(m), plan);
      }
      const Point3 above{at.x, at.y, options_.safety_z};
      if (at != above) put(straight(MotionKind::rapid, at, above), plan);
      at = above;
    }
  }

  const geom::Composite& composite_;
  const PlanOptions& options_;
  Diagnostics& diagnostics_;
  double radius_;
  double path_mm_ = 1e-6;
  std::vector<Region> regions_;
  std::deque<Sheet> sheets_;  ///< chains point into it
};

}  // namespace

std::vector<Motion> approach(Point3 from, Point3 to, double safety_z) {
  const double travel = std::max(from.z, safety_z);
  std::vector<Motion> motions;
  Point3 at = from;
  for (const Point3 next : {Point3{from.x, from.y, travel}, Point3{to.x, to.y, travel}, to}) {
    if (at != next) motions.push_back(straight(MotionKind::rapid, at, next));
    at = next;
  }
  return motions;
}

Result<SurfacePlan> plan(const geom::Composite& composite, const std::vector<Trim>& trims, geom::Point3 start,
                         const PlanOptions& options, Diagnostics& diagnostics) {
  if (const Result<void> ok = check(composite, start, options); !ok) return ok.error();
  for (const geom::JoinedSurface& s : composite.surfaces)
    if (const Result<void> ok = geom::validate(s.surface); !ok) return ok.error();
  try {
    return SurfacePlanner(composite, trims, options, diagnostics).run(start);
  } catch (const std::bad_alloc&) {
    return Error{
        ErrorCode::range, "the plan needs more memory than there is (a larger scallop S or side step M)", {}};
  }
}

}  // namespace burin::cycle
