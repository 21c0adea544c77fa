// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace excavplan {

/// Adds a number to the bytes of a file, the lowest byte first.
template <typename Number>
void put(Number value, std::string& bytes) {
  static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace excavplan
