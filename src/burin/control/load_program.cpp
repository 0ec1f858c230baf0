// SPDX-License-Identifier: Apache-2.0
// From the text of a surface program to the handle that is ticked.
#include <exception>

#include "burin/control/handle.h"
#include "burin/job/cycle_job.h"

namespace burin::control {
namespace {

Result<servo::Plan> plan_program(std::string_view text, const servo::Limits& limits) {
  Diagnostics unused;
  job::CycleOptions options;
  options.file_name = "program";
  auto job = job::make_cycle_job(text, options, unused, nullptr);
  if (!job) return std::move(job).error();
  return servo::plan(job->stretches, limits, unused);
}

}  // namespace
}  // namespace burin::control

extern "C" burin_servo* burin_servo_load(const char* program, size_t length, const burin_servo_limits* limits,
                                         char* message, size_t size) {
  using burin::control::put_message;
  put_message(message, size, "");
  if (!program) return put_message(message, size, "no program (its text)"), nullptr;
  try {
    auto plan = burin::control::plan_program({program, length}, burin::control::limits_of(limits));
    if (!plan) return put_message(message, size, plan.error().to_string()), nullptr;
    burin_servo* handle = burin::control::make_handle(*std::move(plan));
    if (!handle) put_message(message, size, "not enough memory");
    return handle;
  } catch (const std::exception& e) {
    put_message(message, size, e.what());
    return nullptr;
  }
}
