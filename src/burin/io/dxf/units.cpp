// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/units.h"

#include <array>

namespace burin::io::dxf {
namespace {

struct Unit {
  const char* name;
  double mm;
};

// $INSUNITS from 1; the US survey foot is 1200/3937 m.
constexpr double kSurveyFoot = 1200000.0 / 3937.0;
constexpr std::array<Unit, 24> kUnits = {{{"inch", 25.4},
                                          {"foot", 304.8},
                                          {"mile", 1609344.0},
                                          {"mm", 1.0},
                                          {"cm", 10.0},
                                          {"m", 1000.0},
                                          {"km", 1e6},
                                          {"microinch", 25.4e-6},
                                          {"mil", 0.0254},
                                          {"yard", 914.4},
                                          {"angstrom", 1e-7},
                                          {"nm", 1e-6},
                                          {"micrometre", 1e-3},
                                          {"dm", 100.0},
                                          {"dam", 1e4},
                                          {"hm", 1e5},
                                          {"Gm", 1e12},
                                          {"astronomical unit", 149597870700e3},
                                          {"light year", 9460730472580800e3},
                                          {"parsec", 30856775814913673e3},
                                          {"US survey foot", kSurveyFoot},
                                          {"US survey inch", kSurveyFoot / 12},
                                          {"US survey yard", kSurveyFoot * 3},
                                          {"US survey mile", kSurveyFoot * 5280}}};

}  // namespace

UnitChoice choose_units(const Model& model, Units override_units) {
  if (override_units == Units::mm) return {1.0, "--units mm", ""};
  if (override_units == Units::inch) return {25.4, "--units inch", ""};
  const int code = model.insunits;
  if (code >= 1 && code <= static_cast<int>(kUnits.size())) {
    const Unit& unit = kUnits[static_cast<std::size_t>(code) - 1];
    return {unit.mm, "$INSUNITS " + std::to_string(code) + " (" + unit.name + ")", ""};
  }
  if (code > static_cast<int>(kUnits.size()) || code < -1) {
    const std::string said = "$INSUNITS " + std::to_string(code);
    return {1.0, said + " unknown, mm assumed",
            said + " is no known unit: mm assumed (0 to 24 are known; --units overrides)"};
  }
  constexpr int kEnglish = 0;
  UnitChoice choice{1.0, code == 0 ? "$INSUNITS 0 (none), mm assumed" : "no units, mm assumed", ""};
  if (model.measurement == kEnglish) {
    choice.warning =
        "the drawing names no unit, and $MEASUREMENT 0 hints at inches: mm assumed (--units inch overrides)";
  }
  return choice;
}

}  // namespace burin::io::dxf
