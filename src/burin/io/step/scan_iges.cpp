// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "burin/base/text.h"
#include "burin/geom/surface/nurbs.h"
#include "burin/io/step/references.h"
#include "burin/io/step/scan.h"

namespace burin::io::step {

namespace {

constexpr std::size_t kMaxChain = 500;
constexpr std::array<char, 5> kSections{'S', 'G', 'D', 'P', 'T'};

struct Line {
  std::string_view text;
  int number = 0;
};

/// Values of one entity's parameter data, the entity type first.
using Values = std::vector<std::string_view>;

class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Result<void> run() {
    split();
    if (!failed()) check_terminate();
    if (!failed()) read_delimiters();
    if (!failed()) check_entities();
    if (failed()) return *error_;
    return {};
  }

 private:
  bool failed() const { return error_.has_value(); }
  void fail(std::string message, int line) {
    if (failed()) return;
    Where where;
    where.file = file_;
    where.line = line;
    error_ = Error{ErrorCode::syntax, std::move(message), where};
  }

  std::vector<Line>& section(char letter) {
    return sections_[static_cast<std::size_t>(std::find(kSections.begin(), kSections.end(), letter) -
                                              kSections.begin())];
  }

  /// Lines into sections; they must come in order.
  void split() {
    int number = 0;
    std::size_t current = 0;
    for (std::size_t from = 0; from < text_.size() && !failed();) {
      const std::size_t end = std::min(text_.find('\n', from), text_.size());
      std::string_view line = text_.substr(from, end - from);
      from = end + 1;
      ++number;
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.find_first_not_of(" \t\r\x1a") == std::string_view::npos) continue;
      if (!section('T').empty()) return;  // what follows the last line is nobody's
      if (line.size() < 73 || line.size() > 80)
        return fail("a line of " + std::to_string(line.size()) + " characters (IGES lines have 80)", number);
      const auto found =
          std::find(kSections.begin() + static_cast<std::ptrdiff_t>(current), kSections.end(), line[72]);
      if (found == kSections.end())
        return fail(
            std::string("has '") + line[72] + "' in column 73 (the sections S, G, D, P, T in this order)",
            number);
      current = static_cast<std::size_t>(found - kSections.begin());
      sections_[current].push_back({line, number});
      const auto sequence = parse_integer(line.substr(73));
      if (!sequence || *sequence != static_cast<long long>(sections_[current].size()))
        return fail("the line number in columns 74 to 80 is not " +
                        std::to_string(sections_[current].size()) + " (lines are missing or damaged)",
                    number);
    }
    if (section('T').empty())
      fail("ends in the middle: the T line is missing (a complete IGES file)", number);
  }

  /// The last line repeats the number of lines of each section.
  void check_terminate() {
    const Line last = section('T').front();
    for (std::size_t i = 0; i < 4; ++i) {
      const std::string_view field = last.text.substr(8 * i, 8);
      const auto count = parse_integer(field.substr(1));
      if (field[0] != kSections[i] || !count || *count != static_cast<long long>(sections_[i].size())) {
        return fail(std::string("the T line does not give the ") + std::to_string(sections_[i].size()) +
                        " lines of section " + kSections[i] + " (lines are missing or damaged)",
                    last.number);
      }
    }
  }

  /// The first two values of the global section: 1H, and 1H; unless left out.
  void read_delimiters() {
    if (section('G').empty()) return fail("has no global section", section('T').front().number);
    std::string text;
    for (const Line& line : section('G')) text += line.text.substr(0, 72);
    std::size_t at = 0;
    const auto next = [&](char otherwise) {
      if (text.compare(at, 2, "1H") == 0 && at + 3 < text.size()) {
        const char c = text[at + 2];
        at += 4;
        return c;
      }
      ++at;
      return otherwise;
    };
    separator_ = next(',');
    end_ = next(';');
  }

  /// The values of the entity in lines [first, first + count) of section P, Hollerith texts kept whole.
  std::optional<Values> values(std::size_t first, std::size_t count) {
    data_.clear();
    for (std::size_t i = first; i < first + count; ++i) data_ += section('P')[i].text.substr(0, 64);
    Values list;
    std::size_t at = 0;
    const std::string_view data = data_;
    while (true) {
      while (at < data.size() && data[at] == ' ') ++at;
      const std::size_t start = at;
      while (at < data.size() && data[at] >= '0' && data[at] <= '9') ++at;
      if (at > start && at < data.size() && data[at] == 'H') {
        const auto length = parse_integer(data.substr(start, at - start));
        if (!length || *length > static_cast<long long>(data.size() - at - 1)) return std::nullopt;
        at += 1 + static_cast<std::size_t>(*length);
      }
      while (at < data.size() && data[at] != separator_ && data[at] != end_) ++at;
      if (at == data.size()) return std::nullopt;
      list.push_back(trim(data.substr(start, at - start)));
      if (data[at] == end_) return list;
      ++at;
    }
  }

  static std::optional<long long> integer(const Values& v, std::size_t index) {
    if (index >= v.size()) return std::nullopt;
    if (v[index].empty()) return 0;  // left out: the default
    return parse_integer(v[index]);
  }

  /// Directory entries: two lines each.
  void check_entities() {
    const std::vector<Line>& d = section('D');
    if (d.size() % 2 != 0) return fail("the directory has an odd number of lines", d.back().number);
    References graph(d.size() / 2);
    for (std::size_t i = 0; i < d.size() && !failed(); i += 2) check_entity(i, graph);
    if (failed()) return;
    if (const auto problem = graph.check(kMaxChain)) {
      fail(problem->circle
               ? "the entity refers to itself over others"
               : "the entity begins a chain of more than " + std::to_string(kMaxChain) + " references",
           d[2 * problem->entity].number);
    }
  }

  void check_entity(std::size_t i, References& graph) {
    const Line &a = section('D')[i], &b = section('D')[i + 1];
    const auto field = [](const Line& line, std::size_t k) { return trim(line.text.substr(8 * k, 8)); };
    const auto number = [&](const Line& line, std::size_t k) {
      return field(line, k).empty() ? std::optional<long long>(0) : parse_integer(field(line, k));
    };
    const auto type = number(a, 0), again = number(b, 0), first = number(a, 1), count = number(b, 3);
    if (!type || !again || *type != *again)
      return fail("the two lines of the directory entry do not name one entity type", a.number);
    const auto lines = static_cast<long long>(section('P').size());
    // Type 0 is a deleted entity. A count of 0 stands for one line.
    if (*type == 0) return;
    if (!first || !count || *first < 1 || *count < 0 || *first > lines ||
        *first + std::max<long long>(*count, 1) - 1 > lines)
      return fail("the directory entry points outside of the parameter data", a.number);
    for (long long k = *first; k < *first + std::max<long long>(*count, 1) && !failed(); ++k) {
      const Line& p = section('P')[static_cast<std::size_t>(k) - 1];
      if (parse_integer(trim(p.text.substr(64, 8))) != static_cast<long long>(i) + 1)
        fail("columns 65 to 72 do not lead back to directory line " + std::to_string(i + 1), p.number);
    }
    if (failed()) return;
    const auto list = values(static_cast<std::size_t>(*first) - 1,
                             static_cast<std::size_t>(std::max<long long>(*count, 1)));
    const int line = section('P')[static_cast<std::size_t>(*first) - 1].number;
    if (!list) return fail("the values of the entity do not end with " + std::string(1, end_), line);
    if (integer(*list, 0) != type)
      return fail("the values belong to another entity than directory line " + std::to_string(a.number),
                  line);
    check_counts(*type, *list, line);
    if (!failed() && (*type == 126 || *type == 128)) check_spline(*list, *type == 128, line);
    if (!failed() && *type == 504) check_edges(*list, line);
    if (!failed() && *type == 514) check_shell(*list, line);
    if (!failed()) add_references(i / 2, *type, *list, number(a, 6).value_or(0), graph);
  }

  /// Values that an entity must have for the counts it declares; the entities of curves, surfaces and solids.
  static std::optional<double> needed(long long type, const Values& v) {
    const auto n = [&](std::size_t index) {
      const auto value = integer(v, index);
      return value && *value >= 0 ? static_cast<double>(*value) : std::nan("");
    };
    switch (type) {
      case 102:
        return 1 + n(1);
      case 106:
        return 2 + 2 * n(2);
      case 112:
        return 5 + 13 * n(4);
      case 114:
        return 6 + n(3) + n(4) + 48 * n(3) * n(4);
      case 126:
        return 6 + (n(1) + n(2) + 2) + 4 * (n(1) + 1) + 2;
      case 128:
        return 9 + (n(1) + n(3) + 2) + (n(2) + n(4) + 2) + 4 * (n(1) + 1) * (n(2) + 1) + 4;
      case 141:
        return 4 + 3 * n(4);
      case 143:
        return 3 + n(3);
      case 144:
        return 4 + n(3);
      case 180:
        return 1 + n(1);
      case 184:
        return 1 + 2 * n(1);
      case 186:
        return 3 + 2 * n(3);
      case 308:
      case 320:
        return 3 + n(3);
      case 402:
      case 406:
        return 1 + n(1);
      case 502:
        return 1 + 3 * n(1);
      case 504:
      case 508:
        return 1 + 5 * n(1);
      case 510:
        return 3 + n(2);
      case 514:
        return 1 + 2 * n(1);
      default:
        return std::nullopt;
    }
  }

  /// Reals of IGES may have a D for the exponent; a value left out is 0.
  static std::optional<double> real(const Values& v, std::size_t index) {
    if (index >= v.size()) return std::nullopt;
    if (v[index].empty()) return 0.0;
    std::string text(v[index]);
    std::replace(text.begin(), text.end(), 'D', 'E');
    return parse_double(text);
  }

  /// Values [from, from + count) as numbers, or a message.
  std::vector<double> reals(const Values& v, std::size_t from, std::size_t count, int line) {
    std::vector<double> list;
    for (std::size_t i = from; i < from + count && !failed(); ++i) {
      const auto value = real(v, i);
      if (!value)
        fail("value " + std::to_string(i) + " of entity " + std::string(v[0]) + " is not a number", line);
      list.push_back(value.value_or(0));
    }
    return list;
  }

  void check_knots(const Values& v, std::size_t from, std::size_t count, int line) {
    const std::vector<double> knots = reals(v, from, count, line);
    if (failed()) return;
    constexpr double kRounding = 1e-9;  // knots that should be equal, written with few digits
    const double range = knots.back() - knots.front();
    bool good = range > 0;
    for (std::size_t i = 1; i < knots.size(); ++i)
      good = good && knots[i] >= knots[i - 1] - kRounding * range;
    if (!good) fail("the knots of entity " + std::string(v[0]) + " do not ascend", line);
  }

  /// Curves 126 and surfaces 128: OpenCASCADE reads on with what is missing.
  void check_spline(const Values& v, bool surface, int line) {
    const std::size_t head = surface ? 9 : 6;
    std::vector<std::size_t> points, degrees;
    for (std::size_t i = 1; i <= (surface ? 2u : 1u); ++i) {
      const long long upper = integer(v, i).value_or(-1),
                      degree = integer(v, i + (surface ? 2 : 1)).value_or(-1);
      if (degree < 1 || degree > geom::kMaxSurfaceDegree || upper < degree)
        return fail("entity " + std::string(v[0]) + " has degree " + std::to_string(degree) + " with " +
                        std::to_string(upper + 1) + " points (degrees 1 to " +
                        std::to_string(geom::kMaxSurfaceDegree) + ", more points than the degree)",
                    line);
      points.push_back(static_cast<std::size_t>(upper) + 1);
      degrees.push_back(static_cast<std::size_t>(degree));
    }
    for (std::size_t i = points.size() + degrees.size() + 1; i <= head; ++i) {
      const auto flag = integer(v, i);
      if (!flag || *flag < 0 || *flag > 1)
        return fail("a flag of entity " + std::string(v[0]) + " is not 0 or 1", line);
    }
    std::size_t at = head + 1;
    for (std::size_t i = 0; i < points.size() && !failed(); ++i) {
      check_knots(v, at, points[i] + degrees[i] + 1, line);
      at += points[i] + degrees[i] + 1;
    }
    const std::size_t all = surface ? points[0] * points[1] : points[0];
    for (const double w : reals(v, at, all, line)) {
      if (!(w > 0)) fail("a weight of entity " + std::string(v[0]) + " is not above 0", line);
    }
    reals(v, at + all, 3 * all + (surface ? 4 : 2), line);
  }

  void check_counts(long long type, const Values& v, int line) {
    const auto wanted = needed(type, v);
    if (!wanted) return;
    const auto there = static_cast<double>(v.size() - 1);
    if (!std::isfinite(*wanted) || *wanted > there) {
      fail("entity " + std::to_string(type) + " declares " +
               (std::isfinite(*wanted) ? "counts for " + format_fixed(*wanted, 0) + " values"
                                       : "a count that is none") +
               " but has " + std::to_string(v.size() - 1),
           line);
    }
  }

  /// The entity type at a pointer; 0 when it points to nothing.
  long long type_at(long long pointer) {
    const std::vector<Line>& d = section('D');
    if (pointer < 1 || pointer % 2 == 0 || pointer >= static_cast<long long>(d.size())) return 0;
    return parse_integer(trim(d[static_cast<std::size_t>(pointer) - 1].text.substr(0, 8))).value_or(0);
  }

  /// The curves of an edge list (504): OpenCASCADE follows whatever stands there.
  void check_edges(const Values& v, int line) {
    constexpr std::array<long long, 9> kCurves{100, 102, 104, 106, 110, 112, 126, 130, 116};
    const auto count = static_cast<std::size_t>(integer(v, 1).value_or(0));
    for (std::size_t k = 0; k < count; ++k) {
      const long long type = type_at(integer(v, 2 + 5 * k).value_or(0));
      const long long start = type_at(integer(v, 3 + 5 * k).value_or(0));
      const long long end = type_at(integer(v, 5 + 5 * k).value_or(0));
      if (std::find(kCurves.begin(), kCurves.end(), type) == kCurves.end() || start != 502 || end != 502)
        return fail("edge " + std::to_string(k + 1) + " of entity 504 is not a curve between vertices", line);
    }
  }

  /// The faces of a shell (514), each with its orientation.
  void check_shell(const Values& v, int line) {
    const auto count = static_cast<std::size_t>(integer(v, 1).value_or(0));
    bool good = count > 0;
    for (std::size_t k = 0; k < count; ++k)
      good = good && type_at(integer(v, 2 + 2 * k).value_or(0)) == 510 && integer(v, 3 + 2 * k).has_value();
    if (!good) fail("entity 514 does not name the faces of a shell", line);
  }

  /// Pointers to other entities of the types that readers follow by recursion.
  void add_references(std::size_t entity, long long type, const Values& v, long long matrix,
                      References& graph) {
    const auto entities = static_cast<long long>(section('D').size()) / 2;
    const auto point_to = [&](long long pointer) {
      if (pointer < 1 || pointer % 2 == 0 || pointer / 2 >= entities) return;
      graph.add(entity, static_cast<std::size_t>(pointer / 2));
    };
    const auto follow = [&](std::size_t from, std::size_t to, std::size_t step = 1) {
      for (std::size_t k = from; k <= to && k < v.size(); k += step)
        point_to(std::abs(integer(v, k).value_or(0)));
    };
    const auto count = [&](std::size_t index) {
      return static_cast<std::size_t>(integer(v, index).value_or(0));
    };
    point_to(matrix);
    switch (type) {
      case 102:
      case 402:
      case 180:
      case 184:
        return follow(2, 1 + count(1));
      case 118:
      case 120:
        return follow(1, 2);
      case 122:
      case 130:
      case 190:
      case 192:
      case 194:
      case 196:
      case 198:
      case 408:
      case 430:
        return follow(1, 1);
      case 140:
        return follow(5, 5);
      case 141:
        return follow(3, 3);
      case 142:
        return follow(2, 4);
      case 143:
        return follow(2, 2), follow(4, 3 + count(3));
      case 144:
        return follow(1, 1), follow(4, 4 + count(3));
      case 186:
        return follow(1, 1), follow(4, 3 + 2 * count(3), 2);
      case 308:
      case 320:
        return follow(4, 3 + count(3));
      case 510:
        return follow(1, 1), follow(4, 3 + count(2));
      case 514:
        return follow(2, 1 + 2 * count(1), 2);
      default:
        return;
    }
  }

  std::string_view text_;
  const std::string& file_;
  std::array<std::vector<Line>, 5> sections_;
  char separator_ = ',', end_ = ';';
  std::string data_;
  std::optional<Error> error_;
};

}  // namespace

Result<void> scan_iges(std::string_view bytes, const std::string& file_name) {
  return Scanner(bytes, file_name).run();
}

}  // namespace burin::io::step
