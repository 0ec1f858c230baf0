// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/orient.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "burin/base/text.h"
#include "burin/geom/mesh/mesh_index.h"
#include "burin/plan/orient/comparison.h"
#include "burin/plan/orient/path_task.h"

namespace burin::orient {

namespace {

Result<void> validate(const OrientOptions& o) {
  const auto bad = [](const std::string& what) -> Result<void> { return Error{ErrorCode::range, what, {}}; };
  const AngleRange& r = o.range;
  const auto deg = [](double a) { return format_shortest(geom::degrees(a)); };
  if (!(r.alpha_lo >= 0 && r.alpha_hi >= r.alpha_lo && r.alpha_hi < geom::kPi / 2))
    return bad("the tilts run from " + deg(r.alpha_lo) + " to " + deg(r.alpha_hi) +
               " degrees (ascending, from 0 to below 90)");
  if (!(r.beta_lo >= -geom::kPi / 2 && r.beta_hi >= r.beta_lo && r.beta_hi <= geom::kPi / 2))
    return bad("the yaws run from " + deg(r.beta_lo) + " to " + deg(r.beta_hi) +
               " degrees (ascending, from -90 to 90)");
  if (!(o.tolerance_mm > 0)) return bad("the tolerance is not above 0");
  if (!(o.clearance_mm >= 0)) return bad("the clearance is negative");
  if (!(o.scallop_mm > 0)) return bad("the scallop is not above 0");
  if (!(o.feed_mm_min > 0)) return bad("the feed is not above 0");
  if (o.search == Search::contour && o.objective == Objective::strip)
    return Error{
        ErrorCode::usage,
        "search \"contour\" follows contours of the effective radius (objective \"radius\", or search "
        "\"optimal\")",
        {}};
  return {};
}

/// Contacts that were given may lie off the design or inside the part.
void check_contacts(const Part& part, const std::vector<CcPath>& contacts, double tolerance,
                    Diagnostics& diagnostics) {
  geom::Mesh design;
  design.vertices = part.mesh.vertices;
  design.triangles.assign(part.mesh.triangles.begin(),
                          part.mesh.triangles.begin() + static_cast<std::ptrdiff_t>(part.design_triangles));
  const geom::MeshIndex index(design);
  const double far = part.bounds.diagonal() + 1;
  for (const CcPath& path : contacts) {
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const CcPoint& at = path.points[i];
      const auto hit = index.nearest(at.c, far);
      if (hit && hit->distance <= tolerance + part.deflection_mm) continue;
      const std::string place =
          "contact point " + std::to_string(i) + " of path " + std::to_string(path.number);
      const bool inside = hit && dot(at.c - hit->p, at.n) < 0;
      diagnostics.add({Severity::info,
                       inside ? "contact_inside" : "contact_off",
                       place +
                           (hit ? " lies " + format_fixed(hit->distance, 3) + " mm " +
                                      (inside ? "below" : "above") + " the design surface"
                                : " is far from the design surface") +
                           " (a place on it)",
                       {},
                       std::array{at.c.x, at.c.y, at.c.z}});
    }
  }
}

/// Counts finished tasks from any thread.
class Counter {
 public:
  Counter(ProgressSink* sink, std::size_t expected) : sink_(sink), expected_(expected) {}
  void one() {
    if (sink_ == nullptr) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    ++done_;
    sink_->progress("tool angles",
                    std::min(1.0, static_cast<double>(done_) / static_cast<double>(expected_)));
  }

 private:
  ProgressSink* sink_;
  std::size_t expected_, done_ = 0;
  std::mutex mutex_;
};

/// Places of a family's paths that the strips do not decide.
std::optional<std::vector<double>> even_places(const PathFamily& family, const OrientOptions& options) {
  double count = 0;
  if (options.path_count) count = *options.path_count;
  if (options.side_step_mm) count = std::ceil(family.extent() / *options.side_step_mm);
  if (count < 1) return std::nullopt;
  const auto n = static_cast<std::size_t>(std::min(count, static_cast<double>(kMostPaths)));
  std::vector<double> places(n);
  for (std::size_t i = 0; i < n; ++i) places[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
  return places;
}

/// The lanes of one family: what has been worked out is kept by its place.
class Lanes {
 public:
  Lanes(const PathFamily& family, const PathTask& task, Workers& workers, ProgressSink* progress)
      : family_(family), task_(task), workers_(workers), progress_(progress) {}

  /// The pieces of the paths at the places.
  void need(const std::vector<double>& ws) {
    std::vector<double> missing;
    for (const double w : ws)
      if (done_.count(w) == 0 && std::find(missing.begin(), missing.end(), w) == missing.end())
        missing.push_back(w);
    Counter counter(progress_, missing.size());
    const auto results = workers_.map(missing.size(), [&](std::size_t i) {
      std::vector<OrientedPath> pieces;
      for (const std::vector<CcPoint>& points : family_.at(missing[i])) pieces.push_back(task_.run(points));
      counter.one();
      return to_bytes(pieces);
    });
    for (std::size_t i = 0; i < missing.size(); ++i) done_[missing[i]] = paths_from_bytes(results[i]);
  }
  std::vector<OrientedPath>& at(double w) { return done_.at(w); }

  std::vector<Lane> lanes(const std::vector<double>& ws) {
    need(ws);
    std::vector<Lane> lanes;
    for (const double w : ws) {
      Lane lane;
      lane.w = w;
      for (const OrientedPath& piece : done_.at(w)) {
        lane.pieces.emplace_back();
        lane.strips.emplace_back();
        for (const OrientedPoint& point : piece.points) {
          lane.pieces.back().push_back(point.cc);
          lane.strips.back().push_back(point.strip);
        }
      }
      lanes.push_back(std::move(lane));
    }
    return lanes;
  }

 private:
  const PathFamily& family_;
  const PathTask& task_;
  Workers& workers_;
  ProgressSink* progress_;
  std::map<double, std::vector<OrientedPath>> done_;
};

Result<void> plan_family(const PathFamily& family, int face, const PathTask& task, Workers& workers,
                         ProgressSink* progress, OrientPlan& plan) {
  Lanes lanes(family, task, workers, progress);
  std::vector<double> places;
  if (const auto even = even_places(family, *task.options)) {
    places = *even;
  } else {
    auto laid = lay_paths(
        family, [&](const std::vector<double>& ws) { return lanes.lanes(ws); }, kMostPaths);
    if (!laid) return laid.error();
    places = std::move(*laid);
  }
  lanes.need(places);
  for (const double w : places) {
    for (OrientedPath& piece : lanes.at(w)) {
      piece.number = static_cast<int>(plan.paths.size());
      piece.face = face;
      piece.at = w;
      plan.paths.push_back(std::move(piece));
    }
  }
  return {};
}

/// Points that are not reached, and the length that is cut.
std::pair<std::size_t, double> worth(const std::vector<OrientedPath>& paths) {
  std::pair<std::size_t, double> sum{0, 0};
  for (const OrientedPath& path : paths)
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      if (!path.points[i].reachable) ++sum.first;
      if (i > 0) sum.second += distance(path.points[i - 1].cc.c, path.points[i].cc.c);
    }
  return sum;
}

/// Every way to count strips (docs/strip.md); the best is kept.
Result<void> plan_strips(const PathFamily& family, int face, const PathTask& task, Workers& workers,
                         ProgressSink* progress, OrientPlan& plan) {
  const StripGoal whole(task.mill(), task.options->scallop_mm, StripCount::whole);
  const RadiusGoal radius(task.mill());
  // Smoothing is for the way that is kept: it costs more than the angles themselves.
  OrientOptions plain_options = *task.options;
  plain_options.smooth = false;
  PathTask plain = task;
  plain.options = &plain_options;
  std::vector<PathTask> ways{plain, plain};
  ways[1].goal = &radius;
  PathTask to_left = plain, to_right = plain;
  to_left.goal = to_right.goal = &whole;
  to_left.setting.range.beta_lo = std::max(0.0, task.setting.range.beta_lo);
  to_right.setting.range.beta_hi = std::min(0.0, task.setting.range.beta_hi);
  for (const PathTask& way : {to_left, to_right})
    if (way.setting.range.beta_lo <= way.setting.range.beta_hi) ways.push_back(way);
  std::optional<Error> error;
  std::optional<OrientPlan> best;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    OrientPlan tried;
    if (auto ok = plan_family(family, face, ways[i], workers, progress, tried); !ok) {
      error = ok.error();
    } else if (!best || worth(tried.paths) < worth(best->paths)) {
      best = std::move(tried);
      kept = i;
    }
  }
  if (!best) return *error;
  if (task.options->smooth) {
    ways[kept].options = task.options;
    best.emplace();
    if (auto ok = plan_family(family, face, ways[kept], workers, progress, *best); !ok) return ok;
  }
  for (OrientedPath& path : best->paths) {
    path.number = static_cast<int>(plan.paths.size());
    plan.paths.push_back(std::move(path));
  }
  return {};
}

void plan_contacts(const std::vector<CcPath>& contacts, const PathTask& task, Workers& workers,
                   ProgressSink* progress, OrientPlan& plan) {
  Counter counter(progress, contacts.size());
  const auto results = workers.map(contacts.size(), [&](std::size_t i) {
    OrientedPath path = task.run(contacts[i].points);
    path.number = contacts[i].number;
    counter.one();
    return to_bytes({std::move(path)});
  });
  for (const std::string& bytes : results) plan.paths.push_back(std::move(paths_from_bytes(bytes).front()));
}

/// An initial solution at yaw +-90 degrees cuts no width at all: below this share of the tool's radius there
/// is nothing to compare with.
constexpr double kNoRadius = 1e-6;

/// Mean of rho / rho_initial - 1 over the points that have both; 0 where none has.
struct Gain {
  double radius = 0;  ///< of the tool
  double sum = 0;
  std::size_t count = 0;
  void add(const OrientedPoint& point) {
    if (!point.reachable || !point.initial_found || point.rho_initial < kNoRadius * radius) return;
    const double ratio = point.rho / point.rho_initial;
    if (!std::isfinite(ratio)) return;
    sum += ratio - 1, ++count;
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0; }
};

void sum_up(double radius, OrientPlan& plan) {
  Gain all{radius};
  for (const OrientedPath& path : plan.paths) {
    Gain gain{radius};
    const OrientedPoint* before = nullptr;
    for (const OrientedPoint& point : path.points) {
      ++plan.contact_points;
      plan.tests += point.tests;
      if (!point.reachable) {
        ++plan.unreachable;
        before = nullptr;
        continue;
      }
      gain.add(point), all.add(point);
      if (before != nullptr) {
        const geom::Vec3 a = before->pose.axis, b = point.pose.axis;
        plan.axis_step_max = std::max(plan.axis_step_max, std::atan2(norm(cross(a, b)), dot(a, b)));
        plan.cut_mm += distance(before->cc.c, point.cc.c);
      }
      before = &point;
    }
    plan.gain_per_path.push_back(gain.mean());
  }
  plan.gain_mean = all.mean();
}

}  // namespace

Setting setting_of(const Scene& scene, const MachineLimits& limits, const OrientOptions& options) {
  return {&scene, &limits, options.range};
}

Result<OrientPlan> plan(const Part& part, const Scene& scene, const MachineLimits& limits,
                        const std::vector<CcPath>& contacts, const kinematics::Kinematics* machine,
                        const OrientOptions& options, Workers& workers, Diagnostics& diagnostics,
                        ProgressSink* progress) {
  if (auto ok = validate(options); !ok) return ok.error();
  const model::Mill& mill = scene.mill();
  const RadiusGoal radius(mill);
  const StripGoal strip(mill, options.scallop_mm, StripCount::narrower);
  PathTask task;
  task.setting = setting_of(scene, limits, options);
  task.options = &options;
  task.machine = machine;
  task.goal = options.objective == Objective::radius ? static_cast<const Goal*>(&radius) : &strip;
  task.sturz_tilt = options.sturz_tilt.value_or(options.range.alpha_lo);

  OrientPlan plan;
  if (!contacts.empty()) {
    check_contacts(part, contacts, options.tolerance_mm, diagnostics);
    if (options.search == Search::sturz && !options.sturz_tilt) {
      OrientOptions free = options;
      free.search = Search::optimal;
      PathTask first = task;
      first.options = &free;
      OrientPlan any;
      plan_contacts(contacts, first, workers, nullptr, any);
      task.sturz_tilt = sturz_tilt(task.setting, any.paths, workers).tilt;
    }
    plan_contacts(contacts, task, workers, progress, plan);
    sum_up(mill.radius, plan);
    return plan;
  }

  std::vector<PathFamily> families;
  for (std::size_t face = 0; face < part.faces.size(); ++face) {
    auto family = PathFamily::make(part, static_cast<int>(face), options.paths);
    if (!family) return family.error();
    families.push_back(std::move(*family));
  }
  if (families.empty())
    return Error{ErrorCode::usage, "a mesh has no parameters to lay paths by (contacts = \"FILE.csv\")", {}};
  const auto run = [&](const PathTask& with, OrientPlan& out) -> Result<void> {
    for (std::size_t face = 0; face < families.size(); ++face) {
      const auto number = static_cast<int>(face);
      // Where the places are given no way to count strips leads to fewer paths than another.
      const bool by_strips = with.options->objective == Objective::strip &&
                             with.options->search == Search::optimal &&
                             !even_places(families[face], *with.options);
      auto ok = by_strips ? plan_strips(families[face], number, with, workers, progress, out)
                          : plan_family(families[face], number, with, workers, progress, out);
      if (!ok) return ok;
      std::size_t points = 0;
      for (const OrientedPath& path : out.paths) points += path.points.size();
      if (points > options.max_points)
        return Error{ErrorCode::range,
                     "more than " + std::to_string(options.max_points) +
                         " contact points (a larger scallop, side step or tolerance)",
                     {}};
    }
    return {};
  };
  std::optional<SturzTilt> one_tilt;
  if (options.search == Search::sturz && !options.sturz_tilt) {
    // The least tilt for all is known only when the points are: those of the best angles stand for them.
    OrientOptions free = options;
    free.search = Search::optimal;
    free.smooth = false;
    PathTask first = task;
    first.options = &free;
    OrientPlan any;
    if (auto ok = run(first, any); !ok) return ok.error();
    one_tilt = sturz_tilt(task.setting, any.paths, workers);
    task.sturz_tilt = one_tilt->tilt;
  }
  if (auto ok = run(task, plan); !ok) return ok.error();
  sum_up(mill.radius, plan);
  if (!one_tilt) one_tilt = sturz_tilt(task.setting, plan.paths, workers);
  plan.comparisons.push_back(compare_sturz(families, mill, options, *one_tilt));
  plan.comparisons.push_back(compare_ball(families, plan.paths, mill, options));
  return plan;
}

}  // namespace burin::orient
