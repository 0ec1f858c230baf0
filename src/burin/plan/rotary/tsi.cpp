// SPDX-License-Identifier: Apache-2.0
// Tool-size interference (Suh & Lee 2.2) against the whole part. Centres are so close together that what is
// clear at two neighbours is clear between them within a known depth: a point outside of both balls lies at
// most h^2 / (8 R) inside of the ball between.
#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/rotary/excess.h"
#include "burin/plan/rotary/sweep.h"
#include "burin/plan/rotary/tsi.h"

namespace burin::rotary {

using geom::Point3;
using geom::Vec3;

namespace detail {

Place place_at(const Contact& contact, double radius) {
  return {contact, contact.p + radius * contact.n, State::ok, 0};
}

Contact mixed(const Contact& a, const Contact& b, double f) {
  double to = b.u;
  // u runs round: from 0.99 to 0.01 it goes on through 1.
  if (to - a.u > 0.5) to -= 1;
  if (a.u - to > 0.5) to += 1;
  double u = a.u + f * (to - a.u);
  u = u < 0 ? u + 1 : u > 1 ? u - 1 : u;
  return {lerp(a.p, b.p, f), turned(a.n, b.n, f), u, a.w + f * (b.w - a.w)};
}

std::vector<Contact> densified(const ContactPath& path, double radius, double spacing,
                               std::vector<std::uint8_t>& original) {
  std::vector<Contact> out;
  const std::size_t n = path.points.size(), last = path.closed ? n : n - 1;
  for (std::size_t i = 0; i < n; ++i) {
    const Contact &a = path.points[i], &b = path.points[(i + 1) % n];
    out.push_back(a);
    original.push_back(1);
    if (i >= last) break;
    // At a concave corner the two normals belong to two walls: there is nothing between.
    const double length = norm(b.p - a.p) + radius * angle_between(a.n, b.n);
    const bool corner = norm(b.p - a.p) < 1e-9 * radius && concave_at(path, i);
    const double wanted = std::ceil(length / spacing);
    if (corner || !(wanted > 1)) continue;
    const std::size_t steps = wanted < 1e7 ? std::size_t(wanted) : std::size_t(1e7);
    for (std::size_t k = 1; k < steps; ++k) {
      out.push_back(mixed(a, b, double(k) / double(steps)));
      original.push_back(0);
    }
  }
  return out;
}

bool concave_at(const ContactPath& path, std::size_t i) {
  const std::size_t n = path.points.size();
  const Contact &a = path.points[i], &b = path.points[(i + 1) % n];
  // The way in comes from where the path was before; the normal turns back against it in a hollow.
  for (std::size_t back = 1; back < n; ++back) {
    if (!path.closed && back > i) break;
    const Vec3 way = a.p - path.points[(i + n - back) % n].p;
    if (norm(way) > 0) return dot(b.n - a.n, way) < 0;
  }
  for (std::size_t ahead = 1; i + 1 + ahead < n; ++ahead) {
    const Vec3 way = path.points[i + 1 + ahead].p - b.p;
    if (norm(way) > 0) return dot(b.n - a.n, way) < 0;
  }
  return false;
}

}  // namespace detail

namespace {

using detail::Roller;

/// Bisections for the last good place before a bad one.
constexpr int kBisections = 8;
/// Halvings of a stretch where rolled places jump.
constexpr int kRefinements = 12;

class Resolver {
 public:
  Resolver(const ContactPath& path, const geom::MeshIndex& part, const TsiOptions& options)
      : options_(options),
        radius_(options.radius),
        spacing_(std::sqrt(0.4 * options.radius * options.tolerance_mm)),
        allowed_(allowed_depth(options)),
        roller_(part, options.radius, 0.02 * options.tolerance_mm) {
    contacts_ = detail::densified(path, radius_, spacing_, original_);
    result_.path.closed = path.closed;
  }
  TsiResult run();

 private:
  /// What the ball may sink into the mesh at a place: half the tolerance, less what lies between two places
  /// (spacing^2 / 8 R = tolerance / 20) and what the mesh is off.
  static double allowed_depth(const TsiOptions& o) {
    const double half = 0.5 * o.tolerance_mm - 0.05 * o.tolerance_mm;
    // A hollow wall of the mesh stands out by its deflection under a ball that touches the true surface: less
    // cannot be asked for.
    return std::max(half - o.deflection_mm, 1.05 * o.deflection_mm);
  }
  bool good(const Contact& c) const {
    Point3 nearest;
    return -roller_.room(c.p + radius_ * c.n, nearest) <= allowed_;
  }
  bool touches(const Contact& c, double room, Point3 nearest) const;
  Place standing(const Contact& c, bool touches) const;
  Place end_place(const Contact& c) const;
  Contact last_good(Contact good_end, Contact bad_end) const;
  void bridge(std::size_t first, std::size_t end);
  void follow(std::size_t first, std::size_t end);
  void roll(const Place& from, const Place& to, int depth, std::vector<Place>& out) const;
  const Contact& at(std::size_t i) const { return contacts_[i % contacts_.size()]; }
  std::vector<Contact> skipped(std::size_t first, std::size_t end) const;
  void append(std::vector<Place>& places, std::vector<Contact> left, const Place* before, const Place* after);

  TsiOptions options_;
  double radius_, spacing_, allowed_;
  Roller roller_;
  std::vector<Contact> contacts_;
  std::vector<std::uint8_t> original_, good_, touches_;
  TsiResult result_;
};

Contact Resolver::last_good(Contact good_end, Contact bad_end) const {
  const Contact a = good_end, b = bad_end;
  // Between the two normals of a corner there is no contact.
  if (norm(b.p - a.p) < 1e-9 * radius_) return a;
  double lo = 0, hi = 1;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = 0.5 * (lo + hi);
    (good(detail::mixed(a, b, middle)) ? lo : hi) = middle;
  }
  return detail::mixed(a, b, lo);
}

std::vector<Contact> Resolver::skipped(std::size_t first, std::size_t end) const {
  std::vector<Contact> left;
  for (std::size_t i = first; i < end; ++i) left.push_back(at(i));
  return left;
}

/// Between two places that touch: the middle, pushed out to touch, and so on until neighbours are close.
void Resolver::roll(const Place& from, const Place& to, int depth, std::vector<Place>& out) const {
  if (depth > kRefinements || distance(from.center, to.center) <= spacing_) return;
  Place middle;
  middle.contact = detail::mixed(from.contact, to.contact, 0.5);
  if (!roller_.touch(lerp(from.center, to.center, 0.5), middle)) return;
  // Pushed to where one end already is: no way on from here.
  if (distance(middle.center, from.center) < 1e-3 * spacing_ ||
      distance(middle.center, to.center) < 1e-3 * spacing_) {
    return;
  }
  roll(from, middle, depth + 1, out);
  out.push_back(middle);
  roll(middle, to, depth + 1, out);
}

void Resolver::append(std::vector<Place>& places, std::vector<Contact> left, const Place* before,
                      const Place* after) {
  result_.excess_max_mm =
      std::max(result_.excess_max_mm, detail::spread_excess(places, left, before, after, radius_));
  for (const Place& p : places) result_.path.places.push_back(p);
  result_.moved += places.size();
}

/// Bad contacts [first, end) between two good ones.
void Resolver::bridge(std::size_t first, std::size_t end) {
  const Place from = end_place(last_good(at(first - 1 + contacts_.size()), at(first)));
  const Place to = end_place(last_good(at(end), at(end - 1)));
  result_.path.places.push_back(from);
  result_.moved += (from.state == State::moved) + (to.state == State::moved);
  const std::vector<Contact> left = skipped(first, end);
  std::vector<Place> places;
  const auto angle = [](Point3 p) { return std::atan2(p.z, p.y); };
  // Once round the part and straight ahead are different ways: follow the contacts' own turn about the axis.
  double turn = 0, before = angle(from.center);
  for (const Contact& c : left) {
    turn += std::remainder(angle(c.p) - before, 2 * geom::kPi);
    before = angle(c.p);
  }
  turn += std::remainder(angle(to.center) - before, 2 * geom::kPi);
  constexpr double kPart = geom::kPi / 6;
  const int parts = std::max(1, int(std::ceil(std::abs(turn) / kPart)));
  const double r0 = std::hypot(from.center.y, from.center.z), r1 = std::hypot(to.center.y, to.center.z);
  Place last = from;
  for (int k = 1; k <= parts; ++k) {
    Place next = to;
    const double f = double(k) / parts;
    if (k < parts) {
      const double a = angle(from.center) + f * turn, r = r0 + f * (r1 - r0);
      next.contact = left[std::min(left.size() - 1, std::size_t(f * double(left.size())))];
      if (!roller_.touch(
              {from.center.x + f * (to.center.x - from.center.x), r * std::cos(a), r * std::sin(a)}, next)) {
        continue;
      }
    }
    roll(last, next, 0, places);
    if (k < parts) places.push_back(next);
    last = next;
  }
  if (places.empty()) {
    // A corner: both ends are nearly the same place. One stands for what was skipped.
    Place corner;
    corner.contact = left[left.size() / 2];
    if (roller_.touch(lerp(from.center, to.center, 0.5), corner)) places.push_back(corner);
  }
  append(places, left, &from, &to);
  result_.path.places.push_back(to);
}

/// Bad contacts without good ones before or after them: each rolls out on its own.
void Resolver::follow(std::size_t first, std::size_t end) {
  const std::vector<Contact> left = skipped(first, end);
  std::vector<Place> guide, places;
  for (const Contact& c : left) {
    Place p;
    p.contact = c;
    if (!roller_.touch(c.p + radius_ * c.n, p)) continue;
    if (!guide.empty() && distance(guide.back().center, p.center) < 0.25 * spacing_) continue;
    guide.push_back(p);
  }
  for (std::size_t k = 0; k < guide.size(); ++k) {
    if (k > 0) roll(guide[k - 1], guide[k], kRefinements - 4, places);
    places.push_back(guide[k]);
  }
  append(places, left, nullptr, nullptr);
}

/// Whether a ball that gouges nothing touches at its contact. Between contacts that follow the part only
/// roughly (lines on meshes) it may hang free, or touch elsewhere.
bool Resolver::touches(const Contact& c, double room, Point3 nearest) const {
  const double half = 0.5 * options_.tolerance_mm;
  if (room > half) return false;
  // A ball that touches within the tolerance touches about this far around its contact.
  if (distance(nearest, c.p) < std::sqrt(8 * radius_ * options_.tolerance_mm)) return true;
  return roller_.on_part(c.p, half);
}

Place Resolver::standing(const Contact& c, bool touches) const {
  Place place = detail::place_at(c, radius_);
  if (touches) return place;
  Place touching = place;
  return roller_.touch(place.center, touching) ? touching : place;
}

/// At either end of a stretch, where the contact lies between two given ones.
Place Resolver::end_place(const Contact& c) const {
  Point3 nearest = c.p;
  const double room = roller_.room(c.p + radius_ * c.n, nearest);
  return standing(c, touches(c, room, nearest));
}

TsiResult Resolver::run() {
  const std::size_t n = contacts_.size();
  touches_.reserve(n);
  good_.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    Point3 nearest = contacts_[i].p;
    const double room = roller_.room(contacts_[i].p + radius_ * contacts_[i].n, nearest);
    good_.push_back(-room <= allowed_);
    touches_.push_back(good_[i] && touches(contacts_[i], room, nearest));
    result_.interfering += original_[i] && !good_[i];
  }
  std::size_t start = 0;
  if (result_.path.closed) {
    while (start < n && !good_[start]) ++start;
    if (start == n) {
      follow(0, n);
      return std::move(result_);
    }
  }
  for (std::size_t i = start; i < start + n;) {
    if (!result_.path.closed && i >= n) break;
    if (good_[i % n]) {
      result_.path.places.push_back(standing(at(i), touches_[i % n] != 0));
      result_.moved += result_.path.places.back().state == State::moved;
      ++i;
      continue;
    }
    std::size_t end = i;
    const std::size_t limit = result_.path.closed ? start + n : n;
    while (end < limit && !good_[end % n]) ++end;
    if (!result_.path.closed && (i == 0 || end == n)) {
      follow(i, end);
    } else {
      bridge(i, end);
    }
    i = end;
  }
  return std::move(result_);
}

}  // namespace

TsiResult resolve_tsi(const ContactPath& path, const geom::MeshIndex& part, const TsiOptions& options) {
  if (path.points.empty() || !(options.radius > 0) || !(options.tolerance_mm > 0)) {
    TsiResult empty;
    empty.path.closed = path.closed;
    return empty;
  }
  if (options.method == Tsi::path) return detail::resolve_by_path(path, options);
  return Resolver(path, part, options).run();
}

}  // namespace burin::rotary
