// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/scene_kernels.h"

#include <gtest/gtest.h>

#include <cstring>

#include "burin/plan/orient/scene_cases.h"
#include "burin/plan/orient/scene_fit.h"
#include "burin/plan/orient/scene_tree.h"

namespace burin::orient {
namespace {

using namespace cases;
using namespace detail;

struct Asked {
  SceneNode node{};
  std::array<std::vector<std::array<Point3, 3>>, 8> triangles;
  SceneQuery query{};
  cl::Pose pose;
  std::vector<BodyPiece> body;
};

/// Eight patches, thin or not, about the pose of a tool that nearly touches some of them.
Asked asked(Random& r, int n) {
  Asked a;
  const double far = n % 3 == 0 ? 1e5 : 10;
  const Point3 origin = Point3{} + r.vector(far);
  a.pose = {origin + r.vector(10), r.direction()};
  for (int k = 0; k < 2; ++k) {
    BodyPiece p{r.between(0.1, 15), r.between(-2, 5), 0, n % 2 ? r.between(0, 1) : 0, Cause::gouge};
    p.to = p.from + r.between(0, 20);
    a.body.push_back(p);
    a.query.middle[k] = static_cast<float>(0.5 * (p.from + p.to));
    a.query.half[k] = static_cast<float>(0.5 * (p.to - p.from));
    a.query.radius[k] = static_cast<float>(p.radius);
    a.query.grow[k] = static_cast<float>(p.grow);
    a.query.size =
        std::max(a.query.size, static_cast<float>(std::max(std::abs(p.from), p.to) + p.radius + p.grow));
  }
  a.query.count = 2;
  a.query.tip[0] = a.pose.tip.x, a.query.tip[1] = a.pose.tip.y, a.query.tip[2] = a.pose.tip.z;
  a.query.axis[0] = static_cast<float>(a.pose.axis.x);
  a.query.axis[1] = static_cast<float>(a.pose.axis.y);
  a.query.axis[2] = static_cast<float>(a.pose.axis.z);
  a.query.lever[0] = 0.6F, a.query.lever[1] = -0.8F, a.query.arm = 3, a.query.corner = 1;
  a.node.origin[0] = origin.x, a.node.origin[1] = origin.y, a.node.origin[2] = origin.z;
  for (int lane = 0; lane < 8; ++lane) {
    auto& t = a.triangles[static_cast<std::size_t>(lane)];
    const Point3 middle = origin + r.vector(20);
    const Vec3 u = r.direction(), w = geom::unit(cross(u, r.direction())), v = cross(w, u);
    const double size = std::pow(10, r.between(-1, 1)), thin = size * std::pow(10, r.between(-4, 0));
    for (int i = 0; i < 4; ++i) {
      const auto corner = [&] {
        return middle + r.between(-size, size) * u + r.between(-size, size) * v + r.between(-thin, thin) * w;
      };
      t.push_back({corner(), corner(), corner()});
    }
    Mesh mesh;
    for (const auto& c : t) add(mesh, c[0], c[1], c[2]);
    const std::vector<std::uint32_t> all{0, 1, 2, 3};
    put_box(fit_box(mesh, all, all.size()), origin, lane, a.node);
  }
  return a;
}

TEST(SceneKernels, WhatIsPartedDoesNotMeet) {
  Random r(11);
  int parted = 0, kept = 0;
  for (int n = 0; n < 3000; ++n) {
    const Asked a = asked(r, n);
    SceneHits hits;
    scene_kernels_avx2().boxes(a.node, a.query, 3, hits);
    for (std::size_t lane = 0; lane < 8; ++lane)
      for (std::size_t k = 0; k < 2; ++k) {
        if (hits.hit[k] >> lane & 1) {
          ++kept;
          continue;
        }
        ++parted;
        for (const auto& t : a.triangles[lane])
          for (int i = 0; i < 12; ++i) {
            double p = r.between(0, 1), q = r.between(0, 1);
            if (i < 3) p = i == 1, q = i == 2;
            if (p + q > 1) p = 1 - p, q = 1 - q;
            EXPECT_GT(outside(t[0] + p * (t[1] - t[0]) + q * (t[2] - t[0]), a.pose, a.body[k]), 0);
          }
      }
  }
  EXPECT_GT(parted, 10000);
  EXPECT_GT(kept, 3000);
}

TEST(SceneKernels, SameBitsOnAnyProcessor) {
  Random r(12);
  for (int n = 0; n < 1000; ++n) {
    const Asked a = asked(r, n);
    for (const bool turning : {false, true}) {
      const auto run = [&](const SceneKernels& kernels) {
        SceneHits hits;
        std::memset(static_cast<void*>(&hits), 0, sizeof hits);
        (turning ? kernels.turning : kernels.boxes)(a.node, a.query, 3, hits);
        return hits;
      };
      const SceneHits any = run(scene_kernels_any()), avx2 = run(scene_kernels_avx2());
      EXPECT_EQ(std::memcmp(&any, &avx2, sizeof any), 0);
    }
  }
}

/// Every triangle stands in one packet, and within the boxes above it (a tool of one point finds it).
TEST(SceneTree, HoldsEveryTriangleOnce) {
  Random r(13);
  for (const int count : {1, 4, 5, 33, 700}) {
    Mesh mesh = soup(r, count, 20, 3);
    add_quad(mesh, {-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0}, 2, 2);
    mesh.triangles.push_back({0, 1, 1000000});
    const SceneTree tree = build_scene_tree(mesh);
    EXPECT_EQ(tree.place.back(), kNoPlace);
    for (std::size_t i = 0; i + 1 < mesh.triangles.size(); ++i) {
      const auto place = tree.place[i];
      ASSERT_LT(place / 4, tree.packets.size());
      EXPECT_EQ(tree.packets[place / 4].triangle[place % 4], i);
    }
    const model::Mill mill = flat(1, 1);
    const Scene scene(mesh, mill, {{0, 0, 0, 1e-6, Cause::collision}});
    for (std::size_t i = 0; i + 1 < mesh.triangles.size(); ++i) {
      Scene::Memory memory;
      EXPECT_TRUE(scene.blocker({mesh.vertices[mesh.triangles[i][1]], {0, 0, 1}}, memory));
    }
  }
}

}  // namespace
}  // namespace burin::orient
