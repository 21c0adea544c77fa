// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/input_file.hpp"

/// @file The first directory of a TIFF 6.0 or BigTIFF file and the numbers of its image. Private to
/// the library.

namespace excavplan {

/// A TIFF file open for reading. All members throw Error (bad_file) naming byte or tag, value and
/// rule.
class TiffFile {
 public:
  explicit TiffFile(const std::string& path);

  bool has(std::uint16_t tag) const { return find(tag) != nullptr; }
  /// All numbers of a field; empty if it is not there.
  std::vector<double> numbers(std::uint16_t tag) const;
  /// The first number of a field, of none the fallback; it must be whole and in these bounds.
  std::uint64_t whole(std::uint16_t tag, std::uint64_t lowest, std::uint64_t highest,
                      std::optional<std::uint64_t> fallback = {}) const;
  /// A text, without what follows its end; empty if it is not there.
  std::string text(std::uint16_t tag) const;

  bool is_swapped() const { return swapped_; }  ///< has the highest byte of a number first
  const InputFile& file() const { return file_; }
  [[noreturn]] void refuse_tag(std::uint16_t tag, const std::string& why) const;

 private:
  struct Field {
    std::uint16_t tag;
    std::uint16_t type;
    std::uint64_t count;
    std::uint64_t place;  ///< of the first value in the file
  };
  const Field* find(std::uint16_t tag) const;
  void read_directory(std::uint64_t place, bool is_big);
  template <typename Number>
  Number at(std::uint64_t place) const;

  InputFile file_;
  bool swapped_ = false;
  std::vector<Field> fields_;
};

/// Where the numbers of the first sample of an image lie, and of what kind they are.
class TiffImage {
 public:
  explicit TiffImage(const TiffFile& tiff);

  std::uint64_t rows() const { return rows_; }
  std::uint64_t cols() const { return cols_; }
  /// Row after row from the top.
  std::vector<double> values() const;

 private:
  /// A strip or a tile.
  struct Block {
    std::uint64_t row;  ///< of the image, of its first
    std::uint64_t col;
    std::uint64_t rows;  ///< that it holds
    std::uint64_t place;
    std::uint64_t bytes;
  };
  std::vector<Block> blocks() const;
  std::string bytes_of(const Block& block) const;
  double number_of(const char* bytes) const;

  const TiffFile& tiff_;
  std::uint64_t rows_, cols_;
  std::uint64_t bits_, format_, samples_, compression_, predictor_;
  std::uint64_t block_rows_, block_cols_;
  bool is_tiled_;
};

}  // namespace excavplan
