// SPDX-License-Identifier: Apache-2.0
// Planned programs of small random parts (orient, cycle), clean as they are; then one fault planted in each:
// verify names it, with the figure that trying places and moments shows, too.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>

#include "burin/geom/surface/interpolate.h"
#include "burin/geom/surface/tessellate.h"
#include "burin/job/cycle_job.h"
#include "burin/job/orient_check.h"
#include "burin/plan/orient/to_cl.h"
#include "verify_support.h"

namespace burin {
namespace {

using geom::Point3;
using geom::Vec3;

/// Where trying places and moments may miss the worst, mm.
constexpr double kTrial = 0.004;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double in(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(engine_()) / 4294967296.0; }
  std::size_t below(std::size_t n) { return engine_() % n; }

 private:
  std::mt19937 engine_;
};

/// What an operation made of a part.
struct Planned {
  verified::Design design;
  cl::Program program;
  verify::CheckedMill tool;
  std::vector<int> pass;               ///< of a record; -1: none
  double gouge_mm = 0, excess_mm = 0;  ///< what it may leave
  bool ends = false;                   ///< of passes that the tool does not come to
  double spacing_mm = 0.5;

  verify::CheckedPath path(const cl::Program& p, const verify::CheckedMill& t) const {
    return verified::path_of(p, t);
  }
};

// --- trying

bool inside(const verify::CheckedMill& tool, double d, double h) {
  if (h < 0 || d > tool.radius) return false;
  const double r = tool.corner_radius, out = d - (tool.radius - r);
  if (h < r && out > 0 && std::hypot(out, r - h) > r) return false;
  if (h <= tool.length) return true;
  return false;
}
double depth_in_cutter(const verify::CheckedMill& tool, double d, double h) {
  if (!inside(tool, d, h)) return 0;
  const double r = tool.corner_radius, out = d - (tool.radius - r);
  if (h < r && out > 0) return std::min(r - std::hypot(out, r - h), tool.length - h);
  return std::min({h, tool.radius - d, tool.length - h});
}

/// Moments of the pieces of some moves.
std::vector<cl::Pose> moments(const verify::CheckedPath& path, std::uint32_t first, std::uint32_t last) {
  std::vector<cl::Pose> out;
  for (const verify::ToolPath& tool : path.tools) {
    cl::Pose from = tool.from;
    for (const verify::PathPiece& piece : tool.pieces) {
      if (piece.move >= first && piece.move <= last) {
        const double turn = distance(Point3{} + from.axis, Point3{} + piece.to.axis) * tool.tool.radius;
        const int count = 1 + static_cast<int>((distance(from.tip, piece.to.tip) + turn) / 0.04);
        for (int k = 0; k <= count; ++k) {
          const double t = double(k) / count;
          out.push_back({lerp(from.tip, piece.to.tip, t), unit((1 - t) * from.axis + t * piece.to.axis)});
        }
      }
      from = piece.to;
    }
  }
  return out;
}

template <class Each>
void near_samples(const std::vector<verify::SurfaceSample>& samples, const verify::CheckedMill& tool,
                  const cl::Pose& pose, Each&& each) {
  const double reach = std::hypot(tool.radius, tool.length);
  for (const verify::SurfaceSample& s : samples) {
    const Vec3 d = s.p - pose.tip;
    if (std::abs(d.x) > reach || std::abs(d.y) > reach || std::abs(d.z) > reach) continue;
    const double h = dot(d, pose.axis);
    if (h < 0 || h > tool.length) continue;
    const double away = norm(d - h * pose.axis);
    if (away <= tool.radius) each(s, away, h);
  }
}

/// How far below the surface the cutter gets, from the surface down along the normals of the samples.
double gouge_by_trial(const std::vector<verify::SurfaceSample>& samples, const verify::CheckedMill& tool,
                      const std::vector<cl::Pose>& poses) {
  double most = 0;
  for (const cl::Pose& pose : poses)
    near_samples(samples, tool, pose, [&](const verify::SurfaceSample& s, double d, double h) {
      if (!inside(tool, d, h)) return;
      const auto in = [&](double below) {
        const Vec3 at = s.p - below * s.n - pose.tip;
        const double height = dot(at, pose.axis);
        return inside(tool, norm(at - height * pose.axis), height);
      };
      if (!in(most)) return;
      double lo = most, hi = 5;
      while (hi - lo > 1e-4) (in(0.5 * (lo + hi)) ? lo : hi) = 0.5 * (lo + hi);
      most = lo;
    });
  return most;
}
double depth_by_trial(const std::vector<verify::SurfaceSample>& samples, const verify::CheckedMill& tool,
                      const std::vector<cl::Pose>& poses) {
  double most = 0;
  for (const cl::Pose& pose : poses)
    near_samples(samples, tool, pose, [&](const verify::SurfaceSample&, double d, double h) {
      most = std::max(most, depth_in_cutter(tool, d, h));
    });
  return most;
}

// --- faults

std::vector<std::size_t> motions_of(const cl::Program& p) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < p.records.size(); ++i)
    if (cl::is_motion(p.records[i])) out.push_back(i);
  return out;
}
cl::Pose& pose_at(cl::Program& p, std::size_t record) {
  return const_cast<cl::Pose&>(*cl::pose_of(p.records[record]));
}
cl::Pose lifted(cl::Pose pose, double by) {
  pose.tip = pose.tip + by * pose.axis;
  return pose;
}

class Faults {
 public:
  Faults(Planned planned, unsigned seed)
      : p_(std::move(planned)), random_(seed), gotos_(motions_of(p_.program)) {
    // Points put between those of a pass are the pass's.
    std::size_t last = gotos_.front();
    for (const std::size_t i : gotos_) {
      if (p_.pass[i] < 0) continue;
      if (p_.pass[i] == p_.pass[last])
        for (std::size_t k = last; k < i; ++k) p_.pass[k] = p_.pass[i];
      last = i;
    }
    const auto fine = verify::sample_surface(p_.design.mesh, p_.design.machined, {}, {.spacing_mm = 0.1});
    EXPECT_TRUE(fine.ok()) << fine.error().to_string();
    if (fine) fine_ = fine->samples;
    clean_ = say(p_.program, p_.tool);
  }

  void clean() { verified::expect_clean(clean_, p_.gouge_mm, p_.excess_mm, p_.ends); }

  void point_too_deep() {
    planted("a point too deep",
            [&](cl::Pose& pose) { pose.tip = pose.tip - random_.in(0.02, 0.2) * pose.axis; });
  }
  /// About X; whichever way cuts.
  void axis_tilted() {
    planted("an axis tilted", [&](cl::Pose& pose) {
      const double a = geom::radians(random_.below(2) == 0 ? 2.0 : -2.0);
      const Vec3 v = pose.axis;
      pose.axis =
          unit(Vec3{v.x, v.y * std::cos(a) - v.z * std::sin(a), v.y * std::sin(a) + v.z * std::cos(a)});
    });
  }

  void larger_radius() {
    SCOPED_TRACE("larger radius");
    verify::CheckedMill tool = p_.tool;
    tool.radius += 0.1;
    if (p_.tool.corner_radius == p_.tool.radius) tool.corner_radius += 0.1;
    const verified::Says says = say(p_.program, tool);
    const verify::CheckedPath path = p_.path(p_.program, tool);
    // What is reported is there, and no move that is tried does more.
    const std::uint32_t move = says.deviation.gouge.move;
    EXPECT_GE(gouge_by_trial(fine_, tool, moments(path, move, move)),
              says.deviation.gouge.mm - says.bound_mm - kTrial);
    for (int i = 0; i < 8; ++i) {
      const auto tried = static_cast<std::uint32_t>(random_.below(gotos_.size()));
      EXPECT_LE(gouge_by_trial(fine_, tool, moments(path, tried, tried)),
                says.deviation.gouge.mm + says.bound_mm);
    }
    EXPECT_GE(says.deviation.gouge.mm, clean_.deviation.gouge.mm - says.bound_mm);
  }

  void pass_dropped() {
    SCOPED_TRACE("pass dropped");
    const int last = *std::max_element(p_.pass.begin(), p_.pass.end());
    ASSERT_GE(last, 3);
    const int drop = 1 + static_cast<int>(random_.below(static_cast<std::size_t>(last) - 1));
    cl::Program program;
    std::vector<Point3> dropped;
    for (std::size_t i = 0; i < p_.program.records.size(); ++i) {
      if (p_.pass[i] != drop) {
        program.add(p_.program.records[i], p_.program.source[i]);
        continue;
      }
      if (!cl::is_motion(p_.program.records[i])) continue;
      const cl::Pose& pose = *cl::pose_of(p_.program.records[i]);
      const bool ends = i + 1 == p_.pass.size() || p_.pass[i + 1] != drop;
      if (dropped.empty() || ends) program.add(cl::Rapid{lifted(pose, 25)});
      if (ends) program.add(cl::Feed{pose});
      dropped.push_back(pose.tip);
    }
    const verified::Says says = say(program, p_.tool);
    EXPECT_TRUE(says.deviation.unmachined_area_mm2 > 0 ||
                says.deviation.excess.mm > 1.5 * clean_.deviation.excess.mm + says.bound_mm)
        << says.deviation.excess.mm << " before " << clean_.deviation.excess.mm;
    double nearest = 1e9;
    for (const Point3 p : dropped) nearest = std::min(nearest, distance(p, says.deviation.excess.at));
    EXPECT_LE(nearest, 2 * p_.tool.radius + 1);
  }

  /// From a place of a pass below another one and back.
  void rapid_through_the_part() {
    SCOPED_TRACE("rapid through the part");
    const std::size_t k = some_cut(), other = some_cut();
    cl::Pose below = lifted(pose_at(p_.program, gotos_[other]), -random_.in(0.3, 1));
    below.axis = pose_at(p_.program, gotos_[k]).axis;
    cl::Program program;
    for (std::size_t i = 0; i < p_.program.records.size(); ++i) {
      program.add(p_.program.records[i], p_.program.source[i]);
      if (i == gotos_[k]) {
        program.add(cl::Rapid{below});
        program.add(cl::Rapid{*cl::pose_of(p_.program.records[i])});
      }
    }
    const verify::CheckedPath path = p_.path(program, p_.tool);
    const auto found = collisions(path);
    const auto move = static_cast<std::uint32_t>(k + 1);
    const double tried = depth_by_trial(fine_, p_.tool, moments(path, move, move));
    double depth = 0;
    for (const verify::Collision& c : found.collisions) {
      if (c.body != verify::Body::cutter) continue;
      EXPECT_TRUE(c.move == move || c.move == move + 1) << c.move;
      if (c.move == move) depth = c.depth_mm;
    }
    EXPECT_GT(depth, 0.1);
    EXPECT_GE(depth, tried - found.bound_mm - p_.design.deflection_mm);
    // Samples are up to 0.07 from any place.
    EXPECT_LE(depth, tried + 0.07);
  }

  /// A wall square to X beyond all that the holder sweeps.
  void holder_into_a_wall() {
    SCOPED_TRACE("holder into a wall");
    const verify::ToolCylinder holder = p_.tool.cylinders.back();
    const auto reach = [&](double radius) {
      double most = -1e9, deep = 0;
      const double wall = wall_;
      const verify::CheckedPath path = p_.path(p_.program, p_.tool);
      for (const cl::Pose& pose : moments(path, 0, static_cast<std::uint32_t>(gotos_.size()))) {
        const double up = pose.axis.x, aside = std::sqrt(std::max(0.0, 1 - up * up));
        const double x = pose.tip.x + radius * aside + up * (up > 0 ? holder.to : holder.from);
        most = std::max(most, x);
        // A sharp rim: deepest where side and end are equally near.
        deep = std::max(deep, (x - wall) / (aside + std::abs(up)));
      }
      return std::pair{most, deep};
    };
    wall_ = reach(holder.radius).first + 0.5;
    p_.design.obstacles = geom::Mesh{};
    for (const double y : {-500.0, 500.0})
      for (const double z : {-500.0, 500.0}) p_.design.obstacles.vertices.push_back({wall_, y, z});
    p_.design.obstacles.triangles = {{0, 1, 2}, {1, 3, 2}};
    const auto of_holder = [&](double radius) {
      verify::CheckedMill tool = p_.tool;
      tool.cylinders.back().radius = radius;
      double most = 0;
      const auto found = collisions(p_.path(p_.program, tool));
      for (const verify::Collision& c : found.collisions)
        if (c.against == verify::Against::obstacle) {
          EXPECT_EQ(c.body, verify::Body::holder);
          most = std::max(most, c.depth_mm);
        }
      bound_ = found.bound_mm;
      return most;
    };
    EXPECT_EQ(of_holder(holder.radius), 0);
    const double radius = holder.radius + 0.5 + random_.in(0.02, 2);
    EXPECT_NEAR(of_holder(radius), reach(radius).second, bound_ + kTrial);
    p_.design.obstacles = {};
  }

 private:
  verified::Says say(const cl::Program& program, const verify::CheckedMill& tool) const {
    return verified::say(p_.design, p_.path(program, tool), p_.spacing_mm, 0.02);
  }
  verify::CollisionReport collisions(const verify::CheckedPath& path) const {
    auto found = verify::find_collisions(p_.design.mesh, p_.design.obstacles, path, {.tolerance_mm = 0.02});
    EXPECT_TRUE(found.ok()) << found.error().to_string();
    return found.ok() ? *std::move(found) : verify::CollisionReport{};
  }
  /// A GOTO in the middle of a pass that is not at the border.
  std::size_t some_cut() {
    const int most = *std::max_element(p_.pass.begin(), p_.pass.end());
    for (int i = 0; i < 10'000; ++i) {
      const std::size_t k = 1 + random_.below(gotos_.size() - 2);
      const int pass = p_.pass[gotos_[k]];
      if (pass > 0 && pass < most && p_.pass[gotos_[k - 1]] == pass && p_.pass[gotos_[k + 1]] == pass)
        return k;
    }
    ADD_FAILURE() << "no cut";
    return 1;
  }

  /// Tried until a place was found where it does harm (it may stand at the border).
  void planted(const char* what, const std::function<void(cl::Pose&)>& fault) {
    SCOPED_TRACE(what);
    for (int i = 0; i < 40; ++i) {
      cl::Program program = p_.program;
      const std::size_t k = some_cut();
      fault(pose_at(program, gotos_[k]));
      const verify::CheckedPath path = p_.path(program, p_.tool);
      const auto move = static_cast<std::uint32_t>(k);
      const double tried = gouge_by_trial(fine_, p_.tool, moments(path, move, move + 1));
      if (tried < 0.015 + clean_.deviation.gouge.mm) continue;
      const verified::Says says = say(program, p_.tool);
      EXPECT_GE(says.deviation.gouge.mm, tried - says.bound_mm);
      EXPECT_LE(says.deviation.gouge.mm, tried + says.bound_mm + kTrial);
      EXPECT_TRUE(says.deviation.gouge.move == move || says.deviation.gouge.move == move + 1)
          << says.deviation.gouge.move << " for " << move;
      return;
    }
    ADD_FAILURE() << "harms nowhere";
  }

  Planned p_;
  Random random_;
  std::vector<std::size_t> gotos_;  ///< records
  std::vector<verify::SurfaceSample> fine_;
  verified::Says clean_;
  double wall_ = 0, bound_ = 0;
};

// --- operations

/// A face of 30 x 20 mm, bent by two curvatures.
geom::NurbsSurface bent(Random& random) {
  geom::PointGrid grid{13, 9, {}};
  const double kx = random.in(-0.004, 0.004), ky = random.in(-0.004, 0.004), wave = random.in(0, 0.3);
  for (int j = 0; j < grid.count_v; ++j)
    for (int i = 0; i < grid.count_u; ++i) {
      const double x = -15 + 30.0 * i / (grid.count_u - 1), y = -10 + 20.0 * j / (grid.count_v - 1);
      grid.points.push_back({x, y, 0.5 * (kx * x * x + ky * y * y) + wave * std::sin(x / 6)});
    }
  return geom::interpolate(grid).value();
}
verified::Design design_of(const geom::NurbsSurface& surface) {
  auto triangles = geom::tessellate(surface, false, {}, {0.0005, 0, 2'000'000}).value();
  return {std::move(triangles.mesh), {}, {}, triangles.deflection_mm};
}

std::optional<Planned> orient_case(unsigned seed) {
  Random random(seed);
  orient::Part part;
  orient::DesignFace face;
  face.surface = bent(random);
  face.number = 1;
  Planned out;
  out.design = design_of(face.surface);
  part.mesh = out.design.mesh;
  part.design_triangles = part.mesh.triangles.size();
  part.deflection_mm = out.design.deflection_mm;
  for (const Point3& p : part.mesh.vertices) part.bounds.add(p);
  part.faces.push_back(std::move(face));
  const model::Mill mill{model::MillKind::bull, 8, random.in(1, 3), 30, {{20, 60}}};
  orient::OrientOptions options;
  options.range.alpha_hi = geom::radians(30);
  options.objective = orient::Objective::radius;
  options.search = orient::Search::sturz;
  options.smooth = false;
  options.scallop_mm = 0.01;
  options.paths.max_step_mm = 3;
  const orient::Scene scene(part.mesh, mill,
                            orient::tool_body(mill, options.tolerance_mm, options.clearance_mm));
  const orient::MachineLimits limits;
  LocalWorkers workers(0);
  Diagnostics diagnostics;
  const auto plan =
      orient::plan(part, scene, limits, {}, nullptr, options, workers, diagnostics, nullptr).value();
  out.program = orient::to_cl(part, scene, limits, plan.paths, {}).value().program;
  std::vector<int> path_of_point;
  for (std::size_t i = 0; i < plan.paths.size(); ++i)
    path_of_point.insert(path_of_point.end(), plan.paths[i].points.size(), static_cast<int>(i));
  for (const std::uint32_t source : out.program.source)
    out.pass.push_back(source < path_of_point.size() ? path_of_point[source] : -1);
  out.tool = job::checked_mill(mill);
  out.gouge_mm = 1.3 * options.tolerance_mm;
  out.excess_mm = 5;
  out.ends = true;
  return out;
}

std::optional<Planned> cycle_case(unsigned seed) {
  Random random(seed);
  nc::SurfaceBlock block;
  block.number = 10;
  block.surface = bent(random);
  block.tool_diameter = 6;
  block.feed = 1500;
  block.scallop = 0.02;
  nc::SurfaceWriteOptions write;
  write.name = "random";
  write.method = nc::PathMethod::iso_scallop;
  write.tool_diameter = 6;
  write.scallop = 0.02;
  write.feed = 1500;
  write.safety_z = 30;
  write.decimals = 9;
  job::CycleOptions options;
  options.file_name = "random.nc";
  options.along = cycle::Along::u;
  Diagnostics diagnostics;
  const auto job =
      job::make_cycle_job(nc::write_surface_program({block}, write).value(), options, diagnostics, nullptr);
  EXPECT_TRUE(job.ok()) << job.error().to_string();
  if (!job) return {};
  Planned out;
  // (A point of an arc cannot be moved by itself.)
  out.program = job::as_lines(*job, 0.001);
  out.program.from.reset();  // the operator's affair
  // Along x, to and fro: a pass is what goes one way for long.
  int pass = -1;
  std::vector<std::size_t> run;
  double begin = 0, sign = 0;
  cl::Pose at;
  out.pass.assign(out.program.records.size(), -1);
  const auto close = [&] {
    if (!run.empty() && std::abs(at.tip.x - begin) > 15) {
      ++pass;
      for (const std::size_t i : run) out.pass[i] = pass;
    }
    run.clear();
  };
  for (std::size_t i = 0; i < out.program.records.size(); ++i) {
    const cl::Pose* to = cl::pose_of(out.program.records[i]);
    if (!to) continue;
    const double dx = to->tip.x - at.tip.x;
    const bool cut = !std::holds_alternative<cl::Rapid>(out.program.records[i]);
    if (!cut || dx * sign <= 0) close(), begin = at.tip.x, sign = dx;
    if (cut) run.push_back(i);
    at = *to;
  }
  close();
  out.tool = {3, 3, 12, {{20, 12, 60, true}}};
  out.design = design_of(block.surface);
  out.gouge_mm = options.tolerance_mm;
  out.excess_mm = 0.02 * 1.02 + options.tolerance_mm;
  return out;
}

struct Operation {
  const char* name;
  std::optional<Planned> (*make)(unsigned seed);
  bool tilts;  ///< an axis that stands otherwise cuts (a ball about its tip does on slopes only)
};
class VerifyFaults : public testing::TestWithParam<Operation> {};

TEST_P(VerifyFaults, AreFound) {
  auto planned = GetParam().make(7);
  ASSERT_TRUE(planned);
  Faults faults(*std::move(planned), 3);
  faults.clean();
  faults.point_too_deep();
  if (GetParam().tilts) faults.axis_tilted();
  faults.larger_radius();
  faults.pass_dropped();
  faults.rapid_through_the_part();
  faults.holder_into_a_wall();
}

INSTANTIATE_TEST_SUITE_P(Operations, VerifyFaults,
                         testing::Values(Operation{"orient", orient_case, true},
                                         Operation{"cycle", cycle_case, false}),
                         [](const auto& op) { return std::string(op.param.name); });

}  // namespace
}  // namespace burin
