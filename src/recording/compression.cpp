// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/compression.hpp"

#include <array>
#include <memory>
#include <new>
#include <string_view>

#ifdef EXCAVPLAN_WITH_LZ4
#include <lz4frame.h>
#endif
#ifdef EXCAVPLAN_WITH_ZSTD
#include <zstd.h>
#include <zstd_errors.h>
#endif
#ifdef EXCAVPLAN_WITH_BZ2
#include <bzlib.h>
#endif

namespace excavplan {
namespace {

[[noreturn]] void fail(const CompressedPart& part, const std::string& found,
                       const std::string& expected) {
  fail_at(part.file, part.place, found, expected);
}

[[maybe_unused, noreturn]] void refuse_without(const std::string& name, const std::string& package,
                                               const std::string& file, const std::string& place) {
  throw Unsupported(file + ": " + place + ": found data compressed with " + name +
                    ", expected none: this build is without " + name +
                    "; build it anew with Debian's " + package);
}

[[maybe_unused]] void require_size(const CompressedPart& part, std::uint64_t delivered) {
  if (delivered == part.size) return;
  fail(part, "compressed data that hold " + std::to_string(delivered) + " bytes",
       "the " + std::to_string(part.size) + " that it says to hold");
}

[[maybe_unused, noreturn]] void fail_damaged(const CompressedPart& part, const std::string& why) {
  fail(part, "damaged compressed data (" + why + ")",
       std::to_string(part.size) + " bytes uncompressed");
}

Bytes from_lz4(const CompressedPart& part) {
#ifdef EXCAVPLAN_WITH_LZ4
  constexpr std::string_view no_memory = "ERROR_allocation_failed";
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION))) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  Bytes out(part.size);
  std::size_t read = 0, written = 0, hint = 1;
  while (read < part.bytes.size()) {
    std::size_t taken = part.bytes.size() - read;
    std::size_t given = out.size() - written;
    hint = LZ4F_decompress(context.get(), out.data() + written, &given, part.bytes.data() + read,
                           &taken, nullptr);
    if (LZ4F_isError(hint) && LZ4F_getErrorName(hint) == no_memory) throw std::bad_alloc();
    if (LZ4F_isError(hint)) fail_damaged(part, LZ4F_getErrorName(hint));
    if (taken == 0 && given == 0) fail_damaged(part, "more than it says to hold");
    read += taken;
    written += given;
  }
  if (hint != 0) fail_damaged(part, "ends too early");
  require_size(part, written);
  return out;
#else
  refuse_without("LZ4", "liblz4-dev", part.file, part.place);
#endif
}

Bytes from_zstd(const CompressedPart& part) {
#ifdef EXCAVPLAN_WITH_ZSTD
  Bytes out(part.size);
  const std::size_t written =
      ZSTD_decompress(out.data(), out.size(), part.bytes.data(), part.bytes.size());
  if (ZSTD_getErrorCode(written) == ZSTD_error_memory_allocation) throw std::bad_alloc();
  if (ZSTD_isError(written)) fail_damaged(part, ZSTD_getErrorName(written));
  require_size(part, written);
  return out;
#else
  refuse_without("Zstandard", "libzstd-dev", part.file, part.place);
#endif
}

Bytes from_bz2(const CompressedPart& part) {
#ifdef EXCAVPLAN_WITH_BZ2
  Bytes out(part.size);
  auto written = static_cast<unsigned>(part.size);
  char* const input = const_cast<char*>(part.bytes.data());  // an old interface; only read
  const int result = BZ2_bzBuffToBuffDecompress(out.data(), &written, input,
                                                static_cast<unsigned>(part.bytes.size()), 0, 0);
  if (result == BZ_MEM_ERROR) throw std::bad_alloc();
  if (result == BZ_OUTBUFF_FULL) fail_damaged(part, "more than it says to hold");
  if (result != BZ_OK) fail_damaged(part, "bzip2 error " + std::to_string(result));
  require_size(part, written);
  return out;
#else
  refuse_without("bzip2", "libbz2-dev", part.file, part.place);
#endif
}

// Eight tables, so that eight bytes are taken at once: table k tells what a byte adds that is
// followed by k zeros.
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables make_crc_tables() {
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) value = value & 1 ? value >> 1 ^ 0xEDB88320u : value >> 1;
    tables[0][byte] = value;
  }
  for (std::size_t k = 1; k < 8; ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = before >> 8 ^ tables[0][before & 255];
    }
  }
  return tables;
}

}  // namespace

Bytes decompress(const CompressedPart& part) {
  if (part.size > most_bytes) {
    fail(part, "data of " + std::to_string(part.size) + " bytes uncompressed",
         "at most " + std::to_string(most_bytes));
  }
  switch (part.compression) {
    case Compression::lz4:
      return from_lz4(part);
    case Compression::zstd:
      return from_zstd(part);
    case Compression::bz2:
      break;
  }
  return from_bz2(part);
}

bool is_zstd_frame(std::string_view bytes) { return bytes.substr(0, 4) == "\x28\xB5\x2F\xFD"; }

std::uint64_t zstd_content_size([[maybe_unused]] std::string_view bytes, const std::string& file,
                                const std::string& place) {
#ifdef EXCAVPLAN_WITH_ZSTD
  const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) {
    fail_at(file, place, "compressed data that do not say their size", "their size");
  }
  return size;
#else
  refuse_without("Zstandard", "libzstd-dev", file, place);
#endif
}

std::uint32_t crc32(std::string_view bytes) {
  static constexpr CrcTables tables = make_crc_tables();
  std::uint32_t crc = ~std::uint32_t{0};
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  for (; bytes.size() >= 8; bytes.remove_prefix(8)) {
    std::uint32_t next = 0;
    for (std::size_t i = 0; i < 4; ++i) next ^= tables[7 - i][(crc >> 8 * i & 255) ^ byte(i)];
    for (std::size_t i = 4; i < 8; ++i) next ^= tables[7 - i][byte(i)];
    crc = next;
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) crc = crc >> 8 ^ tables[0][(crc ^ byte(i)) & 255];
  return ~crc;
}

}  // namespace excavplan
