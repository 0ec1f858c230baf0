// SPDX-License-Identifier: Apache-2.0
// The tables of the B series as functions of the radius. Internal to model.
#pragma once

#include <string_view>
#include <vector>

#include "burin/base/result.h"

namespace burin::model {

/// Piecewise cubic through given places; beyond them the end pieces go on.
class Cubic {
 public:
  Cubic() = default;
  /// Two continuous derivatives, no jump of the third at the first and last inner place ("not a knot"). At
  /// least four places.
  static Cubic spline(std::vector<double> x, std::vector<double> y);
  /// The same with slopes cut down where it would go beyond neighbouring places (Hyman 1983): one continuous
  /// derivative there, two elsewhere.
  static Cubic monotone(std::vector<double> x, std::vector<double> y);
  double operator()(double x) const;

 private:
  std::vector<double> x_, y_, slope_;
};

/// One row of the section tables at any radius; offsets by place along the chord, from the leading edge.
struct SeriesAt {
  double chord = 0;      ///< c / D * Z / (Ae / Ao)
  double middle = 0;     ///< generator line to mid chord, towards the leading edge, in the same unit
  double thickest = 0;   ///< leading edge to greatest thickness, over the chord
  double thickness = 0;  ///< t_max / D
  double pitch = 1;      ///< share of the nominal pitch
  std::vector<double> v1, v2;
};

class Series {
 public:
  static Result<Series> parse(std::string_view toml);
  SeriesAt at(int blades, double radius_ratio) const;
  /// P of the offsets: 1 leading edge .. -1 trailing edge.
  const std::vector<double>& places() const { return places_; }

 private:
  struct Outline {
    Cubic chord, middle, thickest;
  };
  Outline three_, more_;
  Cubic thickness_, thickness_per_blade_, pitch_four_;
  std::vector<double> places_;
  std::vector<Cubic> v1_, v2_;
};

/// The series that is part of the program.
const Series& b_series();

}  // namespace burin::model
