// SPDX-License-Identifier: Apache-2.0
// Part programs (ISO 6983 / RS-274): text -> blocks of words -> modal state -> CL data. The lexer and the
// block structure serve the surface programs of `burin cycle` as well; interpret() is the reader of ordinary
// motion programs, ours and other systems'.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/diagnostics.h"
#include "burin/base/result.h"
#include "burin/cl/program.h"
#include "burin/kinematics/kinematics.h"

namespace burin::nc {

struct Word {
  char letter = 0;  ///< 'A'..'Z'
  double value = 0;
  int column = 0;  ///< from 1
  bool has_point = false;
  /// The value in hundredths as an integer, for G and M words: G1 is 100, G6.23 is 623, G106.2 is 10620; -1
  /// when it is negative, has more than two decimals, or is above 9999.
  int code() const;
};

/// One line of the program: words in the order written; comments joined.
struct Block {
  int line = 0;               ///< from 1
  std::optional<int> number;  ///< N word
  bool skip = false;          ///< starts with '/'
  bool percent = false;       ///< starts with '%': the first begins, the next ends the program
  std::vector<Word> words;    ///< without N
  std::string comment;
  int comment_column = 0;  ///< where the text of the first comment begins
  /// The first word with this letter, nullptr when there is none.
  const Word* find(char letter) const;
};

struct LexOptions {
  std::string file_name;
  std::size_t max_blocks = 20'000'000;
};
/// Comments `( )` and `;` (a `;` right at the end of a block ends it, as in the paper's listings), `%` lines,
/// blanks anywhere, words in any order, upper or lower case, numbers with or without point. Errors (syntax)
/// with line and column: a letter without number, a number without letter, an open comment, a control
/// character. Expressions, variables and O-word control flow are unsupported errors. Empty lines make no
/// block.
Result<std::vector<Block>> lex(std::string_view text, const LexOptions& options);

/// The same, one block at a time: what stands behind an error is never looked at, and memory does not grow.
class Lexer {
 public:
  Lexer(std::string_view text, LexOptions options);
  /// Fills `block` with the next line that is not empty; false at the end of the text.
  Result<bool> next(Block& block);
  /// Characters behind the block that was read last.
  std::size_t remaining() const { return text_.size() - at_; }

 private:
  std::string_view text_;
  LexOptions options_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::size_t blocks_ = 0;
};

enum class Plane { xy, zx, yz };
enum class MotionMode { rapid, feed, arc_cw, arc_ccw, none };

/// What stays in force from block to block.
struct ModalState {
  MotionMode motion = MotionMode::none;
  Plane plane = Plane::xy;
  bool inch = false;
  bool incremental = false;
  bool arc_centers_absolute = false;  ///< G90.1
  bool inverse_time = false;          ///< G93
  bool tool_centre = false;           ///< G43.4: X, Y, Z are the tip on the part
  double feed = 0;                    ///< mm/min
  double spindle_or_power = 0;        ///< S word
  int tool = 0;
  geom::Point3 position;           ///< mm
  std::array<double, 2> rotary{};  ///< of the machine's rotary axes, radians
};

struct InterpretOptions {
  std::string file_name;
  /// S and M3/M4/M5 mean the beam of a laser (cl::Beam) instead of a spindle; S is scaled to W by
  /// `watts_per_s`.
  bool beam = false;
  double watts_per_s = 1.0;
  /// P of G4 in milliseconds (Fanuc) instead of seconds (LinuxCNC, GRBL). G4 X is always seconds.
  bool dwell_p_milliseconds = false;
  /// Largest difference between start and end radius of an arc before it is an error, mm (LinuxCNC's limit).
  double arc_radius_tolerance_mm = 0.0127;
  geom::Point3 start;
  /// A machine with rotary axes: their letters are read (degrees), X, Y, Z are its joints, and the poses are
  /// where that brings tip and axis in the part frame. Without one they have to stay at 0. Must outlive the
  /// call.
  const kinematics::Kinematics* machine = nullptr;
};

/// G43.4 (tool-centre-point control, with a machine of rotary axes; until G49 or G43): X, Y, Z are the tip on
/// the part. G0 G1 G2 G3 (I J K, R), G4, G17-G19, G20 G21, G90 G91 (and .1), G93 (becomes mm/min of the tip)
/// G94, M0-M9, M30, F S T, G40/G49/G54/G61/G64/G80 and the like that do not change where the tool goes.
/// `source` of the records is the line. Errors: codes that would move the tool in a way not understood
/// (unsupported), damaged blocks (syntax), impossible arcs (geometry), all with line and column.
Result<cl::Program> interpret(std::string_view text, const InterpretOptions& options,
                              Diagnostics& diagnostics);

/// What the machine does: joints[i] belongs to motion i of the program (they run linearly from one to the
/// next but for arcs; under G43.4 only the rotary ones do, the tip runs straight on the part).
struct JointProgram {
  cl::Program program;
  std::vector<kinematics::Joints> joints;
  std::vector<bool> tip_straight;  ///< of each motion: under G43.4
  /// Rapids while an axis stands where only the machine knows: it has not been sent anywhere yet, or was sent
  /// to a place of the machine (G28, G30, G53). Where they end is made up.
  std::vector<bool> unknown;
};
/// Without a machine the joints are the tip.
Result<JointProgram> interpret_joints(std::string_view text, const InterpretOptions& options,
                                      Diagnostics& diagnostics);

}  // namespace burin::nc
