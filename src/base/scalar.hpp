// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

/// @file
/// Numbers in the bytes of a file, of a type that the file names. Private to the project.

namespace excavplan {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
              "the byte order of files is compared with little endian");

enum class ScalarType {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

inline bool is_integer(ScalarType type) { return type < ScalarType::float32; }

/// Calls `body` with a value of the C++ type that `type` stands for.
template <typename Body>
auto with_type(ScalarType type, Body body) {
  switch (type) {
    case ScalarType::int8:
      return body(std::int8_t{});
    case ScalarType::uint8:
      return body(std::uint8_t{});
    case ScalarType::int16:
      return body(std::int16_t{});
    case ScalarType::uint16:
      return body(std::uint16_t{});
    case ScalarType::int32:
      return body(std::int32_t{});
    case ScalarType::uint32:
      return body(std::uint32_t{});
    case ScalarType::int64:
      return body(std::int64_t{});
    case ScalarType::uint64:
      return body(std::uint64_t{});
    case ScalarType::float32:
      return body(float{});
    case ScalarType::float64:
      break;
  }
  return body(double{});
}

/// [byte]
inline std::size_t size_of(ScalarType type) {
  return with_type(type, [](auto value) { return sizeof value; });
}

/// The number at `bytes`, little endian or, with `swapped`, big endian.
template <typename T>
T load(const char* bytes, bool swapped) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), bytes, raw.size());
  if (swapped) std::reverse(raw.begin(), raw.end());
  T value;
  std::memcpy(&value, raw.data(), raw.size());
  return value;
}

/// Adds a number to the bytes of a file, the lowest byte first.
template <typename Number>
void put(Number value, std::string& bytes) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace excavplan
