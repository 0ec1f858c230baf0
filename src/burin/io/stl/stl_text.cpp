// SPDX-License-Identifier: Apache-2.0
#include "burin/io/stl/stl_text.h"

#include <string>

#include "burin/base/text.h"

namespace burin::io::stl {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

/// What a message quotes of the file: short, printable.
std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string out = "\"";
  for (const char c : word.substr(0, kLongest)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (word.size() > kLongest ? "...\"" : "\"");
}

class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  /// The next word; "" at the end.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) step();
    line_of_word_ = line_;
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
  }
  int line() const { return line_of_word_; }

 private:
  void step() {
    const bool cr_lf = text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n';
    if ((text_[at_] == '\n' || text_[at_] == '\r') && !cr_lf) ++line_;
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1, line_of_word_ = 1;
};

class Parser {
 public:
  Parser(std::string_view text, Builder& builder) : words_(text), builder_(builder) {}

  Result<std::size_t> run() {
    std::size_t solids = 0;
    while (true) {
      const std::string_view word = words_.next();
      if (word.empty() && solids > 0) return solids;
      if (to_lower(word) != "solid") return wrong(word, "solid");
      ++solids;
      words_.skip_line();
      if (auto done = solid(); !done) return done.error();
    }
  }

 private:
  Error wrong(std::string_view found, const std::string& expected) const {
    return {ErrorCode::syntax,
            (found.empty() ? "ends too early" : quoted(found) + " is not what belongs here") +
                " (expected: " + expected + ")",
            {.line = words_.line()}};
  }

  Result<void> expect(std::string_view wanted) {
    const std::string_view word = words_.next();
    return to_lower(word) == wanted ? Result<void>{} : wrong(word, std::string(wanted));
  }

  Result<void> solid() {
    while (true) {
      const std::string_view word = words_.next();
      const std::string lower = to_lower(word);
      if (lower == "endsolid") {
        words_.skip_line();
        return {};
      }
      if (lower != "facet") return wrong(word, "facet or endsolid");
      if (auto done = facet(); !done) return done.error();
    }
  }

  Result<void> facet() {
    if (auto ok = expect("normal"); !ok) return ok;
    // Normals are not used, and are written as nan by some programs where there is no area.
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = words_.next();
      if (word.empty() || to_lower(word) == "outer") return wrong(word, "three numbers of the normal");
    }
    if (auto ok = expect("outer"); !ok) return ok;
    if (auto ok = expect("loop"); !ok) return ok;
    std::array<std::array<double, 3>, 3> corners{};
    for (auto& corner : corners) {
      if (auto ok = expect("vertex"); !ok) return ok;
      for (double& v : corner) {
        const std::string_view word = words_.next();
        const auto number = parse_double(word);
        if (!number) return wrong(word, "a finite number");
        v = *number;
      }
    }
    const int line = words_.line();
    const std::string_view word = words_.next();
    if (to_lower(word) == "vertex") {
      return Error{
          ErrorCode::syntax, "a facet has more than three corners (triangles only)", {.line = words_.line()}};
    }
    if (to_lower(word) != "endloop") return wrong(word, "endloop");
    if (auto ok = expect("endfacet"); !ok) return ok;
    if (auto added = builder_.add(corners); !added) {
      Error error = added.error();
      error.where.line = line;
      return error;
    }
    return {};
  }

  Words words_;
  Builder& builder_;
};

}  // namespace

Result<std::size_t> read_text(std::string_view text, Builder& builder) {
  return Parser(text, builder).run();
}

}  // namespace burin::io::stl
