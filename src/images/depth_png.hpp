// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// @file Depth images as PNG files. Private to the library.

namespace excavplan {

/// A 16-bit greyscale image.
struct DepthPng {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<unsigned char> bytes;  ///< row by row, two a pixel, the higher one first

  std::size_t pixels() const { return width * height; }
  std::uint16_t count(std::size_t pixel) const {
    return static_cast<std::uint16_t>(bytes[2 * pixel] << 8 | bytes[2 * pixel + 1]);
  }
};

/// Reads a file that is a whole 16-bit greyscale PNG image (ISO/IEC 15948) of at most 2^24 pixels,
/// 65535 a side; ours. All that libpng finds wrong is refused and nothing printed; chunks that the
/// pixels do not need are skipped but for their sums.
/// @throws Error (bad_file)
DepthPng read_depth_png(const std::string& path);
/// The same of an image in memory. @param name  for messages
DepthPng decode_depth_png(const std::string& name, std::string content);

}  // namespace excavplan
