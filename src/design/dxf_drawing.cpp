// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "design/dxf_drawing.hpp"

#include <cmath>
#include <utility>

#include <excavplan/base/error.hpp>

#include "base/angles.hpp"
#include "base/text.hpp"
#include "clouds/file_stream.hpp"
#include "design/raw_design.hpp"

// DXF reference of Autodesk: entities 3DFACE, POLYLINE (polyface mesh), INSERT; arbitrary axis
// algorithm.

namespace excavplan {
namespace {

using Eigen::Vector3d;

/// Group codes and their values, each on a line of its own.
class Groups {
 public:
  explicit Groups(FileStream& file) : lines_(file) {}

  bool next() {
    if (!read_line()) return false;
    const auto code = number_of_line();
    if (!code || *code != std::floor(*code) || std::abs(*code) > 1100.0) {
      fail(in_quotes(lines_.line()), "a group code of DXF");
    }
    code_ = static_cast<int>(*code);
    if (!read_line()) fail("the end of the file", "a value of group " + std::to_string(code_));
    return true;
  }
  void require_next() {
    if (!next()) fail("the end of the file", "EOF of a DXF drawing");
  }

  int code() const { return code_; }
  bool is(int code, std::string_view value) const { return code_ == code && text() == value; }
  /// Without blanks around.
  std::string_view text() const {
    std::string_view text = lines_.line();
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return text.substr(0, text.find_last_not_of(" \t") + 1);
  }
  double number() const {
    const auto value = number_of_line();
    if (!value || !std::isfinite(*value))
      fail(in_quotes(text()), "a number of group " + std::to_string(code_));
    return *value;
  }
  int whole() const {
    const double value = number();
    if (value != std::floor(value) || std::abs(value) > 1e9) {
      fail(in_quotes(text()), "a whole number of group " + std::to_string(code_));
    }
    return static_cast<int>(value);
  }
  std::uint64_t line() const { return line_; }
  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    lines_.fail(found, expected);
  }

 private:
  bool read_line() {
    ++line_;
    return lines_.next();
  }
  std::optional<double> number_of_line() const { return parse_number(text()); }

  LineReader lines_;
  std::uint64_t line_ = 0;
  int code_ = 0;
};

const Vector3d none = Vector3d::Zero();

/// The groups of an entity that this reader knows.
struct Entity {
  std::string kind;
  std::uint64_t line = 0;
  std::string layer = "0";
  std::string name;                                           // 2
  std::array<Vector3d, 4> places = {none, none, none, none};  // 10 .. 33
  std::array<bool, 12> is_told = {};                          // of their coordinates
  std::array<int, 4> whole = {};                              // 70 .. 73
  int fourth = 0;                                             // 74
  Vector3d scale = {1.0, 1.0, 1.0};                           // 41 .. 43
  Eigen::Vector2d spacing = {0.0, 0.0};                       // 44, 45
  double turn = 0.0;                                          // 50 [degrees]
  Vector3d normal = {0.0, 0.0, 1.0};                          // 210 .. 230

  void take(const Groups& groups) {
    const int code = groups.code();
    const bool has_scale = kind == "INSERT";
    if (code == 8) layer = groups.text();
    if (code == 2) name = groups.text();
    if (code >= 10 && code < 40 && code % 10 < 4) {
      places[static_cast<std::size_t>(code % 10)][code / 10 - 1] = groups.number();
      is_told[static_cast<std::size_t>(3 * (code % 10) + code / 10 - 1)] = true;
    }
    if (code >= 70 && code < 74) whole[static_cast<std::size_t>(code - 70)] = groups.whole();
    if (code == 74) fourth = groups.whole();
    if (has_scale && code >= 41 && code <= 43) scale[code - 41] = groups.number();
    if (has_scale && (code == 44 || code == 45)) spacing[code - 44] = groups.number();
    if (has_scale && code == 50) turn = groups.number();
    if (code == 210 || code == 220 || code == 230) normal[(code - 210) / 10] = groups.number();
  }
};

/// The frame of an object of this normal, by the arbitrary axis algorithm.
Eigen::Matrix3d frame_of(const Vector3d& normal) {
  constexpr double near_z = 1.0 / 64.0;
  const Vector3d z = normal.normalized();
  const bool is_near = std::abs(z.x()) < near_z && std::abs(z.y()) < near_z;
  const Vector3d x = (is_near ? Vector3d::UnitY() : Vector3d::UnitZ()).cross(z).normalized();
  Eigen::Matrix3d frame;
  frame << x, z.cross(x), z;
  return frame;
}

class Reader {
 public:
  explicit Reader(const std::string& path) : file_(path), groups_(file_) {}

  DxfDrawing read() {
    bool has_entities = false;
    groups_.require_next();
    while (!groups_.is(0, "EOF")) {
      if (!groups_.is(0, "SECTION")) {
        groups_.fail(in_quotes(groups_.text()), "0 SECTION or 0 EOF");
      }
      groups_.require_next();
      const std::string section(groups_.text());
      groups_.require_next();
      has_entities = has_entities || section == "ENTITIES";
      while (!groups_.is(0, "ENDSEC")) read_part(section);
      groups_.require_next();
    }
    if (!has_entities) groups_.fail("the end of the drawing", "a section ENTITIES");
    return std::move(drawing_);
  }

 private:
  void read_part(const std::string& section) {
    if (section == "ENTITIES") {
      read_entity(drawing_.entities);
    } else if (section == "BLOCKS" && groups_.is(0, "BLOCK")) {
      read_block();
    } else if (section == "HEADER" && groups_.is(9, "$INSUNITS")) {
      groups_.require_next();
      drawing_.unit_code = groups_.whole();
      groups_.require_next();
    } else {
      groups_.require_next();
    }
  }

  /// From the group 0 that names it to that of the next.
  Entity next_entity() {
    if (groups_.code() != 0) groups_.fail("group " + std::to_string(groups_.code()), "an entity");
    Entity entity;
    entity.kind = groups_.text();
    entity.line = groups_.line();
    const bool is_known = entity.kind == "3DFACE" || entity.kind == "POLYLINE" ||
                          entity.kind == "VERTEX" || entity.kind == "INSERT" ||
                          entity.kind == "BLOCK";
    groups_.require_next();
    for (; groups_.code() != 0; groups_.require_next()) {
      if (is_known) entity.take(groups_);
    }
    return entity;
  }

  void read_block() {
    const Entity head = next_entity();
    DxfBlock block;
    block.base = head.places[0];
    while (!groups_.is(0, "ENDBLK")) read_entity(block);
    drawing_.blocks[head.name] = std::move(block);
    next_entity();
  }

  void read_entity(DxfBlock& block) {
    const Entity entity = next_entity();
    if (entity.kind == "3DFACE") {
      for (std::size_t i = 0; i < 9; ++i) {
        if (!entity.is_told[i]) refuse(entity, "a 3DFACE without three corners of x, y and z");
      }
      DxfFace face = {entity.places, entity.layer};
      if (!entity.is_told[9] || !entity.is_told[10]) face.corners[3] = face.corners[2];
      add(block, std::move(face));
    } else if (entity.kind == "POLYLINE") {
      read_polyline(entity, block);
    } else if (entity.kind == "INSERT") {
      block.inserts.push_back(insert_of(entity));
    } else if (drawing_.unread.size() < 100) {
      ++drawing_.unread[entity.kind];
    }
  }

  void read_polyline(const Entity& head, DxfBlock& block) {
    constexpr int polyface = 64, vertex_of_mesh = 64, of_polyface = 128;
    const bool is_polyface = (head.whole[0] & polyface) != 0;
    std::vector<Vector3d> points;
    while (groups_.is(0, "VERTEX")) {
      const Entity vertex = next_entity();
      const int kind = vertex.whole[0];
      if (!is_polyface) continue;
      if ((kind & vertex_of_mesh) != 0) {
        points.push_back(vertex.places[0]);
      } else if ((kind & of_polyface) != 0) {
        add_polyface(vertex, points, block);
      }
    }
    if (groups_.is(0, "SEQEND")) next_entity();
    if (!is_polyface) ++drawing_.unread["POLYLINE"];
  }

  void add_polyface(const Entity& record, const std::vector<Vector3d>& points, DxfBlock& block) {
    const std::array<int, 4> corners = {record.whole[1], record.whole[2], record.whole[3],
                                        record.fourth};
    DxfFace face = {{}, record.layer};
    std::size_t count = 0;
    for (const int corner : corners) {
      if (corner == 0) continue;  // a negative one begins an edge that is not drawn
      const auto index = static_cast<std::size_t>(std::abs(corner));
      if (index > points.size()) {
        refuse(record, "a face with the vertex " + std::to_string(index) + " of a mesh of " +
                           std::to_string(points.size()));
      }
      face.corners[count++] = points[index - 1];
    }
    if (count < 3) return;  // a line of a mesh
    if (count == 3) face.corners[3] = face.corners[2];
    add(block, std::move(face));
  }

  void add(DxfBlock& block, DxfFace face) {
    if (++faces_ > most_design_triangles) groups_.fail("too many faces", "fewer");
    block.faces.push_back(std::move(face));
  }

  DxfInsert insert_of(const Entity& entity) const {
    DxfInsert insert;
    insert.block = entity.name;
    insert.layer = entity.layer;
    insert.line = entity.line;
    if (!(entity.normal.norm() > 0.0)) refuse(entity, "an extrusion without direction");
    const double turn = entity.turn * pi / 180.0;
    insert.place = Eigen::Affine3d(frame_of(entity.normal)) *
                   Eigen::Translation3d(entity.places[0]) *
                   Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * Eigen::Scaling(entity.scale);
    insert.columns = std::max(1, entity.whole[0]);
    insert.rows = std::max(1, entity.whole[1]);
    // Spacing is not scaled with the block.
    for (int axis = 0; axis < 2; ++axis) {
      insert.spacing[axis] =
          entity.scale[axis] == 0.0 ? 0.0 : entity.spacing[axis] / entity.scale[axis];
    }
    return insert;
  }

  [[noreturn]] void refuse(const Entity& entity, const std::string& what) const {
    file_.refuse("line " + std::to_string(entity.line) + ": found " + what);
  }

  FileStream file_;
  Groups groups_;
  DxfDrawing drawing_;
  std::uint64_t faces_ = 0;
};

}  // namespace

DxfDrawing read_dxf_drawing(const std::string& path) { return Reader(path).read(); }

}  // namespace excavplan
