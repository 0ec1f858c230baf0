// SPDX-License-Identifier: Apache-2.0
#include "burin/view/cycle_html.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "burin/view/cycle_sample.h"
#include "burin/view/cycle_track.h"
#include "burin/view/encode.h"
#include "burin/view/page_test_support.h"
#include "burin/view/surface_mesh.h"
#include "burin/view/track_labels.h"

namespace burin::view {
namespace {

using sample::Cover;

using test::data_of;
using test::decode64;
using test::expect_closed_page;

TEST(Encode, Base64KnowsTheVectorsOfRfc4648) {
  const auto of = [](const std::string& s) { return base64(std::vector<std::uint8_t>(s.begin(), s.end())); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foob"), "Zm9vYg==");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(decode64(base64(std::vector<std::uint16_t>{0x1234, 0xff00})), std::string("\x34\x12\x00\xff", 4));
  EXPECT_EQ(decode64(base64(std::vector<float>{1.0f})), std::string("\x00\x00\x80\x3f", 4));
}

TEST(Encode, TemplatesAreFilledInOnePass) {
  EXPECT_EQ(fill_template("<@A@|@B@|@C@>", {{"@A@", "@B@"}, {"@B@", "@A@"}}), "<@B@|@A@|@C@>");
  EXPECT_EQ(fill_template("", {{"@A@", "x"}}), "");
  EXPECT_EQ(html_text("<a b=\"c\">&\x01\n"), "&lt;a b=&quot;c&quot;&gt;&amp;\n");
  EXPECT_EQ(script_safe("</script>"), "\\u003c/script>");
}

TEST(SurfaceMesh, LiesOnTheSurfaceAndStaysWithinItsNumber) {
  const Cover cover(4);
  std::vector<const geom::NurbsSurface*> list;
  for (const auto& p : cover.patches) list.push_back(&p);
  list.push_back(&cover.composite.surfaces[0].surface);
  for (const std::size_t most : {100u, 1000u, 12000u, 1'000'000u}) {
    std::size_t n = 0;
    const std::vector<SurfaceMesh> meshes = sample_surfaces(list, most);
    for (std::size_t k = 0; k < list.size(); ++k) {
      const SurfaceMesh& m = meshes[k];
      ASSERT_EQ(m.points.size(), m.u.size() * m.v.size());
      ASSERT_EQ(m.normals.size(), m.points.size());
      EXPECT_EQ(m.u.front(), list[k]->knots_u.front());
      EXPECT_EQ(m.u.back(), list[k]->knots_u.back());
      EXPECT_EQ(m.v.back(), list[k]->knots_v.back());
      n += m.points.size();
      for (std::size_t i = 0; i < m.points.size(); i += 7) {
        const geom::Point3 p = m.points[i];
        EXPECT_NEAR(p.z, sample::height(p.x, p.y), 0.01);  // the cubics' own error
        EXPECT_NEAR(norm(m.normals[i]), 1, 1e-12);
        EXPECT_GT(m.normals[i].z, 0.5);
      }
      for (const int i : m.iso_u) EXPECT_LT(static_cast<std::size_t>(i), m.u.size());
      EXPECT_EQ(static_cast<std::size_t>(m.iso_v.back()), m.v.size() - 1);
    }
    EXPECT_LE(n, std::max<std::size_t>(most, 4 * list.size()));
  }
}

TEST(SurfaceMesh, EdgesHaveTheNormalsOfBothSides) {
  // A roof: degree 1 with a ridge at u = 1.
  geom::NurbsSurface roof{1, 1, 3, 2, {0, 0, 1, 2, 2}, {0, 0, 1, 1}, {}};
  for (const double y : {0.0, 5.0}) {
    for (const auto& [x, z] : {std::pair{0.0, 0.0}, {3.0, 3.0}, {6.0, 0.0}})
      roof.points.push_back(geom::homogeneous({x, y, z}, 1));
  }
  const SurfaceMesh m = sample_surfaces({&roof}, 1000)[0];
  const auto ridge = static_cast<std::size_t>(nearest_line(m.u, 1));
  ASSERT_EQ(m.u[ridge], 1);
  ASSERT_EQ(m.u[ridge + 1], 1);
  EXPECT_NEAR(m.normals[ridge].x, -std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(m.normals[ridge + 1].x, std::sqrt(0.5), 1e-12);
}

TEST(TrackLabels, EverySetpointIsTheMotionItCameFrom) {
  const Cover cover(12);
  const TrackLabels labels = label_setpoints(cover.picture());
  ASSERT_EQ(labels.of_sample.size(), cover.setpoints.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cover.setpoints.size(); ++i) {
    const TrackLabel& l = labels.labels[labels.of_sample[i]];
    // Lengths of the setpoints' chords against the motions' nodes: the ends may be off by one.
    const bool border = i == 0 || i + 1 == cover.truth.size() || cover.truth[i - 1] != cover.truth[i] ||
                        cover.truth[i + 1] != cover.truth[i];
    if (l.kind != cover.truth[i] && !border) ++wrong;
    if (cover.truth[i] == TrackKind::cut) {
      EXPECT_EQ(l.kind, TrackKind::cut);
      EXPECT_EQ(l.group, i < cover.setpoints.size() / 2 ? 0 : 1);
      EXPECT_EQ(l.surface, 0);
      EXPECT_EQ(l.pass, cover.setpoints[i].pass);
    }
  }
  EXPECT_EQ(wrong, 0u);
}

/// Three machinings of different composites, or of one: numbers over the program and in the group.
TEST(TrackLabels, SurfacesCountOverTheProgramOrInTheirGroup) {
  const Cover cover(6);
  geom::Composite other = cover.composite;
  CyclePicture picture = cover.picture();
  picture.groups.push_back(picture.groups[0]);
  picture.groups[2].composite = &other;
  const std::size_t n = cover.setpoints.size();
  for (const int number : {0, 1}) {
    std::vector<servo::Setpoint> setpoints = cover.setpoints;
    for (std::size_t i = 0; i < n / 2; ++i) {
      setpoints.push_back(cover.setpoints[i]);
      if (setpoints.back().surface == 0) setpoints.back().surface = number;
    }
    picture.setpoints = &setpoints;
    const TrackLabels labels = label_setpoints(picture);
    for (std::size_t i = 0; i < setpoints.size(); ++i) {
      if (setpoints[i].pass < 0) continue;
      ASSERT_EQ(labels.labels[labels.of_sample[i]].group, i < n / 2 ? 0 : i < n ? 1 : 2) << i;
      ASSERT_EQ(labels.labels[labels.of_sample[i]].surface, 0);
    }
  }
}

/// Largest distances of the samples from the thinned way, each between its kept neighbours.
void expect_within(const Cover& cover, const Track& track) {
  ASSERT_GE(track.points.size(), 2u);
  EXPECT_EQ(track.points.front().index, 0u);
  EXPECT_EQ(track.points.back().index, cover.setpoints.size() - 1);
  for (std::size_t k = 1; k < track.points.size(); ++k) {
    const TrackPoint &a = track.points[k - 1], &b = track.points[k];
    ASSERT_LT(a.index, b.index);
    for (std::size_t i = a.index; i <= b.index; ++i) {
      const double f = static_cast<double>(i - a.index) / static_cast<double>(b.index - a.index);
      const geom::Point3 p = lerp(a.p, b.p, f);
      const servo::Setpoint& s = cover.setpoints[i];
      ASSERT_LE(std::max({std::abs(p.x - s.x), std::abs(p.y - s.y), std::abs(p.z - s.z)}),
                track.position_mm * 1.000001);
      ASSERT_LE(std::abs(a.feed + f * (b.feed - a.feed) - s.feed_mm_min), track.feed_mm_min * 1.000001);
    }
  }
}

TEST(Track, WhatIsLeftOutLiesWithinTheToleranceThatIsStated) {
  const Cover cover(16);
  for (const std::size_t most : {100'000u, 5'000u, 1'500u}) {
    TrackLimits limits;
    limits.most_points = most;
    const Track track = make_track(cover.picture(), limits);
    EXPECT_LE(track.points.size(), most);
    EXPECT_GT(track.position_mm, 0);
    expect_within(cover, track);
  }
}

TEST(Track, ExtremesStay) {
  const Cover cover(16);
  TrackLimits limits;
  limits.most_points = 1000;
  const Track track = make_track(cover.picture(), limits);
  double feed = 0, axis = 0, true_feed = 0, true_axis = 0;
  for (const TrackPoint& p : track.points) {
    feed = std::max(feed, p.feed);
    axis = std::max(axis, p.axis);
  }
  for (std::size_t i = 0; i < cover.setpoints.size(); ++i) {
    true_feed = std::max(true_feed, cover.setpoints[i].feed_mm_min);
    if (i == 0 || i + 1 == cover.setpoints.size()) continue;
    const auto &a = cover.setpoints[i - 1], &b = cover.setpoints[i], &c = cover.setpoints[i + 1];
    for (const double d : {a.x - 2 * b.x + c.x, a.y - 2 * b.y + c.y, a.z - 2 * b.z + c.z})
      true_axis = std::max(true_axis, std::abs(d) / (sample::kPeriod * sample::kPeriod));
  }
  EXPECT_EQ(feed, true_feed);
  EXPECT_NEAR(axis, true_axis, 1e-4 * true_axis);
}

TEST(Track, NoiseIsStillBounded) {
  Cover cover(6);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (auto& s : cover.setpoints) {
    s.x += noise(random);
    s.feed_mm_min = 1000 * std::abs(noise(random));
    s.pass = static_cast<int>(random() % 50);  // and labels that change all the time
    s.surface = 0;
  }
  TrackLimits limits;
  limits.most_points = 700;
  limits.most_rows = 20;
  const Track track = make_track(cover.picture(), limits);
  EXPECT_LE(track.points.size(), 701u);
  EXPECT_LE(track.rows.size(), 20u);
  EXPECT_LE(track.runs.size(), track.points.size());
}

TEST(Track, RowsHaveTheFiguresOfThePlanAndTheSetpoints) {
  const Cover cover(12);
  const Track track = make_track(cover.picture());
  ASSERT_EQ(track.rows.size(), 24u);
  for (std::size_t i = 0; i < track.rows.size(); ++i) {
    const PassRow& r = track.rows[i];
    EXPECT_EQ(r.group, static_cast<int>(i / 12));
    EXPECT_EQ(r.pass, static_cast<int>(i % 12));
    EXPECT_EQ(std::isnan(r.scallop_max), r.pass == 0);
    if (r.pass > 0) {
      EXPECT_EQ(r.scallop_max, cover.plan.figures[static_cast<std::size_t>(r.pass - 1)].scallop_max);
    }
    EXPECT_NEAR(r.length, geom::length(cover.plan.motions[static_cast<std::size_t>(2 + 2 * r.pass)].path),
                0.02);
    EXPECT_NEAR(r.feed_max, sample::kFeed, 1e-6);
    EXPECT_EQ(r.last_pass, r.pass == 11);
    EXPECT_EQ(r.lift > 0, r.pass >= 4 && r.pass < 7);
  }
}

TEST(Track, LiftIsTheHeightAboveWhereTheSurfaceWouldHaveTheTip) {
  const Cover cover(12);
  const Track track = make_track(cover.picture());
  std::size_t lifted = 0, flat = 0;
  for (const TrackRun& run : track.runs) {
    if (run.label.kind != TrackKind::cut || run.label.lift_max == 0) continue;
    for (std::size_t i = run.first; i < track.points.size(); ++i) {
      if (&run != &track.runs.back() && i >= (&run + 1)->first) break;
      const double d = (track.points[i].p.x - 110 * run.label.group - 45) / 10;
      // The path leaves x a little for the slope, the patches the true surface by their own error.
      const double expected = std::abs(d) < 1 ? sample::kBump * std::pow(1 - d * d, 3) : 0;
      EXPECT_NEAR(track.points[i].lift, expected, 0.12);
      (track.points[i].lift > 0.3 ? lifted : flat) += 1;
    }
  }
  EXPECT_GT(lifted, 10u);
  EXPECT_GT(flat, 10u);
  EXPECT_NEAR(track.lift_max, sample::kBump, 0.01);
}

TEST(Track, TheBallTouchesTheSurface) {
  const Cover cover(12);
  const Track track = make_track(cover.picture());
  std::size_t cuts = 0;
  for (std::size_t r = 0; r < track.runs.size(); ++r) {
    const TrackRun& run = track.runs[r];
    const std::size_t end = r + 1 < track.runs.size() ? track.runs[r + 1].first : track.points.size();
    for (std::size_t i = run.first; i < end; ++i) {
      const TrackPoint& p = track.points[i];
      if (run.label.kind != TrackKind::cut) {
        EXPECT_EQ(p.normal, (geom::Vec3{0, 0, 1}));
        continue;
      }
      if (run.label.lift_max > 0) continue;
      // The sample's u, v are the place of the contact.
      const geom::Point3 c = p.p + sample::kRadius * (geom::Vec3{0, 0, 1} - p.normal);
      EXPECT_NEAR(c.z, sample::height(c.x - 110 * run.label.group, c.y), 0.02);
      ++cuts;
    }
  }
  EXPECT_GT(cuts, 100u);
}

TEST(Track, WithoutSetpointsTheMotionsAreDrawn) {
  const Cover cover(6);
  CyclePicture picture = cover.picture();
  picture.setpoints = nullptr;
  const Track track = make_track(picture);
  EXPECT_FALSE(track.timed);
  double length = 0;
  for (std::size_t i = 1; i < track.points.size(); ++i)
    length += distance(track.points[i - 1].p, track.points[i].p);
  double expected = 110;  // from the first group's end to the second's start
  for (const auto& m : cover.plan.motions) expected += 2 * geom::length(m.path);
  EXPECT_NEAR(length, expected, 1e-3 * expected);
  EXPECT_NEAR(track.points.back().index * track.step, expected, 2e-3 * expected);
  EXPECT_EQ(track.rows.size(), 12u);
  EXPECT_FALSE(data_of(cycle_html(picture))["track"]["timed"].get<bool>());
}

TEST(CycleHtml, IsOnePageWhoseDataParsesAndCannotEscape) {
  const Cover cover(8);
  const std::string page = cycle_html(cover.picture());
  expect_closed_page(page);
  test::expect_balanced(page);
  EXPECT_NE(page.find("<title>cover &lt;&amp;&gt; &quot;@DATA@&quot;"), std::string::npos);
  const auto data = data_of(page);
  EXPECT_EQ(data["title"].get<std::string>().substr(0, 21), "cover <&> \"@DATA@\" \xef\xbf");
  EXPECT_EQ(data["groups"].size(), 2u);
  EXPECT_EQ(data["groups"][0]["patches"].size(), 9u);
  EXPECT_EQ(data["groups"][0]["surfaces"][0]["joints"].size(), 4u);
  EXPECT_EQ(data["meshes"].size(), 10u) << "the repeat shares its meshes";
  EXPECT_EQ(data["warnings"].size(), 2u);
  EXPECT_EQ(data["nc"].get<std::string>(), cover.picture().nc_text);
  const std::size_t n = data["track"]["n"];
  EXPECT_EQ(decode64(data["track"]["xyz"].get<std::string>()).size(), 12 * n);
  EXPECT_EQ(decode64(data["track"]["feed"].get<std::string>()).size(), 2 * n);
  const std::string index = decode64(data["track"]["index"].get<std::string>());
  std::uint32_t last = 0;
  std::memcpy(&last, index.data() + index.size() - 4, 4);
  EXPECT_EQ(last, cover.setpoints.size() - 1);
}

TEST(CycleHtml, SamePictureSameBytes) {
  const Cover a(8), b(8);
  EXPECT_EQ(cycle_html(a.picture()), cycle_html(b.picture()));
}

TEST(CycleHtml, StaysBelowSixMegabytes) {
  Cover cover(6);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (int k = 0; cover.setpoints.size() < 250'000; ++k) {
    servo::Setpoint s = cover.setpoints[static_cast<std::size_t>(k)];
    s.x += noise(random);
    s.pass = k / 8;
    s.surface = 0;
    cover.setpoints.push_back(s);
  }
  CyclePicture picture = cover.picture();
  picture.nc_text = std::string(3'000'000, '\n');
  for (int k = 0; k < 4000; ++k) cover.diagnostics.info("many", "message " + std::to_string(k));
  const std::string page = cycle_html(picture);
  EXPECT_LT(page.size(), 6'000'000u);
  EXPECT_EQ(data_of(page)["warningCount"], 4002);
}

TEST(CycleHtml, NothingAtAllIsAPageToo) {
  const CyclePicture nothing;
  EXPECT_EQ(data_of(cycle_html(nothing))["track"]["n"], 0);
  Cover cover(4);
  CyclePicture bare = cover.picture();
  for (CycleGroup& g : bare.groups) {
    g.composite = nullptr;
    g.plan = nullptr;
    g.patch_names.clear();
  }
  cover.setpoints[5].x = std::nan("");
  EXPECT_EQ(data_of(cycle_html(bare))["groups"][0]["surfaces"].size(), 0u);
}

}  // namespace
}  // namespace burin::view
