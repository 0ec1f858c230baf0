// SPDX-License-Identifier: Apache-2.0
// The tick never allocates, and never loops without bound, whatever is in the plan.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <new>
#include <random>

#include "burin/servo/interpolator.h"
#include "burin/servo/measure.h"
#include "burin/servo/random_curves.h"

namespace {
std::atomic<std::size_t> allocations{0};
void* counted(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
}  // namespace

// The whole test program counts.
void* operator new(std::size_t size) {
  return counted(size);
}
void* operator new[](std::size_t size) {
  return counted(size);
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete[](void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete[](void* p, std::size_t) noexcept {
  std::free(p);
}

namespace burin::servo {
namespace {

static_assert(noexcept(std::declval<Interpolator&>().tick(std::declval<Setpoint&>())));
static_assert(noexcept(std::declval<Interpolator&>().restart()));

TEST(Interpolator, AMillionTicksAllocateNothing) {
  Diagnostics diagnostics;
  std::size_t ticks = 0, planned = 0;
  for (std::uint64_t seed = 1; ticks < 1'000'000; ++seed) {
    test::RandomCurves random(seed);
    const std::size_t before_plan = allocations;
    const auto made = plan(random.curve(), random.limits(), diagnostics);
    planned += allocations - before_plan;
    ASSERT_TRUE(made.ok());
    Interpolator interpolator(*made);
    Setpoint s;
    const std::size_t before = allocations;
    while (interpolator.tick(s) == Status::running) ++ticks;
    interpolator.restart();
    interpolator.tick(s);
    ASSERT_EQ(allocations, before) << "seed " << seed;
  }
  EXPECT_GT(planned, 0u);  // the counter counts
}

/// Numbers of a plan replaced by nonsense: every tick still ends.
TEST(Interpolator, DamagedPlansDoNotHang) {
  std::mt19937_64 random(5);
  const double nonsense[] = {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity(),
                             0.0,
                             -1.0,
                             1e300,
                             1e-300};
  Diagnostics diagnostics;
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    test::RandomCurves curves(seed);
    const auto made = plan(curves.curve(), {}, diagnostics);
    ASSERT_TRUE(made.ok());
    for (int damage = 0; damage < 20; ++damage) {
      Plan broken = *made;
      if (broken.runs.empty()) continue;
      for (int k = 0; k < 3; ++k) {
        const double value = nonsense[random() % std::size(nonsense)];
        Piece& piece = broken.pieces[random() % broken.pieces.size()];
        ProfilePiece& profile = broken.profile[random() % broken.profile.size()];
        switch (random() % 6) {
          case 0:
            piece.c[random() % 5][random() % 6] = value;
            break;
          case 1:
            piece.start = value;
            break;
          case 2:
            piece.end[random() % 3] = value;
            break;
          case 3:
            profile.time = value;
            break;
          case 4:
            profile.v = value;
            break;
          default:
            broken.runs[random() % broken.runs.size()].end_piece += random() % 100;
            break;
        }
      }
      Interpolator interpolator(broken);
      Setpoint s;
      std::size_t ticks = 0;
      while (ticks < 20'000 && interpolator.tick(s) == Status::running) ++ticks;
      EXPECT_LE(ticks, broken.setpoints);
    }
  }
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(spent.count(), 60);
}

TEST(Interpolator, EmptyPlanIsDone) {
  const Plan nothing;
  Interpolator interpolator(nothing);
  Setpoint s;
  EXPECT_EQ(interpolator.tick(s), Status::done);
  EXPECT_EQ(interpolator.tick(s), Status::done);
  EXPECT_EQ(s.t_s, 0);
}

TEST(Interpolator, RestartGivesTheSame) {
  test::RandomCurves random(11);
  Diagnostics diagnostics;
  const auto made = plan(random.curve(), {}, diagnostics);
  ASSERT_TRUE(made.ok());
  const auto once = run(*made);
  Interpolator interpolator(*made);
  Setpoint s;
  for (int i = 0; i < 50; ++i) interpolator.tick(s);
  interpolator.restart();
  for (const Setpoint& wanted : once) {
    ASSERT_EQ(interpolator.tick(s), Status::running);
    ASSERT_TRUE(s.t_s == wanted.t_s && s.x == wanted.x && s.y == wanted.y && s.z == wanted.z);
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(interpolator.tick(s), Status::done);
    EXPECT_EQ(s.x, once.back().x);
    EXPECT_EQ(s.t_s, once.back().t_s);
  }
}

}  // namespace
}  // namespace burin::servo
