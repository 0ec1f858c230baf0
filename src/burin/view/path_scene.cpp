// SPDX-License-Identifier: Apache-2.0
#include "burin/view/path_scene.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "burin/base/text.h"
#include "burin/kinematics/feed_way.h"
#include "burin/kinematics/joint_path.h"

namespace burin::view {
namespace {

using geom::Point3;
using geom::Vec3;

constexpr std::size_t kMostNodes = 20'000'000;
constexpr std::size_t kMostTools = 255, kMostGroups = 65'535;
/// A turn of the axis or of the tip about a centre looks smooth in such steps; finer ones come from the
/// chord.
constexpr double kCoarsestStep = geom::kPi / 36, kFinestStep = geom::kPi / 720;
constexpr double kAxisStep = geom::kPi / 90;
/// However many turns an axis makes in one move.
constexpr double kMostSteps = 3600;
/// A cutter of which only the diameter is known is drawn so long.
constexpr double kLengthOfDiameter = 4;

std::string millimetres(double v) {
  return format_fixed(v, 3) + " mm";
}

class PathMaker {
 public:
  PathMaker(const PathView& view, Scene& scene)
      : view_(view), program_(*view.program), scene_(scene), path_(scene.path) {}

  Result<void> run() {
    if (view_.joints && (!view_.machine || view_.joints->size() != program_.move_count()))
      return Error{ErrorCode::internal, "scene: one set of joints of a machine is needed for each move", {}};
    find_beam();
    with_rotary_ = view_.machine && view_.machine->rotary_count() > 0;
    for (record_ = 0; record_ < program_.records.size(); ++record_) {
      const cl::Record& record = program_.records[record_];
      if (!cl::is_motion(record)) {
        state(record);
        continue;
      }
      motion(record);
      ++move_;
      if (path_.point.size() > kMostNodes)
        return Error{ErrorCode::range, "the path is too long to be shown (at most 20 million nodes)", {}};
    }
    finish();
    return {};
  }

 private:
  // --- what stands between the motions

  void find_beam() {
    beam_program_ = std::any_of(program_.records.begin(), program_.records.end(),
                                [](const cl::Record& r) { return std::holds_alternative<cl::Beam>(r); });
    if (beam_program_) scene_.tools.push_back(beam_tool(view_.kerf_mm));
  }

  void state(const cl::Record& record) {
    if (const auto* feed = std::get_if<cl::FeedRate>(&record)) feed_ = feed->mm_min;
    if (const auto* comment = std::get_if<cl::Comment>(&record)) {
      name_group(comment->text, 2);
      commented_ = true;
    }
    if (const auto* dwell = std::get_if<cl::Dwell>(&record)) wait(dwell->seconds);
    if (const auto* beam = std::get_if<cl::Beam>(&record)) switch_beam(beam->on);
    if (const auto* change = std::get_if<cl::ToolChange>(&record)) {
      if (*change == loaded_ && (tool_ready_ || moved_)) return;
      loaded_ = *change;
      tool_ready_ = false;
      name_group("tool " + std::to_string(change->number), 1);
    }
  }

  void switch_beam(bool on) {
    if (on && !beam_on_) {
      ++contours_;
      if (!commented_) name_group("contour " + std::to_string(contours_), 0);
    }
    if (!on && beam_on_) commented_ = false;
    beam_on_ = on;
  }

  /// The next motion begins a group of that name; of several names before it the weightiest counts.
  void name_group(const std::string& name, int weight) {
    if (next_group_weight_ > weight) return;
    next_group_ = name;
    next_group_weight_ = weight;
  }
  void enter_group() {
    if (next_group_weight_ < 0 && !scene_.groups.empty()) return;
    if (scene_.groups.empty() && next_group_weight_ < 0) next_group_ = "path";
    next_group_weight_ = -1;
    if (!scene_.groups.empty() && scene_.groups.back() == next_group_) return;
    if (scene_.groups.size() < kMostGroups) scene_.groups.push_back(next_group_);
  }

  // --- tools, in the order in which verify/path takes them

  void ready_tool() {
    if (tool_ready_ || beam_program_) return;
    tool_ready_ = true;
    SceneTool tool = drawn_tool();
    ++tools_seen_;
    const auto same = [&tool](const SceneTool& t) { return t.number == tool.number && t.name == tool.name; };
    const auto found = std::find_if(scene_.tools.begin(), scene_.tools.end(), same);
    tool_ = static_cast<std::size_t>(found - scene_.tools.begin());
    if (found != scene_.tools.end()) return;
    if (scene_.tools.size() < kMostTools) scene_.tools.push_back(std::move(tool));
    tool_ = scene_.tools.size() - 1;
  }
  SceneTool drawn_tool() const {
    if (view_.checked && tools_seen_ < view_.checked->tools.size()) {
      const verify::ToolPath& t = view_.checked->tools[tools_seen_];
      return scene_tool(t.tool, t.tool_number);
    }
    const double r = loaded_.diameter / 2;
    if (r > 0 && std::isfinite(r)) {
      const double corner = std::clamp(loaded_.corner_radius, 0.0, r);
      return scene_tool({r, corner, kLengthOfDiameter * loaded_.diameter, {}}, loaded_.number);
    }
    return {loaded_.number, loaded_.number ? "tool " + std::to_string(loaded_.number) : "tool", {}, 0};
  }

  // --- nodes

  std::uint32_t line() const {
    if (!view_.lines.empty()) return record_ < view_.lines.size() ? view_.lines[record_] : 0;
    const std::uint32_t source = record_ < program_.source.size() ? program_.source[record_] : 0;
    return source == cl::Program::kNoSource ? 0 : source;
  }

  void node(const cl::Pose& pose, const std::array<double, 2>& rotary, WayKind kind) {
    path_.point.push_back(pose.tip);
    path_.axis.push_back(geom::unit(pose.axis));
    path_.time_s.push_back(time_);
    path_.kind.push_back(kind);
    path_.feed_mm_min.push_back(kind == WayKind::rapid ? 0 : feed_);
    path_.move.push_back(static_cast<std::uint32_t>(move_));
    path_.line.push_back(line());
    path_.tool.push_back(static_cast<std::uint8_t>(tool_));
    path_.group.push_back(static_cast<std::uint16_t>(scene_.groups.empty() ? 0 : scene_.groups.size() - 1));
    if (with_rotary_) path_.rotary_deg.push_back({geom::degrees(rotary[0]), geom::degrees(rotary[1])});
  }

  /// FROM/, or the end of the first motion when nobody says where it begins.
  void begin(const cl::Pose& pose) {
    at_ = pose;
    joints_at_ = joints_for(pose, nullptr);
    node(pose, joints_at_.rotary, WayKind::rapid);
  }

  void wait(double seconds) {
    if (!at_ || !(seconds > 0)) return;
    time_ += seconds;
    const std::size_t now = move_;
    move_ = std::max<std::size_t>(1, move_) - 1;  // the GOTO it stands at the end of
    node(*at_, joints_at_.rotary, WayKind::dwell);
    move_ = now;
  }

  /// Given, or the machine's nearest solution; those before when there is none.
  kinematics::Joints joints_for(const cl::Pose& pose, const kinematics::Joints* given) {
    if (given) return *given;
    if (!with_rotary_) return {};
    auto joints = view_.machine->inverse(pose, joints_at_);
    if (joints) return *joints;
    if (!beyond_) beyond_ = "move " + std::to_string(move_) + ": " + joints.error().message;
    return joints_at_;
  }

  WayKind kind_of(const cl::Record& record) const {
    if (std::holds_alternative<cl::Rapid>(record)) return WayKind::rapid;
    return beam_program_ && !beam_on_ ? WayKind::link : WayKind::feed;
  }

  void motion(const cl::Record& record) {
    const cl::Pose& to = *cl::pose_of(record);
    enter_group();
    ready_tool();
    // With the tool and in the group of the first motion.
    if (!at_ && program_.from) begin(*program_.from);
    const kinematics::Joints* given = view_.joints ? &(*view_.joints)[move_] : nullptr;
    if (!at_) {
      begin(given ? view_.machine->forward(*given) : to);
      if (given) joints_at_ = *given;
      moved_ = true;
      return;
    }
    const kinematics::Joints end = joints_for(to, given);
    const WayKind kind = kind_of(record);
    const auto* arc = std::get_if<cl::Arc>(&record);
    const bool straight_tip =
        view_.tip_straight && move_ < view_.tip_straight->size() && (*view_.tip_straight)[move_];
    if (arc) {
      along_arc(*arc, end, kind);
    } else if (given && with_rotary_ && !straight_tip) {
      along_joints(end, kind);
    } else if (given && with_rotary_) {
      along_straight_tip(to, end, kind);
    } else {
      along_pose(to, end, kind);
    }
    at_ = cl::Pose{path_.point.back(), path_.axis.back()};
    joints_at_ = end;
    moved_ = true;
  }

  /// Nodes at equal shares of the way; `at` gives pose and joints at t. Time: `seconds` in all.
  template <class At>
  void steps(double count, double seconds, WayKind kind, const At& at) {
    const double n = std::clamp(std::ceil(count), 1.0, kMostSteps), from = time_;
    for (double k = 1; k <= n; ++k) {
      time_ = from + seconds * k / n;
      const auto [pose, rotary] = at(k / n);
      node(pose, rotary, kind);
    }
  }

  double steps_of_turn(const kinematics::Joints& end) const {
    double most = 0;
    for (std::size_t i = 0; i < 2; ++i) most = std::max(most, std::abs(end.rotary[i] - joints_at_.rotary[i]));
    return most / kAxisStep;
  }
  std::array<double, 2> rotary_at(const kinematics::Joints& end, double t) const {
    return kinematics::between(joints_at_, end, t).rotary;
  }

  double seconds(WayKind kind, double length, double turn, const kinematics::Joints& end) const {
    const double least = with_rotary_ ? 60 * kinematics::least_minutes(*view_.machine, joints_at_, end) : 0;
    if (kind != WayKind::rapid && feed_ > 0 && length > 0) return std::max(60 * length / feed_, least);
    if (least > 0) return least;
    return 60 * std::max(length / rapid_speed(), geom::degrees(turn) / view_.turn_deg_min);
  }
  double rapid_speed() const {
    if (!view_.machine) return view_.rapid_mm_min;
    double speed = 0;
    for (const model::Axis& a : view_.machine->machine().axes)
      if (a.kind == model::AxisKind::linear) speed = std::max(speed, a.speed);
    return speed > 0 ? speed : view_.rapid_mm_min;
  }

  void along_pose(const cl::Pose& to, const kinematics::Joints& end, WayKind kind) {
    const kinematics::FeedWay way(*at_, to);
    // Without a turn one line is exact.
    const double count = way.turn() > 1e-9 ? std::max(way.turn() / kAxisStep, steps_of_turn(end)) : 1;
    steps(count, seconds(kind, way.length(), way.turn(), end), kind, [&](double t) {
      return std::pair{t < 1 ? way.at(t) : to, rotary_at(end, t)};
    });
  }

  void along_arc(const cl::Arc& arc, const kinematics::Joints& end, WayKind kind) {
    const double sweep = cl::arc_sweep(at_->tip, arc), length = cl::arc_length(at_->tip, arc);
    const double r = std::max(arc.radius, view_.chord_mm);
    const double step = std::clamp(2 * std::acos(1 - view_.chord_mm / r), kFinestStep, kCoarsestStep);
    const Vec3 n = geom::unit(arc.normal), start = at_->tip - arc.center;
    const double rise0 = dot(start, n), rise1 = dot(arc.to.tip - arc.center, n);
    const Vec3 out = start - rise0 * n, side = cross(n, out);
    const kinematics::FeedWay turn(*at_, arc.to);
    steps(sweep / step, seconds(kind, length, turn.turn(), end), kind, [&](double t) {
      if (t >= 1) return std::pair{arc.to, end.rotary};
      const double a = t * sweep;
      const Point3 p =
          arc.center + std::cos(a) * out + std::sin(a) * side + (rise0 + t * (rise1 - rise0)) * n;
      return std::pair{cl::Pose{p, turn.at(t).axis}, rotary_at(end, t)};
    });
  }

  void along_joints(const kinematics::Joints& end, WayKind kind) {
    const kinematics::TipMotion tip = kinematics::tip_motion(*view_.machine, joints_at_, end);
    steps(steps_of_turn(end), seconds(kind, tip.length, 0, end), kind, [&](double t) {
      const kinematics::Joints j = kinematics::between(joints_at_, end, t);
      return std::pair{view_.machine->forward(j), j.rotary};
    });
  }
  void along_straight_tip(const cl::Pose& to, const kinematics::Joints& end, WayKind kind) {
    const cl::Pose from = *at_;
    steps(steps_of_turn(end), seconds(kind, geom::distance(from.tip, to.tip), 0, end), kind, [&](double t) {
      const auto rotary = rotary_at(end, t);
      kinematics::Joints turned;
      turned.rotary = rotary;
      return std::pair{cl::Pose{lerp(from.tip, to.tip, t), view_.machine->forward(turned).axis}, rotary};
    });
  }

  void finish() {
    const bool upright = std::all_of(path_.axis.begin(), path_.axis.end(), [](const Vec3& a) {
      return a == Vec3{0, 0, 1};
    });
    if (upright) path_.axis.clear();
    if (scene_.groups.empty()) scene_.groups.push_back("path");
    if (with_rotary_ && !beyond_) {
      scene_.machine = scene_machine(*view_.machine);
      return;
    }
    path_.rotary_deg.clear();
    if (beyond_)
      scene_.findings.push_back(
          {SceneFinding::Level::warning, "the machine cannot take every pose", *beyond_, {}, {}});
  }

  const PathView& view_;
  const cl::Program& program_;
  Scene& scene_;
  ScenePath& path_;
  std::size_t record_ = 0, move_ = 0;
  double time_ = 0, feed_ = 0;
  std::optional<cl::Pose> at_;
  kinematics::Joints joints_at_;
  bool with_rotary_ = false, moved_ = false;
  bool beam_program_ = false, beam_on_ = false, commented_ = false;
  std::size_t contours_ = 0;
  cl::ToolChange loaded_;
  bool tool_ready_ = false;
  std::size_t tool_ = 0, tools_seen_ = 0;
  std::string next_group_;
  int next_group_weight_ = -1;
  std::optional<std::string> beyond_;
};

}  // namespace

Result<void> put_path(const PathView& view, Scene& scene) {
  if (!view.program) return {};
  return PathMaker(view, scene).run();
}

SceneTool scene_tool(const verify::CheckedMill& mill, int number) {
  SceneTool tool;
  tool.number = number;
  const bool ball = mill.corner_radius >= mill.radius;
  tool.name = std::string(ball                     ? "ball "
                          : mill.corner_radius > 0 ? "bull nose "
                                                   : "flat ") +
              millimetres(2 * mill.radius) +
              (!ball && mill.corner_radius > 0 ? ", corner " + millimetres(mill.corner_radius) : "");
  tool.pieces.push_back({ToolPiece::Kind::cutter, mill.radius, 0, mill.length, mill.corner_radius});
  for (const verify::ToolCylinder& c : mill.cylinders)
    tool.pieces.push_back(
        {c.holder ? ToolPiece::Kind::holder : ToolPiece::Kind::shank, c.radius, c.from, c.to, 0});
  return tool;
}

SceneTool beam_tool(double kerf_mm) {
  return {0, kerf_mm > 0 ? "beam, kerf " + millimetres(kerf_mm) : "beam", {}, kerf_mm};
}

std::optional<SceneMachine> scene_machine(const kinematics::Kinematics& machine) {
  if (machine.rotary_count() == 0) return std::nullopt;
  SceneMachine out{machine.machine().name, {}};
  for (int i = 0; i < machine.rotary_count(); ++i) {
    const model::Axis& a = machine.rotary_axis(i);
    out.axes.push_back({a.letter, a.side == model::AxisSide::table, a.direction, a.point});
  }
  return out;
}

std::vector<std::uint32_t> lines_of_records(const std::vector<std::uint32_t>& line_to_record,
                                            std::size_t records) {
  // Never empty: that would mean that the sources are lines.
  std::vector<std::uint32_t> lines(std::max<std::size_t>(1, records), 0);
  for (std::size_t i = 0; i < line_to_record.size(); ++i)
    if (line_to_record[i] < records) lines[line_to_record[i]] = static_cast<std::uint32_t>(i + 1);
  return lines;
}

std::vector<std::uint32_t> nodes_of_moves(const ScenePath& path, std::size_t moves) {
  std::vector<std::uint32_t> out(moves, 0);
  std::size_t filled = 0;
  for (std::size_t i = 0; i < path.move.size(); ++i) {
    if (path.move[i] >= moves || path.kind[i] == WayKind::dwell) continue;
    for (; filled < path.move[i]; ++filled) out[filled] = filled > 0 ? out[filled - 1] : 0;
    out[path.move[i]] = static_cast<std::uint32_t>(i);
    filled = path.move[i] + 1;
  }
  for (; filled < moves; ++filled) out[filled] = filled > 0 ? out[filled - 1] : 0;
  return out;
}

}  // namespace burin::view
