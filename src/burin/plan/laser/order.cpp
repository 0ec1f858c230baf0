// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/order.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burin/plan/laser/nesting.h"
#include "burin/plan/laser/point_grid.h"

namespace burin::laser::detail {

using geom::Point2;

namespace {

/// Gains below this are rounding, not shorter rapids (mm; coordinates up to 1e5 mm round to 1.5e-11 mm).
constexpr double kGain = 1e-7;
/// Neighbours of an item that are tried for it.
constexpr std::size_t kNeighbours = 8;
/// Longest block that Or-opt moves.
constexpr std::size_t kBlock = 3;
/// Steps of array work of one improvement run; a second's part on any machine.
constexpr double kBudget = 1.5e8;

const Way& way_of(const std::vector<OrderItem>& items, Visit v) {
  return items[v.item].ways[v.way];
}

Visit backwards(const std::vector<OrderItem>& items, Visit v) {
  return {v.item, way_of(items, v).reverse};
}

// --- local search
// ---------------------------------------------------------------------------------------------

/// A tour under improvement. Positions 0..n-1; "before 0" is the start point, after n-1 the end is free.
class Search {
 public:
  Search(const std::vector<OrderItem>& items, std::vector<Visit> tour, Point2 from)
      : items_(items), tour_(std::move(tour)), from_(from), position_(items.size()) {
    for (std::size_t i = 0; i < tour_.size(); ++i) position_[tour_[i].item] = i;
    find_neighbours();
  }

  /// Until nothing gets better or the budget is spent.
  void run() {
    std::vector<std::uint32_t> queue;
    for (const Visit& v : tour_) queue.push_back(v.item);
    std::vector<std::uint8_t> waiting(items_.size(), 1);
    for (std::size_t head = 0; head < queue.size() && budget_ > 0; ++head) {
      const std::uint32_t item = queue[head];
      waiting[item] = 0;
      touched_.clear();
      if (!improve(item)) continue;
      touched_.push_back(item);
      for (const std::uint32_t t : touched_) {
        if (!waiting[t]) {
          waiting[t] = 1;
          queue.push_back(t);
        }
      }
    }
  }

  std::vector<Visit> take() && { return std::move(tour_); }

 private:
  std::size_t size() const { return tour_.size(); }
  Point2 out_before(std::size_t i) const { return i == 0 ? from_ : way_of(items_, tour_[i - 1]).out; }
  double step(Visit a, Visit b) const { return geom::distance(way_of(items_, a).out, way_of(items_, b).in); }
  double enter(std::size_t i, Visit v) const { return geom::distance(out_before(i), way_of(items_, v).in); }
  /// From `v` to what stands at position i; 0 past the end.
  double leave(Visit v, std::size_t i) const { return i < size() ? step(v, tour_[i]) : 0; }
  std::size_t parent_position(std::uint32_t item) const {
    const std::uint32_t p = items_[item].parent;
    return p == kNoParent ? std::numeric_limits<std::size_t>::max() : position_[p];
  }

  void find_neighbours();
  bool improve(std::uint32_t item);
  bool try_reverse(std::size_t i, std::size_t j);
  bool try_move(std::size_t first, std::size_t count, std::size_t before);
  void place(std::size_t i, Visit v) {
    tour_[i] = v;
    position_[v.item] = i;
  }
  void touch(std::size_t i) {
    if (i < size()) touched_.push_back(tour_[i].item);
  }

  const std::vector<OrderItem>& items_;
  std::vector<Visit> tour_;
  Point2 from_;
  std::vector<std::size_t> position_;
  std::vector<std::vector<std::uint32_t>> near_;
  std::vector<std::uint32_t> touched_;
  double budget_ = kBudget;
};

void Search::find_neighbours() {
  std::vector<Point2> points(2 * items_.size());
  PointGrid grid([&] {
    for (const Visit& v : tour_) {
      points[2 * v.item] = way_of(items_, v).in;
      points[2 * v.item + 1] = way_of(items_, v).out;
    }
    return points;
  }());
  for (const Visit& v : tour_) {
    grid.insert(2 * v.item);
    if (!(points[2 * v.item] == points[2 * v.item + 1])) grid.insert(2 * v.item + 1);
  }
  near_.resize(items_.size());
  for (const Visit& v : tour_) {
    auto& list = near_[v.item];
    for (const std::uint32_t id : {2 * v.item, 2 * v.item + 1}) {
      for (const std::uint32_t other : grid.nearest(points[id], 2 * kNeighbours)) {
        const std::uint32_t item = other / 2;
        const bool known = item == v.item || std::find(list.begin(), list.end(), item) != list.end();
        if (!known && list.size() < 2 * kNeighbours) list.push_back(item);
      }
      if (points[2 * v.item] == points[2 * v.item + 1]) break;
    }
  }
}

/// Reverses positions i..j when that is shorter and nothing in there must come before something else in
/// there.
bool Search::try_reverse(std::size_t i, std::size_t j) {
  if (i > j || j >= size()) return false;
  const Visit first = backwards(items_, tour_[j]), last = backwards(items_, tour_[i]);
  double gain = enter(i, tour_[i]) - enter(i, first) + leave(tour_[j], j + 1) - leave(last, j + 1);
  if (gain <= kGain) return false;
  budget_ -= static_cast<double>(j - i + 1);
  for (std::size_t k = i; k <= j; ++k) {
    if (parent_position(tour_[k].item) <= j) return false;
  }
  // Ways may leave elsewhere than they enter: the rapids inside are not the same backwards.
  for (std::size_t k = i; k < j; ++k) {
    gain += step(tour_[k], tour_[k + 1]) - step(backwards(items_, tour_[k + 1]), backwards(items_, tour_[k]));
  }
  if (gain <= kGain) return false;
  std::reverse(tour_.begin() + static_cast<std::ptrdiff_t>(i),
               tour_.begin() + static_cast<std::ptrdiff_t>(j) + 1);
  for (std::size_t k = i; k <= j; ++k) place(k, backwards(items_, tour_[k]));
  for (const std::size_t k : {i, j, j + 1}) touch(k);
  if (i > 0) touch(i - 1);
  return true;
}

/// Moves positions first..first+count-1, as they are or backwards, to stand before what is now at `before`
/// (size(): to the end).
bool Search::try_move(std::size_t first, std::size_t count, std::size_t before) {
  const std::size_t end = first + count;
  if (end > size() || before > size() || (before >= first && before <= end)) return false;
  const double removed =
      enter(first, tour_[first]) + leave(tour_[end - 1], end) - (end < size() ? enter(first, tour_[end]) : 0);
  const double gap = before < size() ? enter(before, tour_[before]) : 0;
  const auto added = [&](Visit head, Visit tail) { return enter(before, head) + leave(tail, before) - gap; };

  Visit block[kBlock];
  for (std::size_t k = 0; k < count; ++k) block[k] = tour_[first + k];
  double gain = removed - added(block[0], block[count - 1]);
  Visit turned[kBlock];
  for (std::size_t k = 0; k < count; ++k) turned[k] = backwards(items_, block[count - 1 - k]);
  double turned_gain = removed - added(turned[0], turned[count - 1]);
  bool may_turn = true;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    turned_gain += step(block[k], block[k + 1]) - step(turned[k], turned[k + 1]);
  }
  for (std::size_t k = 0; k < count; ++k) may_turn = may_turn && parent_position(block[k].item) >= end;
  const bool turn = may_turn && turned_gain > gain;
  if (turn) gain = turned_gain;
  if (gain <= kGain) return false;

  const std::size_t low = std::min(first, before), high = std::max(end, before);
  budget_ -= static_cast<double>(high - low);
  for (std::size_t k = 0; k < count; ++k) {  // moved later: past its parent?
    if (before > first && parent_position(block[k].item) >= end && parent_position(block[k].item) < before)
      return false;
  }
  for (std::size_t k = before; k < first; ++k) {  // moved earlier: past something it contains?
    const std::size_t p = parent_position(tour_[k].item);
    if (p >= first && p < end) return false;
  }
  if (before > first) {
    for (std::size_t k = end; k < before; ++k) place(k - count, tour_[k]);
  } else {
    for (std::size_t k = first; k-- > before;) place(k + count, tour_[k]);
  }
  const std::size_t at = before > first ? before - count : before;
  for (std::size_t k = 0; k < count; ++k) place(at + k, turn ? turned[k] : block[k]);
  for (const std::size_t k : {low, at, at + count - 1, at + count, high}) touch(k);
  if (low > 0) touch(low - 1);
  if (at > 0) touch(at - 1);
  touch(high - 1);
  return true;
}

/// The first better tour found by bringing `item` next to one of its neighbours.
bool Search::improve(std::uint32_t item) {
  for (const std::uint32_t other : near_[item]) {
    budget_ -= 1;
    const std::size_t p = position_[item], q = position_[other];
    const std::size_t low = std::min(p, q), high = std::max(p, q);
    // 2-opt: the two become neighbours by turning round what lies between, from one side or the other.
    if (try_reverse(low + 1, high) || (high > 0 && try_reverse(low, high - 1))) return true;
    for (std::size_t count = 1; count <= kBlock; ++count) {
      if (try_move(p, count, q) || try_move(p, count, q + 1)) return true;
      if (count > 1 && p + 1 >= count) {
        if (try_move(p + 1 - count, count, q) || try_move(p + 1 - count, count, q + 1)) return true;
      }
    }
  }
  const std::size_t p = position_[item];
  // The tail of the tour may be turned for free at its end, and an open path by itself.
  return try_reverse(p, size() - 1) || try_move(p, 1, size());
}

// --- ways
// -----------------------------------------------------------------------------------------------------

/// The best ways for a fixed order: shortest path through the layers of ways.
void choose_ways(const std::vector<OrderItem>& items, std::vector<Visit>& tour, Point2 from) {
  std::vector<std::vector<std::uint32_t>> came(tour.size());
  std::vector<double> cost, before;
  for (std::size_t i = 0; i < tour.size(); ++i) {
    const auto& ways = items[tour[i].item].ways;
    cost.assign(ways.size(), std::numeric_limits<double>::infinity());
    came[i].assign(ways.size(), 0);
    for (std::uint32_t w = 0; w < ways.size(); ++w) {
      if (i == 0) {
        cost[w] = geom::distance(from, ways[w].in);
        continue;
      }
      const auto& old = items[tour[i - 1].item].ways;
      for (std::uint32_t v = 0; v < old.size(); ++v) {
        const double c = before[v] + geom::distance(old[v].out, ways[w].in);
        if (c < cost[w]) {
          cost[w] = c;
          came[i][w] = v;
        }
      }
    }
    before = cost;
  }
  if (tour.empty()) return;
  auto way = static_cast<std::uint32_t>(std::min_element(before.begin(), before.end()) - before.begin());
  for (std::size_t i = tour.size(); i-- > 0;) {
    tour[i].way = way;
    way = came[i][way];
  }
}

/// The items with only the ways a tour has chosen (and their reverses).
std::vector<OrderItem> with_ways_of(const std::vector<OrderItem>& items, const std::vector<Visit>& tour) {
  std::vector<OrderItem> fixed = items;
  for (const Visit& v : tour) {
    Way way = way_of(items, v);
    Way back = items[v.item].ways[way.reverse];
    const bool turns = way.reverse != v.way;
    way.reverse = turns ? 1 : 0;
    back.reverse = 0;
    fixed[v.item].ways = {way};
    if (turns) fixed[v.item].ways.push_back(back);
  }
  return fixed;
}

}  // namespace

double rapids_of(const std::vector<OrderItem>& items, const std::vector<Visit>& tour, Point2 from) {
  double sum = 0;
  for (const Visit& v : tour) {
    sum += geom::distance(from, way_of(items, v).in);
    from = way_of(items, v).out;
  }
  return sum;
}

std::vector<Visit> nearest_neighbour(const std::vector<OrderItem>& items, Point2 from) {
  std::vector<Point2> points;
  std::vector<Visit> meaning;
  std::vector<std::uint32_t> first(items.size());
  std::vector<std::uint32_t> inside(items.size(), 0);
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    first[i] = static_cast<std::uint32_t>(points.size());
    if (items[i].parent != kNoParent) ++inside[items[i].parent];
    for (std::uint32_t w = 0; w < items[i].ways.size(); ++w) {
      points.push_back(items[i].ways[w].in);
      meaning.push_back({i, w});
    }
  }
  PointGrid grid(std::move(points));
  const auto all_ways = [&](std::uint32_t i, auto&& act) {
    for (std::uint32_t w = 0; w < items[i].ways.size(); ++w) act(first[i] + w);
  };
  for (std::uint32_t i = 0; i < items.size(); ++i) {
    if (inside[i] == 0) all_ways(i, [&](std::uint32_t id) { grid.insert(id); });
  }
  std::vector<Visit> tour;
  while (grid.size() > 0) {
    const Visit v = meaning[grid.nearest(from)];
    tour.push_back(v);
    from = way_of(items, v).out;
    all_ways(v.item, [&](std::uint32_t id) { grid.erase(id); });
    const std::uint32_t p = items[v.item].parent;
    if (p != kNoParent && --inside[p] == 0) all_ways(p, [&](std::uint32_t id) { grid.insert(id); });
  }
  return tour;
}

std::vector<Visit> order_items(const std::vector<OrderItem>& items, Point2 from) {
  if (items.empty()) return {};
  // Two rounds: with better ways other exchanges become good; a third finds next to nothing.
  constexpr int kRounds = 2;
  std::vector<Visit> best = nearest_neighbour(items, from);
  choose_ways(items, best, from);
  for (int round = 0; round < kRounds; ++round) {
    Search search(items, best, from);
    search.run();
    best = std::move(search).take();
    choose_ways(items, best, from);
  }
  // Nearest neighbour over the start points that were chosen is another tour; it is hardly ever the shorter
  // one, but then it is the promise of the header.
  const std::vector<OrderItem> fixed = with_ways_of(items, best);
  const std::vector<Visit> plain = nearest_neighbour(fixed, from);
  if (rapids_of(fixed, plain, from) < rapids_of(items, best, from)) {
    std::vector<std::uint32_t> chosen(items.size());
    for (const Visit& v : best) chosen[v.item] = v.way;
    best = plain;
    for (Visit& v : best) v.way = v.way == 0 ? chosen[v.item] : items[v.item].ways[chosen[v.item]].reverse;
  }
  return best;
}

}  // namespace burin::laser::detail
