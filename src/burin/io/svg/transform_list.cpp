// SPDX-License-Identifier: Apache-2.0
#include "burin/io/svg/transform_list.h"

#include <cmath>
#include <string>
#include <vector>

#include "burin/base/text.h"
#include "burin/io/svg/scanner.h"

namespace burin::io::svg {

using geom::Affine2;

namespace {

struct Function {
  std::string_view name;
  std::size_t min_count, max_count;
};
constexpr Function kFunctions[] = {
    {"matrix", 6, 6}, {"translate", 1, 2}, {"translatex", 1, 1}, {"translatey", 1, 1},
    {"scale", 1, 2},  {"scalex", 1, 1},    {"scaley", 1, 1},     {"rotate", 1, 3},
    {"skewx", 1, 1},  {"skewy", 1, 1},     {"skew", 1, 2},
};

/// Multiples of 90 degrees are exact, so that rotated rectangles keep parallel sides.
void sine_cosine(double degrees, double& s, double& c) {
  const double turn = std::fmod(degrees, 360.0);
  const double quarter = turn / 90.0;
  if (quarter == std::floor(quarter)) {
    const int k = (static_cast<int>(quarter) % 4 + 4) % 4;
    s = k == 1 ? 1 : k == 3 ? -1 : 0;
    c = k == 0 ? 1 : k == 2 ? -1 : 0;
    return;
  }
  s = std::sin(geom::radians(turn));
  c = std::cos(geom::radians(turn));
}

double tangent(double degrees) {
  const double turn = std::fmod(degrees, 180.0);
  return turn == 0 ? 0 : turn == 45 ? 1 : turn == -45 ? -1 : std::tan(geom::radians(turn));
}

Affine2 rotation(const std::vector<double>& v) {
  double s = 0, c = 1;
  sine_cosine(v[0], s, c);
  const Affine2 turn{c, s, -s, c, 0, 0};
  if (v.size() < 3) return turn;
  return Affine2{1, 0, 0, 1, v[1], v[2]} * turn * Affine2{1, 0, 0, 1, -v[1], -v[2]};
}

Affine2 map_of(std::string_view name, const std::vector<double>& v) {
  if (name == "matrix") return {v[0], v[1], v[2], v[3], v[4], v[5]};
  if (name == "translate") return {1, 0, 0, 1, v[0], v.size() > 1 ? v[1] : 0};
  if (name == "translatex") return {1, 0, 0, 1, v[0], 0};
  if (name == "translatey") return {1, 0, 0, 1, 0, v[0]};
  if (name == "scale") return {v[0], 0, 0, v.size() > 1 ? v[1] : v[0], 0, 0};
  if (name == "scalex") return {v[0], 0, 0, 1, 0, 0};
  if (name == "scaley") return {1, 0, 0, v[0], 0, 0};
  if (name == "rotate") return rotation(v);
  if (name == "skewx") return {1, 0, tangent(v[0]), 1, 0, 0};
  if (name == "skewy") return {1, tangent(v[0]), 0, 1, 0, 0};
  return {1, v.size() > 1 ? tangent(v[1]) : 0, tangent(v[0]), 1, 0, 0};  // skew
}

/// Factor of a CSS unit inside a transform (to px or degrees), 0 when it is not taken.
double unit_factor(std::string_view unit) {
  if (unit.empty() || unit == "px" || unit == "deg") return 1;
  if (unit == "rad") return 180.0 / geom::kPi;
  if (unit == "grad") return 0.9;
  if (unit == "turn") return 360;
  return 0;
}

Error bad(const Scanner& scan, const std::string& what) {
  return {ErrorCode::syntax, "transform, character " + std::to_string(scan.position() + 1) + ": " + what, {}};
}

Result<Affine2> one_function(Scanner& scan) {
  const std::string name = to_lower(scan.word());
  const Function* function = nullptr;
  for (const Function& f : kFunctions) {
    if (f.name == name) function = &f;
  }
  if (function == nullptr) {
    return bad(scan, "unknown function '" + name + "' (matrix, translate, scale, rotate, skewX, skewY)");
  }
  scan.skip_blank();
  if (scan.peek() != '(') return bad(scan, "( is expected after " + name);
  scan.skip();
  scan.skip_blank();
  std::vector<double> values;
  while (!scan.done() && scan.peek() != ')') {
    const auto value = scan.number();
    if (!value) return bad(scan, "a number is expected in " + name + "()");
    const double factor = unit_factor(scan.word());
    if (factor == 0 || scan.peek() == '%') {
      return Error{
          ErrorCode::unsupported, "unit in transform " + name + "() (px, deg, rad, grad, turn or none)", {}};
    }
    values.push_back(*value * factor);
    if (values.size() > function->max_count) break;
    scan.skip_separator();
  }
  const bool pair_missing = name == "rotate" && values.size() == 2;
  if (values.size() < function->min_count || values.size() > function->max_count || pair_missing) {
    return bad(scan, name + "() has the wrong number of values (" + std::to_string(function->min_count) +
                         " to " + std::to_string(function->max_count) + ")");
  }
  if (scan.peek() != ')') return bad(scan, ") is expected");
  scan.skip();
  return map_of(name, values);
}

}  // namespace

Result<Affine2> parse_transform(std::string_view text) {
  text = trim(text);
  Affine2 map;
  if (text.empty() || text == "none") return map;
  Scanner scan(text);
  while (!scan.done()) {
    const auto next = one_function(scan);
    if (!next) return next.error();
    map = map * *next;
    while (scan.skip_separator()) {
    }
  }
  return map;
}

}  // namespace burin::io::svg
