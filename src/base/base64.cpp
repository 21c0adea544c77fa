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

template <typename ByteAt>
std::string encoded(std::size_t bytes, ByteAt byte_at) {
  std::string text(text_size(bytes), '=');
  for (std::size_t from = 0, to = 0; from < bytes; from += 3, to += 4) {
    const std::size_t held = bytes - from < 3 ? bytes - from : 3;
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      group = group << 8 | (i < held ? byte_at(from + i) : 0U);
    }
    for (std::size_t i = 0; i <= held; ++i) text[to + i] = letters[group >> (18 - 6 * i) & 63U];
  }
  return text;
}

template <typename Take>
bool decoded(std::string_view text, std::size_t bytes, Take take) {
  if (text.size() != text_size(bytes)) return false;
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
      take(to, static_cast<std::uint8_t>(group >> (16 - 8 * i) & 255U));
    }
  }
  return true;
}

}  // namespace

std::string base64_of(const double* numbers, std::size_t count) {
  return encoded(8 * count, [&](std::size_t at) { return byte_of(numbers, at); });
}

std::string base64_of(std::string_view bytes) {
  return encoded(bytes.size(),
                 [&](std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); });
}

bool read_base64(std::string_view text, double* numbers, std::size_t count) {
  std::uint64_t bits = 0;
  return decoded(text, 8 * count, [&](std::size_t at, std::uint8_t byte) {
    bits |= std::uint64_t{byte} << (8 * (at % 8));
    if (at % 8 != 7) return;
    std::memcpy(numbers + at / 8, &bits, sizeof bits);
    bits = 0;
  });
}

std::optional<std::string> read_base64(std::string_view text) {
  std::size_t padding = 0;
  while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
  std::string bytes(text.size() / 4 * 3 - (text.size() < 4 ? 0 : padding), '\0');
  const bool is_whole = decoded(text, bytes.size(), [&](std::size_t at, std::uint8_t byte) {
    bytes[at] = static_cast<char>(byte);
  });
  if (!is_whole) return std::nullopt;
  return bytes;
}

}  // namespace excavplan
