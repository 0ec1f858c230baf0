// SPDX-License-Identifier: Apache-2.0
// The paper's procedure 2: contacts at which the path is more hollow than the ball, and those on crossing
// loops of the offset path in the plane of the path, are removed. What lies off that plane is not seen.
#include <algorithm>
#include <cmath>

#include "burin/geom/box_tree.h"
#include "burin/plan/rotary/sweep.h"
#include "burin/plan/rotary/tsi.h"

namespace burin::rotary::detail {
namespace {

using geom::Box2;
using geom::Point2;
using geom::Point3;
using geom::Vec2;
using geom::Vec3;

/// Rings and the spiral lie in (or near) planes x = const; a line in the plane of the axis and its own side.
std::vector<Point2> projected(const std::vector<Point3>& centers, const std::vector<double>& turns) {
  std::vector<Point2> flat;
  flat.reserve(centers.size());
  const bool around = std::abs(turns.back() - turns.front()) > 0;
  Vec2 side;
  for (const Point3 c : centers) side = side + Vec2{c.y, c.z};
  side = unit(side);
  for (const Point3 c : centers) {
    flat.push_back(around ? Point2{c.y, c.z} : Point2{c.x, dot(side, Vec2{c.y, c.z})});
  }
  return flat;
}

/// u without jumps at the seam.
std::vector<double> unrolled(const std::vector<Contact>& contacts) {
  std::vector<double> turns{contacts.front().u};
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    turns.push_back(turns.back() + std::remainder(contacts[i].u - contacts[i - 1].u, 1.0));
  }
  return turns;
}

bool cross_each_other(Point2 a, Point2 b, Point2 c, Point2 d) {
  const double ca = cross(d - c, a - c), cb = cross(d - c, b - c);
  const double ac = cross(b - a, c - a), ad = cross(b - a, d - a);
  return ((ca > 0) != (cb > 0)) && ((ac > 0) != (ad > 0));
}

class Procedure2 {
 public:
  Procedure2(const ContactPath& path, const TsiOptions& options)
      : closed_(path.closed), radius_(options.radius) {
    contacts_ = densified(path, radius_, std::sqrt(0.4 * radius_ * options.tolerance_mm), original_);
    removed_.assign(contacts_.size(), 0);
    for (const Contact& c : contacts_) centers_.push_back(center_of(c, radius_));
  }
  TsiResult run() {
    if (contacts_.size() > 2) {
      remove_hollow();
      remove_loops();
    }
    TsiResult result;
    result.path.closed = closed_;
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (removed_[i]) {
        result.interfering += original_[i];
      } else {
        result.path.places.push_back(place_at(contacts_[i], radius_));
      }
    }
    return result;
  }

 private:
  std::size_t segments() const { return closed_ ? contacts_.size() : contacts_.size() - 1; }
  /// Curvature above 1/R: the centre runs back while the contact runs on.
  void remove_hollow() {
    const std::size_t n = contacts_.size();
    for (std::size_t i = 0; i < segments(); ++i) {
      const std::size_t k = (i + 1) % n;
      const Vec3 contact = contacts_[k].p - contacts_[i].p, center = centers_[k] - centers_[i];
      if (dot(contact, center) < 0) removed_[i] = removed_[k] = 1;
    }
  }
  void remove_loops() {
    const std::size_t n = contacts_.size();
    const std::vector<double> turns = unrolled(contacts_);
    const std::vector<Point2> flat = projected(centers_, turns);
    std::vector<Box2> boxes(segments());
    for (std::size_t i = 0; i < segments(); ++i) {
      boxes[i].add(flat[i]);
      boxes[i].add(flat[(i + 1) % n]);
    }
    const geom::BoxTree2 tree(boxes);
    for (std::size_t i = 0; i < segments();) {
      std::size_t farthest = i;
      tree.query(boxes[i], [&](std::uint32_t j) {
        const std::size_t k = j > i ? j : closed_ ? j + n : i;
        if (k < i + 2 || (k + 1) % n == i % n || !near_in_turn(turns, i, k, n)) return true;
        if (cross_each_other(flat[i], flat[(i + 1) % n], flat[j], flat[(j + 1) % n]))
          farthest = std::max(farthest, k);
        return true;
      });
      for (std::size_t k = i + 1; k <= farthest; ++k) removed_[k % n] = 1;
      i = std::max(i + 1, farthest);
    }
  }
  /// Loops are at most half a turn long: turns of the spiral cross each other, seen along X, without any.
  bool near_in_turn(const std::vector<double>& turns, std::size_t i, std::size_t k, std::size_t n) const {
    double way = turns[k % n] - turns[i];
    if (k >= n) way += 1;
    return std::abs(way) < 0.5;
  }

  bool closed_;
  double radius_;
  std::vector<Contact> contacts_;
  std::vector<std::uint8_t> original_, removed_;
  std::vector<Point3> centers_;
};

}  // namespace

TsiResult resolve_by_path(const ContactPath& path, const TsiOptions& options) {
  return Procedure2(path, options).run();
}

}  // namespace burin::rotary::detail
