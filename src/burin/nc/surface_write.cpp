// SPDX-License-Identifier: Apache-2.0
// Surfaces -> a program with one G106.2: words that stay are left out, knots that are the default too.
#include <cmath>
#include <limits>

#include "burin/base/text.h"
#include "burin/nc/modal.h"
#include "burin/nc/surface_program.h"
#include "burin/nc/trim_comment.h"

namespace burin::nc {
namespace {

constexpr int kWeightDecimals = 9, kKnotDecimals = 12;
constexpr int kDefaultOrder = 4;
// Knots have a fixed number of decimals: over a shorter domain they would lose digits, so it becomes 0 to 1.
constexpr double kShortestDomain = 0.03;
// The same for weights: when one is smaller, all are multiplied so that the smallest is 1.
constexpr double kSmallestWeight = 0.1, kLargestWeight = 1e12;
constexpr double kLargestKnot = 1e6;  // 12 decimals of it are still exact to the last digit or two
constexpr std::size_t kMaxName = 100;

Error bad(ErrorCode code, std::string message) {
  return {code, std::move(message), {}};
}

/// With a point, so that controls that count in increments take it for millimetres.
std::string number(double value, int decimals) {
  std::string text = format_fixed(value, decimals);
  if (text.find('.') == std::string::npos) text += '.';
  return text;
}

std::string printable(const std::string& name) {
  std::string text;
  for (char c : name)
    if (text.size() < kMaxName)
      text +=
          static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e || c == '(' || c == ')'
              ? '.'
              : c;
  return std::string(trim(text));
}

Result<void> check_options(const SurfaceWriteOptions& o) {
  const auto positive = [](double value) { return value > 0 && value <= kMaxCoordinate_mm; };
  if (o.decimals < 1 || o.decimals > kWeightDecimals)
    return bad(ErrorCode::usage, std::to_string(o.decimals) + " decimals (1 to 9)");
  if (!positive(o.tool_diameter))
    return bad(ErrorCode::usage, "a tool diameter that is not above 0 (above 0)");
  if (!positive(o.scallop) || !(o.scallop < o.tool_diameter / 2))
    return bad(ErrorCode::usage, "a scallop height that no such tool leaves (above 0, less than its radius)");
  if (!positive(o.feed)) return bad(ErrorCode::usage, "a feed that is not above 0 (above 0)");
  if (o.side_step && !positive(*o.side_step))
    return bad(ErrorCode::usage, "a side step that is not above 0 (above 0, or none)");
  if (!(std::abs(o.safety_z) <= kMaxCoordinate_mm))
    return bad(ErrorCode::usage, "a safety height beyond " + coordinate_limit() + " (less)");
  for (double value : {o.tool_diameter, o.scallop, o.feed, o.side_step.value_or(1)})
    if (number(value, kWeightDecimals) == "0.")
      return bad(ErrorCode::usage, "a value that vanishes at 9 decimals (more)");
  return {};
}

/// The numbers of the blocks when they name them in rising order, else 10, 20, 30, ...
std::vector<int> block_numbers(const std::vector<SurfaceBlock>& blocks) {
  std::vector<int> numbers;
  for (const SurfaceBlock& block : blocks) {
    if (!block.number || *block.number < 0 || (!numbers.empty() && *block.number <= numbers.back())) break;
    numbers.push_back(*block.number);
  }
  if (numbers.size() == blocks.size()) return numbers;
  numbers.clear();
  for (std::size_t i = 0; i < blocks.size(); ++i) numbers.push_back(10 * static_cast<int>(i + 1));
  return numbers;
}

/// A surface as it is written: knots and weights in a range where fixed decimals are enough, trims with them.
struct Written {
  std::vector<double> knots_u, knots_v;
  double weight_factor = 1;
  bool weights = false;  // differ
  std::vector<TrimLoop> trims;
};

double mapped(double t, geom::Interval from, bool unit) {
  return unit ? (t - from.lo) / from.length() : t;
}

Written prepare(const SurfaceBlock& block) {
  const geom::NurbsSurface& s = block.surface;
  Written w{.knots_u = s.knots_u, .knots_v = s.knots_v, .trims = block.trims};
  const geom::Interval u = s.domain(geom::Direction::u), v = s.domain(geom::Direction::v);
  const auto to_unit = [](geom::Interval t) {
    return t.length() < kShortestDomain || std::max(std::abs(t.lo), std::abs(t.hi)) > kLargestKnot;
  };
  const bool unit_u = to_unit(u), unit_v = to_unit(v);
  for (double& t : w.knots_u) t = mapped(t, u, unit_u);
  for (double& t : w.knots_v) t = mapped(t, v, unit_v);
  for (TrimLoop& loop : w.trims)
    for (geom::Point2& p : loop.points) p = {mapped(p.x, u, unit_u), mapped(p.y, v, unit_v)};
  double smallest = std::numeric_limits<double>::infinity();
  for (const geom::HPoint& h : s.points) {
    smallest = std::min(smallest, h.w);
    w.weights = w.weights || h.w != s.points.front().w;
  }
  if (!w.weights || smallest < kSmallestWeight) w.weight_factor = 1 / smallest;
  return w;
}

std::vector<std::string> texts(const std::vector<double>& knots) {
  std::vector<std::string> out;
  out.reserve(knots.size());
  for (double t : knots) out.push_back(number(t, kKnotDecimals));
  return out;
}

/// What the reader takes when there are no K blocks.
bool is_default(const std::vector<std::string>& knots, int count, int degree) {
  return knots == texts(geom::clamped_uniform_knots(count, degree));
}

/// Knots that the decimals make equal must not become more than the degree allows.
Result<void> check_knot_texts(const std::vector<std::string>& knots, int degree) {
  const auto p = static_cast<std::size_t>(degree);
  bool too_often = knots.front() == knots.back();
  for (std::size_t i = 1; i + p + 1 < knots.size(); ++i) too_often = too_often || knots[i] == knots[i + p];
  if (too_often)
    return bad(ErrorCode::range, "knots closer than a program's 12 decimals can tell (farther apart)");
  return {};
}

class Words {
 public:
  /// The word unless it says the same as the last with this letter.
  std::string changed(std::size_t which, char letter, std::string value) {
    if (known_[which] == value) return "";
    known_[which] = std::move(value);
    return letter + known_[which];
  }

 private:
  std::array<std::string, 4> known_;
};

Result<void> write_points(const geom::NurbsSurface& surface, const Written& written, int decimals,
                          std::string& text) {
  Words words;
  for (const geom::HPoint& h : surface.points) {
    const geom::Point3 p = geom::project(h);
    const double weight = h.w * written.weight_factor;
    if (!(weight <= kLargestWeight))
      return bad(ErrorCode::range, "weights that differ by more than a factor of 1e12 (less)");
    for (double c : {p.x, p.y, p.z})
      if (!(std::abs(c) <= kMaxCoordinate_mm))
        return bad(ErrorCode::range, "a control point beyond " + coordinate_limit() + " (less)");
    std::string line = words.changed(0, 'X', number(p.x, decimals));
    line += words.changed(1, 'Y', number(p.y, decimals));
    line += words.changed(2, 'Z', number(p.z, decimals));
    line += words.changed(3, 'W', number(weight, kWeightDecimals));
    if (line.empty()) line = "X" + number(p.x, decimals);  // the same point again
    text += line + '\n';
  }
  return {};
}

Result<void> write_block(const SurfaceBlock& block, int number_of_block, double stock_before, int decimals,
                         std::string& text) {
  const geom::NurbsSurface& s = block.surface;
  text += "N" + std::to_string(number_of_block) + " G06.23 U" + std::to_string(s.count_u) + " V" +
          std::to_string(s.count_v);
  if (s.degree_u + 1 != kDefaultOrder) text += " P" + std::to_string(s.degree_u + 1);
  if (s.degree_v + 1 != kDefaultOrder) text += " Q" + std::to_string(s.degree_v + 1);
  if (block.stock != stock_before) text += " L" + number(block.stock, kWeightDecimals);
  text += '\n';
  const Written written = prepare(block);
  if (auto ok = write_points(s, written, decimals, text); !ok) return ok;
  const auto knots_u = texts(written.knots_u), knots_v = texts(written.knots_v);
  if (auto ok = check_knot_texts(knots_u, s.degree_u); !ok) return ok;
  if (auto ok = check_knot_texts(knots_v, s.degree_v); !ok) return ok;
  if (!is_default(knots_u, s.count_u, s.degree_u) || !is_default(knots_v, s.count_v, s.degree_v))
    for (const auto* knots : {&knots_u, &knots_v})
      for (const std::string& knot : *knots) text += "K" + knot + '\n';
  text += write_trims(written.trims, kKnotDecimals);
  return {};
}

std::string header(const SurfaceWriteOptions& o, int first, int last) {
  std::string text = "%\n";
  const std::string name = printable(o.name);
  if (!name.empty()) text += "(" + name + ")\n";
  const std::string height = number(o.safety_z, o.decimals);
  text += "G21 G90\nG00 Z" + height + "\nG106.2 I" + std::to_string(static_cast<int>(o.method)) + " E" +
          std::to_string(static_cast<int>(o.grouping)) + " P" + std::to_string(first) + " Q" +
          std::to_string(last) + " W" + height + " D" + number(o.tool_diameter, kWeightDecimals);
  if (o.side_step) text += " M" + number(*o.side_step, kWeightDecimals);
  return text + " S" + number(o.scallop, kWeightDecimals) + " F" + number(o.feed, o.decimals) + '\n';
}

}  // namespace

Result<std::string> write_surface_program(const std::vector<SurfaceBlock>& blocks,
                                          const SurfaceWriteOptions& options) {
  if (auto ok = check_options(options); !ok) return ok.error();
  if (blocks.empty()) return bad(ErrorCode::usage, "no surface (at least one)");
  const std::vector<int> numbers = block_numbers(blocks);
  std::string text = header(options, numbers.front(), numbers.back());
  double stock = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto at = [&](const Error& e) {
      return bad(e.code, "surface " + std::to_string(i + 1) + ": " + e.message);
    };
    if (auto ok = geom::validate(blocks[i].surface); !ok) return at(ok.error());
    if (!(blocks[i].stock >= 0 && blocks[i].stock <= kMaxCoordinate_mm) ||
        blocks[i].stock != blocks.front().stock)
      return at(bad(ErrorCode::usage, "a stock of its own, or below 0 (one stock for all, 0 or more)"));
    if (auto ok = write_block(blocks[i], numbers[i], stock, options.decimals, text); !ok)
      return at(ok.error());
    stock = blocks[i].stock;
  }
  return text + "G80\nM30\n%\n";
}

}  // namespace burin::nc
