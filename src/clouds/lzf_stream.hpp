// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "clouds/file_stream.hpp"

/// @file Marc Lehmann's LZF, the compression of PCD files. Private to the library.

namespace excavplan {

/// Where a file holds a compressed block.
struct LzfBlock {
  std::uint64_t begin = 0;     ///< its first byte
  std::uint64_t packed = 0;    ///< its size [byte]
  std::uint64_t unpacked = 0;  ///< what it unpacks to [byte]
};

/// Unpacks a block piece by piece, so that it may be larger than memory.
class LzfStream {
 public:
  LzfStream(const FileStream& file, const LzfBlock& block);

  /// The next bytes, which must be left; good until the next call. @throws Error (bad_file)
  std::string_view read(std::size_t count);
  /// Goes past bytes, which must be left. @throws Error (bad_file)
  void skip(std::uint64_t count);
  /// Goes past all that are left. @throws Error (bad_file) if the block does not end with them
  void finish();

 private:
  void unpack_item();
  void unpack_literals(std::size_t count);
  void unpack_repeat(std::size_t control);
  void make_room();
  [[noreturn]] void fail() const;

  FileStream file_;
  LzfBlock block_;
  std::uint64_t packed_left_;
  std::uint64_t unpacked_left_;  ///< not yet in the window
  std::vector<char> window_;
  std::size_t taken_ = 0;   ///< of the window
  std::size_t filled_ = 0;  ///< of the window
};

}  // namespace excavplan
