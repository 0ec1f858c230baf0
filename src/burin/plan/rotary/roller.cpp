// SPDX-License-Identifier: Apache-2.0
// All moves keep x: a ball that is pushed stays in the plane it was meant for, so that neighbours on a path
// stay neighbours (free pushes slip out of the ends of slots, and along helical valleys).
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "burin/plan/rotary/tsi.h"

namespace burin::rotary::detail {
namespace {

using geom::Point3;
using geom::Vec2;
using geom::Vec3;

/// A point of the part that the ball must not hold.
using Wall = Point3;

/// Walls that face along X more than this cannot be left in the plane.
constexpr double kLeastAcross = 0.05;

/// What the ball may be left in the part when it is said to touch, times the accuracy.
constexpr double kLeftIn = 4;

/// Pushes longer than this part of the radius are looked at again.
constexpr double kLongPush = 0.25;

Vec2 across(Vec3 v) {
  return {v.y, v.z};
}
Point3 moved(Point3 c, Vec2 by) {
  return {c.x, c.y + by.x, c.z + by.y};
}

/// The smallest move in the plane after which the centre is R away from all walls, each taken as the plane
/// that touches the ball there; walls that would hold it back are left out.
Vec2 move_off(Point3 c, const std::vector<Wall>& walls, double radius) {
  std::array<Vec2, 3> n;
  std::array<double, 3> need{}, lambda{};
  const std::size_t count = std::min<std::size_t>(walls.size(), 3);
  for (std::size_t i = 0; i < count; ++i) {
    n[i] = across(unit(c - walls[i]));
    need[i] = radius - distance(c, walls[i]);
  }
  // Hildreth's projections: three planes at most.
  Vec2 move;
  constexpr int kSweeps = 60;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double change = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double more = std::max((need[i] - dot(n[i], move)) / norm2(n[i]), -lambda[i]);
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

double Roller::room(Point3 center, Point3& nearest) const {
  const auto hit = part_.nearest(center, 2 * radius_);
  if (hit) nearest = hit->p;
  return hit ? hit->distance - radius_ : radius_;
}

bool Roller::on_part(Point3 p, double within) const {
  return part_.nearest(p, within).has_value();
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
    if (norm(across(n)) < kLeastAcross) return false;
    std::erase_if(walls, [&](const Wall& w) {
      const Vec3 own = unit(c - w);
      return dot(own, n) > 0.999 || norm(across(own)) < kLeastAcross;
    });
    if (walls.size() == 3) walls.erase(walls.begin());
    walls.push_back(hit->p);
    c = moved(c, move_off(c, walls, radius_));
    // Farther than that it is not this wall's foot any more: `radially` finds the way.
    if (!(distance(c, start) < radius_)) return false;
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

/// From a clear place towards the wanted one, sliding along what is in the way, as near as it gets.
void Roller::settle(Point3& c, Point3 wanted) const {
  constexpr int kRounds = 200;
  constexpr double kSettled = 8;  // steps shorter than this many accuracies are not worth a look
  double step = radius_ / 4;
  for (int round = 0; round < kRounds && step > kSettled * accuracy_; ++round) {
    const double rest = distance(c, wanted);
    if (rest <= accuracy_) return;
    Point3 next = c + std::min(step, rest) * unit(wanted - c);
    // Steps are shorter than the ball: none leads through a wall, only into it.
    const bool nearer = push_out(next) && rest - distance(next, wanted) > 0.01 * std::min(step, rest);
    if (nearer) {
      c = next;
    } else {
      step *= 0.5;
    }
  }
}

/// A ball that hangs free goes towards the nearest point until it touches: by the room there is, which
/// nothing else can be nearer than.
bool Roller::pull_in(Point3& c, geom::MeshIndex::Hit& hit) const {
  constexpr int kRounds = 60;
  for (int round = 0; round < kRounds; ++round) {
    const auto found = part_.nearest(c, size_);
    if (!found || !(found->distance > 0)) return false;
    hit = *found;
    const double room = hit.distance - radius_;
    if (room <= accuracy_) return true;
    const Vec3 n = unit(c - hit.p);
    const double flat = norm(across(n));
    c = flat > 0.3 ? moved(c, (-room / flat) * across(n)) : c - room * n;
  }
  return false;
}

bool Roller::touch(Point3 near, Place& place) const {
  Point3 c = near;
  if (part_.inside(c) || !push_out(c) || part_.inside(c)) {
    c = near;
    if (!radially(c)) return false;
  }
  // Long pushes between several walls may end beside the nearest place.
  if (distance(c, near) > kLongPush * radius_) settle(c, near);
  geom::MeshIndex::Hit hit;
  if (!pull_in(c, hit)) return false;
  const Vec3 n = unit(c - hit.p);
  const Point3 center = hit.p + radius_ * n;
  // What a push or a slide left in the part (past the end of it, between walls that close in) is no place.
  if (part_.nearest(center, radius_ - kLeftIn * accuracy_)) return false;
  place.contact.p = hit.p;
  place.contact.n = n;
  place.center = center;
  place.state = State::moved;
  return true;
}

}  // namespace burin::rotary::detail
