// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/dexels.h"

namespace burin::removal {

using geom::Vec3;

PackedNormal pack(Vec3 n) {
  const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  if (!(sum > 0)) n = {0, 0, 1};
  double x = n.x / (sum > 0 ? sum : 1), y = n.y / (sum > 0 ? sum : 1);
  if (n.z < 0) {
    const double fx = (1 - std::abs(y)) * (x < 0 ? -1 : 1), fy = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
    x = fx, y = fy;
  }
  // 0 and +-1 are met exactly: faces of a block stay plane.
  const auto bits = [](double c) {
    return static_cast<std::uint32_t>(std::lround(c * 32767) + 32767) & 0xffffU;
  };
  return bits(x) << 16 | bits(y);
}

Vec3 unpack(PackedNormal n) {
  const double x = (static_cast<int>(n >> 16) - 32767) / 32767.0;
  const double y = (static_cast<int>(n & 0xffffU) - 32767) / 32767.0;
  Vec3 v{x, y, 1 - std::abs(x) - std::abs(y)};
  if (v.z < 0) {
    v.x = (1 - std::abs(y)) * (x < 0 ? -1 : 1);
    v.y = (1 - std::abs(x)) * (y < 0 ? -1 : 1);
  }
  return unit(v);
}

void Tile::add(std::uint32_t index, const Span& span) {
  Line& line = lines_[index];
  insert(line, line.count, span);
}

void Tile::insert(Line& line, std::uint32_t at, const Span& span) {
  if (line.count == line.room) {
    const auto room = static_cast<std::uint16_t>(line.room == 0 ? 1 : std::min(2 * line.room, 0xffff));
    // 65535 pieces of one line: what comes more is lost, at a length below 1/65535 of the line each.
    if (room == line.count) return;
    const auto first = static_cast<std::uint32_t>(pool_.size());
    pool_.resize(pool_.size() + room);
    std::copy_n(pool_.begin() + line.first, line.count, pool_.begin() + first);
    lost_ += line.room;
    line.first = first, line.room = room;
  }
  const auto begin = pool_.begin() + line.first;
  std::copy_backward(begin + at, begin + line.count, begin + line.count + 1);
  begin[at] = span;
  ++line.count;
  constexpr std::size_t kFew = 1024;
  if (lost_ > kFew && 2 * lost_ > pool_.size()) shrink();
}

void Tile::erase(Line& line, std::uint32_t at) {
  const auto begin = pool_.begin() + line.first;
  std::copy(begin + at + 1, begin + line.count, begin + at);
  --line.count;
}

void Tile::shrink() {
  std::vector<Span> kept;
  std::size_t total = 0;
  for (const Line& line : lines_) total += line.count;
  kept.reserve(total);
  for (Line& line : lines_) {
    const auto first = static_cast<std::uint32_t>(kept.size());
    kept.insert(kept.end(), pool_.begin() + line.first, pool_.begin() + line.first + line.count);
    line.first = first, line.room = line.count;
  }
  pool_ = std::move(kept);
  lost_ = 0;
}

std::uint64_t Tile::parts(float lo, float hi, float per_mm) {
  const int from = static_cast<int>(std::clamp(lo * per_mm, 0.0F, 63.0F));
  const int to = static_cast<int>(std::clamp(hi * per_mm, 0.0F, 63.0F));
  const std::uint64_t up_to = to >= 63 ? ~0ULL : (1ULL << (to + 1)) - 1;
  return up_to & ~((1ULL << from) - 1);
}

void Tile::count_parts(float per_mm) {
  occupied_ = 0;
  for (std::uint32_t l = 0; l < kLines && ~occupied_ != 0; ++l)
    for (const Span* s = begin(l); s != end(l); ++s) occupied_ |= parts(s->lo, s->hi, per_mm);
}

double Tile::length() const {
  double sum = 0;
  for (std::uint32_t l = 0; l < kLines; ++l)
    for (const Span* s = begin(l); s != end(l); ++s)
      sum += static_cast<double>(s->hi) - static_cast<double>(s->lo);
  return sum;
}

DexelField::DexelField(const Grid& grid, std::size_t axis) : grid_(grid), axis_(axis) {
  tiles_u_ = (grid.count[u_axis()] + Tile::kSide - 1) / Tile::kSide;
  tiles_v_ = (grid.count[v_axis()] + Tile::kSide - 1) / Tile::kSide;
  tiles_.resize(static_cast<std::size_t>(tiles_u_) * tiles_v_);
}

double DexelField::volume() const {
  double sum = 0;
  for (const Tile& tile : tiles_) sum += tile.length();
  return sum * cell_area();
}

}  // namespace burin::removal
