// SPDX-License-Identifier: Apache-2.0
#include "burin/servo/interpolator.h"

#include <algorithm>
#include <limits>

namespace burin::servo {

Interpolator::Interpolator(const Plan& plan) noexcept : plan_(&plan) {
  restart();
}

void Interpolator::restart() noexcept {
  run_ = profile_ = 0;
  tick_ = 0;
  travelled_ = 0;
  at_ = plan_->pieces.empty() ? Cursor{} : start_of(plan_->pieces.front(), 0);
  if (!plan_->runs.empty()) profile_ = plan_->runs.front().first_profile;
}

void Interpolator::fill(Setpoint& out, double speed) const noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  out = {static_cast<double>(tick_) * plan_->limits.period_s,
         at_.p[0],
         at_.p[1],
         at_.p[2],
         speed * 60,
         kNone,
         kNone};
  if (at_.piece >= plan_->pieces.size()) return;
  const Piece& piece = plan_->pieces[at_.piece];
  out.surface = piece.surface;
  out.pass = piece.pass;
  if (!piece.has_uv) return;
  out.u = horner(piece.c[3], at_.x);
  out.v = horner(piece.c[4], at_.x);
}

Status Interpolator::tick(Setpoint& out) noexcept {
  const auto setpoints = static_cast<std::int64_t>(plan_->setpoints);
  if (tick_ >= setpoints) {  // at rest at the end; the time is that of the last setpoint
    tick_ = std::max<std::int64_t>(setpoints - 1, 0);
    fill(out, 0);
    tick_ = setpoints;
    return Status::done;
  }
  if (tick_ == 0 || run_ >= plan_->runs.size()) {
    fill(out, 0);
    ++tick_;
    return Status::running;
  }
  const Plan::Run& run = plan_->runs[run_];
  const std::size_t end_piece = std::min(run.end_piece, plan_->pieces.size());
  if (tick_ >= run.end_tick) {  // exactly at its end; the next period is the next run's first
    if (end_piece > 0) {
      const Piece& last = plan_->pieces[end_piece - 1];
      at_ = {end_piece - 1, 1, {last.end[0], last.end[1], last.end[2]}};
    }
    fill(out, 0);
    travelled_ = 0;
    if (++run_ < plan_->runs.size()) {
      const Plan::Run& next = plan_->runs[run_];
      profile_ = next.first_profile;
      if (next.first_piece < plan_->pieces.size())
        at_ = start_of(plan_->pieces[next.first_piece], next.first_piece);
    }
  } else {
    const std::size_t end_profile = std::min(run.end_profile, plan_->profile.size());
    const double t = static_cast<double>(tick_ - run.first_tick) * plan_->limits.period_s;
    const ProfileValue now = look_up(plan_->profile.data(), end_profile, profile_, t);
    advance(plan_->pieces.data(), end_piece, at_, now.s - travelled_);
    travelled_ = now.s;
    fill(out, now.v);
  }
  ++tick_;
  return Status::running;
}

}  // namespace burin::servo
