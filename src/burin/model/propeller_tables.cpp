// SPDX-License-Identifier: Apache-2.0
#include "burin/model/propeller_tables.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

#include "burin/base/embedded.h"
#include "burin/model/toml_reader.h"

namespace burin::embedded {
std::vector<File> propellers();
}

namespace burin::model {
namespace {

constexpr const char* kFile = "bseries.toml";

/// Numbers of an array; `count` 0: any number of them.
std::vector<double> numbers(TomlReader& reader, const toml::table& table, std::string_view key,
                            std::size_t count) {
  std::vector<double> out;
  const toml::array* array = table.get_as<toml::array>(key);
  if (array != nullptr) {
    for (const toml::node& node : *array) out.push_back(node.value<double>().value_or(std::nan("")));
  }
  const bool finite = std::all_of(out.begin(), out.end(), [](double x) { return std::isfinite(x); });
  if (!finite || out.size() < 4 || (count != 0 && out.size() != count)) {
    reader.fail(table, "\"" + std::string(key) + "\" is no list of " +
                           (count == 0 ? "at least 4" : std::to_string(count)) + " numbers");
    out.assign(std::max<std::size_t>(count, 4), 0.0);
  }
  return out;
}

}  // namespace

Cubic Cubic::spline(std::vector<double> x, std::vector<double> y) {
  const std::size_t n = x.size();
  // Slopes d: the usual tridiagonal rows inside, "not a knot" rows at the ends, which are eliminated first
  // (they have two entries beside the diagonal's).
  std::vector<double> h(n - 1), m(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) h[i] = x[i + 1] - x[i], m[i] = (y[i + 1] - y[i]) / h[i];
  std::vector<double> lower(n, 0.0), diagonal(n, 0.0), upper(n, 0.0), right(n, 0.0);
  diagonal[0] = h[1];
  upper[0] = h[0] + h[1];
  right[0] = ((h[0] + 2 * upper[0]) * h[1] * m[0] + h[0] * h[0] * m[1]) / upper[0];
  for (std::size_t i = 1; i + 1 < n; ++i) {
    lower[i] = h[i], diagonal[i] = 2 * (h[i - 1] + h[i]), upper[i] = h[i - 1];
    right[i] = 3 * (h[i] * m[i - 1] + h[i - 1] * m[i]);
  }
  const double a = h[n - 2], b = h[n - 3];
  lower[n - 1] = a + b, diagonal[n - 1] = b;
  right[n - 1] = (a * a * m[n - 3] + (2 * (a + b) + a) * b * m[n - 2]) / (a + b);
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1], right[i] -= factor * right[i - 1];
  }
  Cubic out;
  out.slope_.assign(n, 0.0);
  for (std::size_t i = n; i-- > 0;)
    out.slope_[i] = (right[i] - (i + 1 < n ? upper[i] * out.slope_[i + 1] : 0)) / diagonal[i];
  out.x_ = std::move(x), out.y_ = std::move(y);
  return out;
}

Cubic Cubic::monotone(std::vector<double> x, std::vector<double> y) {
  Cubic out = spline(std::move(x), std::move(y));
  const std::size_t n = out.x_.size();
  const auto m = [&](std::size_t i) { return (out.y_[i + 1] - out.y_[i]) / (out.x_[i + 1] - out.x_[i]); };
  for (std::size_t i = 0; i < n; ++i) {
    const double left = m(i > 0 ? i - 1 : 0), right = m(i + 1 < n ? i : n - 2);
    const double most = left * right > 0 ? 3 * std::min(std::abs(left), std::abs(right)) : 0;
    out.slope_[i] = left > 0 ? std::clamp(out.slope_[i], 0.0, most) : std::clamp(out.slope_[i], -most, 0.0);
  }
  return out;
}

double Cubic::operator()(double x) const {
  const auto above = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - x_.begin()) - 1;
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h, s = 1 - t;
  return s * s * (1 + 2 * t) * y_[i] + t * t * (1 + 2 * s) * y_[i + 1] +
         h * (s * s * t * slope_[i] - t * t * s * slope_[i + 1]);
}

Result<Series> Series::parse(std::string_view toml) {
  TomlReader reader(kFile);
  const toml::table root = reader.parse(toml);
  if (reader.error()) return *reader.error();
  Series series;
  const toml::table& outline = reader.subtable(root, "outline");
  const std::vector<double> radius = numbers(reader, outline, "radius", 0);
  const std::size_t n = radius.size();
  series.thickness_ = Cubic::spline(radius, numbers(reader, outline, "thickness", n));
  series.thickness_per_blade_ = Cubic::spline(radius, numbers(reader, outline, "thickness_per_blade", n));
  series.pitch_four_ = Cubic::monotone(radius, numbers(reader, outline, "pitch_four", n));
  const auto read_outline = [&](std::string_view name) {
    const toml::table& table = reader.subtable(outline, name);
    std::vector<double> chord = numbers(reader, table, "chord", n),
                        middle = numbers(reader, table, "leading", n);
    std::vector<double> thickest = numbers(reader, table, "thickest", n), inner = radius;
    for (std::size_t i = 0; i < n; ++i) middle[i] = (middle[i] - 0.5) * chord[i];
    // The outline is round at the tip: chord / sqrt(1 - r / R) is smooth there. The ratios mean nothing at r
    // = R, where the chord is 0.
    inner.pop_back(), chord.pop_back(), middle.pop_back();
    for (std::size_t i = 0; i + 1 < n; ++i) chord[i] /= std::sqrt(1 - inner[i]);
    thickest.back() = thickest[n - 2];
    return Outline{Cubic::spline(inner, chord), Cubic::spline(inner, middle),
                   Cubic::monotone(radius, thickest)};
  };
  series.three_ = read_outline("three");
  series.more_ = read_outline("more");

  const toml::table& section = reader.subtable(root, "section");
  series.places_ = numbers(reader, section, "p", 0);
  std::reverse(series.places_.begin(), series.places_.end());
  const std::size_t places = series.places_.size();
  std::vector<double> at;
  std::vector<std::vector<double>> v1(places), v2(places);
  for (const toml::table* table : reader.tables(section, "at")) {
    at.push_back(reader.number(*table, "radius", 0, 1));
    const std::vector<double> a = numbers(reader, *table, "v1", places),
                              b = numbers(reader, *table, "v2", places);
    for (std::size_t i = 0; i < places; ++i)
      v1[i].push_back(a[places - 1 - i]), v2[i].push_back(b[places - 1 - i]);
  }
  if (at.size() < 4) reader.fail(section, "fewer than four sections");
  if (reader.error()) return *reader.error();
  for (std::size_t i = 0; i < places; ++i) {
    series.v1_.push_back(Cubic::monotone(at, v1[i]));
    series.v2_.push_back(Cubic::monotone(at, v2[i]));
  }
  return series;
}

SeriesAt Series::at(int blades, double radius_ratio) const {
  const Outline& outline = blades <= 3 ? three_ : more_;
  SeriesAt out;
  out.chord = outline.chord(radius_ratio) * std::sqrt(std::max(0.0, 1 - radius_ratio));
  out.middle = outline.middle(radius_ratio);
  out.thickest = outline.thickest(radius_ratio);
  out.thickness = thickness_(radius_ratio) - blades * thickness_per_blade_(radius_ratio);
  out.pitch = blades == 4 ? pitch_four_(radius_ratio) : 1;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    out.v1.push_back(v1_[i](radius_ratio));
    out.v2.push_back(v2_[i](radius_ratio));
  }
  return out;
}

const Series& b_series() {
  static const Series series = [] {
    for (const embedded::File& file : embedded::propellers()) {
      if (file.name != kFile) continue;
      auto parsed = Series::parse(file.text);
      if (parsed) return *std::move(parsed);
    }
    std::terminate();  // the table is part of the program: a build with a damaged one
  }();
  return series;
}

}  // namespace burin::model
