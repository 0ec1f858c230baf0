// SPDX-License-Identifier: Apache-2.0
// Which ends meet: from exact agreement up to the join tolerance, nearest first.
#include <algorithm>
#include <cmath>

#include "burin/plan/laser/join_parts.h"
#include "burin/plan/laser/near_grid.h"

namespace burin::laser::detail {
namespace {

using geom::Point2;

// A loop needs room to go out and come back: runs up to this many join lengths must not close on themselves,
// nor may an end jump back onto its own chain within that length.
constexpr double kShortLoop = 4.0;
// How many runs such a check follows, how many places it looks at; beyond, ends are not joined.
constexpr int kMostSteps = 64;
constexpr int kMostPlaces = 64;
// Points that make one node; more within a join length of each other are no drawing.
constexpr std::size_t kMostMembers = 64;

class Clusterer {
 public:
  Clusterer(const Pieces& pieces, const Parts& parts, const Runs& runs, const JoinScale& scale)
      : pieces_(pieces), parts_(parts), runs_(runs), scale_(scale), ends_(2 * runs.base_count) {}

  Nodes run() {
    exact();
    pair_odd();
    attach_odd();
    merge_loose_pairs();
    return number();
  }

 private:
  std::uint32_t other_spot(std::uint32_t end) const { return spot_of_[end ^ 1U]; }
  std::uint32_t group(std::uint32_t spot) const { return group_[spot]; }

  /// Spots: ends within the point tolerance of the first of them.
  void exact() {
    spot_of_.resize(ends_);
    NearGrid grid(std::max(4 * scale_.point, 1e-300), ends_);
    for (std::uint32_t end = 0; end < ends_; ++end) {
      const Point2 p = end_point(parts_, runs_, end);
      std::uint32_t spot = kNone;
      grid.near(p, scale_.point, [&](std::uint32_t id, double) {
        spot = std::min(spot, id);
        return true;
      });
      if (spot == kNone) {
        spot = static_cast<std::uint32_t>(places_.size());
        places_.push_back(p);
        grid.insert(p, spot);
      }
      spot_of_[end] = spot;
    }
    first_.assign(places_.size() + 1, 0);
    for (const std::uint32_t spot : spot_of_) ++first_[spot + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    ends_at_.resize(ends_);
    std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
    for (std::uint32_t end = 0; end < ends_; ++end) ends_at_[fill[spot_of_[end]]++] = end;
    group_.resize(places_.size());
    members_.resize(places_.size());
    for (std::uint32_t spot = 0; spot < places_.size(); ++spot) group_[spot] = spot;
  }

  std::size_t count_at(std::uint32_t spot) const { return first_[spot + 1] - first_[spot]; }
  bool odd(std::uint32_t spot) const { return count_at(spot) % 2 == 1; }

  /// Length of a run, at least; stops counting beyond `enough`.
  double reach(std::uint32_t run, double enough) const {
    double sum = 0;
    const Run& r = runs_.list[run];
    for (std::uint32_t k = r.first; k < r.first + r.count && sum <= enough; ++k) {
      const Part& part = parts_.list[runs_.parts[k]];
      const geom::Curve2& curve = *pieces_.list[part.piece].curve;
      Point2 last = part.a;
      for (int i = 1; i <= 4; ++i) {
        const Point2 p = i == 4 ? part.b : geom::point_at(curve, part.t0 + 0.25 * i * (part.t1 - part.t0));
        sum += geom::distance(last, p);
        last = p;
      }
    }
    return sum;
  }

  /// Whether the chains that leave spot p come to the group of spot q within a short length.
  bool short_way(std::uint32_t p, std::uint32_t q) const {
    const double enough = kShortLoop * scale_.join;
    int steps = 0;
    for (std::uint32_t k = first_[p]; k < first_[p + 1]; ++k) {
      std::uint32_t end = ends_at_[k];
      double way = 0;
      while (true) {
        if (++steps > kMostSteps) return true;
        way += reach(end / 2, enough - way);
        if (way > enough) break;
        const std::uint32_t spot = other_spot(end);
        if (group(spot) == group(q)) return true;
        if (count_at(spot) != 2 || spot == p) break;
        end = ends_at_[first_[spot]] == (end ^ 1U) ? ends_at_[first_[spot] + 1] : ends_at_[first_[spot]];
      }
    }
    return false;
  }

  void merge(std::uint32_t p, std::uint32_t q) {  // groups
    if (p > q) std::swap(p, q);
    if (members_[p].empty()) members_[p].push_back(p);
    if (members_[q].empty()) members_[q].push_back(q);
    for (const std::uint32_t spot : members_[q]) {
      group_[spot] = p;
      members_[p].push_back(spot);
    }
    members_[q].clear();
  }

  /// Spots with an odd number of ends are paired, the nearest first. Radii grow by doubling: after each round
  /// few are left within that radius of each other, so that the pairs stay linear in number.
  void pair_odd() {
    std::vector<std::uint32_t> pool;
    for (std::uint32_t spot = 0; spot < places_.size(); ++spot) {
      if (odd(spot)) pool.push_back(spot);
    }
    paired_.assign(places_.size(), false);
    for (double radius = std::min(2 * scale_.point, scale_.join); !pool.empty() && radius > 0; radius *= 4) {
      const bool last = radius >= scale_.join;
      pair_within(pool, last ? scale_.join : radius);
      pool.erase(std::remove_if(pool.begin(), pool.end(), [&](std::uint32_t s) { return paired_[s]; }),
                 pool.end());
      if (last) break;
    }
    left_ = std::move(pool);
  }

  void pair_within(const std::vector<std::uint32_t>& pool, double radius) {
    struct Pair {
      double d2;
      std::uint32_t p, q;
    };
    std::vector<Pair> pairs;
    NearGrid grid(2 * radius, pool.size());
    for (const std::uint32_t spot : pool) {
      int looked_at = 0;
      grid.near(places_[spot], radius, [&](std::uint32_t other, double d2) {
        pairs.push_back({d2, other, spot});
        return ++looked_at < kMostPlaces;
      });
      grid.insert(places_[spot], spot);
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
      if (x.d2 != y.d2) return x.d2 < y.d2;
      return x.p != y.p ? x.p < y.p : x.q < y.q;
    });
    for (const Pair& pair : pairs) {
      if (paired_[pair.p] || paired_[pair.q] || short_way(pair.p, pair.q)) continue;
      paired_[pair.p] = paired_[pair.q] = true;
      merge(pair.p, pair.q);
    }
  }

  /// All spots of a group within join of p.
  bool fits(std::uint32_t p, std::uint32_t q_group) const {
    if (members_[q_group].size() >= kMostMembers) return false;
    if (members_[q_group].empty()) return geom::distance(places_[p], places_[q_group]) <= scale_.join;
    return std::all_of(members_[q_group].begin(), members_[q_group].end(), [&](std::uint32_t spot) {
      return geom::distance(places_[p], places_[spot]) <= scale_.join;
    });
  }

  /// Ends still single go to the nearest place where others meet (a branch drawn loosely).
  void attach_odd() {
    if (left_.empty()) return;
    NearGrid grid(2 * scale_.join, places_.size());
    for (std::uint32_t spot = 0; spot < places_.size(); ++spot) grid.insert(places_[spot], spot);
    for (const std::uint32_t spot : left_) {
      std::vector<std::pair<double, std::uint32_t>> near;
      int looked_at = 0;
      grid.near(places_[spot], scale_.join, [&](std::uint32_t other, double d2) {
        if (other != spot) near.emplace_back(d2, other);
        return ++looked_at < kMostPlaces;
      });
      std::sort(near.begin(), near.end());
      for (const auto& [d2, other] : near) {
        const std::uint32_t target = group(other);
        if (target == group(spot) || !members_[group(spot)].empty()) continue;
        if (!fits(spot, target) || short_way(spot, other)) continue;
        merge(group(spot), target);
        break;
      }
    }
  }

  /// Two pairs that were joined over a gap within join of each other are one place: which of the four ends
  /// belong together is decided by the resolution, not by chance of drawing.
  void merge_loose_pairs() {
    std::vector<std::uint32_t> loose;
    for (std::uint32_t spot = 0; spot < places_.size(); ++spot) {
      if (paired_[spot]) loose.push_back(spot);
    }
    NearGrid grid(2 * scale_.join, loose.size());
    for (const std::uint32_t spot : loose) grid.insert(places_[spot], spot);
    for (const std::uint32_t spot : loose) {
      int looked_at = 0;
      std::uint32_t best = kNone;
      double best_d2 = 0;
      grid.near(places_[spot], scale_.join, [&](std::uint32_t other, double d2) {
        if (group(other) != group(spot) &&
            (best == kNone || d2 < best_d2 || (d2 == best_d2 && other < best))) {
          best = other;
          best_d2 = d2;
        }
        return ++looked_at < kMostPlaces;
      });
      if (best == kNone) continue;
      const std::vector<std::uint32_t> mine = members_[group(spot)];
      const std::uint32_t target = group(best);
      const bool together = std::all_of(
          mine.begin(), mine.end(), [&](std::uint32_t s) { return fits(s, target) && !short_way(s, best); });
      if (together) merge(group(spot), target);
    }
  }

  Nodes number() const {
    Nodes nodes;
    nodes.of_end.resize(2 * runs_.list.size(), kNone);
    std::vector<std::uint32_t> node_of_group(places_.size(), kNone);
    for (std::uint32_t end = 0; end < ends_; ++end) {
      std::uint32_t& node = node_of_group[group(spot_of_[end])];
      if (node == kNone) node = nodes.count++;
      nodes.of_end[end] = node;
    }
    for (auto run = static_cast<std::uint32_t>(runs_.base_count); run < runs_.list.size(); ++run) {
      const Run& spare = runs_.list[run];
      for (std::uint32_t side = 0; side < 2; ++side) {
        nodes.of_end[2 * run + side] = nodes.of_end[2 * spare.twin + (spare.twin_reversed ? 1 - side : side)];
      }
    }
    return nodes;
  }

  const Pieces& pieces_;
  const Parts& parts_;
  const Runs& runs_;
  JoinScale scale_;
  std::size_t ends_;
  std::vector<std::uint32_t> spot_of_;  ///< by end
  std::vector<Point2> places_;          ///< by spot
  std::vector<std::uint32_t> first_, ends_at_;
  std::vector<std::uint32_t> group_;                 ///< by spot: its smallest member
  std::vector<std::vector<std::uint32_t>> members_;  ///< by group; empty for a single spot
  std::vector<bool> paired_;
  std::vector<std::uint32_t> left_;
};

}  // namespace

Nodes cluster_ends(const Pieces& pieces, const Parts& parts, const Runs& runs, const JoinScale& scale) {
  return Clusterer(pieces, parts, runs, scale).run();
}

}  // namespace burin::laser::detail
