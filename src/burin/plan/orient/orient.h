// SPDX-License-Identifier: Apache-2.0
// The plan of a five-axis face-milling job: contact points, their tool angles, and the tool path. mm,
// radians.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/base/workers.h"
#include "burin/cl/program.h"
#include "burin/kinematics/kinematics.h"
#include "burin/plan/orient/paths.h"
#include "burin/plan/orient/smooth.h"

namespace burin::orient {

enum class Objective { radius, strip };
/// optimal: the true optimum; contour: the paper's procedure; sturz: one tilt for all, yaw 0.
enum class Search { optimal, contour, sturz };

struct OrientOptions {
  AngleRange range{1.5 * geom::kPi / 180, 20 * geom::kPi / 180, -geom::kPi / 2, geom::kPi / 2};
  double tolerance_mm = 0.01;
  double clearance_mm = 1;
  Objective objective = Objective::radius;
  Search search = Search::optimal;
  bool smooth = false;
  double scallop_mm = 0.05;
  double feed_mm_min = 1000;
  PathOptions paths;
  std::optional<double> side_step_mm;  ///< equal distances instead of what the strips allow
  std::optional<int> path_count;       ///< this many per face, evenly in w
  std::optional<double> sturz_tilt;    ///< radians; otherwise the least that suits all points
  double safety_mm = 20;               ///< above the part in rapids
  double spindle_rpm = 0;
  std::size_t max_points = 5'000'000;
};

struct OrientedPoint {
  CcPoint cc;
  Angles angles, initial;
  double rho = 0, rho_initial = 0;  ///< effective radii; 0 where not found
  Strip strip;
  cl::Pose pose;
  std::uint32_t tests = 0;
  Cause cause = Cause::none;
  bool reachable = false;
  bool initial_found = false;
};
struct OrientedPath {
  int number = 0, face = -1;
  double at = 0;
  std::vector<OrientedPoint> points;
  double smooth_loss = 0, speed_share = 0, acceleration_share = 0;
};

/// Another way to mill the same faces at the same scallop: one tilt for all at yaw 0 ("sturz"; the least tilt
/// that suits every point, else the one that suits most), or a ball-end mill of the same radius ("ball"; a
/// smaller one where the faces are bent more). Side steps follow the strips as in the plan.
struct Comparison {
  std::string name;
  bool possible = false;  ///< false: contacts came from a file, there is nothing to lay out
  double tilt = 0;        ///< sturz
  double radius_mm = 0;
  std::size_t unreachable = 0;  ///< sturz: contact points that the tilt does not suit
  std::size_t paths = 0;
  double cut_mm = 0;
  double minutes = 0;  ///< at the feed
};

struct OrientPlan {
  std::vector<OrientedPath> paths;
  std::size_t contact_points = 0, unreachable = 0;
  std::uint64_t tests = 0;
  double gain_mean = 0;  ///< mean of rho / rho_initial - 1 over points that have both (initial above 0)
  std::vector<double> gain_per_path;  ///< the same, a path
  double axis_step_max = 0;           ///< between neighbours of a path
  double cut_mm = 0;
  std::vector<Comparison> comparisons;
};

/// Contact points and their angles. `scene` holds the part's mesh and the mill. One path is one task of
/// `workers`; the result does not depend on how many there are. `contacts` in place of generated paths when
/// not empty. `machine`, whose limits `limits` are, tells `smooth` how the axes turn; nullptr: none. Errors:
/// options out of range (range), a search that does not fit the objective, no faces and no contacts (usage),
/// too many paths or points (range), those of PathFamily::make.
Result<OrientPlan> plan(const Part& part, const Scene& scene, const MachineLimits& limits,
                        const std::vector<CcPath>& contacts, const kinematics::Kinematics* machine,
                        const OrientOptions& options, Workers& workers, Diagnostics& diagnostics,
                        ProgressSink* progress);

Setting setting_of(const Scene& scene, const MachineLimits& limits, const OrientOptions& options);

}  // namespace burin::orient
