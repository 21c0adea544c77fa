// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include <excavplan/base/error.hpp>
#include <excavplan/design/design_file.hpp>

#include "base/text.hpp"
#include "design/dxf_drawing.hpp"
#include "design/raw_design.hpp"

namespace excavplan {
namespace {

constexpr int most_block_levels = 16;           // of blocks in one another; ours
constexpr std::uint64_t most_placed = 5000000;  // blocks; ours

struct DxfUnit {
  int code;  // $INSUNITS
  const char* name;
  double length;  // [m]
};
constexpr double survey_foot = 1200.0 / 3937.0;  // [m]
constexpr std::array<DxfUnit, 18> dxf_units = {{{1, "inch", 0.0254},
                                                {2, "foot", 0.3048},
                                                {3, "mile", 1609.344},
                                                {4, "millimetre", 0.001},
                                                {5, "centimetre", 0.01},
                                                {6, "metre", 1.0},
                                                {7, "kilometre", 1000.0},
                                                {8, "microinch", 2.54e-8},
                                                {9, "mil", 2.54e-5},
                                                {10, "yard", 0.9144},
                                                {13, "micron", 1e-6},
                                                {14, "decimetre", 0.1},
                                                {15, "decametre", 10.0},
                                                {16, "hectometre", 100.0},
                                                {21, "US survey foot", survey_foot},
                                                {22, "US survey inch", survey_foot / 12.0},
                                                {23, "US survey yard", 3.0 * survey_foot},
                                                {24, "US survey mile", 5280.0 * survey_foot}}};

/// Places the blocks of a drawing and keeps the faces of the wanted layers.
class Assembly {
 public:
  Assembly(const std::string& path, const DxfDrawing& drawing, const DesignFileOptions& options)
      : path_(path), drawing_(drawing), options_(options), wanted_(options.layers) {
    if (wanted_.empty() && !options.surface.empty()) wanted_ = {options.surface};
  }

  RawDesign assemble() {
    add(drawing_.entities, Eigen::Affine3d::Identity(), "0", 0);
    if (raw_.triangles.empty()) {
      throw Error(ErrorKind::bad_file, path_ + ": line 1 to the end: found no 3DFACE and no " +
                                           "polyface mesh" + of_layers() +
                                           ", expected the triangles of a surface" + others());
    }
    if (left_out_ > 0) {
      raw_.notes.push_back(std::to_string(left_out_) + " faces of other layers were left out");
    }
    set_unit();
    return std::move(raw_);
  }

 private:
  void add(const DxfBlock& block, const Eigen::Affine3d& place, const std::string& layer,
           int level) {
    for (const DxfFace& face : block.faces) add_face(face, place, layer);
    for (const DxfInsert& insert : block.inserts) {
      const auto found = drawing_.blocks.find(insert.block);
      if (found == drawing_.blocks.end()) refuse(insert, "which is not there");
      if (level == most_block_levels) refuse(insert, "in more than 16 levels of blocks");
      const Eigen::Translation3d off_base(-found->second.base);
      const std::string& own_layer = insert.layer == "0" ? layer : insert.layer;
      for (int row = 0; row < insert.rows; ++row) {
        for (int column = 0; column < insert.columns; ++column) {
          if (++placed_ > most_placed) refuse(insert, "with too many copies");
          const Eigen::Translation3d step(column * insert.spacing.x(), row * insert.spacing.y(),
                                          0.0);
          add(found->second, place * insert.place * step * off_base, own_layer, level + 1);
        }
      }
    }
  }

  void add_face(const DxfFace& face, const Eigen::Affine3d& place, const std::string& layer) {
    const std::string& own = face.layer == "0" ? layer : face.layer;
    if (!wanted_.empty() && std::find(wanted_.begin(), wanted_.end(), own) == wanted_.end()) {
      ++left_out_;
      return;
    }
    const std::size_t count = face.corners[3] == face.corners[2] ? 3 : 4;
    if (raw_.points.size() + count > most_design_points) {
      throw Error(ErrorKind::bad_file, path_ + ": its blocks make too many faces");
    }
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 0; i < count; ++i) {
      corners.push_back(static_cast<std::uint32_t>(raw_.points.size()));
      raw_.points.push_back(place * face.corners[i]);
    }
    raw_.add_face(corners);
  }

  void set_unit() {
    const int code = drawing_.unit_code.value_or(0);
    if (code == 0 && !options_.unit)
      raw_.notes.emplace_back("the drawing tells no unit: metres were taken");
    for (const DxfUnit& unit : dxf_units) {
      if (unit.code != code) continue;
      raw_.unit = unit.length;
      raw_.unit_told_by = "$INSUNITS " + std::to_string(code) + ": " + unit.name;
      raw_.notes.push_back(raw_.unit_told_by + " was taken, which drawings often state wrongly");
      return;
    }
    if (code == 0 || options_.unit) return;
    throw Error(ErrorKind::bad_file, path_ + ": $INSUNITS is " + std::to_string(code) +
                                         ", which is no unit of ground; tell the unit");
  }

  std::string of_layers() const { return left_out_ > 0 ? " of these layers" : ""; }
  std::string others() const {
    std::string text;
    for (const auto& [kind, count] : drawing_.unread) {
      if (text.size() < 80) {
        text +=
            (text.empty() ? "; it has " : ", ") + std::to_string(count) + " " + safe_text(kind, 40);
      }
    }
    return text;
  }
  [[noreturn]] void refuse(const DxfInsert& insert, const std::string& why) const {
    throw Error(ErrorKind::bad_file, path_ + ": line " + std::to_string(insert.line) +
                                         ": found an INSERT of the block " +
                                         in_quotes(insert.block) + ", " + why);
  }

  const std::string& path_;
  const DxfDrawing& drawing_;
  const DesignFileOptions& options_;
  std::vector<std::string> wanted_;  ///< layers; empty: all
  RawDesign raw_;
  std::size_t left_out_ = 0;
  std::uint64_t placed_ = 0;
};

}  // namespace

RawDesign read_dxf(const std::string& path, const DesignFileOptions& options) {
  const DxfDrawing drawing = read_dxf_drawing(path);
  return Assembly(path, drawing, options).assemble();
}

}  // namespace excavplan
