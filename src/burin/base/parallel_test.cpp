// SPDX-License-Identifier: Apache-2.0
#include "burin/base/parallel.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
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

// The last task throws at once, one in the middle later: all below that one have run when its exception comes
// out.
TEST(Parallel, TasksBelowTheLowestThatThrewStillRun) {
  for (int round = 0; round < 20; ++round) {
    std::vector<char> done(64, 0);
    try {
      parallel_for(done.size(), 4, [&](std::size_t i, std::size_t) {
        if (i == 40) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (i >= 40) throw std::runtime_error(std::to_string(i));
        done[i] = 1;
      });
      FAIL();
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(std::string(e.what()), "40");
    }
    for (std::size_t i = 0; i < 40; ++i) EXPECT_EQ(done[i], 1) << i;
  }
}

// A worker is never in two tasks of one loop at the same time, loops within the tasks or not: its scratch
// space is its own.
TEST(Parallel, NestedLoopsKeepTheWorkerOfTheOuterOne) {
  std::vector<int> inside(3, 0);
  std::vector<std::size_t> sums(50, 0);
  parallel_for(sums.size(), 3, [&](std::size_t i, std::size_t worker) {
    EXPECT_EQ(++inside[worker], 1);
    std::vector<std::size_t> part(200, 0);
    parallel_for(part.size(), 2, [&](std::size_t k, std::size_t) { part[k] = k + i; });
    for (const std::size_t x : part) sums[i] += x;
    --inside[worker];
  });
  for (std::size_t i = 0; i < sums.size(); ++i) EXPECT_EQ(sums[i], 199 * 100 + 200 * i);
}

TEST(Parallel, ThreadsAreBounded) {
  EXPECT_GE(thread_count(0), 1U);
  EXPECT_EQ(thread_count(3), 3U);
  EXPECT_EQ(thread_count(100000), kMostThreads);
}

}  // namespace
}  // namespace burin
