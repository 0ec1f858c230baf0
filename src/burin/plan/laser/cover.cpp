// SPDX-License-Identifier: Apache-2.0
// One-cover of the intervals that lie on one line or circle: every place drawn once, the rest named.
#include <algorithm>
#include <cmath>

#include "burin/plan/laser/join_parts.h"

namespace burin::laser::detail {
namespace {

/// An interval between clustered ends: covers atoms [i, j).
struct Range {
  std::uint32_t interval = 0;
  std::uint32_t i = 0, j = 0;
};

struct Boundaries {
  std::vector<double> at;  ///< a place for every cluster of ends
  std::vector<Range> ranges;
};

/// Ends closer than `join` become one boundary; a boundary never grows wider than that, so that rows of short
/// pieces do not collapse. Its place is the end of the piece that comes first in the file.
Boundaries boundaries(const std::vector<Interval>& intervals, double join) {
  struct End {
    double x;
    std::uint32_t interval;
    bool high;
  };
  std::vector<End> ends;
  ends.reserve(2 * intervals.size());
  for (std::uint32_t k = 0; k < intervals.size(); ++k) {
    ends.push_back({intervals[k].lo, k, false});
    ends.push_back({intervals[k].hi, k, true});
  }
  std::sort(ends.begin(), ends.end(),
            [](const End& p, const End& q) { return p.x != q.x ? p.x < q.x : p.interval < q.interval; });
  Boundaries result;
  result.ranges.resize(intervals.size());
  double first = 0;
  std::uint32_t owner = kNone;
  for (const End& end : ends) {
    if (result.at.empty() || end.x - first > join) {
      first = end.x;
      owner = kNone;
      result.at.push_back(end.x);
    }
    if (intervals[end.interval].piece < owner) {
      owner = intervals[end.interval].piece;
      result.at.back() = end.x;
    }
    Range& range = result.ranges[end.interval];
    range.interval = end.interval;
    (end.high ? range.j : range.i) = static_cast<std::uint32_t>(result.at.size() - 1);
  }
  return result;
}

struct Layer {
  std::vector<std::uint32_t> owner;  ///< by atom: interval or kNone
  std::vector<Range> rest;           ///< what the layer did not take
};

class Coverer {
 public:
  Coverer(const std::vector<Interval>& intervals, double around, const JoinScale& scale)
      : intervals_(intervals), around_(around), scale_(scale), bounds_(boundaries(intervals, scale.join)) {}

  Cover run() {
    std::vector<Range> ranges = touched();
    if (ranges.empty()) return {};
    const Layer base = layer(ranges);
    const Layer spare = layer(base.rest);
    report(base);
    emit(base, spare);
    return std::move(cover_);
  }

 private:
  std::size_t atoms() const { return bounds_.at.size() - 1; }

  /// Ranges of the pieces that share an atom with another piece; notes those pieces.
  std::vector<Range> touched() {
    std::vector<int> change(bounds_.at.size() + 1, 0);
    for (const Range& r : bounds_.ranges) {
      ++change[r.i];
      --change[r.j];
    }
    std::vector<std::uint32_t> crowded(bounds_.at.size() + 1,
                                       0);  // how many atoms before k are drawn repeatedly
    int count = 0;
    for (std::size_t k = 0; k < bounds_.at.size(); ++k) {
      count += change[k];
      crowded[k + 1] = crowded[k] + (count >= 2 ? 1U : 0U);
    }
    std::vector<std::uint32_t>& pieces = cover_.touched;
    for (const Range& r : bounds_.ranges) {
      if (r.i < r.j && crowded[r.j] > crowded[r.i]) pieces.push_back(intervals_[r.interval].piece);
    }
    std::sort(pieces.begin(), pieces.end());
    pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
    std::vector<Range> ranges;
    for (const Range& r :
         bounds_.ranges) {  // an arc past the seam of the circle has two intervals: both count
      if (std::binary_search(pieces.begin(), pieces.end(), intervals_[r.interval].piece)) ranges.push_back(r);
    }
    return ranges;
  }

  bool earlier(std::uint32_t p, std::uint32_t q) const {
    const std::uint32_t a = intervals_[p].piece, b = intervals_[q].piece;
    return a != b ? a < b : p < q;
  }
  double width(std::uint32_t i, std::uint32_t j) const { return bounds_.at[j] - bounds_.at[i]; }

  /// Ranges that no other range contains, by growing i and j; of equal ones the first in the file. The others
  /// go to `rest`.
  std::vector<Range> proper(std::vector<Range> ranges, std::vector<Range>& rest) const {
    std::sort(ranges.begin(), ranges.end(), [&](const Range& p, const Range& q) {
      if (p.i != q.i) return p.i < q.i;
      if (p.j != q.j) return p.j > q.j;
      return earlier(p.interval, q.interval);
    });
    std::vector<Range> result;
    for (const Range& r : ranges) {
      if (r.i == r.j) continue;
      if (!result.empty() && r.j <= result.back().j) {
        rest.push_back(r);
      } else {
        result.push_back(r);
      }
    }
    return result;
  }

  /// The fewest ranges that cover the same atoms (greedy, exact for intervals).
  static std::vector<Range> fewest(const std::vector<Range>& ranges, std::vector<Range>& rest) {
    std::vector<Range> chosen;
    for (std::size_t p = 0; p < ranges.size();) {
      std::size_t q = p;
      if (!chosen.empty() && ranges[p].i <= chosen.back().j) {
        while (q + 1 < ranges.size() && ranges[q + 1].i <= chosen.back().j) rest.push_back(ranges[q++]);
      }
      chosen.push_back(ranges[q]);
      p = q + 1;
    }
    return chosen;
  }

  Layer layer(const std::vector<Range>& ranges) const {
    Layer result;
    result.owner.assign(atoms(), kNone);
    std::vector<Range> chosen = fewest(proper(ranges, result.rest), result.rest);
    for (std::size_t k = 0; k + 1 < chosen.size(); ++k) {
      Range &p = chosen[k], &q = chosen[k + 1];
      if (q.i >= p.j) continue;
      const std::uint32_t from = q.i, to = p.j;
      const bool keep_first = earlier(p.interval, q.interval);
      result.rest.push_back({keep_first ? q.interval : p.interval, from, to});
      (keep_first ? q.i : p.j) = keep_first ? to : from;
    }
    for (const Range& r : chosen) {
      for (std::uint32_t k = r.i; k < r.j; ++k) result.owner[k] = r.interval;
    }
    return result;
  }

  /// Parameter of the interval's piece at boundary k. Its own end stays its own end when it lies within join.
  double parameter(const Interval& v, std::uint32_t k) const {
    const double x = bounds_.at[k];
    const bool near_lo = x - v.lo <= scale_.join, near_hi = v.hi - x <= scale_.join;
    if (near_lo && (!near_hi || x - v.lo <= v.hi - x)) return v.t_lo;
    if (near_hi) return v.t_hi;
    return v.t_lo + (x - v.lo) / (v.hi - v.lo) * (v.t_hi - v.t_lo);
  }

  void emit(const Layer& base, const Layer& spare) {
    for (std::uint32_t k = 0; k < atoms();) {
      const std::uint32_t p = base.owner[k], s = spare.owner[k];
      std::uint32_t end = k + 1;
      while (end < atoms() && base.owner[end] == p && spare.owner[end] == s) ++end;
      if (p != kNone) emit_part(p, width(k, end) > scale_.join ? s : kNone, k, end);
      k = end;
    }
  }

  void emit_part(std::uint32_t p, std::uint32_t s, std::uint32_t k, std::uint32_t end) {
    CoverPart part;
    part.piece = intervals_[p].piece;
    const double at0 = parameter(intervals_[p], k), at1 = parameter(intervals_[p], end);
    if (at0 == at1) return;
    part.t0 = std::min(at0, at1);
    part.t1 = std::max(at0, at1);
    if (s != kNone) {
      const double s0 = parameter(intervals_[s], k), s1 = parameter(intervals_[s], end);
      if (s0 != s1) {
        part.spare_piece = intervals_[s].piece;
        part.spare_t0 = std::min(s0, s1);
        part.spare_t1 = std::max(s0, s1);
      }
    }
    cover_.parts.push_back(part);
  }

  /// Names every stretch that the base layer took from somebody else.
  void report(const Layer& base) {
    for (const Range& rest : base.rest) {
      const Interval& v = intervals_[rest.interval];
      const double lo = std::max(v.lo, bounds_.at[rest.i]), hi = std::min(v.hi, bounds_.at[rest.j]);
      if (hi - lo <= std::min(scale_.join, 0.5 * (v.hi - v.lo))) continue;
      Repeat repeat;
      repeat.piece = v.piece;
      const std::uint32_t by = base.owner[rest.i + (rest.j - rest.i) / 2];
      repeat.by = intervals_[by == kNone ? rest.interval : by].piece;
      repeat.t = v.t_lo + (0.5 * (lo + hi) - v.lo) / (v.hi - v.lo) * (v.t_hi - v.t_lo);
      repeat.length = hi - lo;
      const Range& own = bounds_.ranges[rest.interval];
      const Range& other = bounds_.ranges[by == kNone ? rest.interval : by];
      repeat.whole =
          own.i == rest.i && own.j == rest.j && other.i == own.i && other.j == own.j && spans_alike(v, by);
      cover_.repeats.push_back(repeat);
    }
  }

  /// On a circle an arc that passes the seam has two intervals: equal intervals are equal pieces only when
  /// both have one, or both have two.
  bool spans_alike(const Interval& v, std::uint32_t by) const {
    if (around_ == 0 || by == kNone) return true;
    const Interval& w = intervals_[by];
    return std::abs(std::abs(v.t_hi - v.t_lo) - std::abs(w.t_hi - w.t_lo)) * around_ <=
           scale_.join + scale_.same;
  }

  const std::vector<Interval>& intervals_;
  double around_;
  JoinScale scale_;
  Boundaries bounds_;
  Cover cover_;
};

}  // namespace

Cover cover(const std::vector<Interval>& intervals, double around, const JoinScale& scale) {
  if (intervals.size() < 2) return {};
  return Coverer(intervals, around, scale).run();
}

}  // namespace burin::laser::detail
