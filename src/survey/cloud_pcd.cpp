// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "cloud_format.hpp"

// PCD as the Point Cloud Library documents it (versions 0.5 to 0.7).

namespace excavplan {
namespace {

enum class Encoding { ascii, binary, compressed };

struct Field {
  std::string_view name;
  std::size_t size = 0;  ///< of one element [byte]
  char type = 0;         ///< I, U or F
  std::size_t count = 1;
  std::size_t bytes() const { return size * count; }
};

struct Header {
  std::vector<Field> fields;
  std::array<std::size_t, 3> xyz{};  ///< indices of the fields x, y, z
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t points = 0;
  Encoding encoding = Encoding::ascii;
  std::size_t row = 0;     ///< of one point [byte]
  std::size_t tokens = 0;  ///< of one point in ASCII
};

/// In the order in which they must stand.
enum Key { version, fields, size, type, count, width, height, viewpoint, points, data };
constexpr std::array<std::string_view, 10> key_names = {
    "VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
bool may_be_left_out(std::size_t key) { return key == count || key == viewpoint; }

using Words = std::vector<std::string_view>;

void read_field_names(const Words& words, const LineReader& lines, Header& header) {
  if (words.size() > most_fields) {
    lines.fail(std::to_string(words.size()) + " fields", "at most " + std::to_string(most_fields));
  }
  for (const auto name : words) header.fields.push_back({name});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    if (const auto times = std::count(words.begin(), words.end(), name); times != 1) {
      lines.fail("field " + name + " " + std::to_string(times) + " times", "x, y and z once each");
    }
    header.xyz[axis] =
        static_cast<std::size_t>(std::find(words.begin(), words.end(), name) - words.begin());
  }
}

void read_sizes(const Words& words, const LineReader& lines, Header& header) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint64_t bytes = count_of(words[i], lines);
    if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) {
      lines.fail("SIZE " + quoted(words[i]), "1, 2, 4 or 8");
    }
    header.fields[i].size = bytes;
  }
}

void read_types(const Words& words, const LineReader& lines, Header& header) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    Field& field = header.fields[i];
    if (words[i] != "I" && words[i] != "U" && words[i] != "F") {
      lines.fail("TYPE " + quoted(words[i]), "I, U or F");
    }
    field.type = words[i].front();
    if (field.type == 'F' && field.size < 4) {
      lines.fail("TYPE F of SIZE " + std::to_string(field.size), "SIZE 4 or 8");
    }
  }
}

void read_counts(const Words& words, const LineReader& lines, Header& header) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::uint64_t elements = count_of(words[i], lines);
    if (elements < 1 || elements > longest_row) {
      lines.fail("COUNT " + quoted(words[i]), "1 .. " + std::to_string(longest_row));
    }
    header.fields[i].count = elements;
  }
  for (const std::size_t i : header.xyz) {
    if (header.fields[i].count != 1) {
      lines.fail("COUNT " + quoted(words[i]) + " of field " + std::string(header.fields[i].name),
                 "1");
    }
  }
}

Encoding encoding_of(std::string_view word, const LineReader& lines) {
  if (word == "ascii") return Encoding::ascii;
  if (word == "binary") return Encoding::binary;
  if (word == "binary_compressed") return Encoding::compressed;
  lines.fail("DATA " + quoted(word), "ascii, binary or binary_compressed");
}

void read_version(std::string_view word, const LineReader& lines) {
  for (const auto known : {"0.7", ".7", "0.6", ".6", "0.5", ".5"}) {
    if (word == known) return;
  }
  lines.fail("VERSION " + quoted(word), "0.5, 0.6 or 0.7");
}

void require_words(std::size_t key, const Words& words, const LineReader& lines,
                   const Header& header) {
  const std::string name(key_names[key]);
  if (key == fields) return;
  const bool per_field = key == size || key == type || key == count;
  const std::size_t expected = per_field ? header.fields.size() : key == viewpoint ? 7 : 1;
  if (words.size() != expected) {
    lines.fail(std::to_string(words.size()) + " values of " + name, std::to_string(expected));
  }
}

void read_entry(std::size_t key, const Words& words, const LineReader& lines, Header& header) {
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
      for (const auto word : words) number_of(word, lines);
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
  const auto found = std::find(key_names.begin(), key_names.end(), word);
  const auto key = static_cast<std::size_t>(found - key_names.begin());
  std::size_t needed = due;
  while (needed < key && may_be_left_out(needed)) ++needed;
  if (found == key_names.end() || key != needed) {
    lines.fail(quoted(word), std::string(key_names[due]));
  }
  return key;
}

void measure_rows(const LineReader& lines, Header& header) {
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

Header read_header(LineReader& lines) {
  Header header;
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

/// Rows of points, or with `by_field` one block per field.
Columns columns_of(const Header& header, bool by_field) {
  Columns columns;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < header.xyz[axis]; ++i) offset += header.fields[i].bytes();
    const Field& field = header.fields[header.xyz[axis]];
    columns.type[axis] = scalar_type(field);
    columns.offset[axis] = by_field ? offset * header.points : offset;
    columns.stride[axis] = by_field ? field.size : header.row;
  }
  return columns;
}

/// Which numbers of an ASCII row are x, y and z.
std::array<std::size_t, 3> tokens_of_xyz(const Header& header) {
  std::array<std::size_t, 3> tokens{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < header.xyz[axis]; ++i) tokens[axis] += header.fields[i].count;
  }
  return tokens;
}

void read_ascii(const FileBytes& file, LineReader& lines, const Header& header, Cloud& cloud) {
  const std::size_t shortest_row = 2 * header.tokens;
  const std::uint64_t room = (file.size() - lines.offset()) / shortest_row + 1;
  file.require_memory(std::min(header.points, room));
  cloud.points.reserve(std::min(header.points, room));
  const std::array<std::size_t, 3> xyz = tokens_of_xyz(header);
  std::vector<double> values;
  while (lines.next_filled()) {
    if (cloud.points.size() == header.points) {
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
    cloud.points.emplace_back(values[xyz[0]], values[xyz[1]], values[xyz[2]]);
  }
  if (cloud.points.size() != header.points) {
    lines.fail("the end after " + std::to_string(cloud.points.size()) + " rows",
               std::to_string(header.points));
  }
}

void read_binary(const FileBytes& file, std::size_t begin, const Header& header, Cloud& cloud) {
  const std::size_t left = file.size() - begin;
  if (header.points > left / header.row) {
    file.fail(
        "byte " + std::to_string(begin), std::to_string(left) + " bytes of data",
        std::to_string(header.points) + " points of " + std::to_string(header.row) + " bytes");
  }
  file.require_end(begin + header.points * header.row);
  file.require_memory(header.points);
  cloud.points.resize(header.points);
  copy_points(file.data() + begin, columns_of(header, false), false, cloud.points);
}

/// Marc Lehmann's LZF: a control byte below 32 heads a run of literals, any other repeats what
/// stands up to 8 KiB back. @return false if `packed` does not unpack to exactly `out`
bool unpack_lzf(std::string_view packed, std::vector<char>& out) {
  std::size_t in = 0;
  std::size_t made = 0;
  while (in < packed.size()) {
    const auto control = static_cast<unsigned char>(packed[in++]);
    if (control < 32) {
      const std::size_t run = control + std::size_t{1};
      if (run > packed.size() - in || run > out.size() - made) return false;
      std::copy_n(packed.data() + in, run, out.data() + made);
      in += run;
      made += run;
      continue;
    }
    std::size_t length = control >> 5U;
    const std::size_t needed = length == 7 ? 2 : 1;
    if (needed > packed.size() - in) return false;
    if (length == 7) length += static_cast<unsigned char>(packed[in++]);
    length += 2;
    const std::size_t back =
        ((control & 31U) << 8U) + static_cast<unsigned char>(packed[in++]) + std::size_t{1};
    if (back > made || length > out.size() - made) return false;
    for (const std::size_t end = made + length; made < end; ++made) out[made] = out[made - back];
  }
  return made == out.size();
}

void read_compressed(const FileBytes& file, std::size_t begin, const Header& header, Cloud& cloud) {
  constexpr std::uint64_t highest_ratio = 256;  // LZF reaches 88
  const std::string place = "byte " + std::to_string(begin);
  const std::size_t left = file.size() - begin;
  if (left < 8) file.fail(place, std::to_string(left) + " bytes of data", "two sizes of 4 bytes");
  const auto size_at = [&](std::size_t at) {
    return static_cast<std::uint64_t>(
        load_scalar(ScalarType::uint32, file.data() + begin + at, false));
  };
  const std::uint64_t packed = size_at(0);
  const std::uint64_t unpacked = size_at(4);
  if (packed > left - 8) {
    file.fail(place, std::to_string(left - 8) + " compressed bytes", std::to_string(packed));
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
  file.require_end(begin + 8 + packed);
  file.require_memory(header.points, unpacked);
  std::vector<char> block(unpacked);
  if (!unpack_lzf(file.text().substr(begin + 8, packed), block)) {
    file.fail(place, "damaged compressed data", std::to_string(unpacked) + " bytes of LZF");
  }
  cloud.points.resize(header.points);
  copy_points(block.data(), columns_of(header, true), false, cloud.points);
}

}  // namespace

bool looks_like_pcd(const FileBytes& file) {
  std::string_view text = file.text().substr(0, longest_header);
  if (text.substr(0, 6) == "# .PCD") return true;
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const std::string_view word = take_word(line);
    if (word.empty() || word.front() == '#') continue;
    return std::find(key_names.begin(), key_names.end(), word) != key_names.end();
  }
  return false;
}

Cloud read_pcd(const FileBytes& file) {
  LineReader lines(file);
  const Header header = read_header(lines);
  Cloud cloud;
  switch (header.encoding) {
    case Encoding::ascii:
      read_ascii(file, lines, header, cloud);
      break;
    case Encoding::binary:
      read_binary(file, lines.offset(), header, cloud);
      break;
    case Encoding::compressed:
      read_compressed(file, lines.offset(), header, cloud);
      break;
  }
  cloud.width = header.width;
  cloud.height = header.height;
  return cloud;
}

}  // namespace excavplan
