// SPDX-License-Identifier: Apache-2.0
// Peer of orient_scene_bench.cpp: a ray tracer. It has no test of solids, so the tool is what one can ask it:
// segments of rays along every piece's lower rim (a polygon of 64 chords), across its bottom (32 diameters)
// and up its side (64 lines), blocked by any triangle between their ends. What pokes into the tool between
// the segments goes unseen: an answer that is less than burin's, "met" says how much less.
#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include "orient_scene_bench_cases.h"

namespace {

using namespace burin::orient;
using burin::geom::Point3;
using burin::geom::Vec3;

class Peer {
 public:
  explicit Peer(const bench::Case& c)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)), body_(bench::body()) {
    const auto geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), c.mesh.vertices.size()));
    for (const Point3& p : c.mesh.vertices) {
      *v++ = static_cast<float>(p.x);
      *v++ = static_cast<float>(p.y);
      *v++ = static_cast<float>(p.z);
    }
    auto* t = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), c.mesh.triangles.size()));
    for (const auto& triangle : c.mesh.triangles)
      for (const auto k : triangle) *t++ = k;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~Peer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  bool meets(const burin::cl::Pose& pose) const {
    const Vec3 u = pose.axis, ex = unit(cross(std::abs(u.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, u)),
               ey = cross(u, ex);
    for (const BodyPiece& p : body_) {
      const double r = p.radius + p.grow, from = p.from - p.grow, to = p.to + p.grow;
      std::array<Point3, kAround> rim;
      for (std::size_t i = 0; i < kAround; ++i) {
        const double a = 2 * burin::geom::kPi * double(i) / kAround;
        rim[i] = pose.tip + from * u + r * (std::cos(a) * ex + std::sin(a) * ey);
      }
      for (std::size_t i = 0; i < kAround; ++i) {
        if (hits(rim[i], rim[(i + 1) % kAround]) || hits(rim[i], rim[i] + (to - from) * u)) return true;
        if (i < kAround / 2 && hits(rim[i], rim[i + kAround / 2])) return true;
      }
    }
    return false;
  }

 private:
  static constexpr std::size_t kAround = 64;
  bool hits(const Point3& a, const Point3& b) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    ray.org_x = static_cast<float>(a.x);
    ray.org_y = static_cast<float>(a.y);
    ray.org_z = static_cast<float>(a.z);
    ray.dir_x = static_cast<float>(b.x - a.x);
    ray.dir_y = static_cast<float>(b.y - a.y);
    ray.dir_z = static_cast<float>(b.z - a.z);
    ray.tfar = 1;
    ray.mask = ~0U;
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
  }
  RTCDevice device_;
  RTCScene scene_;
  std::vector<BodyPiece> body_;
};

void embree_poses(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const Peer peer(c);
  bench::measure_poses(state, c, [&] { return [&](const auto& pose) { return peer.meets(pose); }; });
}
BENCHMARK(embree_poses)->Arg(10'000)->Arg(100'352)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void embree_map(benchmark::State& state) {
  const auto& c = bench::the_case(static_cast<int>(state.range(0)));
  const Peer peer(c);
  bench::measure_maps(state, c, [&] { return [&](const auto& pose) { return peer.meets(pose); }; });
}
BENCHMARK(embree_map)->Arg(100'352)->Unit(benchmark::kMillisecond);

}  // namespace
