// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <deque>
#include <optional>
#include <string>

#include "base/text.hpp"
#include "clouds/cloud_formats.hpp"
#include "clouds/lzf_stream.hpp"

// PCD as the Point Cloud Library documents it (versions 0.5 to 0.7), and as others write it: PDAL
// (io/PcdHeader.cpp) names the fields X Y Z and compressed data "compressed", and reads TYPE and
// DATA in letters of either case; Ouster (map_export.py) leaves VERSION out.

namespace excavplan {
namespace {

constexpr std::size_t longest_row = 4096;  // of a binary point [byte]

enum class Encoding { ascii, binary, compressed };

struct Field {
  std::string name;
  std::size_t size = 0;  ///< of one element [byte]
  char type = 0;         ///< I, U or F
  std::size_t count = 1;
  std::size_t bytes() const { return size * count; }
};

struct PcdHeader {
  std::vector<Field> fields;
  std::array<std::size_t, 3> xyz{};  ///< indices of the fields x, y, z
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t points = 0;
  Encoding encoding = Encoding::ascii;
  std::optional<Eigen::Vector3d> sensor;
  std::size_t row = 0;     ///< of one point [byte]
  std::size_t tokens = 0;  ///< of one point in ASCII
};

/// In the order in which they must stand.
enum Key { version, fields, size, type, count, width, height, viewpoint, points, data };
constexpr std::array<std::string_view, 10> key_names = {
    "VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
bool may_be_left_out(std::size_t key) { return key == version || key == count || key == viewpoint; }

using Words = std::vector<std::string_view>;

void read_field_names(const Words& words, const LineReader& lines, PcdHeader& header) {
  if (words.size() > most_fields) {
    lines.fail(std::to_string(words.size()) + " fields", "at most " + std::to_string(most_fields));
  }
  for (const auto name : words) header.fields.push_back({std::string(name)});
  const auto small = std::count(words.begin(), words.end(), "x");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, (small > 0 ? "xyz" : "XYZ")[axis]);
    if (const auto times = std::count(words.begin(), words.end(), name); times != 1) {
      lines.fail("field " + small_letters(name) + " " + std::to_string(times) + " times",
                 "x, y and z once each");
    }
    header.xyz[axis] =
        static_cast<std::size_t>(std::find(words.begin(), words.end(), name) - words.begin());
  }
}

void read_sizes(const Words& words, const LineReader& lines, PcdHeader& header) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint64_t bytes = count_of(words[i], lines);
    if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) {
      lines.fail("SIZE " + in_quotes(words[i]), "1, 2, 4 or 8");
    }
    header.fields[i].size = bytes;
  }
}

void read_types(const Words& words, const LineReader& lines, PcdHeader& header) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    Field& field = header.fields[i];
    const std::size_t type = words[i].size() == 1 ? std::string("IUFiuf").find(words[i]) : 6;
    if (type >= 6) lines.fail("TYPE " + in_quotes(words[i]), "I, U or F");
    field.type = "IUF"[type % 3];
    if (field.type == 'F' && field.size < 4) {
      lines.fail("TYPE F of SIZE " + std::to_string(field.size), "SIZE 4 or 8");
    }
  }
}

void read_counts(const Words& words, const LineReader& lines, PcdHeader& header) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint64_t elements = count_of(words[i], lines);
    if (elements < 1 || elements > longest_row) {
      lines.fail("COUNT " + in_quotes(words[i]), "1 .. " + std::to_string(longest_row));
    }
    header.fields[i].count = elements;
  }
  for (const std::size_t i : header.xyz) {
    if (header.fields[i].count != 1) {
      lines.fail("COUNT " + in_quotes(words[i]) + " of field " + header.fields[i].name, "1");
    }
  }
}

Encoding encoding_of(std::string_view word, const LineReader& lines) {
  const std::string small = small_letters(std::string(word));
  if (small == "ascii") return Encoding::ascii;
  if (small == "binary") return Encoding::binary;
  if (small == "binary_compressed" || small == "compressed") return Encoding::compressed;
  lines.fail("DATA " + in_quotes(word), "ascii, binary or binary_compressed");
}

void read_version(std::string_view word, const LineReader& lines) {
  for (const auto known : {"0.7", ".7", "0.6", ".6", "0.5", ".5"}) {
    if (word == known) return;
  }
  lines.fail("VERSION " + in_quotes(word), "0.5, 0.6 or 0.7");
}

/// Place of the sensor in the frame of the points, from a translation and a quaternion. What all
/// programs write by default says nothing.
std::optional<Eigen::Vector3d> read_viewpoint(const Words& words, const LineReader& lines) {
  constexpr std::array<double, 7> by_default = {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  std::array<double, 7> pose{};
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = number_of(words[i], lines);
  const Eigen::Vector3d place(pose[0], pose[1], pose[2]);
  if (pose == by_default || !place.allFinite()) return std::nullopt;
  return place;
}

void require_words(std::size_t key, const Words& words, const LineReader& lines,
                   const PcdHeader& header) {
  const std::string name(key_names[key]);
  if (key == fields) return;
  const bool per_field = key == size || key == type || key == count;
  const std::size_t expected = per_field ? header.fields.size() : key == viewpoint ? 7 : 1;
  if (words.size() != expected) {
    lines.fail(std::to_string(words.size()) + " values of " + name, std::to_string(expected));
  }
}

void read_entry(std::size_t key, const Words& words, const LineReader& lines, PcdHeader& header) {
  require_words(key, words, lines, header);
  switch (key) {
    case version:
      return read_version(words[0], lines);
    case fields:
      return read_field_names(words, lines, header);
    case size:
      return read_sizes(words, lines, header);
    case type:
      return read_types(words, lines, header);
    case count:
      return read_counts(words, lines, header);
    case width:
      header.width = count_of(words[0], lines);
      return;
    case height:
      header.height = count_of(words[0], lines);
      return;
    case viewpoint:
      header.sensor = read_viewpoint(words, lines);
      return;
    case points:
      header.points = count_of(words[0], lines);
      return;
    default:
      header.encoding = encoding_of(words[0], lines);
  }
}

/// The key of a header line, which must be `due` or stand behind it with nothing needed between.
std::size_t key_of(std::string_view word, std::size_t due, const LineReader& lines) {
  const std::string_view name = word == "COLUMNS" ? key_names[fields] : word;  // of PCD 0.5
  const auto found = std::find(key_names.begin(), key_names.end(), name);
  const auto key = static_cast<std::size_t>(found - key_names.begin());
  std::size_t needed = due;
  while (needed < key && may_be_left_out(needed)) ++needed;
  if (found == key_names.end() || key != needed) {
    lines.fail(in_quotes(word), std::string(key_names[due]));
  }
  return key;
}

void measure_rows(const LineReader& lines, PcdHeader& header) {
  for (const Field& field : header.fields) {
    header.row += field.bytes();
    header.tokens += field.count;
  }
  if (header.row > longest_row) {
    lines.fail("points of " + std::to_string(header.row) + " bytes",
               "at most " + std::to_string(longest_row));
  }
  std::uint64_t cells = 0;
  const bool overflow = __builtin_mul_overflow(header.width, header.height, &cells);
  if (overflow || cells != header.points) {
    lines.fail(
        "POINTS " + std::to_string(header.points),
        "WIDTH x HEIGHT = " + std::to_string(header.width) + " x " + std::to_string(header.height));
  }
}

PcdHeader read_header(LineReader& lines) {
  PcdHeader header;
  std::size_t due = version;
  while (due <= data) {
    if (!lines.next_filled()) {
      lines.fail("the end of the file", std::string(key_names[due]) + " of a PCD header");
    }
    if (lines.offset() > longest_header) {
      lines.fail("a header of more than " + std::to_string(longest_header) + " bytes", "less");
    }
    std::string_view rest = lines.line();
    const std::string_view word = take_word(rest);
    if (word.front() == '#') continue;
    const std::size_t key = key_of(word, due, lines);
    read_entry(key, words_of(rest), lines, header);
    due = key + 1;
  }
  measure_rows(lines, header);
  return header;
}

ScalarType scalar_type(const Field& field) {
  if (field.type == 'F') return field.size == 4 ? ScalarType::float32 : ScalarType::float64;
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1:
      return is_signed ? ScalarType::int8 : ScalarType::uint8;
    case 2:
      return is_signed ? ScalarType::int16 : ScalarType::uint16;
    case 4:
      return is_signed ? ScalarType::int32 : ScalarType::uint32;
    default:
      return is_signed ? ScalarType::int64 : ScalarType::uint64;
  }
}

/// Of rows of points.
Columns columns_of(const PcdHeader& header) {
  Columns columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < header.xyz[axis]; ++i) offset += header.fields[i].bytes();
    const Field& field = header.fields[header.xyz[axis]];
    columns.type[axis] = scalar_type(field);
    columns.offset[axis] = offset;
    columns.stride[axis] = header.row;
  }
  return columns;
}

/// Which numbers of an ASCII row are x, y and z.
std::array<std::size_t, 3> tokens_of_xyz(const PcdHeader& header) {
  std::array<std::size_t, 3> tokens{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < header.xyz[axis]; ++i) tokens[axis] += header.fields[i].count;
  }
  return tokens;
}

void stream_ascii(FileStream& file, LineReader& lines, const PcdHeader& header, PointSink& sink) {
  const std::size_t shortest_row = 2 * header.tokens;
  sink.require_memory(std::min(header.points, file.left() / shortest_row + 1), 0);
  const std::array<std::size_t, 3> xyz = tokens_of_xyz(header);
  PointBatch batch(sink);
  std::uint64_t rows = 0;
  std::vector<double> values;
  while (lines.next_filled()) {
    if (rows == header.points) {
      lines.fail("more rows", "the end after POINTS " + std::to_string(header.points));
    }
    values.clear();
    std::string_view rest = lines.line();
    for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
      values.push_back(number_of(word, lines));
    }
    if (values.size() != header.tokens) {
      lines.fail(std::to_string(values.size()) + " values", std::to_string(header.tokens));
    }
    batch.add({values[xyz[0]], values[xyz[1]], values[xyz[2]]});
    ++rows;
  }
  if (rows != header.points) {
    lines.fail("the end after " + std::to_string(rows) + " rows", std::to_string(header.points));
  }
  batch.hand_on();
}

void stream_binary(FileStream& file, const PcdHeader& header, PointSink& sink) {
  if (header.points > file.left() / header.row) {
    file.fail_here(
        std::to_string(file.left()) + " bytes of data",
        std::to_string(header.points) + " points of " + std::to_string(header.row) + " bytes");
  }
  file.require_end(header.points * header.row);
  sink.require_memory(header.points, 0);
  stream_rows(file, header.points, columns_of(header), false, sink);
}

/// Compressed PCD stores one field of all points after the other: x, y and z are unpacked side by
/// side, each by a reader of its own, so that none has to be held.
void stream_fields(const FileStream& file, const LzfBlock& block, const PcdHeader& header,
                   PointSink& sink) {
  std::deque<LzfStream> fields;
  Columns columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Field& field = header.fields[header.xyz[axis]];
    std::uint64_t begin = 0;
    for (std::size_t i = 0; i < header.xyz[axis]; ++i) begin += header.fields[i].bytes();
    fields.emplace_back(file, block).skip(begin * header.points);
    columns.type[axis] = scalar_type(field);
    columns.stride[axis] = field.size;
  }
  std::string values;
  for (std::uint64_t first = 0; first < header.points; first += points_at_a_time) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(points_at_a_time, header.points - first));
    values.clear();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns.offset[axis] = values.size();
      values += fields[axis].read(count * columns.stride[axis]);
    }
    stream_block(values.data(), count, columns, sink);
  }
  const auto last = std::max_element(header.xyz.begin(), header.xyz.end()) - header.xyz.begin();
  fields[static_cast<std::size_t>(last)].finish();
}

void stream_compressed(FileStream& file, const PcdHeader& header, PointSink& sink) {
  constexpr std::uint64_t highest_ratio = 256;  // LZF reaches 88
  const std::string place = "byte " + std::to_string(file.offset());
  if (file.left() < 8) {
    file.fail(place, std::to_string(file.left()) + " bytes of data", "two sizes of 4 bytes");
  }
  const std::string sizes(file.peek(8));
  file.skip(8);
  const auto size_at = [&](std::size_t at) {
    return static_cast<std::uint64_t>(load_scalar(ScalarType::uint32, sizes.data() + at, false));
  };
  const std::uint64_t packed = size_at(0);
  const std::uint64_t unpacked = size_at(4);
  if (packed > file.left()) {
    file.fail(place, std::to_string(file.left()) + " compressed bytes", std::to_string(packed));
  }
  std::uint64_t expected = 0;
  if (__builtin_mul_overflow(header.points, header.row, &expected) || unpacked != expected) {
    file.fail(
        place, "an uncompressed size of " + std::to_string(unpacked),
        std::to_string(header.points) + " points of " + std::to_string(header.row) + " bytes");
  }
  if (unpacked > packed * highest_ratio) {
    file.fail(place, std::to_string(packed) + " bytes for " + std::to_string(unpacked),
              "a compression ratio of at most " + std::to_string(highest_ratio));
  }
  file.require_end(packed);
  sink.require_memory(header.points, 0);
  stream_fields(file, {file.offset(), packed, unpacked}, header, sink);
}

/// True if the first words of a file are those of a PCD header.
bool holds_pcd(FileStream& file) {
  std::string_view text = file.peek(longest_header);
  if (text.substr(0, 6) == "# .PCD") return true;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const std::string_view word = take_word(line);
    if (word.empty() || word.front() == '#') continue;
    return word == "COLUMNS" ||
           std::find(key_names.begin(), key_names.end(), word) != key_names.end();
  }
  return false;
}

CloudShape stream_pcd(FileStream& file, PointSink& sink) {
  LineReader lines(file);
  const PcdHeader header = read_header(lines);
  switch (header.encoding) {
    case Encoding::ascii:
      stream_ascii(file, lines, header, sink);
      break;
    case Encoding::binary:
      stream_binary(file, header, sink);
      break;
    case Encoding::compressed:
      stream_compressed(file, header, sink);
      break;
  }
  return {header.width, header.height, header.sensor};
}

std::optional<Eigen::Vector3d> sensor_of_pcd(FileStream& file) {
  LineReader lines(file);
  return read_header(lines).sensor;
}

std::string viewpoint_of(const CloudShape& shape) {
  const Eigen::Vector3d place = shape.sensor.value_or(Eigen::Vector3d::Zero());
  return number_text(place.x()) + " " + number_text(place.y()) + " " + number_text(place.z());
}

std::string head_of_pcd(const CloudShape& shape, Numbers numbers) {
  const std::string size = numbers == Numbers::float32 ? "4" : "8";
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE " + size +
         " " + size + " " + size + "\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
         std::to_string(shape.width) + "\nHEIGHT " + std::to_string(shape.height) + "\nVIEWPOINT " +
         viewpoint_of(shape) + " 1 0 0 0\nPOINTS " + std::to_string(shape.points()) + "\nDATA " +
         (numbers == Numbers::text ? "ascii" : "binary") + "\n";
}

}  // namespace

CloudFileFormat pcd_format() {
  return {"pcd", "PCD", {".pcd"}, holds_pcd, stream_pcd, head_of_pcd, sensor_of_pcd};
}

}  // namespace excavplan
