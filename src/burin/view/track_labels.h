// SPDX-License-Identifier: Apache-2.0
// Which motion of which plan every setpoint of a program belongs to. A setpoint itself knows only its surface
// and pass; links, plunges and rapids between the paths are told apart by the length of the way.
#pragma once

#include <cstdint>
#include <vector>

#include "burin/view/cycle_track.h"

namespace burin::view {

struct TrackLabels {
  std::vector<TrackLabel> labels;
  std::vector<std::uint32_t> of_sample;  ///< index into labels
};

TrackLabels label_setpoints(const CyclePicture& picture);

/// The plans' motions as samples, for pictures without setpoints; `step` is the length between them, about.
struct MotionSamples {
  std::vector<TrackSample> samples;
  TrackLabels labels;
  std::vector<double> length;  ///< along the way, of every sample
};
MotionSamples sample_motions(const CyclePicture& picture, std::size_t most);

}  // namespace burin::view
