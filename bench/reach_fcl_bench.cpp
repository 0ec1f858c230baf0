// SPDX-License-Identifier: Apache-2.0
// Peer of reach_bench.cpp: the flexible collision library asks for one angle whether ball, shank and holder,
// as sphere and cylinders, meet the part (a tree of oriented boxes).
#include <benchmark/benchmark.h>
#include <fcl/fcl.h>

#include <memory>

#include "reach_bench_cases.h"

namespace {

using namespace burin::rotary;

struct Upright {
  std::unique_ptr<fcl::CollisionGeometryd> shape;
  double height;  // of its middle above the ball's centre
};

std::vector<Upright> upright(const burin::model::BallTool& tool) {
  std::vector<Upright> out;
  out.push_back({std::make_unique<fcl::Sphered>(tool.radius * 0.999), 0});
  out.push_back(
      {std::make_unique<fcl::Cylinderd>(tool.shank_radius, tool.shank_length), 0.5 * tool.shank_length});
  double at = tool.shank_length;
  for (const auto& piece : tool.holder) {
    out.push_back({std::make_unique<fcl::Cylinderd>(piece.radius, piece.height), at + 0.5 * piece.height});
    at += piece.height;
  }
  return out;
}

void fcl_reach(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  std::vector<fcl::Vector3d> vertices;
  for (const auto& p : c.mesh.vertices) vertices.emplace_back(p.x, p.y, p.z);
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : c.mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  fcl::BVHModel<fcl::OBBRSSd> part;
  part.beginModel();
  part.addSubModel(vertices, triangles);
  part.endModel();
  const auto tool = upright(state.range(1) == 0 ? bench::tool() : bench::short_tool());
  std::size_t met = 0;
  for (auto _ : state) {
    met = 0;
    for (std::size_t i = 0; i < c.centers.size(); ++i) {
      const auto& p = c.centers[i];
      // Along the first axis of the paper, from the part's axis through the centre: seldom in the part.
      const double theta = std::atan2(p.y, p.z);
      const Eigen::Matrix3d turn = Eigen::AngleAxisd(-theta, Eigen::Vector3d::UnitX()).toRotationMatrix();
      bool hit = false;
      for (std::size_t k = 0; k < tool.size() && !hit; ++k) {
        fcl::Transform3d at = fcl::Transform3d::Identity();
        at.linear() = turn;
        at.translation() = Eigen::Vector3d(p.x, p.y, p.z) + tool[k].height * turn.col(2);
        fcl::CollisionRequestd request;
        fcl::CollisionResultd result;
        hit = fcl::collide(&part, fcl::Transform3d::Identity(), tool[k].shape.get(), at, request, result) > 0;
      }
      met += hit;
    }
    benchmark::DoNotOptimize(met);
  }
  const auto n = static_cast<double>(c.centers.size());
  state.SetLabel(state.range(1) == 0 ? "one angle" : "one angle, short shank");
  state.counters["met"] = static_cast<double>(met) / n;
  state.counters["million_per_s"] =
      benchmark::Counter(n * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(fcl_reach)->ArgsProduct({{10'000, 100'000, 1'000'000}, {0, 1}})->Unit(benchmark::kMillisecond);

}  // namespace
