// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace excavplan {
namespace {

constexpr double negligible = 1e-9;  // of a number to read; ours

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

struct Character {
  std::uint32_t code = 0;
  std::size_t size = 0;  ///< [byte]; 0: it is not UTF-8
};

/// What a text that is not empty begins with.
Character character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::uint32_t first = byte(0);
  if (first < 0x80) return {first, 1};
  const std::size_t size = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  if (first < 0xC2 || first > 0xF4 || size > text.size()) return {};
  std::uint32_t code = first & (0x7FU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t lowest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < lowest[size] || code > 0x10FFFF || is_surrogate) return {};
  return {code, size};
}

bool is_harmless(std::uint32_t code) {
  const bool is_control = code < 0x20 || (code >= 0x7F && code < 0xA0);
  const bool turns = code == 0x61C || code == 0x200E || code == 0x200F ||
                     (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
  return !is_control && !turns;
}

std::string safe(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const Character next = character(text);
    const std::size_t size = std::max<std::size_t>(next.size, 1);
    if (next.size > 0 && is_harmless(next.code)) {
      out.append(text.substr(0, size));
    } else {
      out += '?';
    }
    text.remove_prefix(size);
  }
  return out;
}

/// The first `most` bytes, or fewer where they would cut a character.
std::string_view whole_characters(std::string_view text, std::size_t most) {
  const auto continues = [&] { return (static_cast<unsigned char>(text[most]) & 0xC0U) == 0x80; };
  for (int i = 0; i < 3 && most > 0 && continues(); ++i) --most;
  return text.substr(0, most);
}

/// More digits than a person reads.
bool is_long(double value) { return std::abs(value) >= 1e15; }

std::string with_exponent(double value, int digits) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1).ptr;
  return {text, end};
}

}  // namespace

std::string number_text(double value) {
  char text[64];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string plain_number(double value) {
  constexpr double most = 1e15;
  const bool counts = std::abs(value) < most && value == std::floor(value);
  return counts ? decimals(value, 0) : number_text(value);
}

std::string hundredths(double value) { return number_text(std::round(value * 100.0) / 100.0); }

std::string decimals(double value, int digits) {
  char text[400];
  const auto end =
      std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits).ptr;
  return {text, end};
}

std::string readable(double value, int digits) {
  if (!std::isfinite(value)) return "unknown";
  if (is_long(value)) return with_exponent(value, digits);
  if (std::abs(value) < negligible) value = 0.0;
  const double magnitude = value == 0.0 ? 0.0 : std::floor(std::log10(std::abs(value)));
  int places = std::clamp(digits - 1 - static_cast<int>(magnitude), 0, 17);
  const double rounding = 0.5 * std::pow(10.0, -places);
  const double carried = std::pow(10.0, magnitude + 1.0);  // 9.9996 is 10.0, not 10.00
  if (places > 0 && std::abs(value) + rounding >= carried) --places;
  return decimals(value, places);
}

std::string readable(double value, double sd) {
  constexpr double of_value = 1e-5;  // less says nothing; ours
  if (!std::isfinite(sd) || sd < std::max(negligible, of_value * std::abs(value)))
    return readable(value);
  if (is_long(value) || is_long(sd)) return readable(value) + " ± " + readable(sd, 2);
  const std::string deviation = readable(sd, 2);
  const std::size_t point = deviation.find('.');
  const int places =
      point == std::string::npos ? 0 : static_cast<int>(deviation.size() - point - 1);
  const bool is_zero = std::abs(value) < 0.5 * std::pow(10.0, -places);  // which has no sign
  return decimals(is_zero ? 0.0 : value, places) + " ± " + deviation;
}

std::optional<std::size_t> first_not_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character(text.substr(at)).size;
    if (size == 0) return at;
    at += size;
  }
  return std::nullopt;
}

bool is_printable(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](unsigned char c) {
    return (c >= ' ' && c != 127) || c == '\t' || c == '\r';
  });
}

std::string safe_text(std::string_view text, std::size_t most) {
  constexpr std::string_view gap = " ... ";
  if (text.size() <= most) return safe(text);
  const std::size_t kept = most - gap.size();
  const std::size_t end = kept / 3;
  return safe(whole_characters(text, kept - end)).append(gap) +
         safe(text.substr(text.size() - end));
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  if (text.size() <= longest) return "'" + safe(text) + "'";
  return "'" + safe(whole_characters(text, longest)) + "...'";
}

std::string csv_field(std::string_view text) {
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + '"';
}

std::optional<std::string> fault_of_line(std::string_view text, std::size_t most) {
  if (text.size() > most) {
    return "a text of " + std::to_string(text.size()) + " bytes, expected at most " +
           std::to_string(most);
  }
  if (first_not_utf8(text)) return "not UTF-8";
  if (safe(text) == text) return std::nullopt;
  return in_quotes(text) + ", expected a text on one line without control characters";
}

std::string small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return small;
}

std::optional<std::string> nearest_word(const std::string& word,
                                        const std::vector<std::string>& words) {
  constexpr std::size_t longest = 256;  // of names in files and calls, which may have any length
  if (word.size() > longest) return std::nullopt;
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
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
