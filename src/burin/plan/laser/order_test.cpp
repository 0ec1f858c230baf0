// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/laser/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace burin::laser::detail {
namespace {

using geom::Point2;

/// Points, open lines (two ways) and contours with several start points; parents are items with a higher
/// index.
std::vector<OrderItem> random_items(std::mt19937& random, std::size_t n, bool nested) {
  const auto real = [&] { return static_cast<double>(random()) / 4294967296.0 * 100; };
  std::vector<OrderItem> items(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point2 p{real(), real()};
    switch (random() % 3) {
      case 0: {
        const Point2 q{real(), real()};
        items[i].ways = {{p, q, 1}, {q, p, 0}};
        break;
      }
      case 1:
        for (std::uint32_t w = 0; w < 4; ++w) {
          const Point2 s{p.x + real() / 50, p.y + real() / 50};
          items[i].ways.push_back({s, {s.x + 0.3, s.y}, w});
        }
        break;
      default:
        items[i].ways = {{p, p, 0}};
    }
    if (nested && i + 1 < n && random() % 2) {
      items[i].parent = static_cast<std::uint32_t>(i + 1 + random() % (n - i - 1));
    }
  }
  return items;
}

void expect_valid(const std::vector<OrderItem>& items, const std::vector<Visit>& tour) {
  ASSERT_EQ(tour.size(), items.size());
  std::vector<std::size_t> at(items.size(), items.size());
  for (std::size_t i = 0; i < tour.size(); ++i) {
    ASSERT_EQ(at[tour[i].item], items.size());
    at[tour[i].item] = i;
    ASSERT_LT(tour[i].way, items[tour[i].item].ways.size());
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].parent == 0xffffffffu) continue;
    EXPECT_LT(at[i], at[items[i].parent]);
  }
}

/// Nearest neighbour in the plainest way, with the ways that a tour uses.
double plain_nearest_neighbour(const std::vector<OrderItem>& items, const std::vector<Visit>& tour,
                               Point2 from) {
  std::vector<std::uint32_t> way(items.size());
  for (const Visit& v : tour) way[v.item] = v.way;
  std::vector<bool> done(items.size(), false);
  double sum = 0;
  for (std::size_t step = 0; step < items.size(); ++step) {
    double best = 1e300;
    Visit next;
    for (std::uint32_t i = 0; i < items.size(); ++i) {
      bool ready = !done[i];
      for (std::uint32_t j = 0; ready && j < items.size(); ++j) ready = done[j] || items[j].parent != i;
      if (!ready) continue;
      for (const std::uint32_t w : {way[i], items[i].ways[way[i]].reverse}) {
        const double d = geom::distance(from, items[i].ways[w].in);
        if (d < best) {
          best = d;
          next = {i, w};
        }
      }
    }
    sum += best;
    done[next.item] = true;
    from = items[next.item].ways[next.way].out;
  }
  return sum;
}

TEST(OrderItems, KeepsThePrecedenceAndIsNotWorseThanNearestNeighbour) {
  std::mt19937 random(1);
  double ours = 0, plain = 0;
  for (int n = 0; n < 120; ++n) {
    const auto items = random_items(random, 1 + random() % 40, n % 2);
    const Point2 from{static_cast<double>(random() % 100), 0};
    const auto tour = order_items(items, from);
    expect_valid(items, tour);
    const double length = rapids_of(items, tour, from), greedy = plain_nearest_neighbour(items, tour, from);
    EXPECT_LE(length, greedy + 1e-9);
    EXPECT_LE(length, rapids_of(items, nearest_neighbour(items, from), from) + 1e-9);
    EXPECT_EQ(order_items(items, from), tour);
    ours += length;
    plain += greedy;
  }
  EXPECT_LT(ours, 0.92 * plain);
}

TEST(OrderItems, SmallCasesAreNearTheOptimum) {
  std::mt19937 random(2);
  double ours = 0, best_sum = 0;
  for (int n = 0; n < 40; ++n) {
    auto items = random_items(random, 7, n % 2);
    for (OrderItem& item : items) {  // one way each, so that all orders can be tried
      item.ways.resize(1);
      item.ways[0].reverse = 0;
    }
    std::vector<std::uint32_t> order(items.size());
    std::iota(order.begin(), order.end(), 0u);
    double best = 1e300;
    do {
      std::vector<std::size_t> at(items.size());
      for (std::size_t i = 0; i < order.size(); ++i) at[order[i]] = i;
      bool valid = true;
      for (std::size_t i = 0; i < items.size(); ++i) {
        valid = valid && (items[i].parent == 0xffffffffu || at[i] < at[items[i].parent]);
      }
      if (!valid) continue;
      std::vector<Visit> tour;
      for (const std::uint32_t i : order) tour.push_back({i, 0});
      best = std::min(best, rapids_of(items, tour, {}));
    } while (std::next_permutation(order.begin(), order.end()));
    const double got = rapids_of(items, order_items(items, {}), {});
    EXPECT_GE(got, best - 1e-9);
    ours += got;
    best_sum += best;
  }
  EXPECT_LT(ours, 1.05 * best_sum);
}

TEST(OrderItems, AllInOnePlaceIsNoProblem) {
  std::vector<OrderItem> items(3000);
  for (OrderItem& item : items) item.ways = {{{1, 1}, {1, 1}, 0}};
  const auto tour = order_items(items, {});
  expect_valid(items, tour);
  EXPECT_TRUE(order_items({}, {}).empty());
}

}  // namespace
}  // namespace burin::laser::detail
