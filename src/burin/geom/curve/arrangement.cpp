// SPDX-License-Identifier: Apache-2.0
#include "burin/geom/curve/arrangement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "burin/geom/curve/segment_meet.h"

namespace burin::geom::detail {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
/// Cosine from which on segments through one point run along each other there.
constexpr double kAlong = 0.999;

/// A cut of a raw segment at a point where it meets another.
struct Cut {
  std::uint32_t segment;
  std::uint32_t node;  // before clustering: index of the point; after: cluster
  double key;          // arc length from the segment's start
};

/// A raw segment between two cuts.
struct SubEdge {
  std::uint32_t segment;
  Point2 a, b;
};

/// Sub-edges between two junctions, along which the winding numbers do not change.
struct Chain {
  std::uint32_t from = kNone, to = kNone;  // junctions; kNone: a whole loop
  std::uint32_t begin = 0, end = 0;        // sub-edges; of an untouched loop, raw segments
  bool untouched = false;                  // a whole loop that nothing meets
  std::uint32_t next = kNone;              // chain that continues the boundary
  bool kept = false;
};

Segment as_segment(const RawCurves& curves, const SubEdge& e) {
  Segment s = curves.segments[e.segment];
  s.a = e.a;
  s.b = e.b;
  // Parts are at most half turns; a short one that seems more had its ends exchanged by snapping.
  if (!s.is_line() && distance2(s.a, s.b) < s.radius * s.radius && more_than_half_turn(s)) s.radius = 0;
  return s;
}

/// Arc length from the start of s to a point on it.
double key_of(const Segment& s, Point2 p) {
  if (s.is_line()) return dot(p - s.a, unit(s.b - s.a));
  const Vec2 u = s.a - s.center, v = p - s.center;
  double angle = std::atan2(cross(u, v), dot(u, v));
  if (s.radius < 0) angle = -angle;
  if (angle < -0.5 * kPi)
    angle += 2 * kPi;  // arcs sweep at most a half turn; just before the start stays there
  return angle * std::abs(s.radius);
}

class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parent_(n) {
    for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// The smaller index represents.
  void unite(std::uint32_t i, std::uint32_t j) {
    i = find(i), j = find(j);
    if (i != j) parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

class Arrangement {
 public:
  Arrangement(const RawCurves& curves, const ArrangementOptions& options)
      : curves_(curves), options_(options), tree_(curves, options.eps) {
    double scale = 1;
    if (!curves.segments.empty()) {
      const Point2 p = curves.segments.front().a;
      scale = std::max({scale, std::abs(p.x), std::abs(p.y)});
    }
    noise_ = std::max(1e-3 * options.eps, 8 * scale * std::numeric_limits<double>::epsilon());
  }

  ArrangementResult run() {
    ArrangementResult result;
    find_meetings();
    if (too_many_) return {std::nullopt, ArrangementFailure::too_many};
    cluster();
    cut_loops();
    merge_parallel_chains();
    for (std::uint32_t i = 0; i < chains_.size(); ++i) {
      if (!dropped_[i] && !decide(i)) return result;
    }
    if (!link()) return result;
    result.boundary = collect();
    return result;
  }

 private:
  std::uint32_t next_of(std::uint32_t i) const {
    const std::uint32_t loop = tree_.loop_of(i);
    return i + 1 == curves_.first[loop + 1] ? curves_.first[loop] : i + 1;
  }

  // --- where raw segments meet -----------------------------------------------------------------------------

  void find_meetings() {
    tree_.overlapping_pairs([this](std::size_t i, std::size_t j) {
      if (curves_.inside[i] || curves_.inside[j] || too_many_) return;
      const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>(j);
      const Segment &s = curves_.segments[i], &t = curves_.segments[j];
      if (next_of(a) == b) {
        add_neighbours(a, b);
      } else if (next_of(b) == a) {
        add_neighbours(b, a);
      } else {
        add(a, b, meet(s, t, options_.eps));
      }
    });
  }

  void add_neighbours(std::uint32_t i, std::uint32_t j) {
    const Segment &s = curves_.segments[i], &t = curves_.segments[j];
    const Meeting meeting = meet_neighbours(s, t, options_.eps);
    // Where the second turns back along the first, the way out and the way back are separate chains.
    if (std::holds_alternative<Overlap>(meeting)) add_cut(i, j, t.a);
    add(i, j, meeting);
  }

  void add(std::uint32_t i, std::uint32_t j, const Meeting& meeting) {
    if (const auto* one = std::get_if<OneMeet>(&meeting)) {
      add_cut(i, j, one->p);
    } else if (const auto* two = std::get_if<TwoMeets>(&meeting)) {
      add_cut(i, j, two->p);
      add_cut(i, j, two->q);
    } else if (const auto* overlap = std::get_if<Overlap>(&meeting)) {
      ++degenerate_;
      for (int k = 0; k < overlap->count; ++k) add_cut(i, j, overlap->points[static_cast<std::size_t>(k)]);
    }
    too_many_ = cuts_.size() > 2 * options_.max_meetings;
  }

  void add_cut(std::uint32_t i, std::uint32_t j, Point2 p) {
    const auto node = static_cast<std::uint32_t>(points_.size());
    points_.push_back(p);
    cuts_.push_back({i, node, key_of(curves_.segments[i], p)});
    cuts_.push_back({j, node, key_of(curves_.segments[j], p)});
  }

  // --- points that are one
  // -----------------------------------------------------------------------------------

  /// Raw vertices at the ends of cut segments, and where a piece runs into a connector, take part.
  void cluster() {
    if (cuts_.empty()) return;
    vertex_node_.assign(curves_.segments.size(), kNone);
    cut_points_ = static_cast<std::uint32_t>(points_.size());
    const auto add_vertex = [&](std::uint32_t i) {
      if (vertex_node_[i] != kNone) return;
      vertex_node_[i] = static_cast<std::uint32_t>(points_.size());
      points_.push_back(curves_.segments[i].a);
    };
    for (const Cut& c : cuts_) {
      add_vertex(c.segment);
      add_vertex(next_of(c.segment));
    }
    // Sorted by x; within a run no wider than eps every pair is compared.
    std::vector<std::uint32_t> order(points_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return points_[a].x != points_[b].x   ? points_[a].x < points_[b].x
             : points_[a].y != points_[b].y ? points_[a].y < points_[b].y
                                            : a < b;
    });
    UnionFind sets(points_.size());
    const double reach = 3 * options_.eps;
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        if (points_[order[j]].x - points_[order[i]].x > reach) break;
        if (std::abs(points_[order[j]].y - points_[order[i]].y) <= reach) sets.unite(order[i], order[j]);
      }
    }
    cluster_of_.resize(points_.size());
    for (std::uint32_t i = 0; i < points_.size(); ++i) cluster_of_[i] = sets.find(i);
    junction_.assign(points_.size(), 0);
    // A junction holds a cut or two raw vertices.
    std::vector<std::uint8_t> members(points_.size(), 0);
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      std::uint8_t& m = members[cluster_of_[i]];
      m = std::min<std::uint8_t>(2, static_cast<std::uint8_t>(m + (i < cut_points_ ? 2 : 1)));
      if (m == 2) junction_[cluster_of_[i]] = 1;
    }
    std::sort(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) {
      return a.segment != b.segment ? a.segment < b.segment
             : a.key != b.key       ? a.key < b.key
                                    : a.node < b.node;
    });
  }

  /// Cluster of raw vertex i, or kNone when it stands alone.
  std::uint32_t vertex_cluster(std::uint32_t i) const {
    const std::uint32_t node = vertex_node_.empty() ? kNone : vertex_node_[i];
    if (node == kNone) return kNone;
    const std::uint32_t c = cluster_of_[node];
    return junction_[c] ? c : kNone;
  }

  // --- loops in chains
  // ---------------------------------------------------------------------------------------

  void cut_loops() {
    std::size_t cut = 0;
    if (!cuts_.empty()) subs_.reserve(curves_.segments.size() + cuts_.size());
    for (std::size_t k = 0; k < curves_.loops(); ++k) {
      const std::uint32_t begin = curves_.first[k], end = curves_.first[k + 1];
      first_chain_ = chains_.size();
      open_ = false;
      if (begin == end) continue;
      const bool met = cut < cuts_.size() && cuts_[cut].segment < end;
      if (!met && std::find(curves_.inside.begin() + begin, curves_.inside.begin() + end, 1) ==
                      curves_.inside.begin() + end) {
        chains_.push_back({kNone, kNone, begin, end, true});
        continue;
      }
      for (std::uint32_t i = begin; i < end; ++i) {
        if (curves_.inside[i]) {
          while (cut < cuts_.size() && cuts_[cut].segment == i) ++cut;
          finish_chain(or_dead_end(vertex_cluster(i)));
          continue;
        }
        std::uint32_t at = vertex_cluster(i);
        const bool after_connector = curves_.inside[i == begin ? end - 1 : i - 1] != 0;
        Point2 p = at == kNone ? curves_.segments[i].a : points_[at];
        if (at != kNone) finish_chain(at);
        if (after_connector) at = or_dead_end(at);
        for (; cut < cuts_.size() && cuts_[cut].segment == i; ++cut) {
          const std::uint32_t c = cluster_of_[cuts_[cut].node];
          if (c == at) continue;
          add_sub(i, p, points_[c], at);
          finish_chain(c);
          at = c;
          p = points_[c];
        }
        const std::uint32_t next = next_of(i), c = vertex_cluster(next);
        if (c != kNone && c == at) continue;
        add_sub(i, p, c == kNone ? curves_.segments[next].a : points_[c], at);
      }
      close_loop(begin);
    }
  }

  void add_sub(std::uint32_t segment, Point2 a, Point2 b, std::uint32_t from) {
    if (!open_) {
      Chain chain;
      chain.from = from;
      chain.begin = static_cast<std::uint32_t>(subs_.size());
      chains_.push_back(chain);
      open_ = true;
    }
    subs_.push_back({segment, a, b});
  }

  static std::uint32_t or_dead_end(std::uint32_t cluster) { return cluster == kNone ? kDeadEnd : cluster; }

  void finish_chain(std::uint32_t at) {
    if (!open_) return;
    Chain& c = chains_.back();
    c.to = at;
    c.end = static_cast<std::uint32_t>(subs_.size());
    open_ = false;
  }

  /// The last chain of a loop runs into the first, unless a junction or connector lies between.
  void close_loop(std::uint32_t begin) {
    if (!open_) return;
    const std::uint32_t c = vertex_cluster(begin);
    if (c != kNone) {
      finish_chain(c);
      return;
    }
    finish_chain(kNone);
    Chain& first = chains_[first_chain_];
    if (curves_.inside[begin]) {
      chains_.back().to = kDeadEnd;
      return;
    }
    if (first_chain_ + 1 == chains_.size()) return;  // a whole loop
    // Join: the first chain's sub-edges are appended to the last's.
    Chain& last = chains_.back();
    for (std::uint32_t s = first.begin; s < first.end; ++s) subs_.push_back(SubEdge(subs_[s]));
    last.end = static_cast<std::uint32_t>(subs_.size());
    last.to = first.to;
    first.begin = first.end = 0;
  }

  // --- chains that run along each other
  // ----------------------------------------------------------------------

  /// Members of a bundle of coincident chains, and how often the bundle runs in the direction of the first.
  struct Bundle {
    std::uint32_t begin, end;  // in members_
    int multiplicity;
  };

  void merge_parallel_chains() {
    dropped_.assign(chains_.size(), 0);
    bundle_of_.assign(chains_.size(), kNone);
    std::vector<std::array<std::uint32_t, 3>> keys;
    for (std::uint32_t i = 0; i < chains_.size(); ++i) {
      const Chain& c = chains_[i];
      if (c.begin == c.end || returns_at_once(c)) {
        dropped_[i] = 1;
        continue;
      }
      if (c.end - c.begin != 1 || c.from >= kDeadEnd || c.to >= kDeadEnd) continue;
      keys.push_back({std::min(c.from, c.to), std::max(c.from, c.to), i});
    }
    std::sort(keys.begin(), keys.end());
    for (std::size_t i = 0; i < keys.size();) {
      std::size_t j = i + 1;
      while (j < keys.size() && keys[j][0] == keys[i][0] && keys[j][1] == keys[i][1]) ++j;
      if (j > i + 1) bundle(keys, i, j);
      i = j;
    }
  }

  /// Starts and ends in one junction without leaving it, or ends within it at a connector.
  bool returns_at_once(const Chain& c) const {
    if (c.from == kNone && c.to == kNone) return false;
    if (c.from != c.to && c.from < kDeadEnd && c.to < kDeadEnd) return false;
    const Point2 p = subs_[c.begin].a;
    const double reach = 8 * options_.eps;
    for (std::uint32_t s = c.begin; s < c.end; ++s) {
      if (distance(p, subs_[s].b) > reach || distance(p, middle_of(as_segment(curves_, subs_[s]))) > reach)
        return false;
    }
    return true;
  }

  void bundle(const std::vector<std::array<std::uint32_t, 3>>& keys, std::size_t lo, std::size_t hi) {
    const double reach = 8 * options_.eps;
    std::vector<std::uint32_t> rest;
    for (std::size_t i = lo; i < hi; ++i) rest.push_back(keys[i][2]);
    while (rest.size() > 1) {
      const Point2 middle = middle_of(as_segment(curves_, subs_[chains_[rest[0]].begin]));
      std::vector<std::uint32_t> same, other;
      for (const std::uint32_t c : rest) {
        const bool near = distance(middle, middle_of(as_segment(curves_, subs_[chains_[c].begin]))) <= reach;
        (near ? same : other).push_back(c);
      }
      if (same.size() > 1) bind(same);
      rest = std::move(other);
    }
  }

  void bind(const std::vector<std::uint32_t>& same) {
    ++degenerate_;
    int multiplicity = 0;
    for (const std::uint32_t c : same) multiplicity += chains_[c].from == chains_[same[0]].from ? 1 : -1;
    for (const std::uint32_t c : same) dropped_[c] = 1;
    if (multiplicity == 0) return;
    // The first that runs the way of the majority stands for all.
    for (const std::uint32_t c : same) {
      if ((chains_[c].from == chains_[same[0]].from) != (multiplicity > 0)) continue;
      dropped_[c] = 0;
      bundle_of_[c] = static_cast<std::uint32_t>(bundles_.size());
      break;
    }
    Bundle b{static_cast<std::uint32_t>(members_.size()), 0, std::abs(multiplicity)};
    for (const std::uint32_t c : same) members_.push_back(subs_[chains_[c].begin].segment);
    b.end = static_cast<std::uint32_t>(members_.size());
    bundles_.push_back(b);
  }

  // --- which chains are boundary
  // -----------------------------------------------------------------------------

  /// Sets `kept`; false when no place of the chain allows a sure decision, or when places contradict each
  /// other (a crossing was missed).
  bool decide(std::uint32_t index) {
    Chain& c = chains_[index];
    const Bundle* bundle = bundle_of_[index] == kNone ? nullptr : &bundles_[bundle_of_[index]];
    bool decided = false;
    const std::uint32_t middle = c.begin + (c.end - c.begin) / 2;
    for (const std::uint32_t s : {longest_sub(c), middle, c.begin, c.end - 1}) {
      Segment half = part(c, s);
      for (int attempt = 0; attempt < 4; ++attempt) {
        const Point2 p = middle_of(half);
        if (const std::optional<bool> kept = sample(segment_of(c, s), p, bundle)) {
          c.kept = *kept;
          decided = true;
          break;
        }
        (attempt % 2 == 0 ? half.b : half.a) = p;  // the first quarter, then the middle of what is left of it
      }
      if (decided) break;
    }
    return decided && (bundle || agrees(c));
  }

  /// Looks again near both ends.
  bool agrees(const Chain& c) {
    Segment head = part(c, c.begin), tail = part(c, c.end - 1);
    head.b = middle_of(head);
    tail.a = middle_of(tail);
    if (c.from != kNone || c.to != kNone) {  // of a whole loop the two ends are one
      const std::optional<bool> first = sample(segment_of(c, c.begin), middle_of(head), nullptr);
      if (first && *first != c.kept) return false;
    }
    const std::optional<bool> last = sample(segment_of(c, c.end - 1), middle_of(tail), nullptr);
    return !last || *last == c.kept;
  }

  Segment part(const Chain& c, std::uint32_t s) const {
    return c.untouched ? curves_.segments[s] : as_segment(curves_, subs_[s]);
  }
  std::uint32_t segment_of(const Chain& c, std::uint32_t s) const {
    return c.untouched ? s : subs_[s].segment;
  }

  std::uint32_t longest_sub(const Chain& c) const {
    // The longest of the first few: the choice matters for sureness only.
    constexpr std::uint32_t kLook = 8;
    std::uint32_t best = c.begin;
    double length = -1;
    for (std::uint32_t s = c.begin; s < std::min(c.end, c.begin + kLook); ++s) {
      const Segment g = part(c, s);
      const double l = distance2(g.a, g.b);
      if (l > length) best = s, length = l;
    }
    return best;
  }

  /// Distance from p to the infinite line or full circle.
  static double off_carrier(const Segment& s, Point2 p) {
    if (s.is_line()) return std::abs(cross(unit(s.b - s.a), p - s.a));
    return std::abs(distance(p, s.center) - std::abs(s.radius));
  }

  static Vec2 tangent_at(const Segment& s, Point2 p) {
    if (s.is_line()) return unit(s.b - s.a);
    return unit(s.radius > 0 ? left(p - s.center) : right(p - s.center));
  }

  /// Whether the segment is boundary at p; nothing when that is not sure there.
  std::optional<bool> sample(std::uint32_t segment, Point2 p, const Bundle* bundle) {
    const Vec2 tangent = tangent_at(curves_.segments[segment], p);
    const int axis = std::abs(tangent.y) >= std::abs(tangent.x) ? 0 : 1;
    on_.assign(1, segment);
    if (bundle) on_.assign(members_.begin() + bundle->begin, members_.begin() + bundle->end);
    int beyond = tree_.winding_beyond(p, axis, on_, noise_, close_);
    if (!close_.empty() || bundle) {
      // What runs along the segment here (connectors too) counts as one with it.
      beyond = tree_.winding_beyond(p, axis, on_, 4 * options_.eps, close_);
      on_.insert(on_.end(), close_.begin(), close_.end());
      double thick = 0;
      for (const std::uint32_t m : on_) thick = std::max(thick, off_carrier(curves_.segments[m], p));
      beyond = tree_.winding_beyond(p, axis, on_, noise_ + 2 * thick, close_);
      if (!close_.empty()) return std::nullopt;
    }
    int times = 0;
    for (const std::uint32_t m : on_) {
      const double cosine = dot(tangent, tangent_at(curves_.segments[m], p));
      if (std::abs(cosine) < kAlong) return std::nullopt;
      times += cosine > 0 ? 1 : -1;
    }
    const bool beyond_is_left = axis == 0 ? tangent.y < 0 : tangent.x > 0;
    beyond += options_.base;
    const int left_side = beyond_is_left ? beyond : beyond + times;
    return left_side > 0 && left_side - times <= 0;
  }

  // --- loops of kept chains
  // ----------------------------------------------------------------------------------

  struct End {
    std::uint32_t junction, chain;
    bool leaves;
  };

  bool link() {
    std::vector<End> ends;
    for (std::uint32_t i = 0; i < chains_.size(); ++i) {
      const Chain& c = chains_[i];
      if (dropped_[i] || !c.kept) continue;
      if (c.from == kNone && c.to == kNone) {
        chains_[i].next = i;
        continue;
      }
      if (c.from >= kDeadEnd || c.to >= kDeadEnd) return false;
      ends.push_back({c.from, i, true});
      ends.push_back({c.to, i, false});
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return a.junction != b.junction ? a.junction < b.junction
             : a.chain != b.chain     ? a.chain < b.chain
                                      : a.leaves < b.leaves;
    });
    for (std::size_t i = 0; i < ends.size();) {
      std::size_t j = i + 1;
      while (j < ends.size() && ends[j].junction == ends[i].junction) ++j;
      if (!link_at({ends.data() + i, ends.data() + j})) return false;
      i = j;
    }
    return true;
  }

  bool link_at(std::span<const End> ends) {
    if (ends.size() == 2 && ends[0].leaves != ends[1].leaves) {
      const End &in = ends[0].leaves ? ends[1] : ends[0], &out = ends[0].leaves ? ends[0] : ends[1];
      chains_[in.chain].next = out.chain;
      return true;
    }
    if (ends.size() % 2 != 0) return false;
    ++degenerate_;
    // Around the point, the set lies clockwise of an arriving chain up to the next leaving one.
    struct Spoke {
      double angle, curvature;
      End end;
    };
    std::vector<Spoke> spokes;
    for (const End& e : ends) {
      const Segment s = end_segment(e);
      const Vec2 t = s.is_line() ? s.b - s.a : s.radius > 0 ? left(s.a - s.center) : right(s.a - s.center);
      spokes.push_back({std::atan2(t.y, t.x), s.is_line() ? 0 : 1 / s.radius, e});
    }
    std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
      return a.angle != b.angle ? a.angle > b.angle : a.end.chain < b.end.chain;
    });
    // Chains that leave in the same direction are told apart by curvature (more to the left comes later in
    // clockwise order when it is smaller).
    constexpr double kSameDirection = 1e-6;
    for (std::size_t i = 0; i < spokes.size();) {
      std::size_t j = i + 1;
      while (j < spokes.size() && spokes[j - 1].angle - spokes[j].angle < kSameDirection) ++j;
      std::stable_sort(spokes.begin() + static_cast<std::ptrdiff_t>(i),
                       spokes.begin() + static_cast<std::ptrdiff_t>(j),
                       [](const Spoke& a, const Spoke& b) { return a.curvature > b.curvature; });
      i = j;
    }
    for (std::size_t i = 0; i < spokes.size(); ++i) {
      if (spokes[i].end.leaves) continue;
      const Spoke& next = spokes[(i + 1) % spokes.size()];
      if (!next.end.leaves) return false;
      chains_[spokes[i].end.chain].next = next.end.chain;
    }
    return true;
  }

  /// First sub-edge of a leaving chain, last of an arriving one turned round: both start at the junction.
  Segment end_segment(const End& e) const {
    const Chain& c = chains_[e.chain];
    return e.leaves ? as_segment(curves_, subs_[c.begin]) : reversed(as_segment(curves_, subs_[c.end - 1]));
  }

  Boundary collect() {
    Boundary out;
    out.used.assign(options_.contours, 0);
    loop_subs_.reserve(subs_.size());
    std::vector<std::uint8_t> done(chains_.size(), 0);
    for (std::uint32_t i = 0; i < chains_.size(); ++i) {
      if (dropped_[i] || !chains_[i].kept || done[i]) continue;
      if (chains_[i].untouched) {
        collect_untouched(out, chains_[i]);
        continue;
      }
      loop_subs_.clear();
      for (std::uint32_t c = i; !done[c]; c = chains_[c].next) {
        done[c] = 1;
        for (std::uint32_t s = chains_[c].begin; s < chains_[c].end; ++s) append(subs_[s]);
      }
      finish_loop(out);
    }
    std::stable_sort(out.loops.begin(), out.loops.end(),
                     [](const BoundaryLoop& a, const BoundaryLoop& b) { return a.contour < b.contour; });
    out.degenerate_places = degenerate_;
    return out;
  }

  void collect_untouched(Boundary& out, const Chain& c) {
    BoundaryLoop loop;
    loop.segments.assign(curves_.segments.begin() + c.begin, curves_.segments.begin() + c.end);
    loop.contour = curves_.contour[tree_.loop_of(c.begin)];
    // Long loops are not measured: they could be thin only by being so everywhere.
    constexpr std::size_t kMeasured = 64;
    if (loop.segments.size() < 2 || (loop.segments.size() <= kMeasured && thin(loop.segments))) return;
    out.used[loop.contour] = 1;
    out.loops.push_back(std::move(loop));
  }

  /// Neighbouring parts of one raw segment become one again.
  void append(const SubEdge& e) {
    if (!loop_subs_.empty() && loop_subs_.back().segment == e.segment && loop_subs_.back().b == e.a) {
      loop_subs_.back().b = e.b;
    } else {
      loop_subs_.push_back(e);
    }
  }

  /// Snapping moves ends by little more than rounding; half of the disagreement allowed to arcs may stay.
  static bool on_its_circle(const Segment& s) {
    const double r = std::abs(s.radius), slack = 0.5 * kArcConsistency * (r + 1);
    return std::abs(distance(s.a, s.center) - r) <= slack && std::abs(distance(s.b, s.center) - r) <= slack;
  }

  void finish_loop(Boundary& out) {
    if (loop_subs_.size() > 1 && loop_subs_.front().segment == loop_subs_.back().segment &&
        !(loop_subs_.front().a == loop_subs_.front().b)) {
      // The seam fell inside a raw segment (not when the loop holds two separate parts of it).
      const SubEdge &head = loop_subs_.front(), &tail = loop_subs_.back();
      const Segment& raw = curves_.segments[head.segment];
      if (key_of(raw, tail.a) < key_of(raw, head.b)) {
        loop_subs_.front().a = tail.a;
        loop_subs_.pop_back();
      }
    }
    BoundaryLoop loop;
    loop.segments.reserve(loop_subs_.size());
    std::uint32_t first = kNone;
    for (const SubEdge& e : loop_subs_) {
      Segment s = as_segment(curves_, e);
      if (s.a == s.b) continue;
      const Segment& raw = curves_.segments[e.segment];
      if (!s.is_line() && !(s.a == raw.a && s.b == raw.b) && !on_its_circle(s)) s = refitted(s);
      if (first == kNone) first = e.segment;
      loop.segments.push_back(s);
    }
    if (loop.segments.size() < 2 || thin(loop.segments)) return;
    for (const SubEdge& e : loop_subs_) out.used[curves_.contour[tree_.loop_of(e.segment)]] = 1;
    loop.contour = curves_.contour[tree_.loop_of(first)];
    out.loops.push_back(std::move(loop));
  }

  /// Whether a loop is thinner than a point.
  bool thin(const std::vector<Segment>& segments) const {
    double area = 0, length = 0;
    const Point2 o = segments.front().a;
    for (const Segment& s : segments) {
      area += 0.5 * cross(s.a - o, s.b - o);
      double l = distance(s.a, s.b);
      if (!s.is_line()) {
        const double sweep = sweep_of(s);
        area += 0.5 * s.radius * s.radius * (sweep - std::sin(sweep));
        l = std::abs(sweep * s.radius);
      }
      length += l;
    }
    return std::abs(area) <= 0.5 * options_.point_mm * length;
  }

  static constexpr std::uint32_t kDeadEnd = kNone - 1;

  const RawCurves& curves_;
  const ArrangementOptions& options_;
  BoxTree tree_;
  double noise_ = 0;
  bool too_many_ = false;
  std::size_t degenerate_ = 0;

  std::vector<Cut> cuts_;
  std::vector<Point2> points_;  // cuts first, then raw vertices
  std::uint32_t cut_points_ = 0;
  std::vector<std::uint32_t> vertex_node_;  // per raw segment: point of its start
  std::vector<std::uint32_t> cluster_of_;
  std::vector<std::uint8_t> junction_;

  std::vector<SubEdge> subs_;
  std::vector<Chain> chains_;
  std::size_t first_chain_ = 0;
  bool open_ = false;

  std::vector<std::uint8_t> dropped_;
  std::vector<std::uint32_t> bundle_of_;
  std::vector<Bundle> bundles_;
  std::vector<std::uint32_t> members_;
  std::vector<SubEdge> loop_subs_;
  std::vector<std::uint32_t> on_, close_;
};

}  // namespace

ArrangementResult positive_boundary(const RawCurves& curves, const ArrangementOptions& options) {
  return Arrangement(curves, options).run();
}

}  // namespace burin::geom::detail
