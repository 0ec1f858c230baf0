// SPDX-License-Identifier: Apache-2.0
#include "burin/io/dxf/feed.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <initializer_list>

#include "burin/base/text.h"

namespace burin::io::dxf {
namespace {

// dxflib cuts lines at 1023 bytes (and then never ends); symbol names are at most 255 characters.
constexpr std::size_t kLongestName = 1000;

using Codes = std::initializer_list<int>;

bool contains(Codes codes, int code) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

// A number as integer mantissa and exponent, "1.25" as "125e-2": the same double, but read alike whatever
// decimal point and grouping the locale of the host program has (dxflib reads through the global one).
void append_number(std::string& out, double value) {
  std::array<char, 32> buffer;
  const auto end =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::scientific).ptr;
  const std::string_view text(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  const auto e = text.find('e');
  const auto point = text.find('.');
  const std::string_view exponent_text = text.substr(e + (text[e + 1] == '+' ? 2 : 1));
  int exponent = 0;
  std::from_chars(exponent_text.data(), exponent_text.data() + exponent_text.size(), exponent);
  if (point == std::string_view::npos) {
    out.append(text.substr(0, e));
  } else {
    out.append(text.substr(0, point)).append(text.substr(point + 1, e - point - 1));
    exponent -= static_cast<int>(e - point - 1);
  }
  out += 'e';
  out += std::to_string(exponent);
}

class Writer {
 public:
  Writer(const Document& document, const Record& record, const std::string& file)
      : document_(document), record_(record), file_(file) {}

  Result<FedRecord> run() {
    if (record_.kind == RecordKind::vertex) {
      // Frame points of a spline-fit polyline steer the curve, they do not lie on it.
      constexpr int kFramePoint = 16;
      if ((int_of(document_, record_, 70, 0) & kFramePoint) != 0) return std::move(out_);
    }
    if (!write()) return error_;
    return std::move(out_);
  }

 private:
  bool write() {
    switch (record_.kind) {
      case RecordKind::variable:
        return variable();
      case RecordKind::layer:
        return begin() && names({2}) && integers({62, 70, 420});
      case RecordKind::block:
        return begin() && names({2}) && integers({70}) && reals({10, 20, 30});
      case RecordKind::end_block:
        return true;
      case RecordKind::vertex:
        return begin() && integers({70}) && reals({10, 20, 30, 42});
      case RecordKind::sequence_end:
        return begin();
      case RecordKind::entity:
        return entity();
    }
    return true;
  }

  bool variable() {
    if (record_.name == "$INSUNITS" || record_.name == "$MEASUREMENT") return begin() && integers({70});
    if (record_.name == "$DWGCODEPAGE") return begin() && names({3});
    return true;
  }

  bool entity() {
    const std::string_view kind = record_.name;
    if (!layer_name_fits()) return false;
    const auto common = [&] { return begin() && integers({62, 420}) && reals({210, 220, 230}); };
    if (kind == "LINE") return common() && reals({10, 20, 30, 11, 21, 31});
    if (kind == "CIRCLE") return common() && reals({10, 20, 30, 40});
    if (kind == "ARC") return common() && reals({10, 20, 30, 40, 50, 51});
    if (kind == "ELLIPSE") return common() && reals({10, 20, 30, 11, 21, 31, 40, 41, 42});
    if (kind == "INSERT") {
      return common() && names({2}) && integers({70, 71}) && reals({10, 20, 30, 41, 42, 43, 44, 45, 50});
    }
    if (kind == "POLYLINE") return common() && integers({70, 71, 72}) && reals({30});
    if (kind == "LWPOLYLINE") return common() && integers({70}) && reals({38}) && light_vertices();
    if (kind == "SPLINE") {
      return common() && integers({70, 71}) && reals({12, 22, 32, 13, 23, 33}) && spline_lists();
    }
    return true;
  }

  bool begin() {
    out_.text += record_.kind == RecordKind::variable ? "9\n" : "0\n";
    out_.text.append(record_.name);
    out_.text += '\n';
    return true;
  }

  template <class Visit>
  bool each(Visit visit) {
    for (std::size_t i = record_.first; i < record_.last; ++i) {
      if (!visit(document_.tags[i])) return false;
    }
    return true;
  }

  bool fail(const Tag& tag, std::string message) {
    error_ = syntax_error(file_, tag.value_line(), std::move(message));
    return false;
  }

  void put(int code, std::string_view value) {
    out_.text += std::to_string(code);
    out_.text += '\n';
    out_.text.append(value);
    out_.text += '\n';
  }

  bool put_real(const Tag& tag) {
    const auto value = real_value(tag);
    if (!value) {
      return fail(tag, std::string(record_.name) + ": group " + std::to_string(tag.code) + " is " +
                           quoted(tag.value) + " (a finite number up to 1e15 is expected)");
    }
    out_.text += std::to_string(tag.code);
    out_.text += '\n';
    append_number(out_.text, *value);
    out_.text += '\n';
    return true;
  }

  bool reals(Codes codes) {
    return each([&](const Tag& tag) { return !contains(codes, tag.code) || put_real(tag); });
  }

  bool integers(Codes codes) {
    return each([&](const Tag& tag) {
      if (!contains(codes, tag.code)) return true;
      const auto value = int_value(tag);
      if (!value) {
        return fail(tag, std::string(record_.name) + ": group " + std::to_string(tag.code) + " is " +
                             quoted(tag.value) + " (an integer is expected)");
      }
      put(tag.code, std::to_string(*value));
      return true;
    });
  }

  // Every entity of every insertion carries its layer: the length must be bounded.
  bool layer_name_fits() {
    return each([&](const Tag& tag) { return tag.code != 8 || fits(tag, trim(tag.value)); });
  }

  bool fits(const Tag& tag, std::string_view text) {
    if (text.size() <= kLongestName) return true;
    return fail(tag, std::string(record_.name) + ": a name of " + std::to_string(text.size()) +
                         " bytes (at most 255 characters are allowed)");
  }

  bool names(Codes codes) {
    return each([&](const Tag& tag) {
      if (!contains(codes, tag.code)) return true;
      const auto text = trim(tag.value);
      if (!fits(tag, text)) return false;
      put(tag.code, text);
      return true;
    });
  }

  std::size_t count(int code) {
    std::size_t n = 0;
    each([&](const Tag& tag) { return n += tag.code == code ? 1 : 0, true; });
    return n;
  }

  // A count as the file declares it against what is there; what is there counts.
  void put_count(int code, int counted_code, const char* what) {
    const std::size_t found = count(counted_code);
    const int declared = int_of(document_, record_, code, -1);
    if (declared >= 0 && static_cast<std::size_t>(declared) != found) {
      out_.repairs.push_back(std::to_string(declared) + " " + what + " declared, " + std::to_string(found) +
                             " found and used");
    }
    put(code, std::to_string(found));
  }

  bool light_vertices() {
    put_count(90, 10, "vertices");
    bool in_vertex = false;  // dxflib would write before its buffer for a bulge before the first vertex
    return each([&](const Tag& tag) {
      if (tag.code == 10) in_vertex = true;
      return !in_vertex || !contains({10, 20, 42}, tag.code) || put_real(tag);
    });
  }

  bool spline_lists() {
    put_count(72, 40, "knots");
    put_count(73, 10, "control points");
    put_count(74, 11, "fit points");
    const std::size_t weights = count(41), points = count(10);
    if (weights != 0 && weights != points) {
      out_.repairs.push_back(std::to_string(weights) + " weights for " + std::to_string(points) +
                             " control points; missing ones are 1");
    }
    return reals({40, 10, 20, 30, 41, 11, 21, 31});
  }

  const Document& document_;
  const Record& record_;
  const std::string& file_;
  FedRecord out_;
  Error error_;
};

const Tag* last_tag(const Document& document, const Record& record, int code) {
  for (std::size_t i = record.last; i > record.first; --i) {
    if (document.tags[i - 1].code == code) return &document.tags[i - 1];
  }
  return nullptr;
}

}  // namespace

std::string_view text_of(const Document& document, const Record& record, int code) {
  const Tag* tag = last_tag(document, record, code);
  return tag != nullptr ? trim(tag->value) : std::string_view{};
}

int int_of(const Document& document, const Record& record, int code, int fallback) {
  const Tag* tag = last_tag(document, record, code);
  return tag != nullptr ? int_value(*tag).value_or(fallback) : fallback;
}

Result<FedRecord> feed_record(const Document& document, const Record& record, const std::string& file) {
  return Writer(document, record, file).run();
}

FeedBuffer::int_type FeedBuffer::underflow() {
  text_.clear();
  while (text_.empty() && !failed() && next_ < document_.records.size()) {
    auto record = feed_record(document_, document_.records[next_], file_);
    if (!record) {
      error_ = record.error();
      break;
    }
    if (!record->text.empty()) {
      text_ = std::move(record->text);
      fed_.push_back(next_);
      for (auto& what : record->repairs) repairs_.push_back({next_, std::move(what)});
    }
    ++next_;
  }
  if (text_.empty()) {
    if (ended_) return traits_type::eof();
    ended_ = true;
    text_ = "0\nEOF\n";  // completes the last record
  }
  setg(text_.data(), text_.data(), text_.data() + text_.size());
  return traits_type::to_int_type(text_.front());
}

}  // namespace burin::io::dxf
