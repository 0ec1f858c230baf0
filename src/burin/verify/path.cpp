// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/verify/joint_pieces.h"
#include "burin/verify/mill_search.h"

namespace burin::verify {
namespace {

using geom::Point3;
using geom::Vec3;

// Ends of arcs may lie so far off their circle (controls refuse between 0.01 and 0.02).
constexpr double kArcEnds_mm = 0.05;

class Builder {
 public:
  Builder(const cl::Program& program, const ToolSource& tool, const PathOptions& options)
      : program_(program), source_(tool), options_(options) {}

  /// What the second make_checked_path knows of the motion.
  void joints(const std::vector<kinematics::Joints>& joints, const std::vector<bool>& tip_straight,
              const kinematics::Kinematics& machine) {
    joints_ = &joints;
    tip_straight_ = &tip_straight;
    machine_ = &machine;
  }

  Result<CheckedPath> run() {
    if (auto ok = begin(); !ok) return ok.error();
    for (record_ = 0; record_ < program_.records.size(); ++record_) {
      const cl::Record& record = program_.records[record_];
      if (const auto* change = std::get_if<cl::ToolChange>(&record)) load(*change);
      if (!cl::is_motion(record)) continue;
      if (auto ok = motion(record); !ok) return ok.error();
    }
    return std::move(path_);
  }

 private:
  std::size_t move() const { return path_.moves.size(); }
  std::uint32_t line() const {
    const std::uint32_t line = record_ < program_.source.size() ? program_.source[record_] : 0;
    return line == cl::Program::kNoSource ? 0 : line;
  }
  Error wrong(ErrorCode code, const std::string& what) const {
    Error error{code, "move " + std::to_string(move()) + ": " + what, {}};
    error.where.line = static_cast<int>(line());
    return error;
  }

  Result<void> begin() {
    if (!(options_.motion_mm > 0)) return Error{ErrorCode::range, "the bound of the motion (above 0 mm)", {}};
    if (joints_ && joints_->size() != program_.move_count())
      return Error{ErrorCode::internal, "one set of joints is needed for each move", {}};
    if (!program_.from) return {};
    if (auto ok = check(*program_.from); !ok) return ok;
    at_ = *program_.from;
    if (!machine_) return {};
    auto joints = machine_->inverse(*at_, {});
    if (!joints) return joints.error();
    joints_at_ = *joints;
    return {};
  }

  /// A tool that is in the spindle already is not changed.
  void load(const cl::ToolChange& change) {
    if (change == loaded_) return;
    if (begun_) at_.reset();  // the way to the change and back is the machine's
    loaded_ = change;
    tool_ready_ = false;
  }

  Result<void> ready_tool(const cl::Pose& from) {
    if (tool_ready_) return {};
    auto tool = source_(loaded_);
    if (!tool) return tool.error();
    if (auto ok = validate(*tool); !ok) return ok.error();
    span_ = span(*tool);
    path_.tools.push_back({std::move(*tool), loaded_.number, from, {}});
    tool_ready_ = true;
    return {};
  }

  Result<void> check(const cl::Pose& pose) const {
    if (!is_finite(pose.tip) || !is_finite(pose.axis))
      return wrong(ErrorCode::geometry, "a pose that is not finite");
    if (!is_axis(pose.axis)) return wrong(ErrorCode::geometry, "the tool axis is no unit vector");
    return {};
  }

  Result<void> motion(const cl::Record& record) {
    const cl::Pose& to = *cl::pose_of(record);
    const bool rapid = std::holds_alternative<cl::Rapid>(record);
    const auto* arc = std::get_if<cl::Arc>(&record);
    if (auto ok = check(to); !ok) return ok;
    if (move() < options_.unknown.size() && options_.unknown[move()]) {
      at_.reset();
      tool_ready_ = false;
      if (joints_) joints_at_ = (*joints_)[move()];
      path_.moves.push_back({static_cast<std::uint32_t>(record_), line(), rapid});
      return {};
    }
    if (arc && !at_) return wrong(ErrorCode::geometry, "an arc from nowhere (a move before it)");
    if (auto ok = ready_tool(at_.value_or(to)); !ok) return ok;
    rapid_ = rapid;
    Result<void> done;
    if (joints_) {
      done = arc ? joint_arc(*arc) : joint_move();
      joints_at_ = (*joints_)[move()];
    } else {
      done = !at_ ? piece(to) : arc ? this->arc(*arc) : straight(to);
      at_ = to;
    }
    if (!done) return done;
    begun_ = true;
    path_.moves.push_back({static_cast<std::uint32_t>(record_), line(), rapid});
    return {};
  }

  Result<void> piece(const cl::Pose& to) {
    if (pieces_ == options_.max_pieces)
      return wrong(ErrorCode::range, "more than " + std::to_string(options_.max_pieces) +
                                         " straight pieces (a shorter program, a coarser motion bound)");
    ++pieces_;
    path_.tools.back().pieces.push_back({to, static_cast<std::uint32_t>(move()), rapid_});
    return {};
  }

  Error half_turn() const {
    return wrong(ErrorCode::geometry,
                 "the axis turns by half a turn, which no great circle decides (put a pose between)");
  }

  Result<void> straight(const cl::Pose& to) {
    if (opposite(at_->axis, to.axis)) {
      if (!rapid_) return half_turn();
      // The way of a rapid is the machine's: over an axis across both, one as good as another.
      const Vec3 a = at_->axis;
      const Vec3 aside = std::abs(a.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
      if (auto ok = piece({lerp(at_->tip, to.tip, 0.5), unit(aside - dot(aside, a) * a)}); !ok) return ok;
    }
    return piece(to);
  }

  /// Chords: the tip leaves a chord over the angle h by at most r h^2 / 8, the axis turns as evenly as it
  /// does on the arc. Ends that do not lie on the circle make a spiral of it.
  Result<void> arc(const cl::Arc& arc) {
    if (!is_finite(arc.center) || !is_axis(arc.normal))
      return wrong(ErrorCode::geometry, "an arc without centre or direction");
    if (opposite(at_->axis, arc.to.axis)) return half_turn();
    const Vec3 n = unit(arc.normal), start = at_->tip - arc.center, end = arc.to.tip - arc.center;
    const double rise0 = dot(start, n), rise1 = dot(end, n);
    const Vec3 out = start - rise0 * n;
    const double r0 = norm(out), r1 = norm(end - rise1 * n);
    if (!(std::abs(r0 - arc.radius) <= kArcEnds_mm && std::abs(r1 - arc.radius) <= kArcEnds_mm))
      return wrong(ErrorCode::geometry, "the ends of the arc lie " + format_fixed(r0 - arc.radius, 4) +
                                            " and " + format_fixed(r1 - arc.radius, 4) +
                                            " mm off its circle (at most " + format_shortest(kArcEnds_mm) +
                                            ")");
    const double sweep = cl::arc_sweep(at_->tip, arc);
    const double bend = (std::max(r0, r1) * sweep + 2 * std::abs(r1 - r0)) * sweep / 8;
    const double count = std::max(1.0, std::ceil(std::sqrt(bend / options_.motion_mm)));
    const Vec3 x = unit(out), y = cross(n, x);
    const Stretch turn = Stretch::between(*at_, arc.to);
    for (double k = 1; k <= count; ++k) {
      const double t = k / count, r = r0 + t * (r1 - r0), angle = t * sweep;
      cl::Pose to = arc.to;
      if (k < count)
        to = {arc.center + (r * std::cos(angle)) * x + (r * std::sin(angle)) * y +
                  (rise0 + t * (rise1 - rise0)) * n,
              turn.at(t).axis};
      if (auto ok = piece(to); !ok) return ok;
    }
    path_.motion_mm = std::max(path_.motion_mm, bend / (count * count));
    return {};
  }

  Result<void> joint_move() {
    const kinematics::Joints& to = (*joints_)[move()];
    for (const double x : {to.linear[0], to.linear[1], to.linear[2], to.rotary[0], to.rotary[1]})
      if (!std::isfinite(x)) return wrong(ErrorCode::geometry, "a position that is not finite");
    if (!at_) {
      at_ = path_.tools.back().from = machine_->forward(to);
      return piece(*at_);
    }
    const bool tip_straight = move() < tip_straight_->size() && (*tip_straight_)[move()];
    auto pieces = split_joint_way({machine_, joints_at_, to, tip_straight}, span_, options_.motion_mm,
                                  options_.max_pieces - pieces_);
    if (!pieces) return wrong(pieces.error().code, pieces.error().message);
    for (const cl::Pose& pose : pieces->ends)
      if (auto ok = piece(pose); !ok) return ok;
    path_.motion_mm = std::max(path_.motion_mm, pieces->motion_mm);
    at_ = pieces->ends.back();
    return {};
  }
  /// The record says it in the part frame, which the rotary axes have to leave where it is.
  Result<void> joint_arc(const cl::Arc& record) {
    if ((*joints_)[move()].rotary != joints_at_.rotary)
      return wrong(ErrorCode::unsupported, "an arc while a rotary axis turns (lines)");
    if (auto ok = arc(record); !ok) return ok;
    at_ = record.to;
    return {};
  }

  const cl::Program& program_;
  const ToolSource& source_;
  const PathOptions& options_;
  const std::vector<kinematics::Joints>* joints_ = nullptr;
  const std::vector<bool>* tip_straight_ = nullptr;
  const kinematics::Kinematics* machine_ = nullptr;

  CheckedPath path_;
  std::size_t record_ = 0, pieces_ = 0;
  std::optional<cl::Pose> at_;  // nothing: nobody knows
  kinematics::Joints joints_at_;
  cl::ToolChange loaded_;
  double span_ = 0;
  bool tool_ready_ = false, begun_ = false, rapid_ = false;
};

}  // namespace

std::size_t CheckedPath::piece_count() const {
  std::size_t n = 0;
  for (const ToolPath& t : tools) n += t.pieces.size();
  return n;
}

Result<void> validate(const CheckedPath& path) {
  if (!(std::isfinite(path.motion_mm) && path.motion_mm >= 0))
    return Error{ErrorCode::range, "the bound of the motion is no number (0 or more)", {}};
  for (const ToolPath& tool : path.tools) {
    if (auto ok = validate(tool.tool); !ok) return ok.error();
    const cl::Pose* from = &tool.from;
    if (auto ok = validate_pose(*from, tool.pieces.empty() ? 0 : tool.pieces.front().move); !ok)
      return ok.error();
    for (const PathPiece& piece : tool.pieces) {
      if (piece.move >= path.moves.size())
        return Error{ErrorCode::range, "a piece of the path belongs to no move", {}};
      if (auto ok = validate_pose(piece.to, piece.move); !ok) return ok.error();
      if (auto ok = validate_turn(*from, piece.to, piece.move); !ok) return ok.error();
      from = &piece.to;
    }
  }
  return {};
}

Result<CheckedPath> make_checked_path(const cl::Program& program, const ToolSource& tool,
                                      const PathOptions& options) {
  return Builder(program, tool, options).run();
}

Result<CheckedPath> make_checked_path(const cl::Program& program,
                                      const std::vector<kinematics::Joints>& joints,
                                      const std::vector<bool>& tip_straight,
                                      const kinematics::Kinematics& machine, const ToolSource& tool,
                                      const PathOptions& options) {
  Builder builder(program, tool, options);
  builder.joints(joints, tip_straight, machine);
  return builder.run();
}

}  // namespace burin::verify
