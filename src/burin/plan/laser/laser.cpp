// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/laser.h"

#include <cmath>

namespace burin::laser {
namespace {

Result<void> check(const LaserOptions& o) {
  const auto bad = [](const char* what) { return Error{ErrorCode::usage, what, {}}; };
  if (!std::isfinite(o.offset_mm) || std::abs(o.offset_mm) > 1e4)
    return bad("an impossible offset (up to 10000 mm)");
  if (!(o.tolerance.path_mm > 0)) return bad("an impossible tolerance (above 0 mm)");
  if (!(o.tolerance.join_mm >= 0)) return bad("an impossible join distance (0 mm or more)");
  if (!(o.feed_mm_min > 0)) return bad("an impossible cutting speed (above 0 mm/min)");
  if (!(o.power_w >= 0)) return bad("an impossible power (0 W or more)");
  if (o.copies.columns < 1 || o.copies.rows < 1 || o.copies.columns * o.copies.rows > 10000) {
    return bad("an impossible number of copies (1 to 10000 in all)");
  }
  if (o.micro_joints.per_contour < 0 || !(o.micro_joints.width_mm >= 0))
    return bad("impossible micro-joints (0 or more)");
  return {};
}

}  // namespace

Result<LaserJob> plan_laser(const io::Drawing& drawing, const LaserOptions& options, Diagnostics& diagnostics,
                            ProgressSink* progress) {
  if (auto ok = check(options); !ok) return ok.error();
  const auto go_on = [&](const char* stage, double done) {
    return !progress || progress->progress(stage, done);
  };
  const Error stopped{ErrorCode::usage, "stopped", {}};

  LaserJob job;
  if (!go_on("joining", 0.0)) return stopped;
  auto contours = join_contours(drawing, options, diagnostics);
  if (!contours) return contours.error();
  job.contours = std::move(*contours);
  if (job.contours.empty()) {
    return Error{ErrorCode::geometry,
                 "nothing to cut: the drawing holds no contour (lines, arcs, splines on visible layers)",
                 {}};
  }
  if (!go_on("offset", 0.2)) return stopped;
  auto profile = make_profile(job.contours, drawing, options, diagnostics);
  if (!profile) return profile.error();
  job.profile = std::move(*profile);
  if (!go_on("tool path", 0.6)) return stopped;
  auto toolpath = make_toolpath(job.profile, options, diagnostics);
  if (!toolpath) return toolpath.error();
  job.toolpath = std::move(*toolpath);
  go_on("tool path", 1.0);
  return job;
}

}  // namespace burin::laser
