// SPDX-License-Identifier: Apache-2.0
#include "burin/cl/apt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "burin/base/text.h"
#include "burin/cl/apt_statement.h"

namespace burin::cl {
namespace {

using geom::Point3;
using geom::Vec3;

constexpr double kMmPerInch = 25.4;
constexpr double kMaxValue = 1e9;  // mm, mm/min, rpm, W, s: beyond it nothing is meant
// Written axes carry 12 decimals and are taken as they stand; others are scaled to length 1.
constexpr double kUnitExact = 1e-11;
constexpr double kUnitNear = 1e-3;
constexpr double kNoDirection = 1e-9;

class Reader {
 public:
  Reader(const AptOptions& options, Diagnostics& diagnostics)
      : options_(options), diagnostics_(diagnostics) {}

  Result<Program> run(std::string_view text) {
    AptScanner scanner(text);
    AptStatement statement;
    while (!fini_) {
      auto more = scanner.next(statement);
      if (!more) return located(more.error());
      if (!*more) break;
      statement_ = &statement;
      if (statement.unfinished) {
        unfinished_ = true;  // its end is missing: half a statement says nothing
        break;
      }
      if (auto ok = read(); !ok) return ok.error();
    }
    if (auto ok = finish(scanner); !ok) return ok.error();
    return std::move(program_);
  }

 private:
  using Handler = Result<void> (Reader::*)();
  struct Entry {
    std::string_view word;
    Handler handler;
  };

  // --- helpers
  // ------------------------------------------------------------------------------------------------

  Error located(Error error) const {
    error.where.file = options_.file_name;
    return error;
  }
  Where where() const {
    return {.file = options_.file_name, .line = statement_->line, .column = statement_->column};
  }
  Error error(ErrorCode code, std::string message) const { return {code, std::move(message), where()}; }
  Error error(ErrorCode code, std::string message, const AptParameter& at) const {
    return {code, std::move(message), {.file = options_.file_name, .line = at.line, .column = at.column}};
  }
  void once(Severity severity, const std::string& code, const std::string& key, std::string message) {
    if (said_.insert(code + '/' + key).second)
      diagnostics_.add({severity, code, std::move(message), where(), std::nullopt});
  }
  Result<void> add(Record record, int line) {
    if (program_.records.size() >= options_.max_records)
      return error(ErrorCode::range,
                   "more than " + std::to_string(options_.max_records) + " records (split the file)");
    program_.add(std::move(record), static_cast<std::uint32_t>(line));
    return {};
  }
  Result<void> add(Record record) { return add(std::move(record), statement_->line); }

  Result<double> number(std::size_t i) const {
    const AptParameter& parameter = statement_->parameters[i];
    if (!parameter.number)
      return error(ErrorCode::syntax,
                   "'" + std::string(parameter.text.substr(0, 40)) + "' in " + statement_->word +
                       "/ is not a number (a decimal)",
                   parameter);
    if (!(std::abs(*parameter.number) <= kMaxValue))
      return error(ErrorCode::range, "a number beyond 1e9 in " + statement_->word + "/ (less)", parameter);
    return *parameter.number;
  }

  /// The first `count` parameters as numbers.
  template <std::size_t count>
  Result<std::array<double, count>> numbers(std::size_t first = 0) const {
    std::array<double, count> values{};
    for (std::size_t i = 0; i < count; ++i) {
      const auto value = number(first + i);
      if (!value) return value.error();
      values[i] = *value;
    }
    return values;
  }

  Error wrong_count(const char* accepted) const {
    return error(ErrorCode::syntax, statement_->word + "/ with " +
                                        std::to_string(statement_->parameters.size()) + " parameters (" +
                                        accepted + ")");
  }

  Result<Vec3> direction(std::size_t first) {
    const auto v = numbers<3>(first);
    if (!v) return v.error();
    const Vec3 axis{(*v)[0], (*v)[1], (*v)[2]};
    const double length = norm(axis);
    if (length < kNoDirection)
      return error(ErrorCode::range, "a direction of length 0 (a unit vector)",
                   statement_->parameters[first]);
    if (std::abs(length - 1) <= kUnitExact) return axis;
    if (std::abs(length - 1) > kUnitNear)
      once(Severity::info, "not_unit", statement_->word,
           "directions of another length than 1 are scaled to it");
    return axis / length;
  }

  // --- statements
  // ---------------------------------------------------------------------------------------------

  Result<void> read() {
    static constexpr std::array<Entry, 24> kWords = {{
        {"BEAM", &Reader::beam},        {"CIRCLE", &Reader::circle},  {"COOLNT", &Reader::coolant},
        {"CUTTER", &Reader::cutter},    {"DELAY", &Reader::delay},    {"END", &Reader::end},
        {"FEDRAT", &Reader::feed},      {"FINI", &Reader::fini},      {"FROM", &Reader::from},
        {"GODLTA", &Reader::increment}, {"GOTO", &Reader::go},        {"LOAD", &Reader::load_tool},
        {"LOADTL", &Reader::load},      {"MULTAX", &Reader::nothing}, {"OPSTOP", &Reader::keep},
        {"PARTNO", &Reader::part},      {"PPRINT", &Reader::print},   {"RAPID", &Reader::rapid},
        {"REMARK", &Reader::nothing},   {"SPINDL", &Reader::spindle}, {"STOP", &Reader::keep},
        {"TLDATA", &Reader::tool_data}, {"TOOLNO", &Reader::tool},    {"UNITS", &Reader::units},
    }};
    for (const Entry& entry : kWords)
      if (entry.word == statement_->word) return (this->*entry.handler)();
    return unknown();
  }

  Result<void> nothing() { return {}; }
  Result<void> keep() { return add(Unknown{statement_->text}); }

  /// Words after which a GOTO is no longer the plain motion it says.
  static bool changes_motion(std::string_view word) {
    static constexpr std::array<std::string_view, 29> kWords = {
        "CALL",   "CIRCUL", "COPY",   "CUTCOM", "CYCLE",  "GOBACK", "GOFWD", "GOHOME", "GOLFT",  "GORGT",
        "INDEX",  "INDIRV", "MACRO",  "MATRIX", "MIRROR", "MOVARC", "NURBS", "ORIGIN", "PATTRN", "ROTABL",
        "ROTATE", "ROTHED", "TERMAC", "THREAD", "TLLFT",  "TLON",   "TLRGT", "TRACUT", "TRANS"};
    return std::find(kWords.begin(), kWords.end(), word) != kWords.end();
  }

  Result<void> unknown() {
    const std::string word =
        statement_->word.empty() ? statement_->text.substr(0, 20) : statement_->word.substr(0, 40);
    if (changes_motion(word)) {
      once(Severity::left_out, "unknown_statement", word,
           word + " is not carried out: it is kept as it stands, and the motion after it is read without it");
    } else {
      once(Severity::info, "unknown_statement", word, word + " is not known: it is kept as it stands");
    }
    return keep();
  }

  Result<void> part() {
    const std::string name(trim(statement_->literal));
    if (!program_.name.empty()) return unknown();
    program_.name = name;
    return {};
  }
  Result<void> print() { return add(Comment{statement_->literal}); }

  Result<void> units() {
    const auto& p = statement_->parameters;
    if (p.size() == 1 && p[0].is("MM")) return scale_ = 1, Result<void>{};
    if (p.size() == 1 && (p[0].is("INCHES") || p[0].is("INCH"))) return scale_ = kMmPerInch, Result<void>{};
    return error(ErrorCode::unsupported, "units that are not known (UNITS/MM or UNITS/INCHES)");
  }

  Result<void> end() { return ended_ = true, Result<void>{}; }
  Result<void> fini() { return fini_ = ended_ = true, Result<void>{}; }

  // --- tools
  // --------------------------------------------------------------------------------------------------

  Result<int> tool_number(std::size_t i) const {
    const auto value = number(i);
    if (!value) return value.error();
    if (*value < 0 || *value > 999'999'999 || *value != std::floor(*value))
      return error(ErrorCode::range, "a tool number that is no integer from 0 on (such as LOADTL/1)",
                   statement_->parameters[i]);
    return static_cast<int>(*value);
  }

  Result<void> cutter() {
    const std::size_t count = statement_->parameters.size();
    if (count == 0) return wrong_count("CUTTER/d or CUTTER/d,r");
    if (count > 2)
      once(Severity::info, "cutter_shape", "", "of CUTTER/ only the diameter and the corner radius are read");
    return cutter_sizes(0);
  }
  /// TLDATA/MILL,d,r,length,...
  Result<void> tool_data() {
    if (statement_->parameters.size() < 3 || !statement_->parameters[0].is("MILL")) return unknown();
    return cutter_sizes(1);
  }
  Result<void> cutter_sizes(std::size_t first) {
    std::array<double, 2> dr{};
    for (std::size_t i = first; i < std::min(statement_->parameters.size(), first + 2); ++i) {
      const auto value = number(i);
      if (!value) return value.error();
      if (*value < 0)
        return error(ErrorCode::range, "a negative size of the cutter (0 or more)",
                     statement_->parameters[i]);
      dr[i - first] = *value * scale_;
    }
    // Some systems load first and describe the cutter afterwards.
    if (open_tool_ && *open_tool_ < program_.records.size()) {
      auto& tool = std::get<ToolChange>(program_.records[*open_tool_]);
      tool.diameter = dr[0];
      tool.corner_radius = dr[1];
      open_tool_.reset();
      return {};
    }
    cutter_ = dr;
    tool_line_ = statement_->line;
    return {};
  }

  Result<void> tool() {
    if (statement_->parameters.empty()) return wrong_count("TOOLNO/n");
    const auto n = tool_number(0);
    if (!n) return n.error();
    tool_ = *n;
    tool_line_ = statement_->line;
    return {};
  }

  Result<void> load_tool() {
    if (statement_->parameters.size() < 2 || !statement_->parameters[0].is("TOOL")) return unknown();
    return load_number(1);
  }
  Result<void> load() {
    if (!statement_->parameters.empty()) return load_number(0);
    if (!tool_) return wrong_count("LOADTL/n");
    return change(*tool_, statement_->line);
  }
  Result<void> load_number(std::size_t i) {
    const auto n = tool_number(i);
    if (!n) return n.error();
    return change(*n, statement_->line);
  }

  Result<void> change(int number, int line) {
    ToolChange record{number, 0, 0};
    if (cutter_) record.diameter = (*cutter_)[0], record.corner_radius = (*cutter_)[1];
    open_tool_.reset();
    if (!cutter_) open_tool_ = program_.records.size();
    cutter_.reset();
    tool_.reset();
    return add(record, line);
  }

  /// TOOLNO/ or CUTTER/ without LOADTL/ hold from the next motion on.
  Result<void> flush_tool() {
    if (tool_ || cutter_) {
      if (auto ok = change(tool_.value_or(0), tool_line_); !ok) return ok;
    }
    open_tool_.reset();
    return {};
  }

  // --- state
  // --------------------------------------------------------------------------------------------------

  Result<void> feed() {
    double unit = scale_;
    bool per_turn = false;
    std::optional<double> value;
    for (std::size_t i = 0; i < statement_->parameters.size(); ++i) {
      const AptParameter& p = statement_->parameters[i];
      if (p.is("MMPM")) {
        unit = 1;
      } else if (p.is("IPM")) {
        unit = kMmPerInch;
      } else if (p.is("MMPR") || p.is("IPR") || p.is("PERREV")) {
        per_turn = true;
      } else if (p.number && !value) {
        const auto v = number(i);
        if (!v) return v.error();
        value = *v;
      } else if (!p.is("PERMIN") && !p.text.empty()) {
        once(Severity::info, "unknown_parameter", statement_->word,
             "parameters of FEDRAT/ that are not known are ignored");
      }
    }
    if (!value) return error(ErrorCode::syntax, "FEDRAT/ without a number (FEDRAT/1000,MMPM)");
    if (per_turn) {
      once(Severity::left_out, "feed_per_revolution", "",
           "a feed per revolution is not read (FEDRAT/v,MMPM)");
      return keep();
    }
    if (!(*value * unit > 0))
      return error(ErrorCode::range, "FEDRAT/" + format_shortest(*value) + " (above 0)");
    return add(FeedRate{*value * unit});
  }

  Result<void> spindle() {
    bool off = false;
    std::optional<double> rpm;
    for (std::size_t i = 0; i < statement_->parameters.size(); ++i) {
      const AptParameter& p = statement_->parameters[i];
      if (p.is("OFF")) {
        off = true;
      } else if (p.is("CLW")) {
        rotation_ = Rotation::clockwise;
      } else if (p.is("CCLW")) {
        rotation_ = Rotation::counter_clockwise;
      } else if (p.is("SFM") || p.is("SMM")) {
        once(Severity::left_out, "surface_speed", "",
             "a constant surface speed is not read (SPINDL/RPM,n,CLW)");
        return keep();
      } else if (p.is("RANGE") || p.is("MAXRPM")) {
        ++i;
      } else if (p.number && !rpm) {
        const auto v = number(i);
        if (!v) return v.error();
        rpm = *v;
      } else if (!p.is("RPM") && !p.is("ON") && !p.text.empty()) {
        once(Severity::info, "unknown_parameter", statement_->word,
             "parameters of SPINDL/ that are not known are ignored");
      }
    }
    if (off) return add(Spindle{});
    if (rpm && *rpm < 0) return error(ErrorCode::range, "SPINDL/ with a negative speed (0 or more)");
    if (rpm) rpm_ = *rpm;
    return add(Spindle{rotation_, rpm_});
  }

  Result<void> beam() {
    const auto& p = statement_->parameters;
    if (p.size() == 1 && p[0].is("OFF")) return add(Beam{});
    if (p.size() != 2 || !p[0].is("ON"))
      return error(ErrorCode::syntax, "BEAM/ that is neither on nor off (BEAM/ON,power or BEAM/OFF)");
    const auto power = number(1);
    if (!power) return power.error();
    if (*power < 0) return error(ErrorCode::range, "BEAM/ON with a negative power (0 or more)", p[1]);
    return add(Beam{true, *power});
  }

  Result<void> coolant() {
    const auto& p = statement_->parameters;
    return add(Coolant{!(p.size() == 1 && p[0].is("OFF"))});
  }

  Result<void> delay() {
    if (statement_->parameters.size() != 1) {
      if (statement_->parameters.size() < 2) return wrong_count("DELAY/seconds");
      once(Severity::left_out, "unknown_parameter", statement_->word,
           "DELAY/ in other units than seconds is not read (DELAY/s)");
      return keep();
    }
    const auto seconds = number(0);
    if (!seconds) return seconds.error();
    if (*seconds < 0) return error(ErrorCode::range, "a negative DELAY/ (0 or more)");
    return add(Dwell{*seconds});
  }

  // --- motion
  // -------------------------------------------------------------------------------------------------

  Result<void> rapid() { return rapid_ = true, Result<void>{}; }

  Result<Pose> pose() {
    const std::size_t count = statement_->parameters.size();
    if (count != 3 && count != 6) return wrong_count("x,y,z or x,y,z,i,j,k");
    const auto p = numbers<3>();
    if (!p) return p.error();
    Pose result{{(*p)[0] * scale_, (*p)[1] * scale_, (*p)[2] * scale_}, axis_};
    if (count == 6) {
      const auto axis = direction(3);
      if (!axis) return axis.error();
      result.axis = *axis;
    }
    return result;
  }

  Result<void> from() {
    const auto p = pose();
    if (!p) return p.error();
    if (at_ || program_.from) return unknown();  // a second start is no motion burin knows
    program_.from = *p;
    axis_ = p->axis;
    at_ = p->tip;
    return {};
  }

  Result<void> go() {
    const auto p = pose();
    if (!p) return p.error();
    return move(*p);
  }

  Result<void> increment() {
    const std::size_t count = statement_->parameters.size();
    if (count != 1 && count != 3) return wrong_count("dx,dy,dz, or a way along the tool axis");
    if (!at_) return error(ErrorCode::syntax, "GODLTA/ before any position (FROM/ or GOTO/ before it)");
    Vec3 way;
    if (count == 1) {
      const auto along = number(0);
      if (!along) return along.error();
      way = *along * scale_ * axis_;
    } else {
      const auto d = numbers<3>();
      if (!d) return d.error();
      way = scale_ * Vec3{(*d)[0], (*d)[1], (*d)[2]};
    }
    return move({*at_ + way, axis_});
  }

  Result<void> circle() {
    // Some systems add tolerances behind the radius.
    if (statement_->parameters.size() < 7) return wrong_count("cx,cy,cz,i,j,k,r");
    if (circle_)
      return error(ErrorCode::syntax,
                   "a second CIRCLE/ without a GOTO/ after the first (one GOTO/ for each)");
    const auto c = numbers<3>();
    if (!c) return c.error();
    const auto normal = direction(3);
    if (!normal) return normal.error();
    const auto radius = number(6);
    if (!radius) return radius.error();
    if (*radius <= 0)
      return error(ErrorCode::range, "CIRCLE/ with a radius of " + format_shortest(*radius) + " (above 0)",
                   statement_->parameters[6]);
    circle_ = Arc{{(*c)[0] * scale_, (*c)[1] * scale_, (*c)[2] * scale_}, *normal, *radius * scale_, {}};
    return {};
  }

  Result<void> move(const Pose& to) {
    if (auto ok = flush_tool(); !ok) return ok;
    const bool rapid = std::exchange(rapid_, false);
    axis_ = to.axis;
    at_ = to.tip;
    if (auto arc = std::exchange(circle_, std::nullopt)) {
      if (rapid)
        once(Severity::info, "rapid_arc", "", "RAPID before an arc is ignored: arcs run at the feed");
      arc->to = to;
      return add(*arc);
    }
    if (rapid) return add(Rapid{to});
    return add(Feed{to});
  }

  Result<void> finish(AptScanner& scanner) {
    if (!ended_) {
      std::string half;
      if (unfinished_ || circle_ || rapid_) half = "; the half statement at its end is left out";
      diagnostics_.info("no_fini", "the file ends without FINI: it may be cut off" + half,
                        {.file = options_.file_name});
    } else if (circle_) {
      return error(ErrorCode::syntax, "CIRCLE/ without a GOTO/ after it (one GOTO/)");
    }
    if (tool_ || cutter_) {
      if (auto ok = change(tool_.value_or(0), tool_line_); !ok) return ok;
    }
    if (!fini_) return {};
    AptStatement rest;
    const auto more = scanner.next(rest);
    if (!more || *more) once(Severity::info, "after_fini", "", "what stands after FINI is not read");
    return {};
  }

  const AptOptions& options_;
  Diagnostics& diagnostics_;
  Program program_;
  const AptStatement* statement_ = nullptr;
  std::set<std::string> said_;
  double scale_ = 1;
  Vec3 axis_{0, 0, 1};
  std::optional<Point3> at_;
  std::optional<Arc> circle_;
  std::optional<std::array<double, 2>> cutter_;  // CUTTER/ that waits for LOADTL/
  std::optional<int> tool_;                      // TOOLNO/ that does
  std::optional<std::size_t> open_tool_;         // a tool change that waits for CUTTER/
  int tool_line_ = 0;
  Rotation rotation_ = Rotation::clockwise;
  double rpm_ = 0;
  bool rapid_ = false, fini_ = false, ended_ = false, unfinished_ = false;
};

// --- writer
// -----------------------------------------------------------------------------------------------------

constexpr int kLengthDecimals = 9;
constexpr int kAxisDecimals = 12;

class Writer {
 public:
  std::string run(const Program& program) {
    if (!program.name.empty()) line("PARTNO " + one_line(program.name));
    line("UNITS/MM");
    if (program.from) line("FROM/" + pose(*program.from));
    for (const Record& record : program.records) std::visit([this](const auto& r) { put(r); }, record);
    line("FINI");
    return std::move(text_);
  }

 private:
  void line(const std::string& text) {
    text_ += text;
    text_ += '\n';
  }
  static std::string one_line(std::string text) {
    for (char& c : text)
      if ((static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f) c = ' ';
    return text;
  }
  static std::string length(double value) { return format_fixed(value, kLengthDecimals); }
  static std::string point(const Point3& p) { return length(p.x) + ',' + length(p.y) + ',' + length(p.z); }
  static std::string direction(const Vec3& v) {
    return format_fixed(v.x, kAxisDecimals) + ',' + format_fixed(v.y, kAxisDecimals) + ',' +
           format_fixed(v.z, kAxisDecimals);
  }
  std::string pose(const Pose& p) {
    const std::string axis = direction(p.axis);
    if (axis == axis_) return point(p.tip);
    axis_ = axis;
    return point(p.tip) + ',' + axis;
  }

  void put(const Rapid& r) {
    line("RAPID");
    line("GOTO/" + pose(r.to));
  }
  void put(const Feed& f) { line("GOTO/" + pose(f.to)); }
  void put(const Arc& a) {
    line("CIRCLE/" + point(a.center) + ',' + direction(a.normal) + ',' + length(a.radius));
    line("GOTO/" + pose(a.to));
  }
  void put(const FeedRate& f) { line("FEDRAT/" + length(f.mm_min) + ",MMPM"); }
  void put(const Spindle& s) {
    if (s.rotation == Rotation::off) return line("SPINDL/OFF");
    line("SPINDL/RPM," + length(s.rpm) + (s.rotation == Rotation::clockwise ? ",CLW" : ",CCLW"));
  }
  void put(const Beam& b) { line(b.on ? "BEAM/ON," + length(b.power_w) : "BEAM/OFF"); }
  void put(const Dwell& d) { line("DELAY/" + length(d.seconds)); }
  void put(const ToolChange& t) {
    // CUTTER/ always goes before LOADTL/, so that the reader knows which tool it belongs to.
    line("CUTTER/" + length(t.diameter) + ',' + length(t.corner_radius));
    line("LOADTL/" + std::to_string(t.number));
  }
  void put(const Coolant& c) { line(c.on ? "COOLNT/ON" : "COOLNT/OFF"); }
  void put(const Comment& c) { line("PPRINT " + one_line(c.text)); }
  void put(const Unknown& u) { line(one_line(u.text)); }

  std::string text_;
  std::string axis_ = "0,0,1";
};

}  // namespace

std::string write_apt(const Program& program) {
  return Writer().run(program);
}

Result<Program> read_apt(std::string_view text, const AptOptions& options, Diagnostics& diagnostics) {
  return Reader(options, diagnostics).run(text);
}

}  // namespace burin::cl
