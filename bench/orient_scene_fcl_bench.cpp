// SPDX-License-Identifier: Apache-2.0
// Peer of orient_scene_bench.cpp: the flexible collision library asks whether three cylinders meet the part
// (a tree of oriented boxes). The clearance is added to radius and height: cylinders with sharp rims.
#include <benchmark/benchmark.h>
#include <fcl/fcl.h>

#include <memory>

#include "orient_scene_bench_cases.h"

namespace {

using namespace burin::orient;

class Peer {
 public:
  explicit Peer(const bench::Case& c) {
    std::vector<fcl::Vector3d> vertices;
    for (const auto& p : c.mesh.vertices) vertices.emplace_back(p.x, p.y, p.z);
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : c.mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    part_.beginModel();
    part_.addSubModel(vertices, triangles);
    part_.endModel();
    for (const BodyPiece& p : bench::body())
      tool_.push_back({std::make_unique<fcl::Cylinderd>(p.radius + p.grow, p.to - p.from + 2 * p.grow),
                       0.5 * (p.from + p.to)});
  }
  bool meets(const burin::cl::Pose& pose) const {
    const Eigen::Vector3d axis(pose.axis.x, pose.axis.y, pose.axis.z);
    const Eigen::Matrix3d turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
    for (const auto& [shape, height] : tool_) {
      fcl::Transform3d at = fcl::Transform3d::Identity();
      at.linear() = turn;
      at.translation() = Eigen::Vector3d(pose.tip.x, pose.tip.y, pose.tip.z) + height * axis;
      fcl::CollisionRequestd request;
      fcl::CollisionResultd result;
      if (fcl::collide(&part_, fcl::Transform3d::Identity(), shape.get(), at, request, result) > 0)
        return true;
    }
    return false;
  }

 private:
  struct Piece {
    std::unique_ptr<fcl::Cylinderd> shape;
    double height;  ///< of its middle
  };
  fcl::BVHModel<fcl::OBBRSSd> part_;
  std::vector<Piece> tool_;
};

void fcl_poses(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const Peer peer(c);
  bench::measure_poses(state, c, [&] { return [&](const auto& pose) { return peer.meets(pose); }; });
}
BENCHMARK(fcl_poses)->Arg(10'000)->Arg(100'352)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void fcl_map(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const Peer peer(c);
  bench::measure_maps(state, c, [&] { return [&](const auto& pose) { return peer.meets(pose); }; });
}
BENCHMARK(fcl_map)->Arg(100'352)->Unit(benchmark::kMillisecond);

}  // namespace
