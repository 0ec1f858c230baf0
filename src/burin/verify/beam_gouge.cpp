// SPDX-License-Identifier: Apache-2.0
// The deepest place of the swept region in the part, by branch and bound over pieces of the beam's way, then
// over squares. docs/verify-beam.md
#include <algorithm>
#include <cmath>
#include <queue>

#include "burin/base/parallel.h"
#include "burin/verify/beam_parts.h"

namespace burin::verify {
namespace {

using flat::kNever;
using geom::Point2;
using geom::Segment;
using geom::Vec2;

constexpr std::size_t kChunk = 1024;         ///< pieces a task
constexpr std::size_t kMostNodes = 400'000;  ///< of the search; beyond, the bound is what is left
constexpr double kMostCells = 150'000;       ///< of the area
constexpr double kCellsAcross = 3;           ///< a radius, where there are not too many

/// What the beam does along a stretch of its way.
struct Stretch {
  double upper = 0;  ///< nothing of it lies deeper
  Point2 at;         ///< a swept point that is likely to be the deepest
  bool touches = false, inside = false;
};

class Search {
 public:
  explicit Search(const BeamScene& scene) : scene_(scene), radius_(scene.radius) {}

  GougeResult run() {
    const auto& pieces = scene_.motion.pieces;
    std::vector<Stretch> found(pieces.size());
    std::vector<double> depths(pieces.size(), 0);
    const std::size_t chunks = (pieces.size() + kChunk - 1) / kChunk;
    parallel_for(chunks, scene_.threads, [&](std::size_t chunk, std::size_t) {
      look(chunk * kChunk, std::min(pieces.size(), (chunk + 1) * kChunk), found, depths);
    });
    for (std::uint32_t i = 0; i < pieces.size(); ++i) {
      if (depths[i] > 0) better(depths[i], found[i].at, i);
    }
    refine(found);
    result_.bound_mm = std::max(0.0, left_ - result_.worst.mm);
    result_.area_mm2 = area(found);
    return result_;
  }

 private:
  struct Node {
    double upper = 0;
    std::uint64_t id = 0;  ///< of equal ones the first
    std::uint32_t piece = 0;
    double f0 = 0, f1 = 1;  ///< a stretch of the piece
    double half = -1;       ///< >= 0: a square about `at`
    Point2 at;
    bool operator<(const Node& other) const {
      return upper != other.upper ? upper < other.upper : id > other.id;
    }
  };

  double enough() const { return 0.5 * scene_.options.bound_mm; }

  void better(double mm, Point2 at, std::uint32_t piece) {
    if (mm > result_.worst.mm) result_.worst = {mm, at, scene_.motion.moves[piece]};
  }

  /// From one piece to the next the side changes only where they touch an edge.
  void look(std::size_t first, std::size_t end, std::vector<Stretch>& found,
            std::vector<double>& depths) const {
    bool known = false, inside = false;
    Point2 at;
    double best = 0;
    for (std::size_t i = first; i < end; ++i) {
      const Segment& s = scene_.motion.pieces[i];
      known = known && s.a == at;
      found[i] = bounded(s, known ? &inside : nullptr);
      known = !found[i].touches;
      inside = found[i].inside;
      at = s.b;
      if (found[i].upper > best) {
        depths[i] = depth_at(scene_, found[i].at).mm;
        best = std::max(best, depths[i]);
      }
    }
  }

  Stretch bounded(const Segment& s, const bool* side) const {
    Stretch out;
    out.at = s.a;
    if (scene_.edges.empty()) {
      out.upper = kNever;
      out.inside = true;
    } else {
      const auto pair = scene_.edges.nearest(s, radius_);
      out.touches = pair.distance <= flat::kRounding;
      out.inside = out.touches || (side ? *side : within(point_on(s, 0.5)));
      if (!out.inside) {
        if (pair.distance == kNever) return out;
        out.upper = radius_ - pair.distance;
        out.at = pair.p + (radius_ / pair.distance) * (pair.q - pair.p);
      } else {
        from_within(s, scene_.edges, radius_, out);
      }
    }
    if (out.upper > 0 && !scene_.lines.empty()) {
      // A point of the disc is deeper than the beam's reach from a line by no more than its centre is off it.
      Stretch off = out;
      off.upper = kNever;
      from_within(s, scene_.lines, 0, off);
      if (off.upper < out.upper) {
        out.upper = off.upper;
        if (out.inside) out.at = off.at;
      }
    }
    return out;
  }

  bool within(Point2 p) const {
    return scene_.sides_tell ? in_part(scene_, p, scene_.edges.nearest(p)) : scene_.in_part(p);
  }

  /// Away from everything in the tree, by the nearest of a few places.
  void from_within(const Segment& s, const flat::Tree& tree, double add, Stretch& out) const {
    out.upper = kNever;
    double furthest = -kNever;
    const double length = length_of(s);
    for (const double f : {0.5, 0.0, 1.0}) {
      const Point2 c = point_on(s, f);
      const auto near = tree.nearest(c);
      out.upper = std::min(out.upper, add + flat::most_distance(s, tree.segments()[near.segment]));
      out.upper = std::min(out.upper, add + near.distance + (f == 0.5 ? 0.5 : 1.0) * length);
      const Depth depth = depth_at(scene_, c);
      if (depth.mm > furthest) {
        furthest = depth.mm;
        out.at = c + radius_ * depth.inwards;
      }
    }
  }

  void refine(const std::vector<Stretch>& found) {
    std::priority_queue<Node> open;
    std::uint64_t id = 0;
    for (std::uint32_t i = 0; i < found.size(); ++i) {
      if (found[i].upper > result_.worst.mm + enough()) {
        open.push({found[i].upper, id++, i, 0, 1, -1, {}});
      } else {
        left_ = std::max(left_, found[i].upper);
      }
    }
    const std::size_t most = std::min(kMostNodes, scene_.options.max_samples);
    for (std::size_t n = 0; !open.empty() && n < most; ++n) {
      const Node node = open.top();
      if (node.upper <= result_.worst.mm + enough()) break;
      open.pop();
      if (node.half >= 0) {
        for (const double x : {-0.5, 0.5}) {
          for (const double y : {-0.5, 0.5}) {
            Node child = node;
            child.half = 0.5 * node.half;
            child.at = node.at + node.half * Vec2{x, y};
            if (square(child)) child.id = id++, open.push(child);
          }
        }
        continue;
      }
      const Segment s = flat::stretch(scene_.motion.pieces[node.piece], node.f0, node.f1);
      if (length_of(s) <= radius_) {
        Node child = node;
        child.half = radius_ + 0.5 * length_of(s);
        child.at = point_on(s, 0.5);
        if (square(child)) child.id = id++, open.push(child);
        continue;
      }
      const double middle = 0.5 * (node.f0 + node.f1);
      for (int k = 0; k < 2; ++k) {
        Node child = node;
        (k == 0 ? child.f1 : child.f0) = middle;
        const Stretch part =
            bounded(flat::stretch(scene_.motion.pieces[node.piece], child.f0, child.f1), nullptr);
        child.upper = std::min(node.upper, part.upper);
        if (child.upper > result_.worst.mm) better(depth_at(scene_, part.at).mm, part.at, node.piece);
        if (child.upper > result_.worst.mm + enough()) {
          child.id = id++;
          open.push(child);
        } else {
          left_ = std::max(left_, child.upper);
        }
      }
    }
    if (!open.empty()) left_ = std::max(left_, open.top().upper);
  }

  /// The square's bound; false when nothing of interest is in it.
  bool square(Node& node) {
    const Segment& piece = scene_.motion.pieces[node.piece];
    const double corner = std::sqrt(2.0) * node.half;
    const geom::Nearest near = nearest_on(piece, node.at);
    if (near.distance > radius_ + corner) return false;
    Point2 p = node.at;
    double aside = 0;
    if (near.distance > radius_) {
      aside = near.distance - radius_;
      p = near.point + (radius_ / near.distance) * (node.at - near.point);
    }
    const double depth = depth_at(scene_, p).mm;
    better(depth, p, node.piece);
    node.upper = std::min(node.upper, depth + aside + corner);
    if (node.upper > result_.worst.mm + enough()) return true;
    left_ = std::max(left_, node.upper);
    return false;
  }

  // --- area
  // ----------------------------------------------------------------------------------------------------

  /// Numbers of columns and rows of squares, up to 2^31 each way.
  static std::uint64_t key_of(std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(x + (1LL << 31)) << 32) | static_cast<std::uint64_t>(y + (1LL << 31));
  }

  void cells_of(const Segment& s, double size, std::int64_t x0, std::int64_t x1, std::int64_t y0,
                std::int64_t y1, std::vector<std::uint64_t>& keys) const {
    const double w = size * double(x1 - x0), h = size * double(y1 - y0);
    const Point2 middle{origin_.x + size * 0.5 * double(x0 + x1), origin_.y + size * 0.5 * double(y0 + y1)};
    if (nearest_on(s, middle).distance > radius_ + 0.5 * std::hypot(w, h)) return;
    if (x1 - x0 == 1 && y1 - y0 == 1) {
      keys.push_back(key_of(x0, y0));
    } else if (x1 - x0 >= y1 - y0) {
      const std::int64_t x = x0 + (x1 - x0) / 2;
      cells_of(s, size, x0, x, y0, y1, keys);
      cells_of(s, size, x, x1, y0, y1, keys);
    } else {
      const std::int64_t y = y0 + (y1 - y0) / 2;
      cells_of(s, size, x0, x1, y0, y, keys);
      cells_of(s, size, x0, x1, y, y1, keys);
    }
  }

  /// Of a square of side `size` about the origin, where both linear functions are positive.
  static double clipped(double size, double a, Vec2 da, double b, Vec2 db) {
    std::vector<Point2> shape{{-0.5 * size, -0.5 * size},
                              {0.5 * size, -0.5 * size},
                              {0.5 * size, 0.5 * size},
                              {-0.5 * size, 0.5 * size}};
    for (int k = 0; k < 2; ++k) {
      const auto value = [&](Point2 p) { return (k == 0 ? a : b) + dot(k == 0 ? da : db, p - Point2{}); };
      std::vector<Point2> kept;
      for (std::size_t i = 0; i < shape.size(); ++i) {
        const Point2 p = shape[i], q = shape[(i + 1) % shape.size()];
        const double u = value(p), v = value(q);
        if (u >= 0) kept.push_back(p);
        if ((u > 0 && v < 0) || (u < 0 && v > 0)) kept.push_back(lerp(p, q, u / (u - v)));
      }
      shape = std::move(kept);
    }
    double twice = 0;
    for (std::size_t i = 0; i < shape.size(); ++i)
      twice += cross(shape[i] - Point2{}, shape[(i + 1) % shape.size()] - Point2{});
    return 0.5 * twice;
  }

  /// Squares over the pieces that may reach too deep; in each, edge and cut are taken as straight.
  double area(const std::vector<Stretch>& found) {
    std::vector<std::uint32_t> deep;
    double swept = 0;
    geom::Box2 box;
    for (std::uint32_t i = 0; i < found.size(); ++i) {
      if (found[i].upper <= scene_.area_from_mm) continue;
      const Segment& s = scene_.motion.pieces[i];
      deep.push_back(i);
      swept += 2 * radius_ * (length_of(s) + 2 * radius_);
      box.add(bounds_of(s));
    }
    if (deep.empty()) return 0;
    const double extent = std::max(box.width(), box.height()) + 2 * radius_;
    const double size =
        std::max({radius_ / kCellsAcross, std::sqrt(swept / kMostCells), extent / double(1LL << 30)});
    origin_ = box.lo;
    std::vector<std::uint64_t> keys;
    for (const std::uint32_t i : deep) {
      const Segment& s = scene_.motion.pieces[i];
      const geom::Box2 b = bounds_of(s).grown(radius_);
      const auto number = [&](double v) { return static_cast<std::int64_t>(std::floor(v / size)); };
      cells_of(s, size, number(b.lo.x - origin_.x), number(b.hi.x - origin_.x) + 1,
               number(b.lo.y - origin_.y), number(b.hi.y - origin_.y) + 1, keys);
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    const std::size_t chunks = (keys.size() + kChunk - 1) / kChunk;
    std::vector<double> sums(chunks, 0);
    parallel_for(chunks, scene_.threads, [&](std::size_t chunk, std::size_t) {
      for (std::size_t i = chunk * kChunk; i < std::min(keys.size(), (chunk + 1) * kChunk); ++i)
        sums[chunk] += in_cell(keys[i], size);
    });
    double sum = 0;
    for (const double s : sums) sum += s;
    return sum;
  }

  double in_cell(std::uint64_t key, double size) const {
    const double x = double(static_cast<std::int64_t>(key >> 32) - (1LL << 31));
    const double y = double(static_cast<std::int64_t>(key & 0xffffffffU) - (1LL << 31));
    const Point2 p{origin_.x + size * (x + 0.5), origin_.y + size * (y + 0.5)};
    const auto beam = scene_.cut.nearest(p, radius_ + size);
    if (!beam.found()) return 0;
    const Depth depth = depth_at(scene_, p);
    const double within = radius_ - beam.distance;
    if (depth.mm + within <= scene_.area_from_mm) return 0;
    return clipped(size, depth.mm, depth.inwards, within, unit(beam.point - p));
  }

  const BeamScene& scene_;
  double radius_;
  GougeResult result_;
  double left_ = 0;  ///< what was not looked into lies no deeper
  Point2 origin_;
};

}  // namespace

bool in_part(const BeamScene& scene, Point2 p, const flat::Tree::Near& near) {
  const Segment& s = scene.edges.segments()[near.segment];
  // At a joint of two edges either may be the nearest, and one alone does not say.
  if (!scene.sides_tell || distance(near.point, s.a) <= flat::kRounding ||
      distance(near.point, s.b) <= flat::kRounding) {
    return scene.in_part(p);
  }
  if (s.is_line()) return cross(s.b - s.a, p - s.a) > 0;
  return (distance(p, s.center) < std::abs(s.radius)) == (s.radius > 0);
}

Depth depth_at(const BeamScene& scene, Point2 p) {
  Depth depth{kNever, {}};
  if (!scene.edges.empty()) {
    const auto near = scene.edges.nearest(p);
    const double side = in_part(scene, p, near) ? 1 : -1;
    depth.mm = side * near.distance;
    depth.inwards = near.distance > flat::kRounding
                        ? (side / near.distance) * (p - near.point)
                        : -flat::normal_at(scene.edges.segments()[near.segment], 0.5);
  }
  if (depth.mm > -scene.radius && !scene.lines.empty()) {
    const auto near = scene.lines.nearest(p);
    if (near.distance - scene.radius < depth.mm) {
      depth.mm = near.distance - scene.radius;
      depth.inwards = unit(p - near.point);
    }
  }
  return depth;
}

GougeResult find_gouge(const BeamScene& scene) {
  return Search(scene).run();
}

}  // namespace burin::verify
