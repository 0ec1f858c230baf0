// SPDX-License-Identifier: Apache-2.0
#include "burin/post/axis_writer.h"

#include <cmath>
#include <utility>

#include "burin/base/text.h"
#include "burin/post/words.h"

namespace burin::post {

AxisWriter::AxisWriter(const cl::Program& program, const kinematics::Kinematics& machine,
                       const kinematics::JointPath& path, const Dialect& dialect, const EmitOptions& options,
                       Diagnostics& diagnostics)
    : NcWriter(program, dialect, options, diagnostics), machine_(machine), path_(path) {
  axes_ = 3 + static_cast<std::size_t>(machine.rotary_count());
  for (std::size_t i = 3; i < axes_; ++i) letters_[i] = machine.rotary_axis(static_cast<int>(i - 3)).letter;
}

Result<void> AxisWriter::check_axes() const {
  if (machine_.rotary_count() > 0 && !dialect_.rotary_axes)
    return Error{ErrorCode::unsupported,
                 "the dialect " + dialect_.name + " has no rotary axes (linuxcnc or fanuc)",
                 {}};
  return {};
}

Result<AxisWriter::Grid> AxisWriter::rounded(const Places& places) const {
  Grid grid{};
  for (std::size_t i = 0; i < axes_; ++i) {
    if (!(std::abs(places[i]) <= dialect_.coordinate_limit_mm))
      return error(ErrorCode::range, std::string(1, letters_[i]) + format_shortest(places[i]) + " (within " +
                                         format_shortest(dialect_.coordinate_limit_mm) + " for " +
                                         dialect_.name + ")");
    grid[i] = to_grid(places[i], dialect_.decimals);
  }
  return grid;
}

std::string AxisWriter::changes(const Grid& to) const {
  std::string text;
  for (std::size_t i = 0; i < axes_; ++i) {
    if (known_ && at_[i] == to[i] && !(i == 2 && !length_.empty())) continue;
    text += std::string(" ") + letters_[i] + grid_text(to[i], dialect_.decimals, dialect_.require_point);
  }
  return text;
}

Result<void> AxisWriter::block(bool rapid, const Grid& to, const std::string& words,
                               const std::string& feed) {
  std::string text = words + feed;
  const int code = rapid ? 0 : 1;
  if (code != motion_code_) text.insert(0, " " + g(motion_code_ = code));
  if (!length_.empty()) text.insert(0, " " + std::exchange(length_, ""));
  at_ = to;
  known_ = true;
  ++out_.moves;
  return line(text.substr(1));
}

}  // namespace burin::post
