// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/base64.hpp"

#include <array>
#include <cstdint>
#include <cstring>

namespace excavplan {
namespace {

constexpr std::string_view letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t no_letter = 64;

const std::array<std::uint8_t, 256> values = [] {
  std::array<std::uint8_t, 256> table{};
  table.fill(no_letter);
  for (std::size_t i = 0; i < letters.size(); ++i) {
    table[static_cast<unsigned char>(letters[i])] = static_cast<std::uint8_t>(i);
  }
  return table;
}();

std::size_t text_size(std::size_t bytes) { return (bytes + 2) / 3 * 4; }

std::uint8_t byte_of(const double* numbers, std::size_t at) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, numbers + at / 8, sizeof bits);
  return static_cast<std::uint8_t>(bits >> (8 * (at % 8)));
}

}  // namespace

std::string base64_of(const double* numbers, std::size_t count) {
  const std::size_t bytes = 8 * count;
  std::string text(text_size(bytes), '=');
  for (std::size_t from = 0, to = 0; from < bytes; from += 3, to += 4) {
    const std::size_t held = bytes - from < 3 ? bytes - from : 3;
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      group = group << 8 | (i < held ? byte_of(numbers, from + i) : 0U);
    }
    for (std::size_t i = 0; i <= held; ++i) text[to + i] = letters[group >> (18 - 6 * i) & 63U];
  }
  return text;
}

bool read_base64(std::string_view text, double* numbers, std::size_t count) {
  const std::size_t bytes = 8 * count;
  if (text.size() != text_size(bytes)) return false;
  std::uint64_t bits = 0;
  for (std::size_t from = 0, to = 0; to < bytes; from += 4) {
    const std::size_t held = bytes - to < 3 ? bytes - to : 3;
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint8_t value = values[static_cast<unsigned char>(text[from + i])];
      const bool padding = i > held && text[from + i] == '=';
      if (!padding && (value == no_letter || i > held)) return false;
      group = group << 6 | (padding ? 0U : value);
    }
    for (std::size_t i = 0; i < held; ++i, ++to) {
      bits |= std::uint64_t{group >> (16 - 8 * i) & 255U} << (8 * (to % 8));
      if (to % 8 != 7) continue;
      std::memcpy(numbers + to / 8, &bits, sizeof bits);
      bits = 0;
    }
  }
  return true;
}

}  // namespace excavplan
