// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/to_cl.h"

#include <algorithm>
#include <cmath>

#include "burin/base/parallel.h"
#include "burin/plan/orient/air_ways.h"

namespace burin::orient {
namespace {

// Feed of turning ways over the part, of the feed, when none is given.
constexpr double kAirFeed = 5;
// Axes that differ by less rest.
constexpr double kResting = 1e-9;

class Writer {
 public:
  explicit Writer(const AirOptions& options) : options_(options) {
    air_mm_min_ = options.air_mm_min > 0 ? options.air_mm_min : kAirFeed * options.feed_mm_min;
    if (options.spindle_rpm > 0) out_.program.add(cl::Spindle{cl::Rotation::clockwise, options.spindle_rpm});
  }

  /// To the first pose, from wherever the machine stands.
  void begin(const cl::Pose& at) {
    out_.program.add(cl::Rapid{at});
    at_ = at;
  }

  void cut(const Run& run) {
    for (std::size_t i = 1; i < run.size(); ++i) {
      out_.cut_mm += feed(run[i].pose, options_.feed_mm_min, run[i].source);
      if (run[i].source == run[i - 1].source) ++out_.inserted;
    }
  }

  /// Through the air; the last safety_mm before a contact (`ends_at_part`) and the first after one at feed.
  void fly(const Way& way, bool starts_at_part, bool ends_at_part) {
    for (std::size_t i = 0; i < way.size(); ++i) {
      const bool resting = norm(way[i].axis - at_.axis) <= kResting;
      const double length = geom::distance(at_.tip, way[i].tip);
      if (length == 0 && resting) continue;
      const cl::Pose from = at_, to = way[i];
      const double near = std::min(1.0, length > 0 ? options_.safety_mm / length : 1.0);
      if (!resting) {
        out_.link_mm += feed(to, air_mm_min_);
      } else if (starts_at_part && i == 0) {
        out_.link_mm += feed({lerp(from.tip, to.tip, near), to.axis}, air_mm_min_);
        quick(to);
      } else if (ends_at_part && i + 1 == way.size()) {
        quick({lerp(to.tip, from.tip, near), to.axis});
        out_.link_mm += feed(to, options_.feed_mm_min);
      } else {
        quick(to);
      }
    }
  }

  ToolPath take() {
    if (options_.spindle_rpm > 0) out_.program.add(cl::Spindle{});
    return std::move(out_);
  }
  ToolPath& out() { return out_; }

 private:
  double feed(const cl::Pose& to, double mm_min, std::uint32_t source = cl::Program::kNoSource) {
    if (mm_min != feed_) out_.program.add(cl::FeedRate{feed_ = mm_min}, source);
    out_.program.add(cl::Feed{to}, source);
    const double length = geom::distance(at_.tip, to.tip);
    at_ = to;
    return length;
  }

  void quick(const cl::Pose& to) {
    if (to == at_) return;
    if (options_.air_mm_min > 0) {
      out_.link_mm += feed(to, options_.air_mm_min);
      return;
    }
    out_.program.add(cl::Rapid{to});
    out_.rapid_mm += geom::distance(at_.tip, to.tip);
    at_ = to;
  }

  const AirOptions& options_;
  double air_mm_min_ = 0, feed_ = 0;
  cl::Pose at_;
  ToolPath out_;
};

Way reversed(const Way& way, const cl::Pose& end) {
  Way back(way.rbegin() + 1, way.rend());
  back.push_back(end);
  return back;
}

}  // namespace

Result<ToolPath> to_cl(const Part& part, const Scene& scene, const MachineLimits& limits,
                       const std::vector<OrientedPath>& paths, const AirOptions& options) {
  if (!(options.feed_mm_min > 0 && options.safety_mm >= 0 && options.air_mm_min >= 0))
    return Error{ErrorCode::range, "a feed or a safety distance that is negative or none (above 0)", {}};
  const MotionCheck check(part.mesh, scene, limits, 0.5 * options.safety_mm);
  const AirWays air(part.bounds, check, options.safety_mm);
  Runs runs = cutting_runs(scene, check, paths, options.threads);
  Writer writer(options);
  writer.out().broken = std::move(runs.broken);

  std::vector<std::optional<Way>> ins(runs.runs.size()), outs(runs.runs.size());
  parallel_for(runs.runs.size(), thread_count(options.threads), [&](std::size_t i, std::size_t) {
    ins[i] = air.out(runs.runs[i].front());
    outs[i] = air.out(runs.runs[i].back());
  });
  const Run* last = nullptr;  // the run the tool stands at the end of
  Way last_out;
  for (std::size_t i = 0; i < runs.runs.size(); ++i) {
    // A run that the tool could not leave is not begun.
    const Run& run = runs.runs[i];
    const std::optional<Way>& in = ins[i];
    const std::optional<Way>& out = outs[i];
    std::optional<Way> way;
    bool lifted = false;
    if (in && out && last != nullptr) {
      way = air.across(last->back(), run.front());
      if (!way) way = air.over(last_out.back(), in->back()), lifted = true;
    }
    if (!in || !out || (last != nullptr && !way)) {
      for (const RunPoint& point : run)
        if (writer.out().stranded.empty() || writer.out().stranded.back() != point.source)
          writer.out().stranded.push_back(point.source);
      continue;
    }
    const Way down = reversed(*in, run.front().pose);
    if (last == nullptr) {
      writer.begin(in->back());
      writer.fly(down, false, true);
    } else if (lifted) {
      writer.fly(last_out, true, false);
      writer.fly(*way, false, false);
      writer.fly(down, false, true);
    } else {
      writer.fly(*way, true, true);
    }
    if (last != nullptr) ++writer.out().links;
    writer.cut(run);
    last = &run;
    last_out = *out;
  }
  if (last != nullptr) writer.fly(last_out, true, false);
  return writer.take();
}

}  // namespace burin::orient
