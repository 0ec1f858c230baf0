// SPDX-License-Identifier: Apache-2.0
// What stands behind the C interface: a plan and the interpolator over it. For the functions that load
// programs.
#pragma once

#include <string_view>
#include <utility>

#include "burin/control/burin_servo.h"
#include "burin/servo/interpolator.h"

struct burin_servo {
  explicit burin_servo(burin::servo::Plan p) : plan(std::move(p)), interpolator(plan) {}
  burin_servo(const burin_servo&) = delete;
  burin_servo& operator=(const burin_servo&) = delete;

  const burin::servo::Plan plan;
  burin::servo::Interpolator interpolator;
};

namespace burin::control {

/// The handle of a plan; nullptr when memory is short. Free with burin_servo_free.
burin_servo* make_handle(servo::Plan plan) noexcept;
/// Null: the defaults.
servo::Limits limits_of(const burin_servo_limits* limits) noexcept;
/// `text`, cut to size - 1 characters, into the caller's buffer (which may be null).
void put_message(char* message, std::size_t size, std::string_view text) noexcept;

}  // namespace burin::control
