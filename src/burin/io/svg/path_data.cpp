// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/path_data.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "burin/io/svg/scanner.h"

namespace burin::io::svg {

using geom::Curve2;
using geom::Point2;
using geom::Vec2;

namespace {

constexpr std::string_view kCommands = "MmZzLlHhVvCcSsQqTtAa";

/// Reads one command after the other into the builder.
class PathParser {
 public:
  PathParser(std::string_view data, std::size_t max_curves)
      : scan_(data), data_(data), max_curves_(max_curves) {}

  Result<Outline> run() {
    scan_.skip_blank();
    while (!scan_.done() && !error_) {
      const char command = scan_.peek();
      if (kCommands.find(command) == std::string_view::npos) {
        fail(previous_ == '\0' ? "a path starts with M or m"
                               : "not a path command (M L H V C S Q T A Z or a number)");
        break;
      }
      if (previous_ == '\0' && command != 'M' && command != 'm') {
        fail("a path starts with M or m");
        break;
      }
      scan_.skip();
      run_command(command);
    }
    if (error_) return std::move(*error_);
    return builder_.finish();
  }

 private:
  /// A command letter with all its repeats.
  void run_command(char command) {
    const bool relative = command >= 'a';
    char kind = relative ? static_cast<char>(command - 'a' + 'A') : command;
    scan_.skip_blank();
    if (kind == 'Z') {
      builder_.close();
      previous_ = 'Z';
      return;
    }
    bool more = true;
    while (more && !error_) {
      run_once(kind, relative);
      if (builder_.curve_count() > max_curves_) {
        error_ = Error{ErrorCode::range, "more curves than the limit of " + std::to_string(max_curves_), {}};
      }
      previous_ = kind;
      if (kind == 'M') kind = 'L';  // further pairs after a move are lines
      const bool comma = scan_.skip_separator();
      const char next = scan_.peek();
      more = is_digit(next) || next == '.' || next == '-' || next == '+';
      if (comma && !more && !error_) fail("a number is expected after the comma");
    }
  }

  void run_once(char kind, bool relative) {
    const Vec2 base = relative ? builder_.current() - Point2{} : Vec2{};
    switch (kind) {
      case 'M':
        if (auto p = point(base)) builder_.move_to(*p);
        break;
      case 'L':
        if (auto p = point(base)) builder_.line_to(*p);
        break;
      case 'H':
        if (auto x = number()) builder_.line_to({*x + base.x, builder_.current().y});
        break;
      case 'V':
        if (auto y = number()) builder_.line_to({builder_.current().x, *y + base.y});
        break;
      case 'A':
        arc(base);
        break;
      default:
        bezier(kind, base);
    }
  }

  void bezier(char kind, Vec2 base) {
    const Point2 from = builder_.current();
    // S and T mirror the control point of a preceding curve of the same family, else start with the current
    // point.
    const bool smooth =
        kind == 'S' ? previous_ == 'C' || previous_ == 'S' : previous_ == 'Q' || previous_ == 'T';
    const Point2 mirrored = smooth ? from + (from - last_control_) : from;
    Point2 c1 = mirrored;
    if (kind == 'C' || kind == 'Q') {
      const auto p = point(base);
      if (!p) return;
      c1 = *p;
      scan_.skip_separator();
    }
    Point2 c2 = c1;
    if (kind == 'C' || kind == 'S') {
      const auto p = point(base);
      if (!p) return;
      c2 = *p;
      scan_.skip_separator();
    }
    const auto end = point(base);
    if (!end) return;
    last_control_ = c2;
    if (kind == 'C' || kind == 'S') {
      builder_.cubic_to(c1, c2, *end);
    } else {
      builder_.quadratic_to(c1, *end);
    }
  }

  void arc(Vec2 base) {
    std::array<double, 3> shape{};
    for (double& value : shape) {
      const auto number_read = number();
      if (!number_read) return;
      value = *number_read;
      scan_.skip_separator();
    }
    std::array<bool, 2> flags{};
    for (bool& value : flags) {
      const auto flag = scan_.flag();
      if (!flag) return fail("an arc flag is expected (0 or 1)");
      value = *flag;
      scan_.skip_separator();
    }
    if (auto p = point(base)) builder_.arc_to(shape[0], shape[1], shape[2], flags[0], flags[1], *p);
  }

  std::optional<double> number() {
    const auto value = scan_.number();
    if (!value) fail("a number is expected");
    return value;
  }

  std::optional<Point2> point(Vec2 base) {
    const auto x = number();
    if (!x) return std::nullopt;
    scan_.skip_separator();
    const auto y = number();
    if (!y) return std::nullopt;
    return Point2{*x, *y} + base;
  }

  void fail(const std::string& what) {
    if (error_) return;
    constexpr std::size_t kShown = 12;
    const std::size_t at = std::min(scan_.position(), data_.size());
    std::string found =
        at == data_.size() ? "the end of the data" : "'" + std::string(data_.substr(at, kShown)) + "'";
    error_ = Error{ErrorCode::syntax,
                   "path data, character " + std::to_string(at + 1) + ": " + what + ", found " + found,
                   {}};
  }

  Scanner scan_;
  std::string_view data_;
  std::size_t max_curves_;
  OutlineBuilder builder_;
  Point2 last_control_;
  char previous_ = '\0';  // upper-case letter of the command before, '\0' at the start
  std::optional<Error> error_;
};

geom::Nurbs2 bezier_of(std::vector<Point2> points) {
  geom::Nurbs2 curve;
  curve.degree = static_cast<int>(points.size()) - 1;
  curve.knots.assign(2 * points.size(), 0.0);
  for (std::size_t i = points.size(); i < curve.knots.size(); ++i) curve.knots[i] = 1.0;
  curve.weights.assign(points.size(), 1.0);
  curve.points = std::move(points);
  return curve;
}

}  // namespace

void OutlineBuilder::move_to(Point2 p) {
  flush(false);
  start_ = current_ = p;
  pending_ = true;
  magnitude_ = 0;
  steps_ = 0;
  note(p);
}

void OutlineBuilder::begin_if_needed() {
  if (!pending_) move_to(current_);  // drawing goes on after Z: from the start of the closed subpath
}

void OutlineBuilder::note(Point2 p) {
  magnitude_ = std::max({magnitude_, std::abs(p.x), std::abs(p.y)});
  ++steps_;
}

void OutlineBuilder::add(Curve2 curve, Point2 end) {
  note(end);
  curves_.push_back(std::move(curve));
  ++curve_count_;
  current_ = end;
}

void OutlineBuilder::line_to(Point2 p) {
  begin_if_needed();
  if (p == current_) return;
  add(geom::Line2{current_, p}, p);
}

void OutlineBuilder::quadratic_to(Point2 c, Point2 p) {
  begin_if_needed();
  if (c == current_ || c == p)
    return line_to(p);  // all control points on the ends: the same points as the line
  add(bezier_of({current_, c, p}), p);
}

void OutlineBuilder::cubic_to(Point2 c1, Point2 c2, Point2 p) {
  begin_if_needed();
  // Control points that coincide with the ends, in order: monotone along the chord, the same points as the
  // line.
  const bool straight = (c1 == current_ && (c2 == current_ || c2 == p)) || (c1 == p && c2 == p);
  if (straight) return line_to(p);
  add(bezier_of({current_, c1, c2, p}), p);
}

void OutlineBuilder::arc_to(double rx, double ry, double rotation_deg, bool large, bool sweep, Point2 p) {
  begin_if_needed();
  if (p == current_) return;  // F.6.2: equal end points leave the arc out
  add(arc_between(current_, p, rx, ry, rotation_deg, large, sweep), p);
}

/// n additions of coordinates up to M, each read and summed with relative error 2^-53 twice, move the end by
/// at most 2 n 2^-53 M = n eps M; doubled for the closing step itself.
double OutlineBuilder::closing_rounding() const {
  return 2.0 * static_cast<double>(steps_) * std::numeric_limits<double>::epsilon() * magnitude_;
}

void OutlineBuilder::snap_end_to_start() {
  if (auto* line = std::get_if<geom::Line2>(&curves_.back())) {
    line->b = start_;
    if (line->a == line->b) curves_.pop_back(), --curve_count_;
  } else if (auto* nurbs = std::get_if<geom::Nurbs2>(&curves_.back())) {
    nurbs->points.back() = start_;
  }
  // An arc ends within its own rounding anyway.
}

void OutlineBuilder::close() {
  if (pending_ && !(current_ == start_)) {
    const bool only_rounding = distance(current_, start_) <= closing_rounding();
    if (only_rounding && curves_.size() > 1) {
      snap_end_to_start();
    } else {
      line_to(start_);
    }
  }
  flush(true);
  current_ = start_;
}

void OutlineBuilder::flush(bool closed) {
  if (pending_) {
    if (curves_.empty()) {
      ++outline_.points_dropped;
    } else {
      outline_.paths.push_back({std::move(curves_), closed});
    }
  }
  curves_.clear();
  pending_ = false;
}

Outline OutlineBuilder::finish() {
  flush(false);
  return std::move(outline_);
}

Curve2 arc_between(Point2 from, Point2 to, double rx, double ry, double rotation_deg, bool large,
                   bool sweep) {
  rx = std::abs(rx);
  ry = std::abs(ry);
  if (rx == 0 || ry == 0) return geom::Line2{from, to};
  const double phi = geom::radians(std::fmod(rotation_deg, 360.0));
  const double c = std::cos(phi), s = std::sin(phi);
  // Half the chord in the frame in which the ellipse is the unit circle (F.6.5.1 divided by the radii).
  const Vec2 half = 0.5 * (from - to);
  const Vec2 u{(c * half.x + s * half.y) / rx, (-s * half.x + c * half.y) / ry};
  const double lambda = norm2(u);
  const double grow = lambda > 1 ? std::sqrt(lambda) : 1.0;  // F.6.6: radii too small for the chord
  const double chord = std::min(1.0, std::sqrt(lambda));     // half chord of the unit circle
  const double height = lambda > 1 ? 0.0 : std::sqrt(1.0 - lambda);
  const double side = large != sweep ? 1.0 : -1.0;
  const Vec2 along = unit(u);
  const Vec2 center = side * height * Vec2{along.y, -along.x};
  const Vec2 first = chord * along - center;
  const double start = std::atan2(first.y, first.x);
  // From the same half chord and height, so that the end falls on `to` however small the arc is.
  const double small_angle = 2.0 * std::atan2(chord, height);
  const double angle = large ? 2.0 * geom::kPi - small_angle : small_angle;
  const double turn = sweep ? angle : -angle;
  const double a = rx * grow, b = ry * grow;
  const Vec2 offset{c * a * center.x - s * b * center.y, s * a * center.x + c * b * center.y};
  const Point2 middle = lerp(from, to, 0.5) + offset;
  if (rx == ry) return geom::Arc2{middle, a, start + phi, turn};
  return geom::EllipseArc2{middle, a * Vec2{c, s}, b * Vec2{-s, c}, start, turn};
}

Result<Outline> parse_path_data(std::string_view data, std::size_t max_curves) {
  return PathParser(data, max_curves).run();
}

}  // namespace burin::io::svg
