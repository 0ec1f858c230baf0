// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "burin/plan/rotary/tsi.h"

namespace burin::rotary::detail {
namespace {

using geom::Point3;
using geom::Vec3;

/// A point of the part that the ball must not hold, as seen from the ball's centre.
struct Wall {
  Point3 p;
};

/// The smallest move after which the centre is R away from all walls, each taken as a plane; walls that would
/// hold it back are left out. At most three.
Vec3 move_off(Point3 c, const std::vector<Wall>& walls, double radius) {
  std::array<Vec3, 3> n;
  std::array<double, 3> need{};
  const std::size_t count = walls.size();
  for (std::size_t i = 0; i < count; ++i) {
    n[i] = unit(c - walls[i].p);
    need[i] = radius - distance(c, walls[i].p);
  }
  // Dykstra's projections: few, the sizes are tiny.
  std::array<double, 3> lambda{};
  Vec3 move;
  constexpr int kSweeps = 60;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double more = std::max(need[i] - dot(n[i], move), -lambda[i]);
      lambda[i] += more;
      move = move + more * n[i];
      change = std::max(change, std::abs(more));
    }
    if (change < 1e-12 * radius) break;
  }
  return move;
}

}  // namespace

Roller::Roller(const geom::MeshIndex& part, double radius, double accuracy_mm)
    : part_(part), radius_(radius), accuracy_(accuracy_mm), size_(part.bounds().diagonal() + 4 * radius) {}

double Roller::depth(Point3 center) const {
  const auto hit = part_.nearest(center, radius_);
  return hit ? radius_ - hit->distance : 0;
}

bool Roller::push_out(Point3& c) const {
  constexpr int kRounds = 40;
  std::vector<Wall> walls;
  const Point3 start = c;
  for (int round = 0; round < kRounds; ++round) {
    const auto hit = part_.nearest(c, radius_ - accuracy_);
    if (!hit) return true;
    if (hit->distance < accuracy_) return false;  // no direction
    // The walls of the last rounds; one that is nearly the same is replaced.
    const Vec3 n = unit(c - hit->p);
    std::erase_if(walls, [&](const Wall& w) { return dot(unit(c - w.p), n) > 0.999; });
    if (walls.size() == 3) walls.erase(walls.begin());
    walls.push_back({hit->p});
    c = c + move_off(c, walls, radius_);
    if (!(distance(c, start) < 4 * radius_)) return false;
  }
  return false;
}

bool Roller::radially(Point3& c) const {
  const double r = std::hypot(c.y, c.z);
  const Vec3 out = r > 0 ? Vec3{0, c.y / r, c.z / r} : Vec3{0, 0, 1};
  const auto t = part_.ball_out(c, out, radius_, accuracy_, size_, 0.5 * accuracy_);
  if (!t) return false;
  c = c + *t * out;
  return true;
}

bool Roller::touch(Point3 near, Place& place) const {
  Point3 c = near;
  if (part_.inside(c) || !push_out(c) || part_.inside(c)) {
    c = near;
    if (!radially(c)) return false;
  }
  auto hit = part_.nearest(c, size_);
  if (!hit) return false;
  if (hit->distance > radius_ + accuracy_) {
    // Straight towards the nearest point: nothing else can become nearer on the way.
    c = hit->p + radius_ * unit(c - hit->p);
  }
  if (!(hit->distance > 0)) return false;
  place.contact.p = hit->p;
  place.contact.n = unit(c - hit->p);
  place.center = hit->p + radius_ * place.contact.n;
  place.state = State::moved;
  return true;
}

}  // namespace burin::rotary::detail
