// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

/// @file How the bytes of a TIFF image are packed (TIFF 6.0, sections 9, 13 and 14; Adobe's
/// technical notes for Deflate and the floating point predictor). Private to the library.

namespace excavplan {

/// Whether unpacked() knows a compression, by its number.
bool is_known_compression(std::uint64_t compression);
/// Exactly so many bytes; nothing if they are not in `packed`.
std::optional<std::string> unpacked(std::uint64_t compression, std::string_view packed,
                                    std::size_t count);

/// Rows of numbers of which differences were stored.
struct PredictedRows {
  std::size_t row_bytes;
  std::size_t number_bytes;
  std::size_t samples;  ///< side by side in a row
  bool is_swapped;
};
/// Turns the differences of predictor 2 (whole numbers) or 3 (floating point) into the numbers, in
/// the byte order of the file.
void take_predictor_off(std::uint64_t predictor, const PredictedRows& rows, std::string& bytes);

}  // namespace excavplan
