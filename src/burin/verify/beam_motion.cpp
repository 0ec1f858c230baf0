// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/beam_motion.h"

#include <cmath>
#include <optional>
#include <string>

namespace burin::verify {
namespace {

using geom::Point2;
using geom::Segment;
using geom::Vec2;

/// Arcs whose normal leaves the sheet's by more than this (sine) are not in its plane: at a radius of 1 m
/// that is rounding.
constexpr double kUpright = 1e-9;
/// An arc of which start and end radius differ by D is taken as circles through points of the spiral between
/// them, a quarter turn each; those leave the spiral by 0.03 D (docs/verify-beam.md).
constexpr double kSpiralShare = 0.03;

class Walk {
 public:
  explicit Walk(bool rapids_cut) : rapids_cut_(rapids_cut) {}

  Result<BeamMotion> run(const cl::Program& program) {
    if (program.from) at_ = xy(program.from->tip);
    for (const cl::Record& record : program.records) {
      if (const auto* beam = std::get_if<cl::Beam>(&record)) {
        switch_to(beam->on);
        continue;
      }
      const cl::Pose* pose = cl::pose_of(record);
      if (!pose) continue;
      const Point2 to = xy(pose->tip);
      if (!std::isfinite(to.x) || !std::isfinite(to.y)) return wrong(ErrorCode::range, "ends nowhere");
      const bool cuts = on_ && at_ && (rapids_cut_ || !std::holds_alternative<cl::Rapid>(record));
      if (cuts) {
        if (const auto* arc = std::get_if<cl::Arc>(&record)) {
          if (auto ok = add_arc(*arc, to); !ok) return ok.error();
        } else {
          add(geom::make_line(*at_, to));
        }
      }
      at_ = to;
      ++move_;
    }
    switch_to(false);
    return std::move(motion_);
  }

 private:
  Error wrong(ErrorCode code, const char* what) const {
    return {
        code, "move " + std::to_string(move_) + " " + what + " (finite numbers, arcs in the XY plane)", {}};
  }

  void switch_to(bool on) {
    // Switched on and off at one place, the beam leaves a hole there.
    if (on_ && !on && at_ && !cut_) {
      motion_.pieces.push_back(geom::make_line(*at_, *at_));
      motion_.moves.push_back(move_ > 0 ? move_ - 1 : 0);
    }
    if (on != on_) cut_ = false;
    on_ = on;
  }

  void add(const Segment& s) {
    cut_ = true;
    flat::quarters(s, motion_.pieces);
    motion_.moves.resize(motion_.pieces.size(), move_);
  }

  Result<void> add_arc(const cl::Arc& arc, Point2 to) {
    const double up = arc.normal.z;
    if (!(std::hypot(arc.normal.x, arc.normal.y) <= kUpright) || up == 0)
      return wrong(ErrorCode::geometry, "is an arc that is not in the plane");
    const Point2 center = xy(arc.center), from = *at_;
    const double r0 = distance(from, center), r1 = distance(to, center);
    if (!std::isfinite(r0) || !std::isfinite(r1)) return wrong(ErrorCode::range, "has no centre");
    if (r0 == 0 || r1 == 0) {
      add(geom::make_line(from, to));
      return {};
    }
    double sweep = 2 * geom::kPi;
    if (distance(from, to) > cl::kSamePoint_mm) {
      const Vec2 u = from - center, v = to - center;
      sweep = std::atan2(cross(u, v), dot(u, v));
      if (up < 0) sweep = -sweep;
      if (sweep <= 0) sweep += 2 * geom::kPi;
    }
    const double uneven = std::abs(r1 - r0);
    const bool exact = uneven <= geom::kArcConsistency * (r0 + 1);
    if (!exact) motion_.motion_mm = std::max(motion_.motion_mm, kSpiralShare * uneven);
    const int parts = std::max(1, static_cast<int>(std::ceil(sweep / (0.5 * geom::kPi))));
    const Vec2 u = (from - center) / r0;
    const auto point = [&](int i) {
      if (i == 0) return from;
      if (i == parts) return to;
      const double f = double(i) / parts, angle = (up > 0 ? f : -f) * sweep;
      return center + (r0 + f * (r1 - r0)) * (std::cos(angle) * u + std::sin(angle) * left(u));
    };
    for (int i = 0; i < parts; ++i) {
      const Point2 a = point(i), b = point(i + 1);
      const double bulge = (up > 0 ? 1 : -1) * std::tan(0.25 * sweep / parts);
      add(exact ? Segment{a, b, center, up > 0 ? r0 : -r0, 0} : geom::from_bulge(a, b, bulge));
    }
    return {};
  }

  bool rapids_cut_;
  std::optional<Point2> at_;
  bool on_ = false, cut_ = false;
  std::uint32_t move_ = 0;
  BeamMotion motion_;
};

}  // namespace

Result<BeamMotion> beam_motion(const cl::Program& program, bool rapids_cut) {
  return Walk(rapids_cut).run(program);
}

}  // namespace burin::verify
