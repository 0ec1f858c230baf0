// SPDX-License-Identifier: Apache-2.0
#include "burin/base/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace burin {
namespace {

TEST(Parallel, EveryTaskOnceAndWorkersInRange) {
  for (const unsigned threads : {0U, 1U, 2U, 7U}) {
    std::vector<int> done(1000, 0);
    std::vector<std::size_t> by(done.size(), 99);
    parallel_for(done.size(), threads, [&](std::size_t i, std::size_t worker) {
      ++done[i];
      by[i] = worker;
    });
    for (std::size_t i = 0; i < done.size(); ++i) {
      EXPECT_EQ(done[i], 1);
      EXPECT_LT(by[i], std::max(1U, threads));
    }
  }
  parallel_for(0, 4, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(Parallel, ThrowsWhatTheLowestTaskThrew) {
  for (const unsigned threads : {1U, 4U}) {
    try {
      parallel_for(200, threads, [](std::size_t i, std::size_t) {
        if (i >= 20) throw std::runtime_error(std::to_string(i));
      });
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(std::string(e.what()), "20");
    }
  }
}

TEST(Parallel, ThreadsAreBounded) {
  EXPECT_GE(thread_count(0), 1U);
  EXPECT_EQ(thread_count(3), 3U);
  EXPECT_EQ(thread_count(100000), kMostThreads);
}

}  // namespace
}  // namespace burin
