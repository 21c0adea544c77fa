// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "support/png_bytes.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace excavplan::test {

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xffU);
  return bytes;
}

std::string png_chunk(const std::string& content) {
  std::uint32_t crc = 0xffffffffU;
  for (const char c : content) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (crc & 1U ? 0xedb88320U : 0U);
  }
  return big_endian(static_cast<std::uint32_t>(content.size() - 4)) + content + big_endian(~crc);
}

std::string zlib_stored(const std::string& bytes) {
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<unsigned char>(c)) % 65521U;
    b = (b + a) % 65521U;
  }
  std::string stored = "\x78\x01";
  for (std::size_t at = 0; at == 0 || at < bytes.size(); at += 65535) {
    const std::string block = bytes.substr(at, 65535);
    const auto size = static_cast<std::uint32_t>(block.size());
    stored += at + size == bytes.size() ? '\1' : '\0';  // the last one or not
    for (const std::uint32_t n : {size, ~size}) {
      stored += static_cast<char>(n & 0xffU);
      stored += static_cast<char>(n >> 8U & 0xffU);
    }
    stored += block;
  }
  return stored + big_endian(b << 16U | a);
}

std::string png_of(std::uint32_t width, const std::vector<std::uint16_t>& pixels) {
  std::string rows;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i % width == 0) rows += '\0';  // no filter
    rows += static_cast<char>(pixels[i] >> 8U);
    rows += static_cast<char>(pixels[i] & 0xffU);
  }
  const auto height = static_cast<std::uint32_t>(pixels.size()) / width;
  const std::string kind = {16, 0, 0, 0, 0};
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR" + big_endian(width) + big_endian(height) + kind) +
         png_chunk("IDAT" + zlib_stored(rows)) + png_chunk("IEND");
}

}  // namespace excavplan::test
