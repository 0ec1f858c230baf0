// SPDX-License-Identifier: Apache-2.0
#include "burin/post/emit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/post/nc_writer.h"
#include "burin/post/round_arc.h"
#include "burin/post/words.h"

namespace burin::post {
namespace {

using geom::Point3;
using geom::Vec3;

// Directions from files with six decimals.
constexpr double kAxisTolerance = 2e-6;
constexpr double kMaxCenter_mm = 1e9;

using Grid = std::array<std::int64_t, 3>;
constexpr std::array<char, 3> kAxis = {'X', 'Y', 'Z'};
constexpr std::array<char, 3> kCenter = {'I', 'J', 'K'};

/// A plane of arcs: the code, and its axes in right-handed order with the normal last.
struct PlaneCode {
  int code;
  std::array<std::size_t, 3> axes;
};
constexpr std::array<PlaneCode, 3> kPlanes = {{{17, {0, 1, 2}}, {18, {2, 0, 1}}, {19, {1, 2, 0}}}};

class Emitter : NcWriter {
 public:
  Emitter(const cl::Program& program, const Dialect& dialect, const EmitOptions& options,
          Diagnostics& diagnostics)
      : NcWriter(program, dialect, options, diagnostics) {}

  Result<NcText> run() {
    if (program_.from) exact_ = program_.from->tip;
    if (auto ok = begin(); !ok) return ok.error();
    for (; index_ < program_.records.size(); ++index_) {
      auto ok = std::visit([this](const auto& record) { return put(record); }, program_.records[index_]);
      if (!ok) return ok.error();
    }
    return finish();
  }

 private:
  using NcWriter::put;

  // --- motion
  // -------------------------------------------------------------------------------------------------

  /// On the grid, within what the control takes.
  Result<Grid> rounded(const Point3& p) const {
    Grid grid{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = component(p, i);
      if (!(std::abs(value) <= dialect_.coordinate_limit_mm))
        return error(ErrorCode::range, std::string(1, kAxis[i]) + format_shortest(value) + " (within " +
                                           format_shortest(dialect_.coordinate_limit_mm) + " mm for " +
                                           dialect_.name + ")");
      grid[i] = to_grid(value, dialect_.decimals);
    }
    return grid;
  }

  Result<void> check(const cl::Pose& pose) {
    if (norm(pose.axis - Vec3{0, 0, 1}) > kAxisTolerance)
      return error(ErrorCode::unsupported,
                   "a tilted tool axis (0, 0, 1: other axes need a machine that turns)");
    if (options_.write_z) return {};
    if (!level_) level_ = exact_ ? exact_->z : pose.tip.z;
    if (std::abs(pose.tip.z - *level_) > from_grid(1, dialect_.decimals) / 2)
      return error(ErrorCode::unsupported, "Z changes from " + format_fixed(*level_, 6) + " to " +
                                               format_fixed(pose.tip.z, 6) +
                                               " in a program without Z words (one height)");
    return {};
  }

  std::string coordinate(char letter, std::int64_t steps) const {
    return std::string(" ") + letter + grid_text(steps, dialect_.decimals, dialect_.require_point);
  }

  /// One motion block. `forced`: axes written even when they do not change; `center`: the words of an arc.
  Result<void> block(int code, const Grid& to, std::array<bool, 3> forced, const std::string& center) {
    std::string text;
    bool any = false;
    for (std::size_t i = 0; i < (options_.write_z ? 3u : 2u); ++i) {
      if (known_[i] && at_[i] == to[i] && !forced[i] && !(i == 2 && !length_.empty())) continue;
      text += coordinate(kAxis[i], to[i]);
      any = true;
      known_[i] = true;
    }
    at_ = to;
    if (!any) {
      ++out_.vanished;
      return {};
    }
    text += center;
    if (code != 0 && feed_ != written_feed_) text += " F" + (written_feed_ = feed_);
    if (code != motion_code_) text.insert(0, " " + g(motion_code_ = code));
    if (!length_.empty()) text.insert(0, " " + std::exchange(length_, ""));
    ++out_.moves;
    return line(text.substr(1));
  }

  Result<void> straight(int code, const cl::Pose& pose) {
    if (auto ok = check(pose); !ok) return ok;
    const auto to = rounded(pose.tip);
    if (!to) return to.error();
    exact_ = pose.tip;
    auto ok = block(code, *to, {}, "");
    ++move_;
    return ok;
  }
  Result<void> put(const cl::Rapid& rapid) { return straight(0, rapid.to); }
  Result<void> put(const cl::Feed& feed) { return straight(1, feed.to); }

  /// The plane whose normal the arc has, up to its sense.
  Result<PlaneCode> plane_of(const cl::Arc& arc) const {
    for (const PlaneCode& plane : kPlanes) {
      const double along = component(arc.normal, plane.axes[2]);
      const Vec3 unit{plane.axes[2] == 0 ? 1.0 : 0.0, plane.axes[2] == 1 ? 1.0 : 0.0,
                      plane.axes[2] == 2 ? 1.0 : 0.0};
      // A normal off by this much lifts the far side of the circle by half a step.
      const double allowed = std::max(1e-9, from_grid(1, dialect_.decimals) / (4 * arc.radius));
      if (norm(arc.normal - along * unit) > std::min(allowed, kAxisTolerance)) continue;
      if (plane.code != 17 && !options_.write_z) break;
      return plane;
    }
    return error(ErrorCode::unsupported,
                 "an arc about the axis " + format_fixed(arc.normal.x, 6) + ", " +
                     format_fixed(arc.normal.y, 6) + ", " + format_fixed(arc.normal.z, 6) +
                     (options_.write_z ? " (X, Y or Z)" : " (Z, in a program without Z words)"));
  }

  Result<void> put(const cl::Arc& arc) {
    if (auto ok = check(arc.to); !ok) return ok;
    const auto plane = plane_of(arc);
    if (!plane) return plane.error();
    if (std::max({std::abs(arc.center.x), std::abs(arc.center.y), std::abs(arc.center.z)}) > kMaxCenter_mm)
      return error(ErrorCode::range,
                   "an arc centre beyond " + format_shortest(kMaxCenter_mm) + " mm (nearer)");
    const auto start = rounded(*exact_), end = rounded(arc.to.tip);
    if (!start) return start.error();
    if (!end) return end.error();
    const Point3 from = *exact_;
    at_ = *start;
    exact_ = arc.to.tip;
    auto ok = pieces(arc, *plane, from, *end);
    ++move_;
    return ok;
  }

  Result<void> pieces(const cl::Arc& arc, const PlaneCode& plane, const Point3& from, const Grid& end) {
    const auto [a, b, c] = plane.axes;
    const PlaneArc flat{.center = {component(arc.center, a), component(arc.center, b)},
                        .start = {component(from, a), component(from, b)},
                        .end = {component(arc.to.tip, a), component(arc.to.tip, b)},
                        .clockwise = component(arc.normal, c) < 0,
                        .sweep = cl::arc_sweep(from, arc)};
    const double c_from = component(from, c), c_to = component(arc.to.tip, c);
    const ArcGrid grid{.decimals = dialect_.decimals,
                       .absolute_mm = dialect_.arc_absolute_mm,
                       .relative = dialect_.arc_relative,
                       .min_radius_mm = dialect_.arc_min_radius_mm,
                       .max_radius_mm = std::min(dialect_.arc_max_radius_mm, dialect_.coordinate_limit_mm),
                       .min_sweep = geom::radians(dialect_.min_arc_sweep_deg),
                       .lines_only = at_[c] != end[c] && !dialect_.arc_helix};
    const auto rounded_pieces = round_arc(flat, {at_[a], at_[b]}, grid);
    if (!rounded_pieces)
      return error(ErrorCode::range, "an arc of radius " + format_shortest(arc.radius) +
                                         " mm needs more than a million lines (a smaller radius)");
    std::size_t arcs = 0;
    for (const ArcPiece& piece : *rounded_pieces) {
      Grid to{};
      to[a] = piece.end.a;
      to[b] = piece.end.b;
      to[c] = piece.at >= 1 ? end[c] : to_grid(c_from + piece.at * (c_to - c_from), dialect_.decimals);
      if (auto ok = reachable(to); !ok) return ok;
      if (auto ok = piece.line ? block(1, to, {}, "") : arc_block(flat.clockwise, plane, piece, to); !ok)
        return ok;
      arcs += piece.line ? 0 : 1;
    }
    out_.arcs_split += arcs > 1 ? 1 : 0;
    out_.arcs_as_lines += arcs < rounded_pieces->size() ? 1 : 0;
    return {};
  }

  Result<void> reachable(const Grid& to) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (const double value = from_grid(to[i], dialect_.decimals);
          !(std::abs(value) <= dialect_.coordinate_limit_mm + 1))
        return error(ErrorCode::range, std::string("the arc leaves the range of ") + kAxis[i] + " (within " +
                                           format_shortest(dialect_.coordinate_limit_mm) + " mm for " +
                                           dialect_.name + ")");
    return {};
  }

  /// Both words of the plane and both of the centre are always written: controls differ in what they take for
  /// granted.
  Result<void> arc_block(bool clockwise, const PlaneCode& plane, const ArcPiece& piece, const Grid& to) {
    if (plane.code != plane_code_) {
      if (auto ok = line(g(plane_code_ = plane.code)); !ok) return ok;
    }
    std::array<std::int64_t, 3> offset{};
    offset[plane.axes[0]] = piece.offset.a;
    offset[plane.axes[1]] = piece.offset.b;
    std::array<bool, 3> forced{};
    forced[plane.axes[0]] = forced[plane.axes[1]] = true;
    std::string center;
    for (std::size_t i = 0; i < 3; ++i)
      if (forced[i]) center += coordinate(kCenter[i], offset[i]);
    return block(clockwise ? 2 : 3, to, forced, center);
  }

  // What the control knows.
  Grid at_{};
  std::array<bool, 3> known_{};
  std::optional<Point3> exact_;  // where the last motion record ended
  std::optional<double> level_;  // the one Z of a program without Z words
  int motion_code_ = -1, plane_code_ = 17;
  std::string written_feed_;
};

}  // namespace

Result<NcText> emit(const cl::Program& program, const Dialect& dialect, const EmitOptions& options,
                    Diagnostics& diagnostics) {
  return Emitter(program, dialect, options, diagnostics).run();
}

}  // namespace burin::post
