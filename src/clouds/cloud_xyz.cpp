// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include "clouds/cloud_formats.hpp"

namespace excavplan {
namespace {

using Words = std::vector<std::string_view>;

/// Tells a cloud without points from a file that lost them.
constexpr std::string_view empty_mark = "# 0 points";

bool is_comment(std::string_view line) {
  const std::string_view word = take_word(line);
  return word.front() == '#' || word.substr(0, 2) == "//";
}

/// One kind of separator holds for the whole file, so that the decimal commas of "1,5 2,5 3,5" or
/// "1,5;2,5;3,5" are refused and never read as columns.
char separator_of(std::string_view line) {
  if (line.find(';') != line.npos) return ';';
  return line.find(',') != line.npos ? ',' : ' ';
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

void split(std::string_view line, char separator, Words& columns) {
  columns.clear();
  if (separator == ' ') {
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
      columns.push_back(word);
    }
    return;
  }
  while (true) {
    const std::size_t end = line.find(separator);
    columns.push_back(without_blanks(line.substr(0, end)));
    if (end == line.npos) return;
    line.remove_prefix(end + 1);
  }
}

/// The columns that a line of names calls x, y and z, if it does so once each.
std::optional<std::array<std::size_t, 3>> columns_by_name(const Words& names) {
  std::array<std::size_t, 3> columns{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto is_axis = [&](std::string_view name) {
      if (name.size() > 2 && name.front() == '"' && name.back() == '"') {
        name = name.substr(1, name.size() - 2);
      }
      return name.size() == 1 && (name[0] == "xyz"[axis] || name[0] == "XYZ"[axis]);
    };
    if (std::count_if(names.begin(), names.end(), is_axis) != 1) return std::nullopt;
    columns[axis] =
        static_cast<std::size_t>(std::find_if(names.begin(), names.end(), is_axis) - names.begin());
  }
  return columns;
}

CloudShape stream_xyz(FileStream& file, PointSink& sink) {
  PointBatch batch(sink);
  std::uint64_t points = 0;
  bool is_empty = false;
  LineReader lines(file);
  char separator = 0;
  std::array<std::size_t, 3> xyz = {0, 1, 2};
  Words columns;
  while (lines.next_filled()) {
    if (is_comment(lines.line())) {
      is_empty = is_empty || lines.line() == empty_mark;
      continue;
    }
    const bool is_first = separator == 0;
    if (is_first) separator = separator_of(lines.line());
    split(lines.line(), separator, columns);
    if (is_first && !parse_number(columns[0])) {
      const auto named = columns_by_name(columns);
      if (!named)
        lines.fail(in_quotes(lines.line()), "numbers, or names of columns with x, y and z");
      xyz = *named;
      continue;
    }
    if (columns.size() <= *std::max_element(xyz.begin(), xyz.end())) {
      lines.fail(std::to_string(columns.size()) + " columns", "x, y and z");
    }
    batch.add({number_of(columns[xyz[0]], lines), number_of(columns[xyz[1]], lines),
               number_of(columns[xyz[2]], lines)});
    ++points;
  }
  if (points == 0 && !is_empty) lines.fail("no row of numbers", "x y z");
  batch.hand_on();
  return {points, 1};
}

bool holds_xyz(FileStream& file) { return !foreign_content(file); }

std::string head_of_xyz(const CloudShape& shape, Numbers) {
  std::string head = "# x y z [m]\n";
  if (shape.points() == 0) head.append(empty_mark).append("\n");
  return head;
}

}  // namespace

CloudFileFormat xyz_format() {
  return {"xyz",   "XYZ text", {".xyz", ".txt", ".asc"}, holds_xyz, stream_xyz, head_of_xyz,
          nullptr, true};
}

}  // namespace excavplan
