// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// @file PNG images, laid byte by byte.

namespace excavplan::test {

std::string big_endian(std::uint32_t value);

std::string png_chunk(const std::string& content);

/// Bytes as a zlib stream of stored blocks, each of at most 65535 bytes.
std::string zlib_stored(const std::string& bytes);

/// A 16-bit greyscale PNG.
std::string png_of(std::uint32_t width, const std::vector<std::uint16_t>& pixels);

}  // namespace excavplan::test
