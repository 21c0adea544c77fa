// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/read_double.hpp"

#ifndef __cpp_lib_to_chars
#include <algorithm>
#include <cerrno>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <string>
#include <system_error>
#endif

namespace excavplan {

#ifdef __cpp_lib_to_chars

std::from_chars_result read_double(const char* begin, const char* end, double& value) {
  return std::from_chars(begin, end, value);
}

#else

namespace {

const char* past_digits(const char* at, const char* end) {
  return std::find_if(at, end, [](char c) { return c < '0' || c > '9'; });
}

/// Behind the exponent that begins here; `at` if none does.
const char* past_exponent(const char* at, const char* end) {
  if (at == end || (*at != 'e' && *at != 'E')) return at;
  const char* const digits = at + (at + 1 < end && (at[1] == '+' || at[1] == '-') ? 2 : 1);
  const char* const last = past_digits(std::min(digits, end), end);
  return last > digits ? last : at;
}

/// Behind the word, in letters of either size, if the text begins with it; else `at`.
const char* past_word(const char* at, const char* end, const std::string& word) {
  const bool is_there = end - at >= static_cast<std::ptrdiff_t>(word.size()) &&
                        std::equal(word.begin(), word.end(), at,
                                   [](char low, char c) { return c == low || c == low - 32; });
  return is_there ? at + word.size() : at;
}

/// What strtod() would take too is left: blanks, a plus, hexadecimals.
const char* past_number(const char* begin, const char* end) {
  const char* const first = begin + (begin < end && *begin == '-' ? 1 : 0);
  for (const char* word : {"infinity", "inf", "nan"}) {
    if (const char* const last = past_word(first, end, word); last > first) return last;
  }
  const char* last = past_digits(first, end);
  std::ptrdiff_t digits = last - first;
  if (last < end && *last == '.') {
    const char* const fraction = last + 1;
    const char* const behind = past_digits(fraction, end);
    digits += behind - fraction;
    if (digits > 0) last = behind;
  }
  return digits > 0 ? past_exponent(last, end) : begin;
}

}  // namespace

std::from_chars_result read_double(const char* begin, const char* end, double& value) {
  static const locale_t plain = ::newlocale(LC_ALL_MASK, "C", nullptr);
  const char* const last = past_number(begin, end);
  if (last == begin) return {begin, std::errc::invalid_argument};
  errno = 0;
  const double found = ::strtod_l(std::string(begin, last).c_str(), nullptr, plain);
  if (errno == ERANGE && (found == 0.0 || std::isinf(found))) {
    return {last, std::errc::result_out_of_range};
  }
  value = found;
  return {last, {}};
}

#endif

}  // namespace excavplan
