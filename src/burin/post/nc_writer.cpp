// SPDX-License-Identifier: Apache-2.0
#include "burin/post/nc_writer.h"

#include <algorithm>

#include "burin/base/text.h"
#include "burin/post/words.h"

namespace burin::post {

Result<void> NcWriter::begin() {
  if (options_.program_number < 1 || options_.program_number > 9999)
    return Error{
        ErrorCode::usage, "program number " + std::to_string(options_.program_number) + " (1 to 9999)", {}};
  if (auto ok = cl::validate(program_, kArcInput_mm); !ok) return ok;
  if (dialect_.percent) raw_line("%");
  return frame(dialect_.header);
}

Result<NcText> NcWriter::finish() {
  index_ = NcText::kNoRecord;
  if (auto ok = frame(dialect_.footer); !ok) return ok.error();
  if (dialect_.percent) raw_line("%");
  return std::move(out_);
}

Error NcWriter::error(ErrorCode code, const std::string& what) const {
  std::string place = "record " + std::to_string(index_);
  if (index_ < program_.records.size() && cl::is_motion(program_.records[index_]))
    place += ", move " + std::to_string(move_);
  return {code, place + ": " + what, {}};
}

void NcWriter::raw_line(const std::string& text) {
  out_.text += text;
  out_.text += '\n';
  out_.line_to_record.push_back(in_frame_ || index_ >= program_.records.size()
                                    ? NcText::kNoRecord
                                    : static_cast<std::uint32_t>(index_));
}

Result<void> NcWriter::line(std::string text, bool has_comment) {
  if (dialect_.line_numbers) {
    // Five digits are the most that every control takes.
    number_ = number_ + dialect_.line_number_step > 99999 ? dialect_.line_number_step
                                                          : number_ + dialect_.line_number_step;
    text.insert(0, "N" + std::to_string(number_) + " ");
  }
  if (text.size() > dialect_.line_limit && !has_comment)
    text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  if (text.size() > dialect_.line_limit)
    return error(ErrorCode::range, "a block of " + std::to_string(text.size()) + " characters (at most " +
                                       std::to_string(dialect_.line_limit) + " for " + dialect_.name + ")");
  raw_line(text);
  return {};
}

Result<void> NcWriter::frame(const std::vector<std::string>& lines) {
  in_frame_ = true;
  std::string number = std::to_string(options_.program_number);
  number.insert(0, 4 - number.size(), '0');
  for (std::string text : lines) {
    text = fill(std::move(text), "program_number", number);
    const bool named = text.find("{name}") != std::string::npos;
    const std::size_t room = dialect_.line_limit - std::min(dialect_.line_limit, text.size() + 8);
    const std::string name =
        options_.comments ? comment_text(program_.name, dialect_, std::min(dialect_.comment_limit, room))
                          : "";
    if (named && name.empty()) {
      const std::string empty = dialect_.comment_open + "{name}" + dialect_.comment_close;
      if (const auto at = text.find(empty); at != std::string::npos) text.erase(at, empty.size());
    }
    text = std::string(trim(fill(std::move(text), "name", name)));
    if (text.empty()) continue;
    if (text[0] == 'O' || text[0] == '%') {
      raw_line(text);  // a program number stands without N
    } else if (auto ok = line(text, named); !ok) {
      return ok;
    }
  }
  in_frame_ = false;
  return {};
}

std::string NcWriter::g(int code) const {
  return (dialect_.two_digit_codes && code < 10 ? "G0" : "G") + std::to_string(code);
}

Result<void> NcWriter::put(const cl::FeedRate& feed) {
  const std::string text = number_text(feed.mm_min, dialect_.feed_decimals, dialect_.require_point);
  if (parse_double(text).value_or(0) <= 0)
    return error(ErrorCode::range,
                 "a feed of " + format_shortest(feed.mm_min) + " mm/min rounds to 0 (more)");
  feed_ = text;
  return {};
}

Result<void> NcWriter::put(const cl::Spindle& spindle) {
  if (spindle_ == spindle) return {};
  spindle_ = spindle;
  const std::string rpm = number_text(spindle.rpm, dialect_.power_decimals, false);
  switch (spindle.rotation) {
    case cl::Rotation::clockwise:
      return word_line(fill(dialect_.spindle_cw, "rpm", rpm), "the spindle");
    case cl::Rotation::counter_clockwise:
      return word_line(fill(dialect_.spindle_ccw, "rpm", rpm), "the spindle");
    case cl::Rotation::off:
      break;
  }
  return word_line(dialect_.spindle_off, "the spindle");
}

Result<void> NcWriter::put(const cl::Beam& beam) {
  if (beam_ && beam_->on == beam.on && (!beam.on || beam_->power_w == beam.power_w)) return {};
  const bool change = beam_ && beam_->on && beam.on;
  beam_ = beam;
  const std::string power = number_text(beam.power_w * dialect_.power_scale, dialect_.power_decimals, false);
  // S0 would burn nothing; without S the control keeps the power it has.
  if (beam.on && beam.power_w == 0 && !change && !dialect_.beam_on_plain.empty()) {
    if (!std::exchange(said_no_power_, true)) {
      diagnostics_.info("no_power", "no power is known: the beam goes on without an S word");
    }
    return word_line(dialect_.beam_on_plain, "a beam");
  }
  if (change && dialect_.power_inline) return line("S" + power);
  return word_line(beam.on ? fill(dialect_.beam_on, "power", power) : dialect_.beam_off, "a beam");
}

Result<void> NcWriter::word_line(const std::string& text, const std::string& what) {
  if (text.empty())
    return error(ErrorCode::unsupported,
                 "the dialect " + dialect_.name + " has no word for " + what + " (a dialect file that has)");
  return line(text);
}

Result<void> NcWriter::put(const cl::Dwell& dwell) {
  constexpr int kSecondDecimals = 3;
  std::string text =
      fill(dialect_.dwell, "seconds", number_text(dwell.seconds, kSecondDecimals, dialect_.require_point));
  text = fill(std::move(text), "milliseconds", number_text(dwell.seconds * 1000, 0, false));
  return word_line(text, "a dwell");
}

Result<void> NcWriter::put(const cl::ToolChange& tool) {
  if (tool.number == 0) return {};  // only the cutter's dimensions are known: nothing to load
  if (!dialect_.tool_change_supported) {
    once("tool_change", "the tool change to " + std::to_string(tool.number) +
                            " is left out: " + dialect_.name + " has none");
    return {};
  }
  const std::string number = std::to_string(tool.number);
  length_ = options_.write_z ? fill(dialect_.tool_length, "number", number) : "";
  return word_line(fill(dialect_.tool_change, "number", number), "a tool change");
}

Result<void> NcWriter::put(const cl::Coolant& coolant) {
  if (coolant_ && coolant_->on == coolant.on) return {};
  coolant_ = coolant;
  return word_line(coolant.on ? dialect_.coolant_on : dialect_.coolant_off, "coolant");
}

Result<void> NcWriter::put(const cl::Comment& comment) {
  if (!options_.comments) return {};
  const std::size_t frame_size = dialect_.comment_open.size() + dialect_.comment_close.size() + 8;
  const std::size_t room = dialect_.line_limit - std::min(dialect_.line_limit, frame_size);
  const std::string text = comment_text(comment.text, dialect_, std::min(dialect_.comment_limit, room));
  if (text.empty()) return {};
  return line(dialect_.comment_open + text + dialect_.comment_close, true);
}

Result<void> NcWriter::put(const cl::Unknown& unknown) {
  if (unknown.text == "STOP") return word_line(dialect_.stop, "a stop");
  if (unknown.text == "OPSTOP") return word_line(dialect_.optional_stop, "an optional stop");
  const std::string word =
      unknown.text.substr(0, std::min(unknown.text.find_first_of("/ ,"), std::size_t{40}));
  once("unknown_statement", "'" + word + "' is not known and not in the NC text");
  return {};
}

void NcWriter::once(const std::string& code, const std::string& message) {
  if (said_.insert(message).second) diagnostics_.left_out(code, error(ErrorCode::internal, message).message);
}

}  // namespace burin::post
