// SPDX-License-Identifier: Apache-2.0
// The syntax of APT CL text, without meaning: lines, continuation, comments -> a major word and its
// parameters.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burin/base/result.h"

namespace burin::cl {

struct AptParameter {
  std::string_view text;  ///< trimmed; into the statement's own text
  int line = 0, column = 0;
  std::optional<double> number;
  /// Upper-case comparison.
  bool is(std::string_view word) const;
};

struct AptStatement {
  int line = 0, column = 0;  ///< of the major word
  std::string word;          ///< upper case
  std::string text;          ///< the whole statement as it stood, continuation joined
  std::string literal;       ///< of PARTNO, PPRINT, INSERT, REMARK: what follows the word
  std::vector<AptParameter> parameters;
  bool unfinished = false;  ///< ends with a continuation that nothing follows
};

class AptScanner {
 public:
  explicit AptScanner(std::string_view text) : text_(text) {}
  /// Fills the next statement that is not empty; false at the end. Errors: control characters, a statement of
  /// more than 100,000 characters.
  Result<bool> next(AptStatement& statement);

 private:
  std::string_view take_line();
  struct Piece {
    std::size_t begin;  // in AptStatement::text
    int line, column;
  };
  Result<bool> join(AptStatement& statement);
  void split(AptStatement& statement) const;
  AptParameter parameter(const AptStatement& statement, std::size_t begin, std::size_t end) const;

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace burin::cl
