// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstring>

#include "base/scalar.hpp"
#include "base/text.hpp"
#include "clouds/ply_mesh.hpp"
#include "design/raw_design.hpp"

namespace excavplan {
namespace {

class Points : public PointSink {
 public:
  Points(const FileStream& file, std::vector<Eigen::Vector3d>& points)
      : file_(file), points_(points) {}
  void require_memory(std::uint64_t points, std::uint64_t /*more_bytes*/) override {
    if (points > most_design_points) {
      file_.refuse("byte 0: found " + std::to_string(points) + " points, expected at most " +
                   std::to_string(most_design_points));
    }
    points_.reserve(points);
  }
  void take(const std::vector<Eigen::Vector3d>& points) override {
    points_.insert(points_.end(), points.begin(), points.end());
  }

 private:
  const FileStream& file_;
  std::vector<Eigen::Vector3d>& points_;
};

/// A corner of a face as OBJ has it, "7", "7/1/2" or "-1", as a number from 0.
std::uint32_t obj_corner(std::string_view word, std::size_t points, const LineReader& lines) {
  const std::string_view index = word.substr(0, word.find('/'));
  const bool is_from_end = !index.empty() && index.front() == '-';
  const std::uint64_t value = count_of(index.substr(is_from_end ? 1 : 0), lines);
  if (value == 0 || value > points) {
    lines.fail("the vertex " + in_quotes(index) + " of " + std::to_string(points),
               "one that comes before");
  }
  return static_cast<std::uint32_t>(is_from_end ? points - value : value - 1);
}

constexpr std::size_t stl_head = 84;      // with the count [byte]
constexpr std::size_t stl_triangle = 50;  // [byte]

/// Also text files begin with "solid", and some binary ones: their size tells.
bool is_binary_stl(FileStream& file) {
  const std::string_view head = file.peek(stl_head);
  if (head.size() < stl_head) return false;
  const auto count = load<std::uint32_t>(head.data() + stl_head - 4, false);
  return file.size() == stl_head + std::uint64_t{stl_triangle} * count ||
         head.substr(0, 5) != "solid";
}

void read_binary_stl(FileStream& file, RawDesign& raw) {
  const auto count = load<std::uint32_t>(file.peek(stl_head).data() + stl_head - 4, false);
  file.skip(stl_head);
  if (count > file.left() / stl_triangle || count > most_design_triangles) {
    file.fail_here(std::to_string(file.left()) + " bytes",
                   std::to_string(count) + " triangles of 50 bytes");
  }
  raw.points.reserve(3 * std::size_t{count});
  for (std::uint32_t i = 0; i < count; ++i) {
    const char* const corners = file.peek(stl_triangle).data() + 12;  // behind the normal
    for (std::size_t corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d point;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[static_cast<Eigen::Index>(axis)] =
            static_cast<double>(load<float>(corners + 12 * corner + 4 * axis, false));
      }
      raw.points.push_back(point);
    }
    const std::uint32_t first = 3 * i;
    raw.triangles.push_back({first, first + 1, first + 2});
    file.skip(stl_triangle);
  }
  file.require_end();
}

Eigen::Vector3d three_numbers(std::string_view rest, const LineReader& lines) {
  Eigen::Vector3d point;
  for (double& number : point) number = number_of(take_word(rest), lines);
  return point;
}

void read_text_stl(FileStream& file, RawDesign& raw) {
  LineReader lines(file);
  std::size_t corners = 0;
  bool is_ended = false;
  while (lines.next_filled()) {
    std::string_view rest = lines.line();
    const std::string word = small_letters(take_word(rest));
    if (word == "vertex") {
      raw.points.push_back(three_numbers(rest, lines));
      ++corners;
    } else if (word == "facet") {
      corners = 0;
    } else if (word == "endfacet") {
      const auto last = static_cast<std::uint32_t>(raw.points.size());
      if (corners != 3) lines.fail(std::to_string(corners) + " corners", "three of a facet");
      raw.triangles.push_back({last - 3, last - 2, last - 1});
    } else if (word == "endsolid") {
      is_ended = true;
    } else if (word != "solid" && word != "outer" && word != "endloop") {
      lines.fail(in_quotes(word), "solid, facet, outer, vertex, endloop, endfacet or endsolid");
    }
    if (raw.points.size() > most_design_points) lines.fail("too many points", "fewer");
  }
  if (!is_ended) lines.fail("the end of the file", "endsolid");
}

}  // namespace

RawDesign read_ply_design(const std::string& path) {
  FileStream file(path);
  RawDesign raw;
  Points points(file, raw.points);
  std::vector<std::uint32_t> corners;
  const auto take_face = [&](const std::vector<double>& face) {
    corners.clear();
    for (const double corner : face) {
      if (!(corner >= 0.0 && corner < static_cast<double>(most_design_points)) ||
          corner != std::floor(corner)) {
        file.fail_here("the vertex " + number_text(corner) + " of face " +
                           std::to_string(raw.triangles.size()),
                       "a whole number from 0");
      }
      corners.push_back(static_cast<std::uint32_t>(corner));
    }
    raw.add_face(corners);
    if (raw.triangles.size() > most_design_triangles) file.fail_here("too many faces", "fewer");
  };
  stream_ply_mesh(file, {points, take_face});
  return raw;
}

RawDesign read_obj(const std::string& path) {
  FileStream file(path);
  LineReader lines(file);
  RawDesign raw;
  std::vector<std::uint32_t> corners;
  while (lines.next_filled()) {
    std::string_view rest = lines.line();
    const std::string_view word = take_word(rest);
    if (word == "v") {
      raw.points.push_back(three_numbers(rest, lines));
    } else if (word == "f") {
      corners.clear();
      for (auto corner = take_word(rest); !corner.empty(); corner = take_word(rest)) {
        corners.push_back(obj_corner(corner, raw.points.size(), lines));
      }
      if (corners.size() < 3) {
        lines.fail(std::to_string(corners.size()) + " corners", "three or more of a face");
      }
      raw.add_face(corners);
    } else if (word.front() != '#' &&
               word.find_first_not_of("abcdefghijklmnopqrstuvwxyz_ABCDEFGHIJKLMNOPQRSTUVWXYZ") !=
                   word.npos) {
      lines.fail(in_quotes(word), "a keyword of OBJ");
    }
    if (raw.points.size() > most_design_points) lines.fail("too many vertices", "fewer");
  }
  return raw;
}

RawDesign read_stl(const std::string& path) {
  FileStream file(path);
  RawDesign raw;
  if (is_binary_stl(file)) {
    read_binary_stl(file, raw);
  } else {
    read_text_stl(file, raw);
  }
  raw.notes.emplace_back("STL holds numbers of 32 bits: 6 cm at coordinates of 10^6");
  return raw;
}

}  // namespace excavplan
