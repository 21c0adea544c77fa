// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace excavplan {
namespace {

/// Insertions, deletions, replacements and swaps of neighbours that turn one word into the other
/// (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

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

std::string quoted(std::string_view text) {
  std::string out(text.substr(0, 40));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < 32 || c == 127; }, '?');
  return "'" + out + (text.size() > 40 ? "...'" : "'");
}

std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& words) {
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  constexpr std::size_t longest = 256;  // of names in files, which may have any length
  for (const std::string& candidate : words) {
    if (candidate.size() > longest) continue;
    const bool abbreviated = word.size() >= 2 && candidate.rfind(word, 0) == 0;
    const std::size_t distance = abbreviated ? 1 : edit_distance(word, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      best = candidate;
    }
  }
  return best;
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
