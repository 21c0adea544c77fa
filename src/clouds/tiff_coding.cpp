// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/tiff_coding.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include <zlib.h>

#include "base/scalar.hpp"

namespace excavplan {
namespace {

constexpr std::uint64_t none = 1, lzw = 5, deflate = 8, pack_bits = 32773, old_deflate = 32946;

using Unpacked = std::optional<std::string>;

Unpacked of_pack_bits(std::string_view packed, std::size_t count) {
  std::string bytes;
  while (bytes.size() < count && !packed.empty()) {
    const std::size_t head = static_cast<unsigned char>(packed.front());
    packed.remove_prefix(1);
    if (head < 128) {
      const std::size_t length = head + 1;
      if (length > packed.size()) return std::nullopt;
      bytes += packed.substr(0, length);
      packed.remove_prefix(length);
    } else if (head > 128) {
      if (packed.empty()) return std::nullopt;
      bytes.append(257 - head, packed.front());
      packed.remove_prefix(1);
    }
  }
  return bytes;
}

/// Codes of 9 to 12 bits, the highest bit first.
class LzwCodes {
 public:
  explicit LzwCodes(std::string_view packed) : packed_(packed) {}
  std::optional<unsigned> next(unsigned width) {
    while (held_ < width) {
      if (packed_.empty()) return std::nullopt;
      bits_ = bits_ << 8U | static_cast<unsigned char>(packed_.front());
      packed_.remove_prefix(1);
      held_ += 8;
    }
    held_ -= width;
    return bits_ >> held_ & ((1U << width) - 1U);
  }

 private:
  std::string_view packed_;
  std::uint32_t bits_ = 0;
  unsigned held_ = 0;
};

Unpacked of_lzw(std::string_view packed, std::size_t count) {
  constexpr unsigned clear = 256, end = 257, most = 4096;
  struct Word {
    std::size_t begin;  // in the bytes that came out
    std::size_t size;
  };
  std::vector<Word> words;  // from code 258
  LzwCodes codes(packed);
  std::string bytes;
  Word last = {0, 0};
  const auto width = [&words] {
    const std::size_t next = 258 + words.size() + 1;
    return next < 512 ? 9U : next < 1024 ? 10U : next < 2048 ? 11U : 12U;
  };
  while (bytes.size() < count) {
    const auto code = codes.next(width());
    if (!code || *code == end) break;
    if (*code == clear) {
      words.clear();
      last = {0, 0};
      continue;
    }
    const Word now = {bytes.size(), 0};
    const std::size_t known = *code < clear ? 0 : *code - 258U;
    if (*code >= clear && known > words.size()) return std::nullopt;
    if (*code >= clear && known == words.size() && last.size == 0) return std::nullopt;
    if (*code < clear) {
      bytes += static_cast<char>(*code);
    } else {
      const Word word = known < words.size() ? words[known] : Word{last.begin, last.size + 1};
      for (std::size_t i = 0; i < word.size; ++i) bytes += bytes[word.begin + i];
    }
    if (last.size > 0 && words.size() + 258 < most) words.push_back({last.begin, last.size + 1});
    last = {now.begin, bytes.size() - now.begin};
  }
  return bytes;
}

Unpacked of_deflate(std::string_view packed, std::size_t count) {
  std::string bytes(count, '\0');
  z_stream stream = {};
  if (inflateInit(&stream) != Z_OK) return std::nullopt;
  // zlib reads these bytes alone; it has no pointer to constant ones unless it is told to.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(count);
  const int fault = inflate(&stream, Z_FINISH);
  const bool is_whole = (fault == Z_STREAM_END || fault == Z_BUF_ERROR) && stream.avail_out == 0;
  inflateEnd(&stream);
  if (!is_whole) return std::nullopt;
  return bytes;
}

template <typename Number>
void add_up(const PredictedRows& rows, char* row) {
  const std::size_t numbers = rows.row_bytes / sizeof(Number);
  for (std::size_t i = rows.samples; i < numbers; ++i) {
    char* const place = row + i * sizeof(Number);
    const auto before = load<Number>(place - rows.samples * sizeof(Number), rows.is_swapped);
    auto sum = static_cast<Number>(load<Number>(place, rows.is_swapped) + before);
    std::array<char, sizeof(Number)> raw;
    std::memcpy(raw.data(), &sum, raw.size());
    if (rows.is_swapped) std::reverse(raw.begin(), raw.end());
    std::memcpy(place, raw.data(), raw.size());
  }
}

/// The bytes of the numbers lie in planes, that of the highest bytes first.
void join_planes(const PredictedRows& rows, char* row) {
  for (std::size_t i = rows.samples; i < rows.row_bytes; ++i) {
    row[i] = static_cast<char>(static_cast<unsigned char>(row[i]) +
                               static_cast<unsigned char>(row[i - rows.samples]));
  }
  const std::string planes(row, rows.row_bytes);
  const std::size_t numbers = rows.row_bytes / rows.number_bytes;
  for (std::size_t i = 0; i < numbers; ++i) {
    for (std::size_t byte = 0; byte < rows.number_bytes; ++byte) {
      const std::size_t plane = rows.is_swapped ? byte : rows.number_bytes - 1 - byte;
      row[i * rows.number_bytes + byte] = planes[plane * numbers + i];
    }
  }
}

}  // namespace

bool is_known_compression(std::uint64_t compression) {
  return compression == none || compression == lzw || compression == deflate ||
         compression == pack_bits || compression == old_deflate;
}

std::optional<std::string> unpacked(std::uint64_t compression, std::string_view packed,
                                    std::size_t count) {
  Unpacked bytes;
  if (compression == none) bytes = std::string(packed.substr(0, count));
  if (compression == lzw) bytes = of_lzw(packed, count);
  if (compression == pack_bits) bytes = of_pack_bits(packed, count);
  if (compression == deflate || compression == old_deflate) bytes = of_deflate(packed, count);
  if (!bytes || bytes->size() < count) return std::nullopt;
  bytes->resize(count);
  return bytes;
}

void take_predictor_off(std::uint64_t predictor, const PredictedRows& rows, std::string& bytes) {
  if (predictor == 1) return;
  for (std::size_t at = 0; at + rows.row_bytes <= bytes.size(); at += rows.row_bytes) {
    char* const row = bytes.data() + at;
    if (predictor == 3) {
      join_planes(rows, row);
    } else if (rows.number_bytes == 1) {
      add_up<std::uint8_t>(rows, row);
    } else if (rows.number_bytes == 2) {
      add_up<std::uint16_t>(rows, row);
    } else if (rows.number_bytes == 4) {
      add_up<std::uint32_t>(rows, row);
    } else {
      add_up<std::uint64_t>(rows, row);
    }
  }
}

}  // namespace excavplan
