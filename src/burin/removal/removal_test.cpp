// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/removal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "burin/geom/mesh/check.h"
#include "burin/geom/mesh/mesh_cases.h"
#include "burin/geom/point_tools.h"
#include "burin/verify/mill_body.h"
#include "burin/verify/mill_motion.h"

namespace burin::removal {
namespace {

using geom::kPi;
using geom::Point3;
using geom::Vec3;

struct Step {
  Point3 tip;
  Vec3 axis{0, 0, 1};
  bool rapid = false;
};
verify::CheckedPath path_of(const verify::CheckedMill& tool, const std::vector<Step>& steps) {
  verify::CheckedPath path;
  verify::ToolPath t;
  t.tool = tool;
  t.from = {steps[0].tip, steps[0].axis};
  for (std::size_t i = 1; i < steps.size(); ++i) {
    t.pieces.push_back({{steps[i].tip, steps[i].axis}, static_cast<std::uint32_t>(i - 1), steps[i].rapid});
    path.moves.push_back({static_cast<std::uint32_t>(i), 0, steps[i].rapid});
  }
  path.tools.push_back(t);
  return path;
}
verify::CheckedMill mill(double radius, double corner, double length = 30) {
  return {radius, corner, length, {}};
}
RemovalOptions at(double resolution, Directions directions = Directions::automatic) {
  RemovalOptions o;
  o.resolution_mm = resolution;
  o.directions = directions;
  return o;
}
const BlockStock kBlock{{0, 0, 0}, {40, 20, 10}};

double removed(const Stock& stock, const verify::CheckedPath& path, const RemovalOptions& options) {
  auto r = remove_material(stock, path, options);
  EXPECT_TRUE(r) << r.error().to_string();
  return r ? r->removed_mm3() : -1;
}

// A slot along X through the whole block, z of the tip at 6: 4 deep.
TEST(Removal, SlotsOfAllEndsHaveTheirVolume) {
  const double r = 3, depth = 4, length = 40;
  for (const double c : {0.0, 1.0, 3.0}) {
    // Below the height of the corner: 2 (r - c) c + half a disc of radius c.
    const double section = 2 * r * (depth - c) + 2 * (r - c) * c + 0.5 * kPi * c * c;
    for (const Directions d : {Directions::one, Directions::three}) {
      const double v = removed(kBlock, path_of(mill(r, c), {{{-10, 10, 6}}, {{50, 10, 6}}}), at(0.1, d));
      EXPECT_NEAR(v, section * length, 0.003 * section * length) << "corner " << c;
    }
  }
}

void expect_closed(const geom::Mesh& mesh, double volume, double slack) {
  const geom::MeshReport report = geom::examine(mesh);
  EXPECT_TRUE(report.holes.empty());
  EXPECT_EQ(report.shared_by_many, 0U);
  EXPECT_EQ(report.against_sense, 0U);
  EXPECT_NEAR(report.signed_volume, volume, slack * volume);
}

TEST(Removal, MeshOfABlockIsTheBlock) {
  for (const Directions d : {Directions::one, Directions::three}) {
    auto r = remove_material(kBlock, {}, at(0.7, d));
    ASSERT_TRUE(r);
    EXPECT_NEAR(r->stock_mm3(), 8000, 0.01);
    EXPECT_EQ(r->removed_mm3(), 0);
    expect_closed(r->mesh(), 8000, d == Directions::three ? 1e-9 : 0.05);
  }
}

// The planes of block and slot are met exactly, round edges to the square of the step.
TEST(Removal, MeshOfASlotHasItsVolume) {
  for (const double c : {0.0, 1.0, 3.0}) {
    const auto path = path_of(mill(3, c), {{{-10, 10, 6}}, {{50, 10, 6}}});
    const double left = 8000 - 40 * (2 * 3 * (4 - c) + 2 * (3 - c) * c + 0.5 * kPi * c * c);
    auto three = remove_material(kBlock, path, at(0.3, Directions::three));
    ASSERT_TRUE(three);
    expect_closed(three->mesh(), left, c == 0 ? 1e-9 : 2e-4);
    auto one = remove_material(kBlock, path, at(0.3, Directions::one));
    ASSERT_TRUE(one);
    expect_closed(one->mesh(), left, 0.01);
  }
}

TEST(Removal, ObliqueDrillTakesItsCylinder) {
  const Vec3 axis = unit(Vec3{0.4, 0.3, 1});
  const Point3 middle{20, 10, 5};
  const double r = 3, volume = kPi * r * r * 10 / axis.z;
  const auto path = path_of(mill(r, 0), {{middle + 20 * axis, axis}, {middle - 15 * axis, axis}});
  auto result = remove_material(kBlock, path, at(0.1));
  ASSERT_TRUE(result) << result.error().to_string();
  EXPECT_NEAR(result->removed_mm3(), volume, 0.005 * volume);
  expect_closed(result->mesh(), 8000 - volume, 1e-4);
}

TEST(Removal, OrderOfTheMovesDoesNotChangeTheVolume) {
  const std::vector<Step> steps{{{5, 5, 6}, unit(Vec3{0.2, 0, 1})},
                                {{30, 12, 4}, unit(Vec3{-0.3, 0.2, 1})},
                                {{12, 18, 5}, unit(Vec3{0, 0.5, 1})}};
  const std::vector<Step> back(steps.rbegin(), steps.rend());
  const double a = removed(kBlock, path_of(mill(2, 2), steps), at(0.25)),
               b = removed(kBlock, path_of(mill(2, 2), back), at(0.25));
  EXPECT_GT(a, 100);
  EXPECT_NEAR(a, b, 1e-3);
}

// --- random five-axis motions: the clock says for every node which move took it
class RandomMotion {
 public:
  explicit RandomMotion(unsigned seed) : random_(seed) {}
  double in(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  std::vector<Step> steps(int count) {
    std::vector<Step> out;
    for (int i = 0; i < count; ++i)
      out.push_back({{in(0, 12), in(0, 12), in(2, 9)}, unit(Vec3{in(-1, 1), in(-1, 1), in(0.3, 1)}), false});
    return out;
  }

 private:
  std::mt19937 random_;
};

/// The most that the place is inside the cutter during the move.
double deepest(const verify::CheckedPath& path, std::size_t move, Point3 p) {
  const verify::ToolPath& t = path.tools[0];
  const verify::MillBody body{t.tool.radius, 0, t.tool.length, t.tool.corner_radius};
  const verify::Stretch s =
      verify::Stretch::between(move == 0 ? t.from : t.pieces[move - 1].to, t.pieces[move].to);
  double best = -1e9;
  constexpr int kMoments = 500;
  for (int i = 0; i <= kMoments; ++i) {
    const verify::Placed at = s.at(i / double(kMoments));
    best = std::max(best, verify::body_at(body, at.tip, at.axis, p).f);
  }
  return best;
}

TEST(Removal, ClockOfRandomMotionsAgreesWithManyMoments) {
  const BlockStock block{{0, 0, 0}, {12, 12, 8}};
  for (const unsigned seed : {1U, 2U, 3U}) {
    RandomMotion random(seed);
    const double r = random.in(1, 2.5);
    const auto path = path_of(mill(r, seed == 1 ? 0 : seed == 2 ? r : 0.4 * r, 12), random.steps(4));
    RemovalOptions options = at(0.1);
    options.resolution_mm = 0.2;
    options.keep_times = true;
    auto result = remove_material(block, path, options);
    ASSERT_TRUE(result) << result.error().to_string();
    const StockClock clock = result->clock(1500);
    ASSERT_EQ(clock.cut_at.size(), std::size_t{clock.count[0]} * clock.count[1] * clock.count[2]);
    ASSERT_LE(clock.cut_at.size(), 1500U);
    // Ends of cuts are known to 0.02; moments are 0.04 apart.
    const double slack = 0.05;
    std::size_t n = 0, gone = 0;
    for (std::uint32_t k = 0; k < clock.count[2]; ++k)
      for (std::uint32_t j = 0; j < clock.count[1]; ++j)
        for (std::uint32_t i = 0; i < clock.count[0]; ++i, ++n) {
          const Point3 p = clock.origin + clock.step_mm * Vec3{double(i), double(j), double(k)};
          const std::uint32_t cut = clock.cut_at[n];
          if (cut == StockClock::kEmpty) continue;
          const std::size_t last = cut == StockClock::kNever ? path.moves.size() : cut - 1;
          for (std::size_t m = 0; m < last; ++m)
            ASSERT_LE(deepest(path, m, p), slack) << "seed " << seed << " node " << n;
          if (cut == StockClock::kNever) continue;
          ASSERT_GE(deepest(path, last, p), -slack) << "seed " << seed << " node " << n;
          ++gone;
        }
    EXPECT_GT(gone, 20U);
    expect_closed(result->mesh(), result->stock_mm3() - result->removed_mm3(), 0.02);
  }
}

TEST(Removal, ClockCrossesTheFacesOfTheBlock) {
  RemovalOptions options = at(1);
  options.keep_times = true;
  auto r = remove_material(kBlock, path_of(mill(3, 0), {{{-10, 10, 6}}, {{50, 10, 6}}}), options);
  ASSERT_TRUE(r);
  const StockClock c = r->clock(30000);
  const auto index = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    return (std::size_t{k} * c.count[1] + j) * c.count[0] + i;
  };
  const auto middle = [&](int axis, double place) {
    return static_cast<std::uint32_t>((place - geom::component(c.origin, axis)) / c.step_mm);
  };
  const std::uint32_t j = middle(1, 2), k = middle(2, 3), i = middle(0, 20);
  // From outside into the block, along X: its face at 0.
  EXPECT_NEAR(c.origin.x + c.step_mm * c.crossing[3 * index(0, j, k)] / 256, 0, c.step_mm / 128);
  // Up from the floor of the slot, at 6.
  const std::uint32_t floor = middle(2, 6), in_slot = middle(1, 10);
  EXPECT_EQ(c.cut_at[index(i, in_slot, floor)], StockClock::kNever);
  EXPECT_EQ(c.cut_at[index(i, in_slot, floor + 1)], 1U);
  EXPECT_NEAR(c.origin.z + c.step_mm * (floor + c.crossing[3 * index(i, in_slot, floor) + 2] / 256.0), 6,
              c.step_mm / 128);
}

TEST(Removal, ThreadsDoNotChangeAnyBit) {
  RandomMotion random(7);
  std::vector<Step> steps = random.steps(12);
  for (std::size_t i = 0; i < steps.size(); i += 3) steps[i].rapid = true;
  verify::CheckedMill tool = mill(2, 1, 6);
  tool.cylinders = {{2.5, 6, 20, true}};
  const auto path = path_of(tool, steps);
  const BlockStock block{{0, 0, 0}, {12, 12, 8}};
  RemovalOptions options = at(0.2);
  auto one = remove_material(block, path, options);
  options.threads = 4;
  auto four = remove_material(block, path, options);
  ASSERT_TRUE(one && four);
  EXPECT_EQ(one->removed_mm3(), four->removed_mm3());
  const geom::Mesh a = one->mesh(), b = four->mesh();
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(one->contacts().size(), four->contacts().size());
  EXPECT_GT(one->contacts().size(), 3U);
  for (std::size_t i = 0; i < one->contacts().size(); ++i) {
    const StockContact &x = one->contacts()[i], &y = four->contacts()[i];
    EXPECT_TRUE(x.move == y.move && x.body == y.body && x.depth_mm == y.depth_mm &&
                x.volume_mm3 == y.volume_mm3 && x.at == y.at);
  }
}

// --- contacts
TEST(Removal, RapidThroughTheStockIsAContact) {
  // 1.5 deep, across the whole width.
  for (const Directions d : {Directions::one, Directions::three}) {
    auto r = remove_material(
        kBlock,
        path_of(mill(3, 0),
                {{{-10, 10, 20}}, {{-10, 10, 8.5}, {0, 0, 1}, true}, {{50, 10, 8.5}, {0, 0, 1}, true}}),
        at(0.2, d));
    ASSERT_TRUE(r);
    ASSERT_EQ(r->contacts().size(), 1U);
    const StockContact& c = r->contacts()[0];
    EXPECT_EQ(c.move, 1U);
    EXPECT_EQ(c.body, verify::Body::cutter);
    EXPECT_NEAR(c.depth_mm, 1.5, 1e-5);
    EXPECT_NEAR(c.volume_mm3, 360, 360 * 0.1);
    EXPECT_TRUE((geom::Box3{{0, 7, 8.5}, {40, 13, 10}}.contains(c.at)));
  }
}
TEST(Removal, WithdrawingRapidlyIsNoContact) {
  for (const double tilt : {0.0, 0.3}) {
    const Vec3 axis = unit(Vec3{tilt, 0, 1});
    const Point3 deep{20, 10, 3};
    verify::CheckedMill tool = mill(3, 1, 8);
    tool.cylinders = {{3, 8, 40, false}};
    auto r = remove_material(
        kBlock, path_of(tool, {{deep + 30 * axis, axis}, {deep, axis}, {deep + 30 * axis, axis, true}}),
        at(0.2));
    ASSERT_TRUE(r);
    EXPECT_GT(r->removed_mm3(), 100);
    EXPECT_TRUE(r->contacts().empty());
  }
}
TEST(Removal, ContactsAreDeeperThanAsked) {
  for (const double depth : {0.04, 0.06}) {
    auto r = remove_material(
        kBlock, path_of(mill(3, 0), {{{-10, 10, 10 - depth}}, {{50, 10, 10 - depth}, {0, 0, 1}, true}}),
        at(0.5));
    ASSERT_TRUE(r);
    EXPECT_EQ(r->contacts().size(), depth > 0.05 ? 1U : 0U);
  }
}
TEST(Removal, HolderInTheStockIsAContact) {
  verify::CheckedMill tool = mill(3, 0, 5);
  tool.cylinders = {{2.5, 5, 7, false}, {8, 7, 30, true}};
  // The slot is 4 deep: shank above 5, holder above 7 stay out; 8 deep the holder is 1 in the stock.
  auto r = remove_material(
      kBlock, path_of(tool, {{{-20, 10, 6}}, {{60, 10, 6}}, {{60, 10, 2}}, {{-20, 10, 2}}}), at(0.25));
  ASSERT_TRUE(r);
  ASSERT_EQ(r->contacts().size(), 1U);
  EXPECT_EQ(r->contacts()[0].body, verify::Body::holder);
  EXPECT_EQ(r->contacts()[0].move, 2U);
  EXPECT_NEAR(r->contacts()[0].depth_mm, 1, 1e-5);
}

// --- stocks
TEST(Removal, TurnedCylinderKeepsItsCore) {
  const CylinderStock bar{{0, 0, 0}, {1, 0, 0}, 10, 12};
  std::vector<Step> steps;
  const int per_turn = 60;
  for (int i = 0; i <= 9 * per_turn; ++i) {
    const double a = 2 * kPi * i / per_turn, x = -3 + 2.0 * i / per_turn;
    const Vec3 out{0, std::sin(a), std::cos(a)};
    steps.push_back({Point3{x, 0, 0} + 8 * out, out});
  }
  auto r = remove_material(bar, path_of(mill(3, 0), steps), at(0.2));
  ASSERT_TRUE(r);
  EXPECT_NEAR(r->stock_mm3(), kPi * 100 * 12, kPi * 100 * 12 * 0.003);
  const double left = r->stock_mm3() - r->removed_mm3(), chord = 8 * std::cos(kPi / per_turn);
  EXPECT_GE(left, kPi * chord * chord * 12 * 0.996);
  EXPECT_LE(left, kPi * 64 * 12 * 1.004);
  expect_closed(r->mesh(), kPi * 64 * 12, 0.006);
}

TEST(Removal, MeshStocksAreWhatTheyAre) {
  const geom::Mesh ball = geom::cases::sphere(40, 20, {1, 2, 3}, 6);
  const double volume = geom::examine(ball).signed_volume;
  auto r = remove_material(MeshStock{ball}, {}, at(0.2, Directions::three));
  ASSERT_TRUE(r) << r.error().to_string();
  EXPECT_NEAR(r->stock_mm3(), volume, 0.002 * volume);
  expect_closed(r->mesh(), volume, 0.002);
  // Corners and edges on the lines themselves: the box of a block, its diagonals, a hollow in it.
  geom::Mesh box = geom::cases::box({0, 0, 0}, {4, 4, 4}), hollow = geom::cases::box({1, 1, 1}, {3, 3, 3});
  for (const Point3& p : hollow.vertices) box.vertices.push_back(p);
  for (const auto& t : hollow.triangles) box.triangles.push_back({t[0] + 8, t[2] + 8, t[1] + 8});
  auto b = remove_material(MeshStock{box}, {}, at(0.5, Directions::three));
  ASSERT_TRUE(b);
  EXPECT_NEAR(b->stock_mm3(), 64 - 8, 1e-4);
  expect_closed(b->mesh(), 64 - 8, 1e-6);
}

// --- what is refused
std::string refused(const Stock& stock, const verify::CheckedPath& path, const RemovalOptions& options) {
  auto r = remove_material(stock, path, options);
  EXPECT_FALSE(r);
  return r ? "" : r.error().message;
}
TEST(Removal, RefusesWhatIsNoStock) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refused(BlockStock{{0, 0, 0}, {1, nan, 1}}, {}, at(1)), "");
  EXPECT_NE(refused(BlockStock{{0, 0, 0}, {1, 0, 1}}, {}, at(1)), "");
  EXPECT_NE(refused(CylinderStock{{0, 0, 0}, {1, 1, 0}, 2, 3}, {}, at(1)), "");
  EXPECT_NE(refused(CylinderStock{{0, 0, 0}, {1, 0, 0}, -2, 3}, {}, at(1)), "");
  geom::Mesh box = geom::cases::box({0, 0, 0}, {4, 4, 4});
  geom::Mesh open = box, inside_out = box, astray = box, flat = box;
  open.triangles.pop_back();
  EXPECT_NE(refused(MeshStock{open}, {}, at(1)).find("open along 3 edges"), std::string::npos);
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_NE(refused(MeshStock{inside_out}, {}, at(1)).find("inside out"), std::string::npos);
  astray.triangles[3][1] = 99;
  EXPECT_NE(refused(MeshStock{astray}, {}, at(1)).find("triangle 3"), std::string::npos);
  for (auto& p : flat.vertices) p.z = 0;
  EXPECT_NE(refused(MeshStock{flat}, {}, at(1)), "");
  EXPECT_NE(refused(MeshStock{}, {}, at(1)), "");
}
TEST(Removal, RefusesImpossiblePathsAndSizes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto good = [](const verify::CheckedMill& m) { return path_of(m, {{{0, 0, 5}}, {{1, 0, 5}}}); };
  EXPECT_NE(refused(kBlock, good(mill(nan, 0)), at(1)), "");
  EXPECT_NE(refused(kBlock, good(mill(2, 3)), at(1)), "");
  EXPECT_NE(refused(kBlock, path_of(mill(2, 0), {{{0, 0, 5}}, {{nan, 0, 5}}}), at(1)).find("move 0"),
            std::string::npos);
  EXPECT_NE(refused(kBlock, path_of(mill(2, 0), {{{0, 0, 5}}, {{1, 0, 5}, {0, 0, 2}}}), at(1)).find("move 0"),
            std::string::npos);
  EXPECT_NE(
      refused(kBlock, path_of(mill(2, 0), {{{0, 0, 5}}, {{1, 0, 5}, {0, 0, -1}}}), at(1)).find("half a turn"),
      std::string::npos);
  EXPECT_NE(
      refused(kBlock, path_of(mill(2, 0), {{{0, 0, 5}}, {{1, 0, 5}, {0, 1, 0}}}), at(1, Directions::one))
          .find("tilted"),
      std::string::npos);
  EXPECT_NE(refused(kBlock, {}, at(nan)), "");
  // 40 x 20 x 10 at a nanometre: refused before anything is allocated, and what it says would do does.
  const std::string message = refused(kBlock, {}, at(1e-6));
  const std::size_t of = message.find("resolution of ");
  ASSERT_NE(of, std::string::npos) << message;
  const double would_do = std::stod(message.substr(of + 14));
  RemovalOptions options = at(would_do);
  options.max_dexels = 20'000'000;
  EXPECT_GT(would_do, 0.005);
  EXPECT_LE(would_do, 0.007);
  options.resolution_mm = 1;
  options.max_dexels = 200;
  EXPECT_NE(refused(kBlock, {}, options), "");
  options.max_dexels = 800;
  EXPECT_TRUE(remove_material(kBlock, {}, options));
}

}  // namespace
}  // namespace burin::removal
