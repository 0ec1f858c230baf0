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

Way reversed(const Way& way, const cl::Pose& end) {
  Way back(way.rbegin() + 1, way.rend());
  back.push_back(end);
  return back;
}

/// From an end of a run into the open: along the run itself, whose moves are proven either way round, to the
/// nearest place from which there is a way out (0: the end itself).
struct Exit {
  std::size_t along = 0;
  Way out;
};
std::optional<Exit> exit_of(const AirWays& air, const Run& run, bool from_front) {
  // Places that are tried along a run.
  constexpr std::size_t kTries = 40;
  const std::size_t step = std::max<std::size_t>(1, run.size() / kTries);
  for (std::size_t k = 0; k < run.size(); k += step)
    if (auto way = air.out(from_front ? run[k] : run[run.size() - 1 - k])) return Exit{k, std::move(*way)};
  return std::nullopt;
}

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

  /// From the end of a run into the open, and from there to the begin of one.
  void leave(const Run& run, const Exit& exit) {
    for (std::size_t k = 1; k <= exit.along; ++k)
      out_.link_mm += feed(run[run.size() - 1 - k].pose, options_.feed_mm_min);
    fly(exit.out, true, false);
  }
  void enter(const Run& run, const Exit& exit) {
    fly(reversed(exit.out, run[exit.along].pose), false, true);
    for (std::size_t k = exit.along; k-- > 0;) out_.link_mm += feed(run[k].pose, options_.feed_mm_min);
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

}  // namespace

Result<ToolPath> to_cl(const Part& part, const Scene& scene, const MachineLimits& limits,
                       const std::vector<OrientedPath>& paths, const AirOptions& options) {
  if (!(options.feed_mm_min > 0 && options.safety_mm >= 0 && options.air_mm_min >= 0))
    return Error{ErrorCode::range, "a feed or a safety distance that is negative or none (above 0)", {}};
  const MotionCheck check(scene, limits, 0.5 * options.safety_mm);
  const AirWays air(part.bounds, check, options.safety_mm);
  Runs runs = cutting_runs(scene, check, paths, options.threads);
  Writer writer(options);
  writer.out().broken = std::move(runs.broken);

  std::vector<std::optional<Exit>> ins(runs.runs.size()), outs(runs.runs.size());
  parallel_for(runs.runs.size(), thread_count(options.threads), [&](std::size_t i, std::size_t) {
    ins[i] = exit_of(air, runs.runs[i], true);
    if (ins[i]) outs[i] = exit_of(air, runs.runs[i], false);
  });
  const Run* last = nullptr;  // the run the tool stands at the end of
  const Exit* last_out = nullptr;
  for (std::size_t i = 0; i < runs.runs.size(); ++i) {
    // A run that the tool could not leave is not begun.
    const Run& run = runs.runs[i];
    std::optional<Way> way;
    bool lifted = false;
    if (ins[i] && outs[i] && last != nullptr) {
      way = air.across(last->back(), run.front());
      if (!way) way = air.over(last_out->out.back(), ins[i]->out.back()), lifted = true;
    }
    if (!ins[i] || !outs[i] || (last != nullptr && !way)) {
      for (const RunPoint& point : run)
        if (writer.out().stranded.empty() || writer.out().stranded.back() != point.source)
          writer.out().stranded.push_back(point.source);
      continue;
    }
    if (last != nullptr && !lifted) {
      writer.fly(*way, true, true);
    } else {
      if (last == nullptr) {
        writer.begin(ins[i]->out.back());
      } else {
        writer.leave(*last, *last_out);
        writer.fly(*way, false, false);
      }
      writer.enter(run, *ins[i]);
    }
    if (last != nullptr) ++writer.out().links;
    writer.cut(run);
    last = &run;
    last_out = &*outs[i];
  }
  if (last != nullptr) writer.leave(*last, *last_out);
  return writer.take();
}

}  // namespace burin::orient
