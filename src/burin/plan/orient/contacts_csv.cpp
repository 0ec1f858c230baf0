// SPDX-License-Identifier: Apache-2.0
// Contact points from a file: path,x,y,z,nx,ny,nz,fx,fy,fz.
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "burin/base/text.h"
#include "burin/geom/point_tools.h"
#include "burin/plan/orient/paths.h"

namespace burin::orient {
namespace {

using geom::Vec3;

constexpr std::array<const char*, 10> kColumns{"path", "x", "y", "z", "nx", "ny", "nz", "fx", "fy", "fz"};
constexpr const char* kWanted = "path,x,y,z,nx,ny,nz,fx,fy,fz";
/// More points than this in one file are refused; a line of 10 numbers has 20 characters at least.
constexpr double kFarthest = 1e6;  ///< mm from the origin: beyond a kilometre is a slip
constexpr std::size_t kMostPoints = 20'000'000;
/// A feed whose tangent part is smaller than this share of it has no direction along the surface.
constexpr double kAlongNormal = 1e-6;
/// Vectors are directions: shorter ones are noise.
constexpr double kLeastLength = 1e-12;

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0;;) {
    const std::size_t comma = line.find(',', at);
    fields.push_back(trim(line.substr(at, comma == std::string_view::npos ? comma : comma - at)));
    if (comma == std::string_view::npos) return fields;
    at = comma + 1;
  }
}

class Reader {
 public:
  Reader(std::string_view csv, const std::string& file) : rest_(csv), file_(file) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }
  Result<std::vector<CcPath>> read();

 private:
  Error error(ErrorCode code, std::string message) const {
    return {code, std::move(message), {.file = file_, .line = line_}};
  }
  /// The next line that is neither empty nor a comment.
  std::optional<std::string_view> next();
  Result<void> header(std::string_view line);
  Result<void> point(std::string_view line, std::vector<CcPath>& paths);

  std::string_view rest_;
  const std::string& file_;
  int line_ = 0;
  std::array<std::size_t, kColumns.size()> column_{};
  std::size_t columns_ = 0, points_ = 0;
};

std::optional<std::string_view> Reader::next() {
  while (!rest_.empty()) {
    const std::size_t end = rest_.find('\n');
    const std::string_view line = trim(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    if (!line.empty() && line.front() != '#') return line;
  }
  return std::nullopt;
}

Result<void> Reader::header(std::string_view line) {
  const std::vector<std::string_view> names = fields_of(line);
  columns_ = names.size();
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    std::size_t found = names.size(), times = 0;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (to_lower(names[k]) == kColumns[i]) found = k, ++times;
    }
    if (times != 1) {
      return error(ErrorCode::syntax, std::string(times == 0 ? "no column '" : "more than one column '") +
                                          kColumns[i] + "' in the header (" + kWanted + ")");
    }
    column_[i] = found;
  }
  return {};
}

Result<void> Reader::point(std::string_view line, std::vector<CcPath>& paths) {
  const std::vector<std::string_view> fields = fields_of(line);
  if (fields.size() != columns_) {
    return error(ErrorCode::syntax, std::to_string(fields.size()) + " fields (" + std::to_string(columns_) +
                                        ", as in the header)");
  }
  const std::string_view number = fields[column_[0]];
  const auto path = parse_integer(number);
  if (!path || *path < 0 || *path > 1'000'000'000) {
    return error(ErrorCode::syntax,
                 "path '" + std::string(number.substr(0, 40)) + "' (a whole number from 0 on)");
  }
  std::array<double, 9> value{};
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string_view text = fields[column_[i + 1]];
    const auto number_here = parse_double(text);
    if (!number_here) {
      return error(ErrorCode::syntax, std::string(kColumns[i + 1]) + " = '" +
                                          std::string(text.substr(0, 40)) + "' (a finite number)");
    }
    if (i < 3 && std::abs(*number_here) > kFarthest) {
      return error(ErrorCode::range, std::string(kColumns[i + 1]) + " = " + format_shortest(*number_here) +
                                         " mm (-" + format_shortest(kFarthest) + " to " +
                                         format_shortest(kFarthest) + ")");
    }
    value[i] = *number_here;
  }
  CcPoint at;
  at.c = {value[0], value[1], value[2]};
  const Vec3 n{value[3], value[4], value[5]}, f{value[6], value[7], value[8]};
  // Scaled first: the squares of great components overflow.
  const auto direction = [](Vec3 v) {
    const double most = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return most > kLeastLength ? geom::unit(v / most) : Vec3{};
  };
  at.n = direction(n);
  if (at.n == Vec3{}) {
    return error(ErrorCode::geometry, "a normal without length (nx, ny, nz that point to the tool's side)");
  }
  const Vec3 feed = direction(f);
  if (feed == Vec3{}) {
    return error(ErrorCode::geometry, "a feed without length (fx, fy, fz along the path)");
  }
  const Vec3 tangent = feed - dot(feed, at.n) * at.n;
  if (norm(tangent) <= kAlongNormal) {
    return error(ErrorCode::geometry, "a feed along the normal (a direction in the tangent plane)");
  }
  at.f = geom::unit(tangent);
  if (++points_ > kMostPoints) {
    return error(ErrorCode::range,
                 "more than " + std::to_string(kMostPoints) + " contact points (fewer, or several files)");
  }
  const int here = static_cast<int>(*path);
  if (paths.empty() || here > paths.back().number) {
    paths.push_back({here, -1, 0, {}});
  } else if (here < paths.back().number) {
    return error(ErrorCode::syntax, "path " + std::to_string(here) + " after path " +
                                        std::to_string(paths.back().number) + " (numbers that ascend)");
  }
  paths.back().points.push_back(at);
  return {};
}

Result<std::vector<CcPath>> Reader::read() {
  const auto first = next();
  if (!first) return error(ErrorCode::syntax, std::string("no header (") + kWanted + ")");
  if (auto good = header(*first); !good) return good.error();
  std::vector<CcPath> paths;
  while (const auto line = next()) {
    if (auto good = point(*line, paths); !good) return good.error();
  }
  if (paths.empty())
    return error(ErrorCode::geometry, "no contact points (one line a point after the header)");
  return paths;
}

}  // namespace

Result<std::vector<CcPath>> read_contacts(std::string_view csv, const std::string& file_name) {
  return Reader(csv, file_name).read();
}

}  // namespace burin::orient
