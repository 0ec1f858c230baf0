// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "burin/base/text.h"
#include "burin/io/step/references.h"
#include "burin/io/step/scan.h"

namespace burin::io::step {

namespace {

/// Deeper parentheses or chains of references than any part has; readers recurse over both.
constexpr int kMaxParentheses = 200;
constexpr std::size_t kMaxChain = 500;

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Result<void> run() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    while (!done_ && !failed()) statement();
    if (!failed()) check_references();
    if (failed()) return *error_;
    return {};
  }

 private:
  bool failed() const { return error_.has_value(); }
  void fail(std::string message, int line = 0) {
    if (failed()) return;
    Where where;
    where.file = file_;
    where.line = line > 0 ? line : line_;
    error_ = Error{ErrorCode::syntax, std::move(message), where};
  }
  void truncated() { fail("ends in the middle: END-ISO-10303-21 is missing (a complete STEP file)"); }

  bool more() const { return at_ < text_.size(); }
  char peek(std::size_t ahead = 0) const { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  void advance() {
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }

  void skip_blanks() {
    while (more()) {
      const char c = peek();
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v') {
        advance();
      } else if (c == '/' && peek(1) == '*') {
        const int start = line_;
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) return fail("the comment that begins here has no end", start);
        while (at_ < end + 2) advance();
      } else {
        return;
      }
    }
  }

  std::string_view word() {
    const std::size_t from = at_;
    while (more() && (is_letter(peek()) || is_digit(peek()) || peek() == '-')) ++at_;
    return text_.substr(from, at_ - from);
  }

  std::optional<std::uint64_t> id() {
    std::uint64_t value = 0;
    const char* begin = text_.data() + at_ + 1;
    const auto [end, ok] = std::from_chars(begin, text_.data() + text_.size(), value);
    // OpenCASCADE counts in int.
    if (ok != std::errc{} || value == 0 || value > 0x7fffffff) {
      fail("a # must be followed by the number of an entity (1 to 2147483647)");
      return std::nullopt;
    }
    at_ += static_cast<std::size_t>(end - begin) + 1;
    return value;
  }

  /// One statement up to its semicolon.
  void statement() {
    skip_blanks();
    if (failed()) return;
    if (!more()) return truncated();
    if (peek() == '#' && in_data_) {
      const int line = line_;
      const auto number = id();
      if (!number) return;
      skip_blanks();
      if (peek() != '=') return fail("#" + std::to_string(*number) + " is not followed by =");
      ++at_;
      entities_.push_back({*number, line});
      return tokens();
    }
    const std::size_t start = at_;
    const std::string_view name = word();
    if (at_ == start && !skips_) return fail(unexpected());
    if (first_ && name != "ISO-10303-21") return fail("is no STEP file (ISO-10303-21; as its first word)");
    first_ = false;
    if (name == "DATA") in_data_ = true, had_data_ = true;
    if (name == "ENDSEC") in_data_ = skips_ = false;
    // Sections of edition 3 that carry no geometry; their statements have forms of their own.
    if (name == "ANCHOR" || name == "REFERENCE" || name == "SIGNATURE") skips_ = true;
    if (name == "END-ISO-10303-21") {
      done_ = true;
      if (!had_data_) fail("has no DATA section (a complete STEP file)");
      return;
    }
    if (skips_) return skip_statement();
    tokens();
  }

  void skip_statement() {
    const std::size_t end = text_.find(';', at_);
    if (end == std::string_view::npos) return truncated();
    while (at_ <= end) advance();
  }

  /// To the semicolon that ends the statement.
  void tokens() {
    const int start = line_;
    int depth = 0;
    while (!failed()) {
      skip_blanks();
      if (failed()) return;
      if (!more()) return truncated();
      const char c = peek();
      if (c == ';') {
        ++at_;
        if (depth != 0) fail("a parenthesis of this statement is not closed", start);
        return;
      }
      if (c == '(') {
        if (++depth > kMaxParentheses)
          return fail("parentheses nested deeper than " + std::to_string(kMaxParentheses));
        ++at_;
      } else if (c == ')') {
        if (--depth < 0) return fail("a closing parenthesis without an opening one");
        ++at_;
      } else {
        token(c);
      }
    }
  }

  void token(char c) {
    if (c == '\'') return quoted('\'');
    if (c == '"') return quoted('"');
    if (c == '#') return reference();
    if (is_digit(c) || c == '+' || c == '-') return number();
    if (c == '.') return enumeration();
    if (c == ',' || c == '$' || c == '*' || c == '!' || c == '=') {
      ++at_;
      return;
    }
    if (is_letter(c)) {
      word();
      return;
    }
    fail(unexpected());
  }

  std::string unexpected() const {
    const char c = peek();
    const bool printable = c > 0x20 && c < 0x7f;
    static constexpr char kHex[] = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    return "has a " +
           (printable ? std::string("'") + c + "'"
                      : std::string("byte 0x") + kHex[byte >> 4] + kHex[byte & 15]) +
           " where none belongs (the statements of ISO 10303-21)";
  }

  void quoted(char quote) {
    const int start = line_;
    for (advance(); more(); advance()) {
      if (peek() != quote) continue;
      ++at_;
      if (peek() != quote) return;  // a doubled one stands for itself
    }
    fail("the text that begins here has no end", start);
  }

  void reference() {
    const int line = line_;
    const auto number = id();
    if (number && in_data_ && !entities_.empty())
      references_.push_back({entities_.size() - 1, *number, line});
  }

  void number() {
    const std::size_t from = at_;
    if (peek() == '+' || peek() == '-') ++at_;
    const std::size_t digits = at_;
    while (is_digit(peek())) ++at_;
    bool good = at_ > digits;
    if (peek() == '.') ++at_;
    while (is_digit(peek())) ++at_;
    if (peek() == 'E' || peek() == 'e') {
      ++at_;
      if (peek() == '+' || peek() == '-') ++at_;
      const std::size_t exponent = at_;
      while (is_digit(peek())) ++at_;
      good = good && at_ > exponent;
    }
    std::string_view text = text_.substr(from, at_ - from);
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    // Too small for a double is zero; too large is damage.
    const bool small = code == std::errc::result_out_of_range && text.find('-', 1) != std::string_view::npos;
    if (!good || is_letter(peek()) || (code != std::errc{} && !small) || !std::isfinite(value))
      fail("\"" + std::string(text.substr(0, 40)) +
           "\" is not a number that can be (digits, a point, an exponent)");
  }

  void enumeration() {
    ++at_;
    const std::string_view name = word();
    if (name.empty() || peek() != '.') return fail("a word between points is not closed (such as .T.)");
    ++at_;
  }

  void check_references() {
    std::vector<std::size_t> order(entities_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return entities_[a].id < entities_[b].id; });
    for (std::size_t i = 1; i < order.size(); ++i) {
      const Entity& e = entities_[order[i]];
      if (e.id == entities_[order[i - 1]].id)
        return fail("#" + std::to_string(e.id) + " is defined twice", e.line);
    }
    References graph(entities_.size());
    for (const Reference& r : references_) {
      const auto found =
          std::lower_bound(order.begin(), order.end(), r.to,
                           [&](std::size_t index, std::uint64_t id) { return entities_[index].id < id; });
      if (found == order.end() || entities_[*found].id != r.to)
        return fail("refers to #" + std::to_string(r.to) + ", which the file does not define", r.line);
      graph.add(r.from, *found);
    }
    if (const auto problem = graph.check(kMaxChain)) {
      const Entity& e = entities_[problem->entity];
      fail(
          "#" + std::to_string(e.id) +
              (problem->circle ? " refers to itself over others"
                               : " begins a chain of more than " + std::to_string(kMaxChain) + " references"),
          e.line);
    }
  }

  struct Entity {
    std::uint64_t id;
    int line;
  };
  struct Reference {
    std::size_t from;
    std::uint64_t to;
    int line;
  };

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
  bool first_ = true, in_data_ = false, had_data_ = false, skips_ = false, done_ = false;
  std::vector<Entity> entities_;
  std::vector<Reference> references_;
  std::optional<Error> error_;
};

}  // namespace

Result<void> scan_step(std::string_view bytes, const std::string& file_name) {
  return Scanner(bytes, file_name).run();
}

}  // namespace burin::io::step
