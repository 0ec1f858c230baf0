// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/mesh/mesh_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace burin::geom::detail {

namespace {

constexpr std::size_t kPacket = 4, kWide = 8;
constexpr int kBins = 16;
/// Below this level ranges are halved by count: a chain of lopsided splits ends, and kTreeLevels holds
/// (8^11 > 2^32).
constexpr int kSplitByArea = kTreeLevels - 12;

float down(double v) {
  const auto f = static_cast<float>(v);
  return f > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float up(double v) {
  const auto f = static_cast<float>(v);
  return f < v ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

struct FloatBox {
  std::array<float, 3> lo, hi;
};
constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr FloatBox kEmpty{{kInfinite, kInfinite, kInfinite}, {-kInfinite, -kInfinite, -kInfinite}};

void add(FloatBox& box, const FloatBox& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    box.lo[k] = std::min(box.lo[k], other.lo[k]);
    box.hi[k] = std::max(box.hi[k], other.hi[k]);
  }
}
double half_area(const FloatBox& box) {
  const double x = static_cast<double>(box.hi[0]) - box.lo[0], y = static_cast<double>(box.hi[1]) - box.lo[1],
               z = static_cast<double>(box.hi[2]) - box.lo[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

struct Item {
  FloatBox box;
  std::uint32_t triangle;
  float middle(std::size_t k) const { return 0.5F * (box.lo[k] + box.hi[k]); }
};

struct Range {
  std::size_t first = 0, end = 0;
  FloatBox box = kEmpty;
  std::size_t count() const { return end - first; }
};

class Builder {
 public:
  Builder(const Mesh& mesh, std::vector<Item> items, MeshTree& out)
      : mesh_(mesh), items_(std::move(items)), out_(out) {
    out_.packets.reserve(items_.size() / 3 + 1);
    out_.nodes.reserve(items_.size() / 12 + 1);
    Range all = range(0, items_.size());
    node(all, 0);
  }

 private:
  Range range(std::size_t first, std::size_t end) const {
    Range r{first, end, kEmpty};
    for (std::size_t i = first; i < end; ++i) add(r.box, items_[i].box);
    return r;
  }

  /// Makes the node of the range, of at most eight parts. Returns its number.
  int node(const Range& whole, int level) {
    std::array<Range, kWide> parts{whole};
    std::size_t n = 1;
    const bool by_area = level < kSplitByArea;
    while (n < kWide) {
      std::size_t largest = kWide;
      double most = -1;
      for (std::size_t i = 0; i < n; ++i) {
        if (parts[i].count() <= kPacket) continue;
        const double size = by_area ? half_area(parts[i].box) : static_cast<double>(parts[i].count());
        if (size > most) most = size, largest = i;
      }
      if (largest == kWide) break;
      const std::size_t middle = split(parts[largest], by_area);
      parts[n++] = range(middle, parts[largest].end);
      parts[largest] = range(parts[largest].first, middle);
    }
    const std::size_t number = out_.nodes.size();
    out_.nodes.emplace_back();
    std::array<int, kWide> child{};
    for (std::size_t i = 0; i < n; ++i)
      child[i] = parts[i].count() <= kPacket ? packet(parts[i]) : node(parts[i], level + 1);
    TreeNode& made = out_.nodes[number];
    for (std::size_t i = 0; i < kWide; ++i) {
      const FloatBox& box = i < n ? parts[i].box : kEmpty;
      for (std::size_t k = 0; k < 3; ++k) made.lo[k][i] = box.lo[k], made.hi[k][i] = box.hi[k];
      made.child[i] = child[i];
    }
    return static_cast<int>(number);
  }

  /// Orders the range in two and returns where the second part begins.
  std::size_t split(const Range& r, bool by_area) {
    FloatBox middles = kEmpty;
    for (std::size_t i = r.first; i < r.end; ++i) {
      const Item& item = items_[i];
      const std::array<float, 3> m{item.middle(0), item.middle(1), item.middle(2)};
      add(middles, {m, m});
    }
    if (by_area) {
      if (const std::size_t at = split_by_area(r, middles); at != r.first) return at;
    }
    std::size_t axis = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (middles.hi[k] - middles.lo[k] > middles.hi[axis] - middles.lo[axis]) axis = k;
    }
    const std::size_t half = r.first + r.count() / 2;
    const auto begin = items_.begin();
    std::nth_element(begin + static_cast<std::ptrdiff_t>(r.first), begin + static_cast<std::ptrdiff_t>(half),
                     begin + static_cast<std::ptrdiff_t>(r.end), [axis](const Item& a, const Item& b) {
                       const float ma = a.middle(axis), mb = b.middle(axis);
                       return ma != mb ? ma < mb : a.triangle < b.triangle;
                     });
    return half;
  }

  struct Bin {
    FloatBox box = kEmpty;
    std::size_t count = 0;
  };

  static int bin_of(const Item& item, std::size_t axis, float lo, float scale) {
    return std::clamp(static_cast<int>((item.middle(axis) - lo) * scale), 0, kBins - 1);
  }

  /// The split of least expected work along any axis; r.first when the middles cannot be told apart.
  std::size_t split_by_area(const Range& r, const FloatBox& middles) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t best_axis = 0;
    int best_bin = -1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float scale = scale_of(middles, axis);
      if (!(scale > 0)) continue;
      std::array<Bin, kBins> bins{};
      for (std::size_t i = r.first; i < r.end; ++i) {
        Bin& bin = bins[static_cast<std::size_t>(bin_of(items_[i], axis, middles.lo[axis], scale))];
        add(bin.box, items_[i].box);
        ++bin.count;
      }
      const auto [cost, at] = best_split(bins);
      if (cost < best) best = cost, best_axis = axis, best_bin = at;
    }
    if (best_bin < 0) return r.first;
    const float lo = middles.lo[best_axis], scale = scale_of(middles, best_axis);
    const auto begin = items_.begin();
    const auto at = std::partition(
        begin + static_cast<std::ptrdiff_t>(r.first), begin + static_cast<std::ptrdiff_t>(r.end),
        [&](const Item& item) { return bin_of(item, best_axis, lo, scale) <= best_bin; });
    return static_cast<std::size_t>(at - begin);
  }

  static float scale_of(const FloatBox& middles, std::size_t axis) {
    const float scale = static_cast<float>(kBins) / (middles.hi[axis] - middles.lo[axis]);
    return std::isfinite(scale) ? scale : 0;
  }

  /// Cost of the best place to divide the bins, and the last bin of the first part.
  static std::pair<double, int> best_split(const std::array<Bin, kBins>& bins) {
    const auto work = [](const FloatBox& box, std::size_t count) {
      return half_area(box) * static_cast<double>((count + kPacket - 1) / kPacket);
    };
    std::array<double, kBins> after{};
    FloatBox box = kEmpty;
    std::size_t count = 0;
    for (std::size_t i = kBins; i-- > 1;) {
      add(box, bins[i].box);
      count += bins[i].count;
      after[i - 1] = count > 0 ? work(box, count) : std::numeric_limits<double>::infinity();
    }
    double best = std::numeric_limits<double>::infinity();
    int at = -1;
    box = kEmpty, count = 0;
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
      add(box, bins[i].box);
      count += bins[i].count;
      if (count == 0) continue;
      const double cost = work(box, count) + after[i];
      if (cost < best) best = cost, at = static_cast<int>(i);
    }
    return {best, at};
  }

  int packet(const Range& r) {
    const auto number = static_cast<int>(out_.packets.size());
    TreePacket& made = out_.packets.emplace_back();
    for (std::size_t k = 0; k < kPacket; ++k) {
      const std::size_t i = std::min(r.first + k, r.end - 1);
      fill(made, k, items_[i].triangle);
    }
    return ~number;
  }

  void fill(TreePacket& out, std::size_t lane, std::uint32_t triangle) const {
    const auto& corner = mesh_.triangles[triangle];
    std::array<Point3, 3> p{mesh_.vertices[corner[0]], mesh_.vertices[corner[1]], mesh_.vertices[corner[2]]};
    // The longest edge first.
    const std::array<double, 3> length{norm(p[1] - p[0]), norm(p[2] - p[1]), norm(p[0] - p[2])};
    const auto longest =
        static_cast<std::size_t>(std::max_element(length.begin(), length.end()) - length.begin());
    std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(longest), p.end());
    const double base = length[longest];
    const Vec3 u = base > 0 ? unit(p[1] - p[0]) : Vec3{1, 0, 0}, f = p[2] - p[0];
    const double px = std::clamp(dot(f, u), 0.0, base);
    auto [v, py] = across(u, f, base);
    const double qx = px - base, l1 = px * px + py * py, l2 = qx * qx + py * py;
    const std::array<double, 3> a_{p[0].x, p[0].y, p[0].z}, u_{u.x, u.y, u.z}, v_{v.x, v.y, v.z};
    for (std::size_t k = 0; k < 3; ++k)
      out.a[k][lane] = a_[k], out.u[k][lane] = u_[k], out.v[k][lane] = v_[k];
    out.base[lane] = base, out.px[lane] = px, out.py[lane] = py;
    out.side1[lane] = inverse(l1), out.side2[lane] = inverse(l2);
    out.triangle[lane] = triangle;
  }

  static double inverse(double length2) {
    const double r = 1 / length2;
    return std::isfinite(r) ? r : 0;
  }

  struct Across {
    Vec3 v;
    double py;
  };
  /// The unit vector perpendicular to u towards f, and how far f goes along it. Heights of less than rounding
  /// are none: then any perpendicular does.
  static Across across(Vec3 u, Vec3 f, double base) {
    constexpr double kFlat = 4e-16;
    Vec3 w = f - dot(f, u) * u;
    w = w - dot(w, u) * u;
    if (norm(w) > kFlat * base) {
      Vec3 v = unit(w);
      v = unit(v - dot(v, u) * u);
      return {v, std::max(0.0, dot(f, v))};
    }
    const Vec3 other = std::abs(u.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return {unit(cross(u, other)), 0};
  }

  const Mesh& mesh_;
  std::vector<Item> items_;
  MeshTree& out_;
};

bool usable(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  return std::all_of(triangle.begin(), triangle.end(), [&](std::uint32_t i) {
    if (i >= mesh.vertices.size()) return false;
    const Point3 p = mesh.vertices[i];
    return std::abs(p.x) <= kTreeLargest && std::abs(p.y) <= kTreeLargest && std::abs(p.z) <= kTreeLargest;
  });
}

}  // namespace

MeshTree build_tree(const Mesh& mesh) {
  MeshTree out;
  std::vector<Item> items;
  items.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!usable(mesh, mesh.triangles[i])) continue;
    for (const std::uint32_t k : mesh.triangles[i]) out.bounds.add(mesh.vertices[k]);
    items.push_back({kEmpty, i});
  }
  if (items.empty()) return out;
  out.center = lerp(out.bounds.lo, out.bounds.hi, 0.5);
  for (Item& item : items) {
    for (const std::uint32_t k : mesh.triangles[item.triangle]) {
      const Vec3 p = mesh.vertices[k] - out.center;
      add(item.box, {{down(p.x), down(p.y), down(p.z)}, {up(p.x), up(p.y), up(p.z)}});
    }
  }
  Builder(mesh, std::move(items), out);
  return out;
}

TreePlace place_in(const MeshTree& tree, Point3 c) {
  constexpr double kFar = 1e15;
  const Vec3 d = c - tree.center;
  TreePlace at{{c.x, c.y, c.z}, {down(d.x), down(d.y), down(d.z)}, {up(d.x), up(d.y), up(d.z)}};
  if (!(std::abs(d.x) <= kFar && std::abs(d.y) <= kFar && std::abs(d.z) <= kFar)) {
    constexpr float kAll = std::numeric_limits<float>::max();
    for (std::size_t k = 0; k < 3; ++k) at.lo[k] = -kAll, at.hi[k] = kAll;
  }
  return at;
}

}  // namespace burin::geom::detail
