// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/tiff_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <excavplan/base/ceilings.hpp>

#include "base/scalar.hpp"
#include "base/text.hpp"
#include "clouds/tiff_coding.hpp"

namespace excavplan {
namespace {

constexpr std::uint64_t most_fields_of_image = 1000;  // ours
constexpr std::uint64_t most_values = 4000000;        // of a field; ours

/// Type of a field's numbers (TIFF 6.0, BigTIFF); nothing of rational ones and texts.
std::optional<ScalarType> type_of(std::uint16_t type) {
  switch (type) {
    case 1:
    case 7:
      return ScalarType::uint8;
    case 3:
      return ScalarType::uint16;
    case 4:
    case 13:
      return ScalarType::uint32;
    case 6:
      return ScalarType::int8;
    case 8:
      return ScalarType::int16;
    case 9:
      return ScalarType::int32;
    case 11:
      return ScalarType::float32;
    case 12:
      return ScalarType::float64;
    case 16:
    case 18:
      return ScalarType::uint64;
    default:
      return std::nullopt;
  }
}

std::uint64_t bytes_of_type(std::uint16_t type) {
  const auto number = type_of(type);
  if (number) return size_of(*number);
  return type == 2 ? 1 : 8;
}

}  // namespace

template <typename Number>
Number TiffFile::at(std::uint64_t place) const {
  if (place > file_.size() || sizeof(Number) > file_.size() - place) {
    file_.refuse("byte " + std::to_string(place) + ": beyond the end of the file, which has " +
                 std::to_string(file_.size()) + " bytes");
  }
  std::array<char, sizeof(Number)> bytes;
  file_.read(place, bytes.data(), bytes.size());
  return load<Number>(bytes.data(), swapped_);
}

TiffFile::TiffFile(const std::string& path) : file_(path) {
  std::array<char, 2> order = {};
  if (file_.size() >= 8) file_.read(0, order.data(), order.size());
  if (order != std::array<char, 2>{'I', 'I'} && order != std::array<char, 2>{'M', 'M'}) {
    file_.refuse("byte 0: found no 'II' or 'MM', with which a TIFF begins");
  }
  swapped_ = order[0] == 'M';
  const auto version = at<std::uint16_t>(2);
  if (version != 42 && version != 43) {
    file_.refuse("byte 2: the version of TIFF is " + std::to_string(version) +
                 ", must be 42 or 43");
  }
  const bool is_big = version == 43;
  read_directory(is_big ? at<std::uint64_t>(8) : at<std::uint32_t>(4), is_big);
}

void TiffFile::read_directory(std::uint64_t place, bool is_big) {
  const std::uint64_t count = is_big ? at<std::uint64_t>(place) : at<std::uint16_t>(place);
  if (count > most_fields_of_image) {
    file_.refuse("byte " + std::to_string(place) + ": a directory of " + std::to_string(count) +
                 " fields, must have at most " + std::to_string(most_fields_of_image));
  }
  const std::uint64_t size = is_big ? 20 : 12;
  const std::uint64_t inside = is_big ? 8 : 4;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t here = place + (is_big ? 8 : 2) + i * size;
    Field field = {at<std::uint16_t>(here), at<std::uint16_t>(here + 2), 0, 0};
    field.count = is_big ? at<std::uint64_t>(here + 4) : at<std::uint32_t>(here + 4);
    const std::uint64_t values = here + (is_big ? 12 : 8);
    if (field.count > most_values) {
      refuse_tag(field.tag, "has " + std::to_string(field.count) + " values, must be at most " +
                                std::to_string(most_values));
    }
    const std::uint64_t bytes = field.count * bytes_of_type(field.type);
    field.place = bytes <= inside ? values
                  : is_big        ? at<std::uint64_t>(values)
                                  : at<std::uint32_t>(values);
    if (field.place > file_.size() || bytes > file_.size() - field.place) {
      refuse_tag(field.tag, "reaches beyond the end of the file");
    }
    fields_.push_back(field);
  }
}

const TiffFile::Field* TiffFile::find(std::uint16_t tag) const {
  const auto found = std::find_if(fields_.begin(), fields_.end(),
                                  [tag](const Field& field) { return field.tag == tag; });
  return found == fields_.end() ? nullptr : &*found;
}

std::vector<double> TiffFile::numbers(std::uint16_t tag) const {
  const Field* const field = find(tag);
  if (field == nullptr) return {};
  const auto type = type_of(field->type);
  if (!type) refuse_tag(tag, "has the type " + std::to_string(field->type) + ", must be a number");
  std::string bytes(field->count * size_of(*type), '\0');
  file_.read(field->place, bytes.data(), bytes.size());
  std::vector<double> values(field->count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const char* const place = bytes.data() + i * size_of(*type);
    values[i] = with_type(*type, [&](auto example) {
      return static_cast<double>(load<decltype(example)>(place, swapped_));
    });
  }
  return values;
}

std::uint64_t TiffFile::whole(std::uint16_t tag, std::uint64_t lowest, std::uint64_t highest,
                              std::optional<std::uint64_t> fallback) const {
  const std::vector<double> values = numbers(tag);
  if (values.empty()) {
    if (fallback) return *fallback;
    refuse_tag(tag, "is missing");
  }
  const double value = values.front();
  if (!(value >= static_cast<double>(lowest) && value <= static_cast<double>(highest)) ||
      value != std::floor(value)) {
    refuse_tag(tag, "is " + number_text(value) + ", must be a whole number in " +
                        std::to_string(lowest) + " .. " + std::to_string(highest));
  }
  return static_cast<std::uint64_t>(value);
}

std::string TiffFile::text(std::uint16_t tag) const {
  const Field* const field = find(tag);
  if (field == nullptr) return {};
  if (field->type != 2) {
    refuse_tag(tag, "has the type " + std::to_string(field->type) + ", must be a text");
  }
  std::string text(field->count, '\0');
  file_.read(field->place, text.data(), text.size());
  return text.substr(0, text.find('\0'));
}

void TiffFile::refuse_tag(std::uint16_t tag, const std::string& why) const {
  file_.refuse("byte 0, a TIFF: its tag " + std::to_string(tag) + " " + why);
}

TiffImage::TiffImage(const TiffFile& tiff) : tiff_(tiff) {
  constexpr auto most = static_cast<std::uint64_t>(most_cells);
  cols_ = tiff.whole(256, 1, most);
  rows_ = tiff.whole(257, 1, most);
  if (cols_ * rows_ > most) {
    tiff.refuse_tag(257, "makes " + std::to_string(cols_ * rows_) + " cells, must be at most " +
                             std::to_string(most));
  }
  bits_ = tiff.whole(258, 1, 64, 1);
  samples_ = tiff.whole(277, 1, 1000, 1);
  format_ = tiff.whole(339, 1, 4, 1);
  const bool is_real = format_ == 3 && (bits_ == 32 || bits_ == 64);
  const bool is_whole = format_ < 3 && (bits_ == 8 || bits_ == 16 || bits_ == 32);
  if (!is_real && !is_whole) {
    tiff.refuse_tag(258,
                    "is " + std::to_string(bits_) + " bits of the kind " + std::to_string(format_) +
                        ", must be whole numbers of 8, 16 or 32 or floating point of 32 or 64");
  }
  compression_ = tiff.whole(259, 1, 65535, 1);
  if (!is_known_compression(compression_)) {
    tiff.refuse_tag(259, "is " + std::to_string(compression_) +
                             ", must be 1, 5 (LZW), 8 (Deflate) or 32773 (PackBits): convert it by "
                             "gdal_translate -co COMPRESS=DEFLATE");
  }
  predictor_ = tiff.whole(317, 1, is_real ? 3 : 2, 1);
  if (tiff.whole(284, 1, 2, 1) == 2) samples_ = 1;  // planes one after another: the first
  is_tiled_ = tiff.has(322);
  block_cols_ = is_tiled_ ? tiff.whole(322, 1, most) : cols_;
  block_rows_ =
      is_tiled_ ? tiff.whole(323, 1, most) : std::min(rows_, tiff.whole(278, 1, 0xFFFFFFFF, rows_));
  if (block_cols_ * block_rows_ > 4 * most) {
    tiff.refuse_tag(is_tiled_ ? 323 : 278,
                    "makes blocks of more than " + std::to_string(4 * most) + " cells");
  }
}

std::vector<TiffImage::Block> TiffImage::blocks() const {
  const std::uint16_t place_tag = is_tiled_ ? 324 : 273;
  const std::uint16_t size_tag = is_tiled_ ? 325 : 279;
  const std::vector<double> places = tiff_.numbers(place_tag);
  const std::vector<double> sizes = tiff_.numbers(size_tag);
  const std::uint64_t across = (cols_ + block_cols_ - 1) / block_cols_;
  const std::uint64_t down = (rows_ + block_rows_ - 1) / block_rows_;
  const auto require_count = [&](std::uint16_t tag, std::size_t count) {
    if (count >= across * down) return;
    tiff_.refuse_tag(tag, "has " + std::to_string(count) + " values, must have " +
                              std::to_string(across * down));
  };
  require_count(place_tag, places.size());
  require_count(size_tag, sizes.size());
  std::vector<Block> list;
  const auto file_size = static_cast<double>(tiff_.file().size());
  for (std::size_t i = 0; i < across * down; ++i) {
    if (!(places[i] + sizes[i] <= file_size)) {
      tiff_.refuse_tag(place_tag, "leads to byte " + number_text(places[i] + sizes[i]) +
                                      ", beyond the end of the file, which has " +
                                      std::to_string(tiff_.file().size()) + " bytes");
    }
    const std::uint64_t row = i / across * block_rows_;
    const std::uint64_t held = is_tiled_ ? block_rows_ : std::min(block_rows_, rows_ - row);
    list.push_back({row, i % across * block_cols_, held, static_cast<std::uint64_t>(places[i]),
                    static_cast<std::uint64_t>(sizes[i])});
  }
  return list;
}

std::string TiffImage::bytes_of(const Block& block) const {
  std::string packed(block.bytes, '\0');
  tiff_.file().read(block.place, packed.data(), packed.size());
  const std::uint64_t number_bytes = bits_ / 8;
  const std::uint64_t row_bytes = block_cols_ * samples_ * number_bytes;
  auto bytes = unpacked(compression_, packed, row_bytes * block.rows);
  if (!bytes) {
    tiff_.file().refuse("byte " + std::to_string(block.place) + ": a block of " +
                        std::to_string(block.bytes) + " bytes does not hold the " +
                        std::to_string(row_bytes * block.rows) + " bytes of its cells");
  }
  take_predictor_off(predictor_, {row_bytes, number_bytes, samples_, tiff_.is_swapped()}, *bytes);
  return *bytes;
}

double TiffImage::number_of(const char* bytes) const {
  const ScalarType type = format_ == 3   ? (bits_ == 32 ? ScalarType::float32 : ScalarType::float64)
                          : bits_ == 8   ? (format_ == 2 ? ScalarType::int8 : ScalarType::uint8)
                          : bits_ == 16  ? (format_ == 2 ? ScalarType::int16 : ScalarType::uint16)
                          : format_ == 2 ? ScalarType::int32
                                         : ScalarType::uint32;
  return with_type(type, [&](auto example) {
    return static_cast<double>(load<decltype(example)>(bytes, tiff_.is_swapped()));
  });
}

std::vector<double> TiffImage::values() const {
  std::vector<double> values(rows_ * cols_, std::numeric_limits<double>::quiet_NaN());
  const std::uint64_t step = samples_ * (bits_ / 8);
  for (const Block& block : blocks()) {
    const std::string bytes = bytes_of(block);
    const std::uint64_t rows = std::min(block.rows, rows_ - block.row);
    const std::uint64_t cols = std::min(block_cols_, cols_ - block.col);
    for (std::uint64_t row = 0; row < rows; ++row) {
      for (std::uint64_t col = 0; col < cols; ++col) {
        values[(block.row + row) * cols_ + block.col + col] =
            number_of(bytes.data() + (row * block_cols_ + col) * step);
      }
    }
  }
  return values;
}

}  // namespace excavplan
