// SPDX-License-Identifier: Apache-2.0
// The comments `(BURIN TRIM ...)` behind the points and knots of a surface block: loops in its parameters
// that bound what is machined. Other controls read over them. See docs/surface-program.md.
//   (BURIN TRIM LOOP 4)                          a loop of four points follows
//   (BURIN TRIM 0.25,0.25 0.75,0.25)             u,v u,v ...
//   (BURIN TRIM 0.75,0.75 0.25,0.75)
#pragma once

#include <string>
#include <vector>

#include "burin/nc/place.h"
#include "burin/nc/surface_program.h"

namespace burin::nc {

bool is_trim_comment(const Block& block);

/// Collects the loops of one surface.
class TrimReader {
 public:
  /// `block` holds a trim comment and nothing else; `remaining`: characters of text that follow it. Errors
  /// (syntax, range) with the column of the word in the comment.
  Result<void> read(const Source& source, const Block& block, const geom::NurbsSurface& surface,
                    std::size_t remaining);
  /// True when the last loop has all its points.
  bool complete() const { return missing_ == 0; }
  std::size_t missing() const { return missing_; }
  Place open_loop() const { return loop_; }
  std::vector<TrimLoop> take_loops() { return std::move(loops_); }

 private:
  std::vector<TrimLoop> loops_;
  std::size_t missing_ = 0;  // points of the last loop
  Place loop_;
};

/// Lines of the program, each ended by a newline.
std::string write_trims(const std::vector<TrimLoop>& loops, int decimals);

}  // namespace burin::nc
