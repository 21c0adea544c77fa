// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace excavplan {

std::string number_text(double value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string decimals(double value, int digits) {
  char text[400];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr;
  return {text, end};
}

std::string readable(double value, int digits) {
  if (!std::isfinite(value)) return "unknown";
  const double magnitude = value == 0.0 ? 0.0 : std::floor(std::log10(std::abs(value)));
  int places = std::clamp(digits - 1 - static_cast<int>(magnitude), 0, 17);
  const double rounding = 0.5 * std::pow(10.0, -places);
  const double carried = std::pow(10.0, magnitude + 1.0);  // 9.9996 is 10.0, not 10.00
  if (places > 0 && std::abs(value) + rounding >= carried) --places;
  return decimals(value, places);
}

std::string readable(double value, double sd) {
  if (!std::isfinite(sd) || sd <= 0.0) return readable(value);
  const std::string deviation = readable(sd, 2);
  const std::size_t point = deviation.find('.');
  const int places =
      point == std::string::npos ? 0 : static_cast<int>(deviation.size() - point - 1);
  return decimals(value, places) + " ± " + deviation;
}

std::uint64_t checksum(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

std::string checksum_text(const std::string& text) {
  std::uint64_t hash = checksum(text);
  std::string digits(16, '0');
  for (std::size_t i = 16; i-- > 0; hash >>= 4) digits[i] = "0123456789abcdef"[hash & 15];
  return digits;
}

}  // namespace excavplan
