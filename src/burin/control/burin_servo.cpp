// SPDX-License-Identifier: Apache-2.0
#include "burin/control/burin_servo.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "burin/control/handle.h"

namespace burin::control {

burin_servo* make_handle(servo::Plan plan) noexcept {
  return new (std::nothrow) burin_servo(std::move(plan));
}

servo::Limits limits_of(const burin_servo_limits* l) noexcept {
  if (!l) return {};
  return {l->period_s,   l->chord_error_mm,     l->accel_mm_s2,
          l->jerk_mm_s3, l->axis_velocity_mm_s, l->rapid_mm_min};
}

void put_message(char* message, std::size_t size, std::string_view text) noexcept {
  if (!message || size == 0) return;
  const std::size_t n = std::min(size - 1, text.size());
  std::memcpy(message, text.data(), n);
  message[n] = '\0';
}

namespace {

Result<servo::Plan> plan_polyline(const double* xyz, std::size_t count, double feed,
                                  const servo::Limits& limits) {
  if (!xyz || count == 0) return Error{ErrorCode::usage, "no points (one or more, x y z each)", {}};
  if (!(feed > 0 && std::isfinite(feed)))
    return Error{ErrorCode::usage, "a feed that is not above 0 (mm/min)", {}};
  const auto point = [xyz](std::size_t i) {
    return geom::Point3{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]};
  };
  std::vector<servo::Stretch> stretches;
  stretches.reserve(count);
  if (count == 1) stretches.push_back({geom::straight(point(0), point(0)), {}, feed});
  for (std::size_t i = 1; i < count; ++i)
    stretches.push_back({geom::straight(point(i - 1), point(i)), {}, feed});
  Diagnostics unused;
  return servo::plan(stretches, limits, unused);
}

}  // namespace
}  // namespace burin::control

using burin::control::put_message;

extern "C" {

burin_servo_limits burin_servo_default_limits(void) {
  const burin::servo::Limits l;
  return {l.period_s, l.chord_error_mm, l.accel_mm_s2, l.jerk_mm_s3, l.axis_velocity_mm_s, l.rapid_mm_min};
}

burin_servo* burin_servo_load_polyline(const double* xyz, size_t count, double feed_mm_min,
                                       const burin_servo_limits* limits, char* message, size_t size) {
  put_message(message, size, "");
  try {
    auto made = burin::control::plan_polyline(xyz, count, feed_mm_min, burin::control::limits_of(limits));
    if (!made) return put_message(message, size, made.error().message), nullptr;
    burin_servo* handle = burin::control::make_handle(std::move(*made));
    if (!handle) put_message(message, size, "not enough memory");
    return handle;
  } catch (const std::exception& e) {
    put_message(message, size, e.what());
    return nullptr;
  }
}

int burin_servo_tick(burin_servo* servo, burin_servo_setpoint* out) {
  if (!servo || !out) return BURIN_SERVO_ERROR;
  burin::servo::Setpoint s;
  const burin::servo::Status status = servo->interpolator.tick(s);
  *out = {s.t_s, s.x, s.y, s.z, s.feed_mm_min, s.u, s.v, s.surface, s.pass};
  return status == burin::servo::Status::done ? BURIN_SERVO_DONE : BURIN_SERVO_RUNNING;
}

void burin_servo_restart(burin_servo* servo) {
  if (servo) servo->interpolator.restart();
}

uint64_t burin_servo_setpoints(const burin_servo* servo) {
  return servo ? servo->plan.setpoints : 0;
}

void burin_servo_free(burin_servo* servo) {
  delete servo;
}

}  // extern "C"
