// SPDX-License-Identifier: Apache-2.0
#include "burin/verify/slivers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace burin::verify {
namespace {

using geom::Point3;

constexpr double kSliver = 2;       // a triangle so many times longer than its shortest side
constexpr int kMostDoublings = 20;  // of the pieces of a side

class Cutter {
 public:
  Cutter(const geom::Mesh& mesh, double length, std::size_t most)
      : mesh_(mesh), length_(length), most_(most), out_{mesh.vertices, {}} {}

  geom::Mesh run() && {
    for (const auto& t : mesh_.triangles) triangle(t);
    return std::move(out_);
  }

 private:
  double side(std::uint32_t a, std::uint32_t b) const {
    return distance(mesh_.vertices[a], mesh_.vertices[b]);
  }

  void triangle(const std::array<std::uint32_t, 3>& t) {
    // The apex is opposite the shortest side.
    std::array<double, 3> opposite{side(t[1], t[2]), side(t[2], t[0]), side(t[0], t[1])};
    const auto apex =
        static_cast<std::size_t>(std::min_element(opposite.begin(), opposite.end()) - opposite.begin());
    const double longest = *std::max_element(opposite.begin(), opposite.end());
    const std::uint32_t p = t[apex], q = t[(apex + 1) % 3], r = t[(apex + 2) % 3];
    if (!(longest > length_ && longest > kSliver * opposite[apex])) return add(t);
    const int doublings =
        std::min(kMostDoublings, static_cast<int>(std::lround(std::log2(longest / length_))));
    const std::size_t pieces = std::size_t{1} << doublings;
    if (out_.triangles.size() + 2 * pieces > most_) return add(t);
    std::uint32_t a = p, b = p;
    for (std::size_t i = 1; i <= pieces; ++i) {
      const std::uint32_t c = on_side(p, q, i, pieces), d = on_side(p, r, i, pieces);
      add({a, c, d});
      if (i > 1) add({a, d, b});
      a = c, b = d;
    }
  }
  void add(const std::array<std::uint32_t, 3>& t) { out_.triangles.push_back(t); }

  /// The vertex at i of `pieces` from p to q: one for the triangles on both sides, named by the share of the
  /// way from the lower vertex in the finest pieces there are.
  std::uint32_t on_side(std::uint32_t p, std::uint32_t q, std::size_t i, std::size_t pieces) {
    if (i == pieces) return q;
    const std::size_t finest = (std::size_t{1} << kMostDoublings) / pieces;
    const std::uint32_t low = std::min(p, q), high = std::max(p, q);
    const std::size_t at = finest * (p == low ? i : pieces - i);
    const auto [known, is_new] =
        made_.try_emplace({{low, high}, at}, static_cast<std::uint32_t>(out_.vertices.size()));
    if (is_new)
      out_.vertices.push_back(lerp(mesh_.vertices[low], mesh_.vertices[high],
                                   static_cast<double>(at) / (std::size_t{1} << kMostDoublings)));
    return known->second;
  }

  const geom::Mesh& mesh_;
  double length_;
  std::size_t most_;
  geom::Mesh out_;
  std::map<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::size_t>, std::uint32_t> made_;
};

}  // namespace

geom::Mesh cut_slivers(const geom::Mesh& mesh, double length, std::size_t most) {
  if (!(length > 0)) return mesh;
  return Cutter(mesh, length, most).run();
}

}  // namespace burin::verify
