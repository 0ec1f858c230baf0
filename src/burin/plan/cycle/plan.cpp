// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>
#include <optional>
#include <set>

#include "burin/base/parallel.h"
#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/plan/cycle/cycle.h"
#include "burin/plan/cycle/estimate.h"
#include "burin/plan/cycle/extend.h"
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
  double length = 0;      ///< cut, links and the ways over the safety height
  bool given_up = false;  ///< longer than another plan that is at hand
};

/// A direction that the paths of a surface may run in.
struct Candidate {
  geom::NurbsSurface whole;  ///< continued over its edges where paths run over them
  std::unique_ptr<Sheet> sheet;
  PassTask task;
  double estimate = 0;  ///< length of its iso-parametric paths
  bool empty() const { return !(task.t.length() > 0 && task.w.length() > 0); }
};

// A direction whose iso-parametric paths would be this much longer than those of the other one is not
// planned: they are as much denser in some places than in others, which I2 inherits.
constexpr double kClearlyLonger = 1.5;
// And this much longer not even when the shorter one leaves too much somewhere: it would cost many times the
// time, and leaves too much as well where its paths crowd.
constexpr double kFarLonger = 3;

class SurfacePlanner {
 public:
  SurfacePlanner(const geom::Composite& composite, const std::vector<Trim>& trims, const PlanOptions& options,
                 Diagnostics& diagnostics)
      : composite_(composite),
        options_(options),
        diagnostics_(diagnostics),
        radius_(0.5 * options.tool_diameter) {
    for (const geom::JoinedSurface& s : composite.surfaces) regions_.emplace_back(s, trims);
    sheets_.resize(2 * composite.surfaces.size());
    // The cusp is found from the path: a thousandth of it must not be the path's error.
    path_mm_ = std::min(options.path_mm, 1e-3 * options.scallop);
  }

  Result<SurfacePlan> run(Point3 start) {
    SurfacePlan plan;
    std::vector<Chain> chains;
    std::size_t steep = 0;
    std::vector<std::optional<Result<SheetPlan>>> sheets = plan_all();
    for (std::size_t i = 0; i < sheets.size(); ++i) {
      if (!sheets[i]) {
        ++steep;
        diagnostics_.left_out("surface_steep",
                              "surface " + std::to_string(i + 1) +
                                  " is vertical or degenerate everywhere and is not machined "
                                  "(its normal would have to look up somewhere)");
        continue;
      }
      if (!*sheets[i]) return sheets[i]->error();
      take(**sheets[i], i, plan, chains);
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
  // Nothing for a surface that does not look up.
  std::vector<std::optional<Result<SheetPlan>>> plan_all() {
    const std::size_t count = composite_.surfaces.size();
    std::vector<std::optional<Result<SheetPlan>>> sheets(count);
    // Surfaces side by side, or else the two directions of one.
    const bool many = count >= 2 * options_.threads;
    const auto plan_one = [&](std::size_t i, std::size_t /*worker*/) {
      const double sign = side_that_looks_up(composite_.surfaces[i].surface);
      if (sign != 0) sheets[i].emplace(best_plan(i, sign, many ? 1 : options_.threads));
    };
    if (!many) {
      for (std::size_t i = 0; i < count; ++i) plan_one(i, 0);
      return sheets;
    }
    // What cannot be done ends the run as it would one after the other.
    parallel_for(count, options_.threads, plan_one);
    return sheets;
  }

  Result<SheetPlan> best_plan(std::size_t i, double sign, unsigned threads) {
    if (options_.along != Along::automatic) {
      const Direction along = options_.along == Along::u ? Direction::u : Direction::v;
      return plan_sheet(i, candidate(i, sign, along));
    }
    std::array<Candidate, 2> c{candidate(i, sign, Direction::u), candidate(i, sign, Direction::v)};
    for (Candidate& k : c)
      if (!k.empty()) k.estimate = estimate(*k.sheet, k.task, regions_[i], Method::iso_parametric).length;
    const std::size_t first = c[1].estimate < c[0].estimate ? 1 : 0, other = 1 - first;
    const bool clear = c[other].estimate > kClearlyLonger * c[first].estimate;
    const bool far = c[other].estimate > kFarLonger * c[first].estimate;
    std::array<std::optional<Result<SheetPlan>>, 2> plans;
    if (clear || threads < 2) {
      plans[first].emplace(plan_sheet(i, std::move(c[first])));
      const Result<SheetPlan>& done = *plans[first];
      const bool good = done && most_left(*done) <= kAbove * options_.scallop;
      if (done && !done->chains.empty() && (far || (good && clear))) return std::move(*plans[first]);
      // Trimmed passes are shorter than what is counted while they are planned.
      if (good && regions_[i].whole()) c[other].task.most_length = done->length;
      plans[other].emplace(plan_sheet(i, std::move(c[other])));
    } else {
      parallel_for(2, threads,
                   [&](std::size_t k, std::size_t) { plans[k].emplace(plan_sheet(i, std::move(c[k]))); });
    }
    return shorter(std::move(*plans[0]), std::move(*plans[1]));
  }

  Result<SheetPlan> shorter(Result<SheetPlan> u, Result<SheetPlan> v) const {
    if (!u || (v && u->given_up)) return v;
    if (!v || v->given_up) return u;
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

  Candidate candidate(std::size_t index, double sign, Direction along) const {
    Candidate c;
    const geom::NurbsSurface& surface = composite_.surfaces[index].surface;
    const bool over_edges = options_.method == Method::iso_scallop && regions_[index].whole();
    // What stands on an edge between two paths is at most half a step off; steps are longer in hollows.
    const double over = std::sqrt(8 * radius_ * options_.scallop);
    c.whole = over_edges ? continued(surface, along, over) : surface;
    c.sheet = std::make_unique<Sheet>(c.whole, along, sign, radius_, options_.stock, surface.domain(along));
    c.task = task_of(*c.sheet, regions_[index]);
    return c;
  }

  Result<SheetPlan> plan_sheet(std::size_t index, Candidate candidate) {
    const Region& region = regions_[index];
    const Direction along = candidate.sheet->along();
    const PassTask& task = candidate.task;
    SheetPlan out;
    out.along = along == Direction::u ? Along::u : Along::v;
    if (candidate.empty()) return out;
    // Chains point to it.
    std::unique_ptr<Sheet>& kept = sheets_[2 * index + (along == Direction::u ? 0 : 1)];
    kept = std::move(candidate.sheet);
    const Sheet& sheet = *kept;
    const geom::NurbsSurface& whole = candidate.whole;
    const Estimate size = estimate(sheet, task, region, options_.method);
    if (const Result<void> ok = check_size(sheet, task, size); !ok) return ok.error();
    Result<Passes> passes = options_.method == Method::iso_parametric
                                ? iso_parametric(sheet, task)
                                : iso_scallop_between_creases(whole, sheet, task);
    if (!passes) return passes.error();
    out.given_up = passes->given_up;
    if (out.given_up) return out;
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
    task.inner_t = task.t;
    if (region.whole()) task.t = sheet.t_range();
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
    lift(chains, obstacles, options_.threads, radius_, options_.tolerance_mm, report);
    double highest = obstacles.top();
    for (const Chain& c : chains)
      for (const ChainPiece& p : c)
        for (const geom::QuinticNode& n : p.track.tip.nodes) highest = std::max(highest, n.p.z);
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
  std::vector<std::unique_ptr<Sheet>> sheets_;  ///< of both directions; chains point to them
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
