// SPDX-License-Identifier: Apache-2.0
// Branch points: which ends continue each other where more than two meet.
#include <algorithm>
#include <cmath>

#include "burin/plan/laser/join_parts.h"

namespace burin::laser::detail {
namespace {

using geom::Vec2;

// Nodes with more ends than this are paired by angle only: all pairs of a node would be a square.
constexpr std::size_t kMostEndsForPairs = 64;

class Resolver {
 public:
  Resolver(const Pieces& pieces, const Parts& parts, const Runs& runs, const Nodes& nodes)
      : pieces_(pieces), parts_(parts), runs_(runs), nodes_(nodes) {}

  Resolved run() {
    result_.used.assign(runs_.list.size(), false);
    std::fill(result_.used.begin(), result_.used.begin() + static_cast<std::ptrdiff_t>(runs_.base_count),
              true);
    index();
    find_bridges();
    if (runs_.list.size() > runs_.base_count && choose_spares()) {
      index();
      find_bridges();
    }
    partner_.assign(2 * runs_.list.size(), kNone);
    for (std::uint32_t node = 0; node < nodes_.count; ++node) pair_node(node);
    chains();
    return std::move(result_);
  }

 private:
  std::uint32_t node(std::uint32_t end) const { return nodes_.of_end[end]; }
  std::uint32_t degree(std::uint32_t at) const { return first_[at + 1] - first_[at]; }

  /// Ends by node, in order of run.
  void index() {
    first_.assign(nodes_.count + 1, 0);
    const auto ends = static_cast<std::uint32_t>(2 * runs_.list.size());
    for (std::uint32_t end = 0; end < ends; ++end) {
      if (result_.used[end / 2]) ++first_[node(end) + 1];
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    ends_.resize(first_.back());
    std::vector<std::uint32_t> fill(first_.begin(), first_.end() - 1);
    for (std::uint32_t end = 0; end < ends; ++end) {
      if (result_.used[end / 2]) ends_[fill[node(end)]++] = end;
    }
  }

  /// Runs that lie on no closed walk (Tarjan 1974, without recursion).
  void find_bridges() {
    bridge_.assign(runs_.list.size(), false);
    std::vector<std::uint32_t> entered(nodes_.count, 0), low(nodes_.count, 0),
        next(first_.begin(), first_.end() - 1);
    std::vector<std::uint32_t> way;  // ends by which the nodes on the way were left
    std::uint32_t clock = 0;
    for (std::uint32_t root = 0; root < nodes_.count; ++root) {
      if (entered[root] != 0) continue;
      entered[root] = low[root] = ++clock;
      std::uint32_t at = root;
      while (true) {
        if (next[at] < first_[at + 1]) {
          const std::uint32_t end = ends_[next[at]++];
          if (!way.empty() && (way.back() ^ 1U) == end) continue;  // the way we came
          const std::uint32_t to = node(end ^ 1U);
          if (entered[to] != 0) {
            low[at] = std::min(low[at], entered[to]);
            continue;
          }
          entered[to] = low[to] = ++clock;
          way.push_back(end);
          at = to;
          continue;
        }
        if (way.empty()) break;
        const std::uint32_t end = way.back(), from = node(end);
        way.pop_back();
        if (low[at] > entered[from]) bridge_[end / 2] = true;
        low[from] = std::min(low[from], low[at]);
        at = from;
      }
    }
  }

  struct SpareEnds {  ///< ends of the spare runs by node
    std::vector<std::uint32_t> first, ends;
  };
  SpareEnds spare_ends() const {
    SpareEnds s;
    s.first.assign(nodes_.count + 1, 0);
    const auto begin = static_cast<std::uint32_t>(2 * runs_.base_count);
    const auto end_of_all = static_cast<std::uint32_t>(2 * runs_.list.size());
    for (std::uint32_t end = begin; end < end_of_all; ++end) ++s.first[node(end) + 1];
    for (std::size_t i = 1; i < s.first.size(); ++i) s.first[i] += s.first[i - 1];
    s.ends.resize(s.first.back());
    std::vector<std::uint32_t> fill(s.first.begin(), s.first.end() - 1);
    for (std::uint32_t end = begin; end < end_of_all; ++end) s.ends[fill[node(end)]++] = end;
    return s;
  }

  /// Uses again what was drawn twice where the number of ends is odd otherwise, so that contours close. True
  /// when any is used.
  bool choose_spares() {
    std::vector<bool> odd(nodes_.count, false);
    for (const std::uint32_t end : ends_) {
      if (!bridge_[end / 2]) odd[node(end)] = !odd[node(end)];
    }
    const SpareEnds spare = spare_ends();
    bool any = false;
    std::vector<bool> seen(nodes_.count, false);
    // Roots: odd nodes first, so that what cannot be evened stays where it was; parts of the drawing without
    // odd nodes need nothing.
    for (std::uint32_t root = 0; root < nodes_.count; ++root) {
      if (seen[root] || !odd[root] || spare.first[root] == spare.first[root + 1]) continue;
      seen[root] = true;
      std::vector<std::uint32_t> tree;  // ends by which nodes were reached, breadth first
      std::vector<std::uint32_t> queue{root};
      for (std::size_t q = 0; q < queue.size(); ++q) {
        for (std::uint32_t k = spare.first[queue[q]]; k < spare.first[queue[q] + 1]; ++k) {
          const std::uint32_t to = node(spare.ends[k] ^ 1U);
          if (seen[to]) continue;
          seen[to] = true;
          tree.push_back(spare.ends[k] ^ 1U);
          queue.push_back(to);
        }
      }
      any = use_all(queue, spare, odd) || use_some(tree, odd) || any;
    }
    return any;
  }

  /// All spare runs among these nodes, when every node is even then: cells side by side, each drawn in full.
  bool use_all(const std::vector<std::uint32_t>& group, const SpareEnds& spare,
               const std::vector<bool>& odd) {
    const bool even = std::all_of(group.begin(), group.end(), [&](std::uint32_t at) {
      return ((spare.first[at + 1] - spare.first[at]) % 2 == 1) == odd[at];
    });
    if (!even) return false;
    for (const std::uint32_t at : group) {
      for (std::uint32_t k = spare.first[at]; k < spare.first[at + 1]; ++k)
        result_.used[spare.ends[k] / 2] = true;
    }
    return true;
  }

  /// The spare runs of a tree whose sum (mod 2) is the set of odd nodes: from the leaves inwards.
  bool use_some(const std::vector<std::uint32_t>& tree, std::vector<bool>& odd) {
    bool any = false;
    for (std::size_t k = tree.size(); k-- > 0;) {
      const std::uint32_t leaf = node(tree[k]), parent = node(tree[k] ^ 1U);
      if (!odd[leaf]) continue;
      odd[leaf] = false;
      odd[parent] = !odd[parent];
      result_.used[tree[k] / 2] = any = true;
    }
    return any;
  }

  /// Direction in which the run leaves the node at this end.
  Vec2 outward(std::uint32_t end) const {
    const Run& run = runs_.list[end / 2];
    const Part& part = parts_.list[runs_.parts[end % 2 == 0 ? run.first : run.first + run.count - 1]];
    const geom::Curve2& curve = *pieces_.list[part.piece].curve;
    return end % 2 == 0 ? geom::tangent_at(curve, part.t0) : -geom::tangent_at(curve, part.t1);
  }

  void link(std::uint32_t p, std::uint32_t q) {
    partner_[p] = q;
    partner_[q] = p;
  }

  void pair_node(std::uint32_t at) {
    const std::uint32_t* begin = ends_.data() + first_[at];
    const std::uint32_t* end = ends_.data() + first_[at + 1];
    const std::size_t count = degree(at);
    if (count == 2) return link(begin[0], begin[1]);
    if (count < 2) return;
    // 1. What the file draws as one line stays one, but only among the ends that can close (or cannot) alike.
    bool all = true;
    for (const std::uint32_t* p = begin; p != end; ++p) {
      const std::uint32_t q = runs_.neighbour[*p];
      if (q != kNone && q != *p && node(q) == at && result_.used[q / 2] && partner_[*p] == kNone &&
          partner_[q] == kNone && bridge_[*p / 2] == bridge_[q / 2]) {
        link(*p, q);
      }
      all = all && partner_[*p] != kNone;
    }
    if (all) return;
    result_.branches.push_back({*begin, static_cast<int>(count)});
    // 2. Ends of runs that lie on closed walks; 3. dead ends among themselves and with what is left.
    std::vector<std::uint32_t> cyclic, rest;
    for (const std::uint32_t* p = begin; p != end; ++p) {
      if (partner_[*p] == kNone && !bridge_[*p / 2]) cyclic.push_back(*p);
    }
    if (!pair_around(cyclic)) pair_smoothest(cyclic);
    for (const std::uint32_t* p = begin; p != end; ++p) {
      if (partner_[*p] == kNone) rest.push_back(*p);
    }
    pair_smoothest(rest);
  }

  bool twins(std::uint32_t p, std::uint32_t q) const {
    return runs_.list[p / 2].twin == q / 2 && result_.used[p / 2] && result_.used[q / 2];
  }

  struct Ray {
    double angle;
    int side;  ///< of two twins, the one to the right first, counter-clockwise about the node
    std::uint32_t end;
  };
  std::vector<Ray> around(const std::vector<std::uint32_t>& ends) const {
    std::vector<Ray> rays;
    for (const std::uint32_t end : ends) {
      const Run& run = runs_.list[end / 2];
      // Both twins take the direction of the base one, so that they sort next to each other.
      const std::uint32_t lead =
          run.spare ? 2 * run.twin + ((end % 2 == 1) != run.twin_reversed ? 1 : 0) : end;
      const Vec2 d = outward(lead);
      // The spare one lies to the left of its base run: leaving along the run, it comes after; against it,
      // before.
      const int side = run.spare == (lead % 2 == 0) ? 1 : 0;
      rays.push_back({std::atan2(d.y, d.x), side, end});
    }
    std::sort(rays.begin(), rays.end(), [](const Ray& p, const Ray& q) {
      if (p.angle != q.angle) return p.angle < q.angle;
      return p.side != q.side ? p.side < q.side : p.end < q.end;
    });
    return rays;
  }

  /// Where an edge is used twice, the ends are paired with their neighbours in angle, twins never with each
  /// other: each contour keeps its own side. False: no such edge here, or no such pairing.
  bool pair_around(const std::vector<std::uint32_t>& ends) {
    const std::size_t n = ends.size();
    bool doubled = false;
    for (const std::uint32_t end : ends) doubled = doubled || (runs_.list[end / 2].spare);
    if (n % 2 != 0 || (!doubled && n <= kMostEndsForPairs)) return false;
    const std::vector<Ray> rays = around(ends);
    for (std::size_t shift = 0; shift < 2; ++shift) {
      bool good = true;
      for (std::size_t k = shift; k < n + shift && good; k += 2) {
        good = !twins(rays[k % n].end, rays[(k + 1) % n].end);
      }
      if (!good) continue;
      for (std::size_t k = shift; k < n + shift; k += 2) link(rays[k % n].end, rays[(k + 1) % n].end);
      return true;
    }
    return false;
  }

  void pair_smoothest(const std::vector<std::uint32_t>& ends) {
    if (ends.size() < 2) return;
    if (ends.size() > kMostEndsForPairs) {
      const std::vector<Ray> rays = around(ends);
      for (std::size_t k = 0; k + 1 < rays.size(); k += 2) link(rays[k].end, rays[k + 1].end);
      return;
    }
    struct Pair {
      double straight;  ///< cosine of the angle between the outward directions: -1 goes straight on
      std::uint32_t p, q;
    };
    std::vector<Vec2> directions;
    for (const std::uint32_t end : ends) directions.push_back(outward(end));
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        if (!twins(ends[i], ends[j]))
          pairs.push_back({geom::dot(directions[i], directions[j]), ends[i], ends[j]});
      }
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
      if (x.straight != y.straight) return x.straight < y.straight;
      return x.p != y.p ? x.p < y.p : x.q < y.q;
    });
    for (const Pair& pair : pairs) {
      if (partner_[pair.p] == kNone && partner_[pair.q] == kNone) link(pair.p, pair.q);
    }
  }

  /// Walks along the pairs; open chains first, then what is closed. A walk that comes to a node again gives
  /// off the loop between as a contour of its own.
  void chains() {
    done_.assign(runs_.list.size(), false);
    on_walk_.assign(nodes_.count, kNone);
    for (std::uint32_t end = 0; end < partner_.size(); ++end) {
      if (result_.used[end / 2] && partner_[end] == kNone && !done_[end / 2]) walk(end);
    }
    for (std::uint32_t run = 0; run < runs_.list.size(); ++run) {
      if (result_.used[run] && !done_[run]) walk(2 * run);
    }
  }

  void walk(std::uint32_t end) {
    std::vector<Step> steps;
    std::vector<std::uint32_t> left_at;  // node that steps[i] leaves
    const auto cut_from = [&](std::size_t from, bool closed) {
      Chain chain;
      chain.closed = closed;
      chain.steps.assign(steps.begin() + static_cast<std::ptrdiff_t>(from), steps.end());
      for (std::size_t k = from; k < steps.size(); ++k) on_walk_[left_at[k]] = kNone;
      steps.resize(from);
      left_at.resize(from);
      result_.chains.push_back(std::move(chain));
    };
    while (end != kNone && !done_[end / 2]) {
      done_[end / 2] = true;
      on_walk_[node(end)] = static_cast<std::uint32_t>(steps.size());
      left_at.push_back(node(end));
      steps.push_back({end / 2, end % 2 == 1});
      const std::uint32_t arrival = end ^ 1U, at = node(arrival);
      if (on_walk_[at] != kNone) cut_from(on_walk_[at], true);
      end = partner_[arrival];
    }
    if (!steps.empty()) cut_from(0, false);
  }

  const Pieces& pieces_;
  const Parts& parts_;
  const Runs& runs_;
  const Nodes& nodes_;
  Resolved result_;
  std::vector<std::uint32_t> first_, ends_;
  std::vector<bool> bridge_;
  std::vector<std::uint32_t> partner_;  ///< by end
  std::vector<bool> done_;
  std::vector<std::uint32_t> on_walk_;  ///< by node: position in the walk
};

}  // namespace

Resolved resolve(const Pieces& pieces, const Parts& parts, const Runs& runs, const Nodes& nodes) {
  return Resolver(pieces, parts, runs, nodes).run();
}

}  // namespace burin::laser::detail
