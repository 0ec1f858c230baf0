// SPDX-License-Identifier: Apache-2.0
// A control's dialect as data (TOML, data/dialects): decimals, header and footer, how beam, spindle, dwell
// and comments are written, how arcs are checked. No code per control.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "burin/base/result.h"

namespace burin::post {

struct Dialect {
  std::string name;  ///< "linuxcnc", "fanuc", "grbl"
  std::string description;
  int decimals = 4;  ///< of coordinates and arc centres, mm; 1 to 6
  int feed_decimals = 1;
  int power_decimals = 1;              ///< of S, power as well as speed
  double coordinate_limit_mm = 99999;  ///< largest coordinate and arc centre offset the control takes
  std::vector<std::string> header;     ///< lines; {name} and {program_number} are replaced
  std::vector<std::string> footer;
  bool percent = false;  ///< the program stands between % lines
  bool line_numbers = false;
  int line_number_step = 10;
  std::size_t line_limit = 255;  ///< characters; blanks go first, a longer block is an error
  bool require_point = false;    ///< "X1." instead of "X1" (Fanuc reads X1 as one increment)
  std::string comment_open = "(", comment_close = ")";
  std::size_t comment_limit = 200;           ///< characters, longer ones are cut
  std::string comment_forbidden;             ///< characters the control acts on even in comments; become '.'
  std::vector<std::string> active_comments;  ///< words that make a comment do something; '*' goes before them
  bool two_digit_codes = true;               ///< G01 rather than G1
  std::string beam_on, beam_off;  ///< e.g. "M3 S{power}", "M5"; {power} is the S value. Empty: no beam
  std::string beam_on_plain;      ///< the same when the power is not known: the control keeps its S
  double power_scale = 1.0;       ///< S per W
  bool power_inline = false;      ///< the power can change while the beam is on by an S word alone
  std::string spindle_cw = "M3 S{rpm}", spindle_ccw = "M4 S{rpm}", spindle_off = "M5";
  std::string dwell = "G4 P{seconds}";  ///< {seconds} or {milliseconds}
  std::string tool_change = "T{number} M6";
  bool tool_change_supported = true;  ///< false: reported and left out (GRBL)
  std::string tool_length;            ///< goes with the first Z after a tool change, e.g. "G43 H{number}"
  /// Tool-centre-point control: X, Y, Z of the tip on the part from here on, e.g. "G43.4 H{number}". Empty:
  /// the control has none.
  std::string tcp_on, tcp_off;
  std::string coolant_on = "M8", coolant_off = "M9";
  std::string stop = "M0", optional_stop = "M1";
  /// The control rejects an arc whose start and end radius differ by more than max(absolute, relative *
  /// radius), mm.
  double arc_absolute_mm = 0.005;
  double arc_relative = 0.001;
  double arc_min_radius_mm = 0.0;    ///< smaller arcs are rejected or ignored: they go out as lines
  double arc_max_radius_mm = 99999;  ///< larger ones are computed too coarsely: they go out as lines
  double min_arc_sweep_deg = 0.0;    ///< shorter arcs go out as lines where that stays within a decimal
  bool rotary_axes = true;           ///< false: X, Y and Z only
  std::string inverse_time = "G93", per_minute = "G94";  ///< inverse_time empty: the control has none
  int inverse_time_decimals = 4;                         ///< of F under inverse time, 1/min
  /// What F counts in a G94 block that moves rotary axes too: true: the linear axes only (degrees when none
  /// moves); false: mm and degrees together.
  bool feed_of_linear_only = true;
  bool arc_helix = true;  ///< false: helices go out as lines
};

/// The dialects that come with burin, sorted by name.
std::vector<std::string> dialect_names();
/// Built-in by name. Error (usage) names the known ones.
Result<Dialect> find_dialect(std::string_view name);
/// From a TOML text; unknown keys are errors that name the nearest known key.
Result<Dialect> parse_dialect(std::string_view toml, const std::string& file_name);

}  // namespace burin::post
