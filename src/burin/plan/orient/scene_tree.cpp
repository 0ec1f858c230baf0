// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene_tree.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "burin/plan/orient/scene_fit.h"

namespace burin::orient::detail {

using geom::Point3;
using geom::Vec3;

namespace {

constexpr std::size_t kPacket = 4, kWide = 8;
/// The directions of a box are chosen from this many triangles at most.
constexpr std::size_t kSample = 256;
/// Smaller runs are cut across the longest side of their axis-parallel box: nearly as good, and most of the
/// time of building goes there.
constexpr std::size_t kPlainCut = 64;

/// A run of the order of triangles.
struct Run {
  std::size_t first = 0, last = 0;
  std::size_t count() const { return last - first; }
  std::size_t packets() const { return (count() + kPacket - 1) / kPacket; }
};

class Builder {
 public:
  Builder(const geom::Mesh& mesh, SceneTree& out) : mesh_(mesh), out_(out) {}
  void run();

 private:
  std::array<Point3, 3> corners(std::uint32_t triangle) const {
    const auto& t = mesh_.triangles[triangle];
    return {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]};
  }
  Point3 middle(std::uint32_t triangle) const {
    const auto t = corners(triangle);
    return t[0] + ((t[1] - t[0]) + (t[2] - t[0])) / 3.0;
  }
  std::vector<Run> by_size();
  int node(std::vector<Run> children, int level);
  int packet(const Run& run);
  Vec3 longest_side(const Run& run) const;
  std::size_t split(const Run& run, int level);
  std::size_t split_by_side(const Run& run, const FittedBox& box);
  FittedBox fit(const Run& run, std::size_t sample = kSample) const {
    return fit_box(mesh_, std::span(order_).subspan(run.first, run.count()), sample);
  }

  const geom::Mesh& mesh_;
  SceneTree& out_;
  std::vector<std::uint32_t> order_;
  std::vector<std::pair<double, std::uint32_t>> keys_;  // of a cut
};

/// Further out single precision would overflow in squares (mm; no part is there).
constexpr double kFarthest = 1e15;
bool sane(const Point3& q) {
  return std::abs(q.x) < kFarthest && std::abs(q.y) < kFarthest && std::abs(q.z) < kFarthest;
}

void Builder::run() {
  const std::size_t n = mesh_.vertices.size();
  order_.reserve(mesh_.triangles.size());
  for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
    const auto& t = mesh_.triangles[i];
    if (std::max({t[0], t[1], t[2]}) >= n) continue;
    const auto c = corners(static_cast<std::uint32_t>(i));
    if (sane(c[0]) && sane(c[1]) && sane(c[2])) order_.push_back(static_cast<std::uint32_t>(i));
  }
  out_.place.assign(mesh_.triangles.size(), kNoPlace);
  if (order_.empty()) return;
  out_.packets.reserve(order_.size() / kPacket + kWide);
  node(by_size(), 0);
}

/// Large triangles apart from small ones: among them they would make every box on their way large.
std::vector<Run> Builder::by_size() {
  constexpr double kTimes = 8;
  constexpr std::size_t kClasses = 4, kFew = 64;
  const auto size = [&](std::uint32_t i) {
    const auto c = corners(i);
    return std::max({distance(c[0], c[1]), distance(c[1], c[2]), distance(c[2], c[0])});
  };
  std::vector<Run> out;
  Run rest{0, order_.size()};
  while (out.size() + 1 < kClasses && rest.count() > kFew) {
    std::vector<double> sizes;
    const std::size_t step = rest.count() / 1024 + 1;
    for (std::size_t i = rest.first; i < rest.last; i += step) sizes.push_back(size(order_[i]));
    const auto mid = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), mid, sizes.end());
    const double limit = kTimes * *mid;
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(rest.first);
    const auto large = std::stable_partition(begin, order_.begin() + static_cast<std::ptrdiff_t>(rest.last),
                                             [&](std::uint32_t i) { return size(i) <= limit; });
    const Run small{rest.first, static_cast<std::size_t>(large - order_.begin())};
    if (small.count() == 0 || small.last == rest.last) break;
    out.push_back(small);
    rest.first = small.last;
  }
  out.push_back(rest);
  return out;
}

int Builder::packet(const Run& run) {
  ScenePacket p{};
  for (std::size_t lane = 0; lane < kPacket; ++lane) {
    const std::uint32_t triangle = order_[std::min(run.first + lane, run.last - 1)];
    const auto c = corners(triangle);
    for (std::size_t i = 0; i < 3; ++i) {
      p.at[i][0][lane] = c[i].x;
      p.at[i][1][lane] = c[i].y;
      p.at[i][2][lane] = c[i].z;
    }
    p.triangle[lane] = triangle;
    if (lane < run.count())
      out_.place[triangle] = static_cast<std::uint32_t>(out_.packets.size() * kPacket + lane);
  }
  out_.packets.push_back(p);
  return static_cast<int>(out_.packets.size()) - 1;
}

/// Two sides of a thin wall: apart where one box would be thick for both.
std::size_t Builder::split_by_side(const Run& run, const FittedBox& box) {
  constexpr double kThick = 0.03, kFew = 0.15;
  if (!(box.half[2] > kThick * box.half[0]) || run.count() < 4 * kPacket) return run.first;
  const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(run.first);
  const auto end = order_.begin() + static_cast<std::ptrdiff_t>(run.last);
  const auto faces_up = [&](std::uint32_t i) {
    const auto c = corners(i);
    return dot(cross(c[1] - c[0], c[2] - c[0]), box.axis[2]) > 0;
  };
  const auto up = static_cast<std::size_t>(std::count_if(begin, end, faces_up));
  const double share = double(up) / double(run.count());
  if (share < kFew || share > 1 - kFew) return run.first;
  std::stable_partition(begin, end, faces_up);
  const double top = fit({run.first, run.first + up}).half[2],
               bottom = fit({run.first + up, run.last}).half[2];
  return std::max(top, bottom) < 0.5 * box.half[2] ? run.first + up : run.first;
}

/// The longest side of the axis-parallel box of the triangles' middles.
Vec3 Builder::longest_side(const Run& run) const {
  geom::Box3 box;
  for (std::size_t i = run.first; i < run.last; ++i) box.add(middle(order_[i]));
  const Vec3 d = box.hi - box.lo;
  if (d.x >= d.y && d.x >= d.z) return {1, 0, 0};
  return d.y >= d.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
}

/// Where to cut the run, after bringing it into order: whole packets on the left of a cut across the longest
/// direction.
std::size_t Builder::split(const Run& run, int level) {
  Vec3 along;
  if (run.count() <= kPlainCut) {
    along = longest_side(run);
  } else {
    const FittedBox box = fit(run);
    along = box.axis[0];
    // Cuts by side need not halve: few of them, so that the levels stay few.
    constexpr int kSideLevels = 12;
    if (level < kSideLevels) {
      const std::size_t at = split_by_side(run, box);
      if (at != run.first) return at;
    }
  }
  const std::size_t at = run.first + run.packets() / 2 * kPacket;
  const Point3 origin = middle(order_[run.first]);
  keys_.resize(run.count());
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const std::uint32_t t = order_[run.first + i];
    keys_[i] = {dot(middle(t) - origin, along), t};
  }
  std::nth_element(keys_.begin(), keys_.begin() + static_cast<std::ptrdiff_t>(at - run.first), keys_.end());
  for (std::size_t i = 0; i < keys_.size(); ++i) order_[run.first + i] = keys_[i].second;
  return at;
}

int Builder::node(std::vector<Run> children, int level) {
  std::size_t packets = 0;
  for (const Run& r : children) packets += r.packets();
  // Children that fill their own nodes: no more than a power of eight below each.
  std::size_t capacity = 1;
  while (capacity * kWide < packets) capacity *= kWide;
  while (children.size() < kWide) {
    const auto most = std::max_element(children.begin(), children.end(),
                                       [](const Run& a, const Run& b) { return a.count() < b.count(); });
    if (most->packets() <= capacity) break;
    const std::size_t at = split(*most, level);
    const Run right{at, most->last};
    most->last = at;
    children.insert(most + 1, right);
  }
  const auto index = out_.nodes.size();
  out_.nodes.emplace_back();
  std::vector<FittedBox> boxes;
  for (const Run& r : children) boxes.push_back(fit(r));
  Point3 origin = boxes[0].middle;
  for (const FittedBox& b : boxes) origin = origin + (b.middle - boxes[0].middle) / double(boxes.size());
  SceneNode made{};
  made.origin[0] = origin.x;
  made.origin[1] = origin.y;
  made.origin[2] = origin.z;
  for (std::size_t lane = 0; lane < children.size(); ++lane) {
    put_box(boxes[lane], origin, static_cast<int>(lane), made);
    made.child[lane] =
        children[lane].packets() == 1 ? ~packet(children[lane]) : node({children[lane]}, level + 1);
  }
  out_.nodes[index] = made;
  return static_cast<int>(index);
}

}  // namespace

SceneTree build_scene_tree(const geom::Mesh& mesh) {
  SceneTree tree;
  Builder(mesh, tree).run();
  return tree;
}

}  // namespace burin::orient::detail
