// SPDX-License-Identifier: Apache-2.0
#include "burin/job/cycle_job.h"

#include <algorithm>
#include <cmath>

#include "burin/base/text.h"
#include "burin/cl/fit_moves.h"
#include "burin/job/curve_path.h"
#include "burin/job/parallel_passes.h"

namespace burin::job {
namespace {

using geom::Point3;
using geom::QuinticPath;
using geom::Vec3;

// Nodes closer than this are one place: a move between them would be no motion.
constexpr double kNoMove_mm = 1e-9;
// The smooth path stays this near the exact one: far below what a servo resolves.
constexpr double kPath_mm = 1e-6;

QuinticPath translated(QuinticPath path, Vec3 by) {
  for (geom::QuinticNode& node : path.nodes) node.p = node.p + by;
  return path;
}

std::string block_name(const nc::SurfaceBlock& block) {
  return block.number ? "N" + std::to_string(*block.number) : "line " + std::to_string(block.line);
}

std::string title_of(const nc::MachineGroup& group, const nc::SurfaceProgram& program) {
  const std::string method = group.method == nc::PathMethod::iso_scallop ? "I2" : "I1";
  std::string blocks = block_name(program.blocks[group.blocks.front()]);
  if (group.blocks.size() > 1) blocks += " to " + block_name(program.blocks[group.blocks.back()]);
  if (group.join)
    return "G106.2 " + method + " E" + std::to_string(static_cast<int>(group.grouping)) + ", " + blocks;
  return "G06.23 " + method + ", " + blocks + (group.repeat ? ", repeated" : "");
}

std::vector<cycle::Trim> trims_of(const nc::SurfaceProgram& program, const nc::MachineGroup& group) {
  std::vector<cycle::Trim> trims;
  for (std::size_t patch = 0; patch < group.blocks.size(); ++patch)
    for (const nc::TrimLoop& loop : program.blocks[group.blocks[patch]].trims)
      trims.push_back({patch, loop.points});
  return trims;
}

cycle::PlanOptions plan_options(const nc::MachineGroup& group, const CycleOptions& options) {
  cycle::PlanOptions plan;
  plan.method = group.method == nc::PathMethod::iso_scallop ? cycle::Method::iso_scallop
                                                            : cycle::Method::iso_parametric;
  plan.along = options.along;
  plan.tool_diameter = group.tool_diameter;
  plan.stock = group.stock;
  plan.scallop = group.scallop;
  plan.side_step = group.side_step;
  plan.safety_z = group.safety_z - group.displacement.z;
  plan.tolerance_mm = options.tolerance_mm;
  plan.path_mm = kPath_mm;
  plan.threads = options.threads;
  return plan;
}

class Builder {
 public:
  Builder(const CycleOptions& options, Diagnostics& diagnostics, ProgressSink* progress)
      : options_(options), diagnostics_(diagnostics), progress_(progress) {}

  Result<CycleJob> run(std::string_view text) {
    auto program = nc::read_surface_program(
        text, {.file_name = options_.file_name, .strict = options_.strict}, diagnostics_);
    if (!program) return std::move(program).error();
    job_.program = std::move(*program);
    at_ = job_.program.start;
    job_.cl.name = job_.program.name;
    job_.cl.from = cl::Pose{at_};
    std::size_t done = 0;
    for (const nc::Step& step : job_.program.steps) {
      auto ok = std::visit([this](const auto& s) { return add(s); }, step);
      if (!ok) return ok.error();
      ++done;
      if (progress_ && !progress_->progress("planning", double(done) / double(job_.program.steps.size())))
        return Error{ErrorCode::usage, "stopped", {}};
    }
    return std::move(job_);
  }

 private:
  Error at_line(Error error, int line) const {
    if (error.where.line == 0) error.where = {.file = options_.file_name, .line = line, .column = 1};
    // To the planner these are its options; here they come from the program.
    if (error.code == ErrorCode::usage) error.code = ErrorCode::range;
    return error;
  }

  // --- ordinary moves
  // ------------------------------------------------------------------------------------------

  Result<void> add(const nc::Plain& plain) {
    const auto source = static_cast<std::uint32_t>(plain.line);
    if (const cl::Pose* to = cl::pose_of(plain.record)) {
      if (!std::holds_alternative<cl::Rapid>(plain.record)) feed_rate(plain.feed, source);
      add_stretch(path_to(plain.record, to->tip),
                  std::holds_alternative<cl::Rapid>(plain.record) ? 0 : plain.feed);
      at_ = to->tip;
    }
    if (const auto* feed = std::get_if<cl::FeedRate>(&plain.record))
      feed_rate(feed->mm_min, source);
    else
      job_.cl.add(plain.record, source);
    return {};
  }

  QuinticPath path_to(const cl::Record& record, Point3 to) const {
    const auto* arc = std::get_if<cl::Arc>(&record);
    if (!arc) return geom::straight(at_, to);
    return geom::arc(at_, arc->center, arc->normal, cl::arc_sweep(at_, *arc), dot(to - at_, arc->normal));
  }

  Result<void> add(const nc::CurveMove& move) {
    const auto source = static_cast<std::uint32_t>(move.line);
    feed_rate(move.feed, source);
    const std::vector<CurvePiece> pieces = curve_path(move.curve, kPath_mm);
    const Point3 begin = pieces.front().path.start();
    if (distance(at_, begin) > kNoMove_mm) {
      add_stretch(geom::straight(at_, begin), move.feed);
      job_.cl.add(cl::Feed{cl::Pose{begin}}, source);
    }
    for (const CurvePiece& piece : pieces) {
      add_stretch(piece.path, move.feed, piece.parameter);
      fit(piece.path, source);
      at_ = piece.path.end();
    }
    return {};
  }

  /// Moves of the program itself, and curves.
  void add_stretch(QuinticPath path, double feed, QuinticPath uv = {}) {
    if (geom::length(path) <= kNoMove_mm) return;
    (feed > 0 ? job_.cut_mm : job_.rapid_mm) += geom::length(path);
    servo::Stretch stretch;
    stretch.path = std::move(path);
    stretch.uv = std::move(uv);
    stretch.feed_mm_min = feed;
    job_.stretches.push_back(std::move(stretch));
  }

  void feed_rate(double mm_min, std::uint32_t source) {
    if (mm_min > 0 && mm_min != feed_) job_.cl.add(cl::FeedRate{mm_min}, source);
    feed_ = mm_min > 0 ? mm_min : feed_;
  }

  void fit(const QuinticPath& path, std::uint32_t source) {
    const cl::FitMoves moves = cl::fit_moves(path, {.tolerance_mm = options_.tolerance_mm});
    job_.fit_deviation_mm = std::max(job_.fit_deviation_mm, moves.deviation_mm);
    cl::append(job_.cl, moves, source);
  }

  // --- surfaces
  // --------------------------------------------------------------------------------------------------

  Result<void> add(const nc::MachineGroup& group) {
    auto surfaces = surfaces_of(group);
    if (!surfaces) return surfaces.error();
    if (auto ok = check_range(group, *surfaces); !ok) return ok.error();
    CycleRun run;
    run.surfaces = *surfaces;
    run.group = group;
    run.title = title_of(group, job_.program);
    auto plan = plan_of(group, *surfaces);
    if (!plan) return plan.error();
    run.plan = std::move(*plan);
    job_.repeats += group.repeat;
    job_.paths += run.plan.paths;
    job_.lifted += run.plan.lifted;
    lay_out(run);
    job_.runs.push_back(std::move(run));
    return {};
  }

  /// Planning takes long: a part that lies beyond what the control takes is refused before. A surface lies in
  /// the hull of its control points, the tip at most a tool's diameter and the stock from it.
  Result<void> check_range(const nc::MachineGroup& group, std::size_t surfaces) const {
    const double limit = options_.coordinate_limit_mm + group.tool_diameter + std::abs(group.stock);
    for (const geom::JoinedSurface& joined : job_.surfaces[surfaces].composite.surfaces) {
      geom::Box3 box;
      for (const geom::HPoint& h : joined.surface.points) box.add(geom::project(h) + group.displacement);
      const auto out = [&](char axis, double lo, double hi) -> std::optional<Error> {
        if (lo <= limit && hi >= -limit) return std::nullopt;
        return at_line({ErrorCode::range,
                        std::string("a surface lies at ") + axis + format_shortest(lo > limit ? lo : hi) +
                            " and beyond (within " + format_shortest(options_.coordinate_limit_mm) +
                            " mm for this control)",
                        {}},
                       group.line);
      };
      if (auto error = out('X', box.lo.x, box.hi.x)) return *error;
      if (auto error = out('Y', box.lo.y, box.hi.y)) return *error;
      if (auto error = out('Z', box.lo.z, box.hi.z)) return *error;
    }
    return {};
  }

  /// The composite of these blocks: made once, whatever number of times they are machined.
  Result<std::size_t> surfaces_of(const nc::MachineGroup& group) {
    for (std::size_t i = 0; i < job_.surfaces.size(); ++i)
      if (job_.surfaces[i].blocks == group.blocks) return i;
    std::vector<geom::NurbsSurface> patches;
    for (const std::size_t block : group.blocks) patches.push_back(job_.program.blocks[block].surface);
    geom::JoinOptions join;
    join.tolerance_mm = options_.join_mm;
    join.max_deviation_mm = options_.join_deviation_mm.value_or(options_.tolerance_mm);
    join.grouping = group.grouping;
    auto composite = geom::join(patches, join, diagnostics_);
    if (!composite) return at_line(composite.error(), group.line);
    job_.surfaces.push_back({group.blocks, std::move(*composite), job_.surfaces_out});
    job_.surfaces_out += job_.surfaces.back().composite.surfaces.size();
    return job_.surfaces.size() - 1;
  }

  /// Planned where the surfaces are defined, then moved to where they are machined. A repeat at the same
  /// height takes the paths of the machining before it and only finds its own way there.
  Result<cycle::SurfacePlan> plan_of(const nc::MachineGroup& group, std::size_t surfaces) {
    if (group.repeat && !job_.runs.empty()) {
      const CycleRun& before = job_.runs.back();
      if (before.surfaces == surfaces && before.group.displacement.z == group.displacement.z &&
          before.group.safety_z == group.safety_z)
        return moved(before.plan, group.displacement - before.group.displacement, group.safety_z);
    }
    auto plan = cycle::plan(job_.surfaces[surfaces].composite, trims_of(job_.program, group),
                            at_ - group.displacement, plan_options(group, options_), diagnostics_);
    if (!plan) return at_line(plan.error(), group.line);
    for (cycle::Motion& motion : plan->motions)
      motion.path = translated(std::move(motion.path), group.displacement);
    return plan;
  }

  cycle::SurfacePlan moved(const cycle::SurfacePlan& before, Vec3 by, double safety_z) const {
    cycle::SurfacePlan plan = before;
    const auto first = std::find_if(plan.motions.begin(), plan.motions.end(), [](const cycle::Motion& m) {
      return m.kind != cycle::MotionKind::rapid;
    });
    if (first == plan.motions.end()) return plan;
    std::vector<cycle::Motion> motions = cycle::approach(at_, first->path.start() + by, safety_z);
    for (const cycle::Motion& m : motions) plan.rapid_mm += geom::length(m.path);
    for (auto it = plan.motions.cbegin(); it != first; ++it) plan.rapid_mm -= geom::length(it->path);
    for (auto it = first; it != plan.motions.end(); ++it) {
      motions.push_back(*it);
      motions.back().path = translated(it->path, by);
    }
    plan.motions = std::move(motions);
    return plan;
  }

  void lay_out(const CycleRun& run) {
    const auto source = static_cast<std::uint32_t>(run.group.line);
    const auto first_surface = static_cast<std::int32_t>(job_.surfaces[run.surfaces].first_surface);
    job_.cl.add(cl::Comment{run.title}, source);
    for (const cycle::Motion& motion : run.plan.motions) {
      const bool rapid = motion.kind == cycle::MotionKind::rapid;
      const double length = geom::length(motion.path);
      (rapid ? job_.rapid_mm : motion.kind == cycle::MotionKind::cut ? job_.cut_mm : job_.link_mm) += length;
      if (length <= kNoMove_mm) continue;
      const bool cut = motion.kind == cycle::MotionKind::cut;
      servo::Stretch stretch;
      stretch.path = motion.path;
      if (cut) stretch.uv = motion.uv;
      stretch.feed_mm_min = rapid ? 0 : run.group.feed;
      // Links and rapids count as no path (contract).
      stretch.surface = motion.surface < 0 ? -1 : first_surface + motion.surface;
      stretch.pass = cut ? motion.pass : -1;
      job_.stretches.push_back(std::move(stretch));
      if (rapid) {
        job_.cl.add(cl::Rapid{cl::Pose{motion.path.end()}}, source);
      } else {
        feed_rate(run.group.feed, source);
        fit(motion.path, source);
      }
    }
    if (!run.plan.motions.empty()) at_ = run.plan.motions.back().path.end();
  }

  const CycleOptions& options_;
  Diagnostics& diagnostics_;
  ProgressSink* progress_;
  CycleJob job_;
  Point3 at_;
  double feed_ = 0;
};

}  // namespace

Result<CycleJob> make_cycle_job(std::string_view text, const CycleOptions& options, Diagnostics& diagnostics,
                                ProgressSink* progress) {
  return Builder(options, diagnostics, progress).run(text);
}

cl::Program as_lines(const CycleJob& job, double tolerance_mm) {
  cl::Program program;
  double feed = 0;
  for (const servo::Stretch& stretch : job.stretches) {
    if (stretch.feed_mm_min == 0) {
      program.add(cl::Rapid{cl::Pose{stretch.path.end()}});
      continue;
    }
    if (stretch.feed_mm_min != feed) program.add(cl::FeedRate{feed = stretch.feed_mm_min});
    cl::append(program, cl::fit_moves(stretch.path, {.tolerance_mm = tolerance_mm, .arcs = false}),
               cl::Program::kNoSource);
  }
  return program;
}

Result<PathLengths> compare_methods(const CycleJob& job, const CycleRun& run, const CycleOptions& options) {
  const geom::Composite& composite = job.surfaces[run.surfaces].composite;
  cycle::PlanOptions plan = plan_options(run.group, options);
  const bool by_scallop = plan.method == cycle::Method::iso_scallop;
  plan.method = by_scallop ? cycle::Method::iso_parametric : cycle::Method::iso_scallop;
  Diagnostics unused;
  const auto other = cycle::plan(composite, trims_of(job.program, run.group), run.group.start, plan, unused);
  if (!other) return other.error();
  PathLengths lengths;
  lengths.iso_parametric_mm = by_scallop ? other->cut_mm : run.plan.cut_mm;
  lengths.iso_scallop_mm = by_scallop ? run.plan.cut_mm : other->cut_mm;
  lengths.parallel_mm = parallel_length(composite, 0.5 * plan.tool_diameter, plan.scallop, plan.side_step);
  return lengths;
}

}  // namespace burin::job
