// SPDX-License-Identifier: Apache-2.0
#include "burin/plan/orient/path_task.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace burin::orient {

namespace {

Optimum sturz(const PathTask& task, const CcPoint& at, Scene::Memory& memory) {
  Optimum o = find_initial(task.setting, *task.goal, at, memory);
  o.angles = {task.sturz_tilt, 0};
  o.cause = cause_at(task.setting, at, o.angles, memory);
  o.found = o.cause == Cause::none;
  o.value = o.found ? task.goal->value(at, o.angles) : 0;
  ++o.tests;
  return o;
}

OrientedPoint oriented(const PathTask& task, const CcPoint& cc, const Optimum& found) {
  OrientedPoint point;
  point.cc = cc;
  point.reachable = found.found;
  point.initial_found = found.initial_found;
  point.cause = found.cause;
  point.tests = found.tests;
  if (found.initial_found) {
    point.initial = found.initial;
    point.rho_initial = effective_radius(found.initial, task.mill());
  }
  if (found.found) {
    point.angles = found.angles;
    point.rho = effective_radius(found.angles, task.mill());
    point.strip = strip_at(cc, found.angles, task.mill(), task.options->scallop_mm);
    point.pose = pose(cc, found.angles, task.mill());
  }
  return point;
}

template <class T>
void put(std::string& bytes, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}
template <class T>
void get(std::string_view& bytes, T& value) {
  std::memcpy(&value, bytes.data(), sizeof(T));
  bytes.remove_prefix(sizeof(T));
}

/// Calls field(x) for everything of a path but its points, and of a point: one list for both ways.
template <class Path, class Field>
void each_field(Path& path, const Field& field) {
  field(path.number), field(path.face), field(path.at);
  field(path.smooth_loss), field(path.speed_share), field(path.acceleration_share);
}

}  // namespace

OrientedPath PathTask::run(const std::vector<CcPoint>& points) const {
  Scene::Memory memory;
  Experience experience;
  std::vector<Optimum> best;
  best.reserve(points.size());
  for (const CcPoint& at : points) {
    switch (options->search) {
      case Search::optimal:
        best.push_back(find_optimal(setting, *goal, at, memory, experience));
        break;
      case Search::contour:
        best.push_back(find_by_contour(setting, at, memory));
        break;
      case Search::sturz:
        best.push_back(sturz(*this, at, memory));
        break;
    }
  }
  OrientedPath path;
  if (options->smooth && options->search != Search::sturz) {
    SmoothOptions smooth;
    smooth.feed_mm_min = options->feed_mm_min;
    smooth.machine = machine;
    const SmoothPath turned = smooth_path(setting, *goal, points, best, smooth, memory);
    path.smooth_loss = turned.value_loss;
    path.speed_share = turned.speed_share;
    path.acceleration_share = turned.acceleration_share;
    for (std::size_t i = 0; i < best.size(); ++i)
      if (best[i].found && turned.points[i].found) best[i].angles = turned.points[i].angles;
  }
  path.points.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) path.points.push_back(oriented(*this, points[i], best[i]));
  return path;
}

std::string to_bytes(const std::vector<OrientedPath>& paths) {
  static_assert(std::is_trivially_copyable_v<OrientedPoint>);
  std::string bytes;
  put(bytes, paths.size());
  for (const OrientedPath& path : paths) {
    each_field(path, [&](const auto& value) { put(bytes, value); });
    put(bytes, path.points.size());
    for (const OrientedPoint& point : path.points) put(bytes, point);
  }
  return bytes;
}

std::vector<OrientedPath> paths_from_bytes(std::string_view bytes) {
  std::size_t count = 0;
  get(bytes, count);
  std::vector<OrientedPath> paths(count);
  for (OrientedPath& path : paths) {
    each_field(path, [&](auto& value) { get(bytes, value); });
    std::size_t points = 0;
    get(bytes, points);
    path.points.resize(points);
    for (OrientedPoint& point : path.points) get(bytes, point);
  }
  return paths;
}

}  // namespace burin::orient
