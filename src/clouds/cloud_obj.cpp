// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "clouds/cloud_formats.hpp"

// Wavefront OBJ (Advanced Visualizer manual, appendix B1): the vertices of its meshes, as scanning
// apps of phones write them. Faces, normals, textures and materials do not count.

namespace excavplan {
namespace {

/// All that a line may begin with, but for free-form curves and surfaces.
constexpr std::array<std::string_view, 18> words = {
    "v",  "vn",     "vt",     "vp",     "f",     "l",   "p",          "o",         "g",
    "mg", "mtllib", "usemtl", "usemap", "bevel", "lod", "shadow_obj", "trace_obj", "s"};

bool is_known(std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Takes it off the line; empty of a comment.
std::string_view first_word(std::string_view& line) {
  const std::string_view word = take_word(line);
  return word.substr(0, word.find('#'));
}

/// Told by the first line that is no comment.
bool holds_obj(FileStream& file) {
  std::string_view text = file.peek(longest_line);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const std::string_view word = first_word(line);
    if (!word.empty()) return is_known(word);
    if (end == text.npos) break;
    text.remove_prefix(end + 1);
  }
  return false;
}

CloudShape stream_obj(FileStream& file, PointSink& sink) {
  PointBatch batch(sink);
  std::uint64_t points = 0;
  LineReader lines(file);
  while (lines.next_filled()) {
    std::string_view rest = lines.line();
    const std::string_view first = first_word(rest);
    if (!first.empty() && !is_known(first)) {
      lines.fail(in_quotes(first), "v, vn, vt, f or another word of OBJ");
    }
    if (first != "v") continue;
    Eigen::Vector3d point;
    for (double& number : point) {
      const std::string_view word = take_word(rest);
      if (word.empty()) lines.fail("the end of the line", "v x y z");
      number = number_of(word, lines);
    }
    batch.add(point);
    ++points;
  }
  if (points == 0) lines.fail("no vertex", "v x y z");
  batch.hand_on();
  return {points, 1};
}

}  // namespace

CloudFileFormat obj_format() {
  return {"obj", "OBJ", {".obj"}, holds_obj, stream_obj, nullptr, nullptr, true};
}

}  // namespace excavplan
