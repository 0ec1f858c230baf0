// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "burin/servo/measure.h"

namespace burin::servo {
namespace {

constexpr std::size_t kColumns = 9;

std::array<double, kColumns> columns(const Setpoint& s) {
  return {s.t_s, s.x, s.y, s.z, s.feed_mm_min, static_cast<double>(s.surface), static_cast<double>(s.pass),
          s.u,   s.v};
}

/// Fixed point with 12 decimals, zeros after the ninth left out. By hand because a million rows are nine
/// million numbers; the fraction of a double is exact, so the digits are right to 1e-4 of the last one.
char* write_number(char* out, double value) {
  constexpr double kWhole = 1e15;  // below, the whole part is exact in 64 bits
  constexpr double kUnits = 1e12;
  constexpr int kDecimals = 12, kLeast = 9;
  if (!(std::abs(value) < kWhole))
    return std::to_chars(out, out + 400, value, std::chars_format::fixed, 9).ptr;
  double size = std::abs(value);
  auto whole = static_cast<std::uint64_t>(size);
  auto units = static_cast<std::uint64_t>(std::llround((size - static_cast<double>(whole)) * kUnits));
  if (units == static_cast<std::uint64_t>(kUnits)) ++whole, units = 0;
  if (value < 0 && (whole > 0 || units > 0)) *out++ = '-';
  out = std::to_chars(out, out + 20, whole).ptr;
  *out++ = '.';
  for (int i = kDecimals; i-- > 0; units /= 10) out[i] = static_cast<char>('0' + units % 10);
  int digits = kDecimals;
  while (digits > kLeast && out[digits - 1] == '0') --digits;
  return out + digits;
}

char* write_integer(char* out, std::int32_t value) {
  return std::to_chars(out, out + 12, value).ptr;
}

}  // namespace

std::string to_npy(const std::vector<Setpoint>& setpoints) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" +
                       std::to_string(setpoints.size()) + ", " + std::to_string(kColumns) + "), }";
  constexpr std::size_t kPrefix = 10, kAlign = 64;  // magic, version, length; data starts aligned
  header.append((kAlign - (kPrefix + header.size() + 1) % kAlign) % kAlign, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size() & 0xff);
  out += static_cast<char>(header.size() >> 8);
  out += header;
  const std::size_t begin = out.size();
  out.resize(begin + setpoints.size() * kColumns * 8);
  char* at = out.data() + begin;
  for (const Setpoint& s : setpoints) {
    for (const double value : columns(s)) {
      auto bits = std::bit_cast<std::uint64_t>(value);
      for (int i = 0; i < 8; ++i, bits >>= 8) *at++ = static_cast<char>(bits & 0xff);
    }
  }
  return out;
}

std::string to_csv(const std::vector<Setpoint>& setpoints) {
  std::string out = "t_s,x_mm,y_mm,z_mm,feed_mm_min,surface,path,u,v\n";
  out.reserve(out.size() + setpoints.size() * 110);
  char row[kColumns * 410];  // a double in fixed point has at most 309 + 11 characters
  for (const Setpoint& s : setpoints) {
    char* at = row;
    for (const double value : {s.t_s, s.x, s.y, s.z, s.feed_mm_min}) {
      at = write_number(at, value);
      *at++ = ',';
    }
    at = write_integer(at, s.surface);
    *at++ = ',';
    at = write_integer(at, s.pass);
    *at++ = ',';
    if (!std::isnan(s.u)) at = write_number(at, s.u);
    *at++ = ',';
    if (!std::isnan(s.v)) at = write_number(at, s.v);
    *at++ = '\n';
    out.append(row, static_cast<std::size_t>(at - row));
  }
  return out;
}

}  // namespace burin::servo
