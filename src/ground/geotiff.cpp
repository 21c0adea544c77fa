// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/geotiff.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/scalar.hpp"

namespace excavplan {
namespace {

// Types of fields, TIFF 6.0.
constexpr std::uint16_t ascii = 2;
constexpr std::uint16_t word = 3;       // 16 bits
constexpr std::uint16_t long_word = 4;  // 32 bits
constexpr std::uint16_t float64 = 12;

struct Field {
  std::uint16_t tag;
  std::uint16_t type;
  std::uint32_t count;
  std::string bytes;
};

template <typename Number>
Field field(std::uint16_t tag, std::uint16_t type, const std::vector<Number>& values) {
  Field made = {tag, type, static_cast<std::uint32_t>(values.size()), {}};
  for (const Number value : values) put(value, made.bytes);
  return made;
}

Field words(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
  return field(tag, word, values);
}
Field long_words(std::uint16_t tag, const std::vector<std::uint32_t>& values) {
  return field(tag, long_word, values);
}
Field float_numbers(std::uint16_t tag, const std::vector<double>& values) {
  return field(tag, float64, values);
}
Field text(std::uint16_t tag, const std::string& value) {
  return {tag, ascii, static_cast<std::uint32_t>(value.size() + 1), value + '\0'};
}

std::string escaped(const std::string& meaning) {
  std::string xml;
  for (const char c : meaning) {
    if (c == '&') {
      xml += "&amp;";
    } else if (c == '<') {
      xml += "&lt;";
    } else {
      xml += c;
    }
  }
  return xml;
}

std::string item_of_band(std::size_t band, const std::string& key, const std::string& role,
                         const std::string& value) {
  return "<Item name=\"" + key + "\" sample=\"" + std::to_string(band) + '"' + role + '>' +
         escaped(value) + "</Item>\n";
}

/// A strip is a row of a band; the strips follow one another.
struct Strips {
  std::uint32_t count;
  std::uint32_t bytes;  ///< of each

  std::vector<std::uint32_t> places(std::uint64_t first) const {
    std::vector<std::uint32_t> at(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      at[i] = static_cast<std::uint32_t>(first + std::uint64_t{bytes} * i);
    }
    return at;
  }
};

Strips strips_of(const LayeredMap& map) {
  return {static_cast<std::uint32_t>(map.layers.size()) *
              static_cast<std::uint32_t>(map.ground.z.rows()),
          8 * static_cast<std::uint32_t>(map.ground.z.cols())};
}

/// All fields in the order of their tags.
std::vector<Field> fields_of(const LayeredMap& map, const MapNotes& notes,
                             std::uint64_t first_strip) {
  using Words = std::vector<std::uint16_t>;
  const HeightMap& grid = map.ground;
  const Strips strips = strips_of(map);
  const auto bands = static_cast<std::uint16_t>(map.layers.size());
  const std::string frame = "excavplan site frame|";
  const auto name_size = static_cast<std::uint16_t>(frame.size());
  const Words keys = {1,    1,     1,         4,      // GeoTIFF 1.1, four keys:
                      1024, 0,     1,         32767,  // a coordinate system of its own,
                      1025, 0,     1,         1,      // a pixel is an area,
                      1026, 34737, name_size, 0,      // name of the frame,
                      3076, 0,     1,         9001};  // metres
  const Rectangle all = grid.extent();
  std::vector<Field> fields;
  fields.push_back(long_words(256, {static_cast<std::uint32_t>(grid.z.cols())}));
  fields.push_back(long_words(257, {static_cast<std::uint32_t>(grid.z.rows())}));
  fields.push_back(words(258, Words(bands, 64)));  // bits of a sample
  fields.push_back(words(259, {1}));               // not compressed
  fields.push_back(words(262, {1}));               // black is zero
  fields.push_back(long_words(273, strips.places(first_strip)));
  fields.push_back(words(277, {bands}));
  fields.push_back(long_words(278, {1}));  // rows of a strip
  fields.push_back(long_words(279, std::vector<std::uint32_t>(strips.count, strips.bytes)));
  fields.push_back(words(284, {2}));                                  // bands one after another
  if (bands > 1) fields.push_back(words(338, Words(bands - 1U, 0)));  // none is opacity
  fields.push_back(words(339, Words(bands, 3)));                      // floating point
  fields.push_back(float_numbers(33550, {grid.cell_size, grid.cell_size, 0.0}));
  fields.push_back(float_numbers(33922, {0.0, 0.0, 0.0, all.x_min, all.y_max, 0.0}));
  fields.push_back(words(34735, keys));
  fields.push_back(text(34737, frame));
  fields.push_back(text(42112, geotiff_metadata(map, notes)));
  fields.push_back(text(42113, "nan"));  // NODATA
  for (Field& each : fields) {
    each.bytes.resize(std::max<std::size_t>(4, each.bytes.size() + each.bytes.size() % 2), '\0');
  }
  return fields;
}

/// Bytes of header, directory and the values that do not fit into it.
std::uint64_t size_of_head(const std::vector<Field>& fields) {
  std::uint64_t size = 8 + 2 + 12 * fields.size() + 4;
  for (const Field& each : fields) size += each.bytes.size() > 4 ? each.bytes.size() : 0;
  return size;
}

// ---- reading ----------------------------------------------------------------------------------

struct Entry {
  std::uint16_t tag;
  std::uint16_t type;
  std::uint32_t count;
  std::uint32_t value;  ///< or its place in the file
};

template <typename Number>
Number number_at(const InputFile& file, std::uint64_t place) {
  if (place + sizeof(Number) > file.size()) {
    file.refuse("ends at byte " + std::to_string(file.size()) + ", within the head of a TIFF");
  }
  std::array<char, sizeof(Number)> bytes;
  file.read(place, bytes.data(), bytes.size());
  return load<Number>(bytes.data(), false);
}

std::vector<Entry> directory_of(const InputFile& file) {
  constexpr std::uint32_t begin = 0x002A4949;  // "II", 42
  constexpr std::uint16_t most_entries = 100;  // ours
  if (number_at<std::uint32_t>(file, 0) != begin) {
    file.refuse("byte 0: is no TIFF of numbers with the lowest byte first ('II', 42)");
  }
  const auto at = number_at<std::uint32_t>(file, 4);
  const auto count = number_at<std::uint16_t>(file, at);
  if (count > most_entries) {
    file.refuse("byte " + std::to_string(at) + ": a directory of " + std::to_string(count) +
                " entries, expected at most " + std::to_string(most_entries));
  }
  std::vector<Entry> entries;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t place = std::uint64_t{at} + 2 + 12 * i;
    entries.push_back(
        {number_at<std::uint16_t>(file, place), number_at<std::uint16_t>(file, place + 2),
         number_at<std::uint32_t>(file, place + 4), number_at<std::uint32_t>(file, place + 8)});
  }
  return entries;
}

Entry entry_of(const InputFile& file, const std::vector<Entry>& entries, std::uint16_t tag,
               std::uint16_t type) {
  for (const Entry& entry : entries) {
    if (entry.tag == tag && entry.type == type) return entry;
  }
  file.refuse("tag " + std::to_string(tag) + " of type " + std::to_string(type) +
              " is not there: no file of excavplan");
}

std::string metadata_in(const InputFile& file, const Entry& entry) {
  constexpr std::uint32_t longest = 1U << 16U;  // ours
  if (entry.count > longest || std::uint64_t{entry.value} + entry.count > file.size()) {
    file.refuse("tag 42112, the metadata, has " + std::to_string(entry.count) +
                " bytes, which are more than " + std::to_string(longest) +
                " or reach beyond the file");
  }
  std::string text(entry.count, '\0');
  file.read(entry.value, text.data(), text.size());
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// What stands in a line of the metadata between these two; nothing if the line is another.
std::optional<std::string> between(const std::string& line, const std::string& first,
                                   const std::string& last) {
  if (line.size() < first.size() + last.size() || line.compare(0, first.size(), first) != 0 ||
      line.compare(line.size() - last.size(), last.size(), last) != 0) {
    return std::nullopt;
  }
  return line.substr(first.size(), line.size() - first.size() - last.size());
}

}  // namespace

std::string geotiff_metadata(const LayeredMap& map, const MapNotes& notes) {
  std::string xml = "<GDALMetadata>\n";
  for (const MapNote& note : notes) {
    xml += "<Item name=\"" + note.key + "\">" + escaped(note.value) + "</Item>\n";
  }
  for (std::size_t i = 0; i < map.layers.size(); ++i) {
    const std::string& name = map.layers[i].name;
    xml += item_of_band(i, "DESCRIPTION", " role=\"description\"", name);
    xml += item_of_band(i, "meaning", "", map.layers[i].meaning);
    const bool is_length = name.size() > 2 && name.substr(name.size() - 2) == "_m";
    if (is_length) xml += item_of_band(i, "UNITTYPE", " role=\"unittype\"", "m");
  }
  return xml + "</GDALMetadata>\n";
}

std::string geotiff_head(const LayeredMap& map, const MapNotes& notes) {
  const std::uint64_t size = size_of_head(fields_of(map, notes, 0));
  const Strips strips = strips_of(map);
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  require(size + std::uint64_t{strips.count} * strips.bytes <= most,
          "a GeoTIFF of this map would have 4 GiB or more");
  const std::vector<Field> fields = fields_of(map, notes, size);
  const std::size_t start = 8 + 2 + 12 * fields.size() + 4;
  std::string head = "II";
  std::string values;
  put(std::uint16_t{42}, head);
  put(std::uint32_t{8}, head);
  put(static_cast<std::uint16_t>(fields.size()), head);
  for (const Field& each : fields) {
    put(each.tag, head);
    put(each.type, head);
    put(each.count, head);
    if (each.bytes.size() == 4) {
      head += each.bytes;
    } else {
      put(static_cast<std::uint32_t>(start + values.size()), head);
      values += each.bytes;
    }
  }
  put(std::uint32_t{0}, head);  // no further directory
  return head + values;
}

std::string geotiff_row(const Eigen::ArrayXXd& values, Eigen::Index row) {
  std::string bytes;
  bytes.reserve(8 * static_cast<std::size_t>(values.cols()));
  for (Eigen::Index col = 0; col < values.cols(); ++col) {
    const double value = values(row, col);
    put(std::isfinite(value) ? value : nan, bytes);
  }
  return bytes;
}

void append_geotiff(const LayeredMap& map, const std::function<void(std::string_view)>& append,
                    const MapNotes& notes) {
  append(geotiff_head(map, notes));
  for (const MapLayer& layer : map.layers) {
    for (Eigen::Index row = layer.values.rows() - 1; row >= 0; --row) {
      append(geotiff_row(layer.values, row));
    }
  }
}

GeotiffSummary read_geotiff_summary(const InputFile& file) {
  const std::vector<Entry> entries = directory_of(file);
  GeotiffSummary summary;
  summary.cols = entry_of(file, entries, 256, long_word).value;
  summary.rows = entry_of(file, entries, 257, long_word).value;
  const std::string metadata = metadata_in(file, entry_of(file, entries, 42112, ascii));
  const auto unescaped = [](const std::string& xml) {
    return replaced(replaced(xml, "&lt;", "<"), "&amp;", "&");
  };
  std::istringstream lines(metadata);
  for (std::string line; std::getline(lines, line);) {
    const std::string end = "</Item>";
    const std::string band = "<Item name=\"DESCRIPTION\" sample=\"" +
                             std::to_string(summary.bands.size()) + "\" role=\"description\">";
    if (const auto name = between(line, band, end)) summary.bands.push_back(unescaped(*name));
    const auto note = between(line, "<Item name=\"", end);
    const std::size_t middle = note ? note->find("\">") : std::string::npos;
    if (middle == std::string::npos || note->find('"') != middle) continue;
    summary.notes.push_back({note->substr(0, middle), unescaped(note->substr(middle + 2))});
  }
  return summary;
}

}  // namespace excavplan
