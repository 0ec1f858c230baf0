// SPDX-License-Identifier: Apache-2.0
#include "burin/io/stl/stl_builder.h"

#include <cmath>
#include <cstring>
#include <string>

namespace burin::io::stl {

namespace {

/// 10 km, as for STEP: what is beyond is damage or a wrong unit.
constexpr double kMaxCoordinate = 1e7;

std::uint64_t bits(double v) {
  const double positive_zero = v + 0.0;
  std::uint64_t out = 0;
  std::memcpy(&out, &positive_zero, sizeof out);
  return out;
}

}  // namespace

std::size_t Builder::Hash::operator()(const std::array<std::uint64_t, 3>& key) const {
  std::uint64_t h = 0;
  for (const std::uint64_t k : key) {
    h = (h ^ k) * 0x9e3779b97f4a7c15ULL;
    h ^= h >> 32;
  }
  return static_cast<std::size_t>(h);
}

std::uint32_t Builder::vertex(geom::Point3 p) {
  const auto [found, is_new] = index_.try_emplace({bits(p.x), bits(p.y), bits(p.z)},
                                                  static_cast<std::uint32_t>(mesh_.vertices.size()));
  if (is_new) mesh_.vertices.push_back({p.x + 0.0, p.y + 0.0, p.z + 0.0});
  return found->second;
}

Error too_many(std::size_t max_triangles) {
  return {ErrorCode::range, "holds too many triangles (up to " + std::to_string(max_triangles) + ")", {}};
}

Result<void> Builder::add(const std::array<std::array<double, 3>, 3>& corners) {
  std::array<geom::Point3, 3> p;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const double v : corners[i]) {
      if (!std::isfinite(v))
        return Error{ErrorCode::syntax, "a coordinate is not a number (finite numbers)", {}};
      if (!(std::abs(v * scale_) <= kMaxCoordinate))
        return Error{
            ErrorCode::syntax, "a coordinate is farther than 10 km out (wrong unit, or damaged)", {}};
    }
    p[i] = {corners[i][0] * scale_, corners[i][1] * scale_, corners[i][2] * scale_};
  }
  if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) {
    ++degenerate_;
    return {};
  }
  if (mesh_.triangles.size() >= max_) return too_many(max_);
  mesh_.triangles.push_back({vertex(p[0]), vertex(p[1]), vertex(p[2])});
  return {};
}

}  // namespace burin::io::stl
