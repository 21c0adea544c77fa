// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "recording/byte_file.hpp"

/// @file Compressed parts of recordings. Private to the library.

namespace excavplan {

/// How a part of a recording is compressed: frames of LZ4 (lz4_Frame_format.md) and Zstandard (RFC
/// 8878), a stream of bzip2.
enum class Compression { lz4, zstd, bz2 };

/// A part of a file as it is compressed.
struct CompressedPart {
  Compression compression;
  std::string_view bytes;
  std::uint64_t size;  ///< what it says to be uncompressed [byte]
  std::string file;    ///< for messages
  std::string place;   ///< for messages: "byte 17"
};

/// What the part holds. Memory is used for what is delivered, not for what is promised.
/// @throws Error (bad_file) if it is damaged, not of the size that it says to be or above
/// most_bytes, or if this build is without the library
Bytes decompress(const CompressedPart& part);

/// True if the bytes begin as a frame of Zstandard does, which no message in CDR does.
bool is_zstd_frame(std::string_view bytes);
/// The size that a frame of Zstandard says its content to be [byte]. @throws Error (bad_file)
std::uint64_t zstd_content_size(std::string_view bytes, const std::string& file,
                                const std::string& place);

/// CRC-32 of ISO 3309 (IEEE 802.3), as MCAP and zip use it.
std::uint32_t crc32(std::string_view bytes);

}  // namespace excavplan
