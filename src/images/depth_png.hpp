// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

/// @file PNG files, checked before they are decoded. Private to the library.

namespace excavplan {

/// Reads a file that is a whole 16-bit greyscale PNG image (ISO/IEC 15948) of at most 2^24 pixels,
/// 65535 a side; ours. Checked are the chunks with their sums and the stream of pixels to its end:
/// libpng would write to the console what it finds wrong, and a header can promise any number of
/// pixels.
/// @return its content without the chunks that are not needed to decode it
/// @throws Error (bad_file)
std::string read_depth_png(const std::string& path);

}  // namespace excavplan
