// SPDX-License-Identifier: Apache-2.0
#include "burin/io/step/references.h"

#include <gtest/gtest.h>

#include <random>

namespace burin::io::step {
namespace {

TEST(References, RandomWithoutCircles) {
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round) {
    const std::size_t n = 1 + random() % 50;
    References graph(n);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = random() % 4; k > 0 && i + 1 < n; --k)
        graph.add(i, i + 1 + random() % (n - i - 1));
    }
    EXPECT_FALSE(graph.check(100));
  }
}

TEST(References, OneEdgeBackMakesACircle) {
  std::mt19937 random(4);
  for (int round = 0; round < 100; ++round) {
    const std::size_t n = 2 + random() % 50, back = random() % (n - 1);
    References graph(n);
    for (std::size_t i = 0; i < n; ++i) graph.add(i, i + 1 < n ? i + 1 : back);
    const auto problem = graph.check(100);
    ASSERT_TRUE(problem);
    EXPECT_TRUE(problem->circle);
    EXPECT_GE(problem->entity, back);
  }
}

TEST(References, ChainsOfAMillion) {
  const std::size_t n = 1'000'000;
  References down(n), up(n);
  for (std::size_t i = 0; i + 1 < n; ++i) down.add(i, i + 1);
  for (std::size_t i = 1; i < n; ++i) up.add(i, i - 1);
  for (References* graph : {&down, &up}) {
    const auto problem = graph->check(500);
    ASSERT_TRUE(problem);
    EXPECT_FALSE(problem->circle);
  }
  References self(1);
  self.add(0, 0);
  EXPECT_TRUE(self.check(10)->circle);
}

TEST(References, DepthIsExact) {
  for (std::size_t n : {5u, 6u, 7u}) {
    References graph(n);
    for (std::size_t i = 0; i + 1 < n; ++i) graph.add(i, i + 1);
    EXPECT_EQ(graph.check(6).has_value(), n > 6) << n;  // n - 1 references
  }
}

}  // namespace
}  // namespace burin::io::step
