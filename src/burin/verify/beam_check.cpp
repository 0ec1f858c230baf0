// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/beam_check.h"

#include <cmath>
#include <exception>
#include <string>
#include <utility>

#include "burin/base/parallel.h"
#include "burin/verify/beam_parts.h"

namespace burin::verify {
namespace {

using geom::Segment;

Error bad_outline(std::size_t i, const char* what) {
  return {ErrorCode::geometry,
          "outline " + std::to_string(i) + " " + what + " (chains of finite lines and arcs)",
          {}};
}

/// Ends further apart than this are a gap. Readers join to the bit; the slack is for callers that compute.
constexpr double kJoined_mm = 1e-6;

Result<void> check(const std::vector<Outline>& outlines) {
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    const auto& s = outlines[i].segments;
    for (std::size_t k = 0; k < s.size(); ++k) {
      for (const double v :
           {s[k].a.x, s[k].a.y, s[k].b.x, s[k].b.y, s[k].center.x, s[k].center.y, s[k].radius}) {
        if (!std::isfinite(v)) return bad_outline(i, "has a number that is not finite");
      }
      if (k == 0 && !outlines[i].closed) continue;
      if (distance(s[(k + s.size() - 1) % s.size()].b, s[k].a) > kJoined_mm)
        return bad_outline(i, "has a gap");
    }
  }
  return {};
}

Result<void> check(const BeamCheckOptions& o) {
  const auto bad = [](const char* what) { return Error{ErrorCode::range, what, {}}; };
  if (!(o.kerf_mm > 0) || !std::isfinite(o.kerf_mm)) return bad("no kerf to check with (above 0 mm)");
  if (!(o.reach_mm > 0) || !std::isfinite(o.reach_mm)) return bad("an impossible reach (above 0 mm)");
  if (!(o.bound_mm > 0) || !std::isfinite(o.bound_mm)) return bad("an impossible bound (above 0 mm)");
  if (!(o.tolerance_mm >= 0) || !std::isfinite(o.tolerance_mm))
    return bad("an impossible tolerance (0 mm or more)");
  if (!(o.spacing_mm >= 0) || !std::isfinite(o.spacing_mm))
    return bad("an impossible spacing (above 0 mm, or 0 for a spacing from the kerf)");
  return {};
}

/// The outline that reaches furthest to the right lies in no other: the part is around everything when that
/// is a hole.
bool part_is_around(const std::vector<Outline>& outlines) {
  double furthest = 0;
  bool any = false, around = false;
  for (const Outline& o : outlines) {
    if (!o.closed || o.segments.empty()) continue;
    const geom::ArcSpline spline{o.segments, true};
    const double x = bounds_of(spline).hi.x;
    if (any && !(x > furthest)) continue;
    any = true;
    furthest = x;
    around = signed_area(spline) < 0;
  }
  return around;
}

/// Where every edge looked at has the part once on its left and not on its right, outlines do not lie in or
/// on each other the wrong way round. Should two cross between those places, both still have the right side.
bool sides_tell(const BeamScene& scene) {
  constexpr std::size_t kLooks = 20'000;
  const auto& edges = scene.edges.segments();
  const std::size_t step = edges.size() / kLooks + 1;
  for (std::size_t i = 0; i < edges.size(); i += step) {
    const flat::Point2 p = point_on(edges[i], 0.5);
    const flat::Vec2 n = kBeside_mm * flat::normal_at(edges[i], 0.5);
    if (scene.winding(p - n) != 1 || scene.winding(p + n) != 0) return false;
  }
  return true;
}

Result<BeamReport> checked(const std::vector<Outline>& outlines, const cl::Program& program,
                           const BeamCheckOptions& options) {
  if (auto ok = check(options); !ok) return ok.error();
  if (auto ok = check(outlines); !ok) return ok.error();
  auto motion = beam_motion(program, options.rapids_cut);
  if (!motion) return motion.error();
  std::vector<Segment> edges, lines;
  std::vector<std::uint32_t> edge_outline, line_outline;
  for (std::uint32_t i = 0; i < outlines.size(); ++i) {
    auto& segments = outlines[i].closed ? edges : lines;
    auto& owners = outlines[i].closed ? edge_outline : line_outline;
    for (const Segment& s : outlines[i].segments) {
      if (s.is_line() && s.a == s.b) continue;
      flat::quarters(s, segments);
    }
    owners.resize(segments.size(), i);
  }
  if (edges.empty() && lines.empty())
    return Error{ErrorCode::geometry, "no outline to check against (at least one line or arc)", {}};
  if (std::max(edges.size() + lines.size(), motion->pieces.size()) > options.max_samples) {
    return Error{ErrorCode::range,
                 "too many lines and arcs (up to " + std::to_string(options.max_samples) +
                     " of the outlines, and of the program)",
                 {}};
  }
  BeamScene scene{options,
                  0.5 * options.kerf_mm,
                  *motion,
                  flat::Tree(motion->pieces),
                  flat::Tree(std::move(edges)),
                  flat::Tree(std::move(lines)),
                  std::move(edge_outline),
                  std::move(line_outline),
                  part_is_around(outlines),
                  false,
                  options.tolerance_mm + options.bound_mm,
                  thread_count(options.threads)};
  scene.sides_tell = sides_tell(scene);
  auto report = measure_edges(scene);
  if (!report) return report;
  GougeResult gouge = find_gouge(scene);
  report->gouge = gouge.worst;
  report->gouge_area_mm2 = gouge.area_mm2;
  report->bound_mm = std::max(report->bound_mm, gouge.bound_mm) + motion->motion_mm + flat::kRounding;
  return report;
}

}  // namespace

Result<BeamReport> check_beam(const std::vector<Outline>& outlines, const cl::Program& program,
                              const BeamCheckOptions& options) {
  try {
    return checked(outlines, program, options);
  } catch (const std::exception& e) {  // memory
    return Error{
        ErrorCode::range, std::string("the check of the beam does not fit into memory: ") + e.what(), {}};
  }
}

}  // namespace burin::verify
