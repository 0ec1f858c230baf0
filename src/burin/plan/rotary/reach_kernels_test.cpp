// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>

#include "burin/plan/rotary/reach_cases.h"
#include "burin/plan/rotary/reach_exact.h"
#include "burin/plan/rotary/reach_kernels.h"

namespace burin::rotary {
namespace {

using namespace detail;
using cases::Random;
using geom::kPi;

LeafBlock random_leaf(Random& r, double size) {
  LeafBlock leaf;
  for (int k = 0; k < 4; ++k) {
    const double x = r.between(-3, 3), y = r.between(-12, 12), z = r.between(-12, 12);
    for (int i = 0; i < 3; ++i) {
      leaf.x[i][k] = x + r.between(-size, size);
      leaf.y[i][k] = y + r.between(-size, size);
      leaf.z[i][k] = z + r.between(-size, size);
    }
  }
  return leaf;
}

Corners corners_of(const LeafBlock& leaf, int k) {
  Corners c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = {leaf.x[i][k], leaf.y[i][k], leaf.z[i][k]};
  return c;
}

ReachGap gap(double lo, double hi) {
  const double mid = 0.5 * (lo + hi);
  return {{std::cos(lo), std::sin(lo)},
          {std::cos(hi), std::sin(hi)},
          {std::cos(mid), std::sin(mid)},
          std::cos(0.5 * (hi - lo)),
          std::sin(0.5 * (hi - lo))};
}

/// Arcs of the kernel are those of the slow way; what the bounds call outside of a gap does not meet it.
TEST(ReachKernels, ArcsAsTheSlowWayAndBoundsHold) {
  Random r(3);
  const ReachKernels& kernels = reach_kernels_avx2();
  int met = 0, unsure = 0, outside = 0;
  for (int n = 0; n < 20000; ++n) {
    const LeafBlock leaf = random_leaf(r, std::pow(10, r.between(-2, 1)));
    Piece piece{0, std::numeric_limits<double>::infinity(), r.between(0.5, 3)};
    if (r.integer(0, 1) == 1) piece.h0 = r.between(0, 10);
    const double lo = r.between(-kPi, kPi), hi = lo + r.between(0.01, 2);
    const ReachGap g = gap(lo, hi);
    const ReachQuery query{0, 0, 0, piece.h0, piece.h1, piece.radius, &g, 1};
    ReachFound bounds, found;
    kernels.triangles(leaf, query, bounds);
    kernels.exact(leaf, query, found);
    for (int k = 0; k < 4; ++k) {
      Arcs slow, fast;
      forbid_exactly(corners_of(leaf, k), piece, slow);
      const AngleSet expected = slow.gaps();
      const bool none = total(expected) > 2 * kPi - 1e-6;
      if (found.unsure >> k & 1) {
        ++unsure;
      } else if (found.meets >> k & 1) {
        ++met;
        fast.add(found.lo[k], found.hi[k]);
        EXPECT_NEAR(total(fast.gaps()), total(expected), 2e-6);
        EXPECT_LE(expected.size(), 1u);
        for (const AngleInterval& i : expected) {
          EXPECT_TRUE(contains(fast.gaps(), i.lo + 1e-6) || i.hi - i.lo < 3e-6);
          EXPECT_TRUE(contains(fast.gaps(), i.hi - 1e-6) || i.hi - i.lo < 3e-6);
        }
      } else {
        EXPECT_TRUE(none);
      }
      EXPECT_TRUE(none || (bounds.meets >> k & 1));
      if ((bounds.meets >> k & 1) && bounds.depth[k] < 0) {
        ++outside;
        for (int j = 0; j <= 10; ++j) EXPECT_TRUE(contains(expected, lo + (hi - lo) * j / 10));
      }
    }
  }
  EXPECT_GT(met, 5000);
  EXPECT_GT(unsure, 500);
  EXPECT_GT(outside, 5000);
}

TEST(ReachKernels, SameBitsOnAnyProcessor) {
  Random r(4);
  for (int n = 0; n < 5000; ++n) {
    const LeafBlock leaf = random_leaf(r, std::pow(10, r.between(-2, 1)));
    NodeBlock node{};
    for (int k = 0; k < 4; ++k) {
      const double a = r.between(-2, 2);
      node.c[k] = std::cos(a);
      node.s[k] = std::sin(a);
      node.tilt[k] = r.between(-2, 2);
      node.x0[k] = r.between(-4, 3);
      node.x1[k] = node.x0[k] + r.between(0, 2);
      node.u0[k] = r.between(-10, 10);
      node.u1[k] = node.u0[k] + r.between(0, 3);
      node.v0[k] = r.between(-10, 10);
      node.v1[k] = node.v0[k] + r.between(0, 3);
    }
    const ReachGap g[2] = {gap(0.3, 1.2), gap(2, 3.5)};
    const ReachQuery query{
        r.between(-1, 1), r.between(-1, 1), r.between(-1, 1), n % 2 ? 0 : 4.0, 1e3, 2, g, n % 3};
    const auto same = [&](const char* what, auto run) {
      ReachFound any, avx2;
      std::memset(static_cast<void*>(&any), 0, sizeof any);
      std::memset(static_cast<void*>(&avx2), 0, sizeof avx2);
      run(reach_kernels_any(), any);
      run(reach_kernels_avx2(), avx2);
      EXPECT_EQ(std::memcmp(&any, &avx2, sizeof any), 0) << what;
    };
    same("boxes", [&](const ReachKernels& k, ReachFound& out) { k.boxes(node, query, out); });
    same("triangles", [&](const ReachKernels& k, ReachFound& out) { k.triangles(leaf, query, out); });
    same("exact", [&](const ReachKernels& k, ReachFound& out) { k.exact(leaf, query, out); });
  }
}

}  // namespace
}  // namespace burin::rotary
