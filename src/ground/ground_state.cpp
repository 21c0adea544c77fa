// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/ground_state.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/non_finite.hpp"
#include "base/read_double.hpp"
#include "base/scalar.hpp"
#include "base/text.hpp"
#include "ground/geotiff.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"
#include "ground/terrain.hpp"

namespace excavplan {
namespace {

// Bounds of what a state holds, all ours.
constexpr double most_void_ratio = 100.0;
constexpr double latest_time = 1e11;  ///< since 1970, in the year 5138 [s]

/// A layer of a state and the band of its file.
struct StateLayer {
  const char* band;
  const char* meaning;
  Eigen::ArrayXXd& (*of)(GroundState& state);
  double lowest, highest;
  bool is_always_there;
};

const std::vector<StateLayer>& layers() {
  using S = GroundState;
  using Layer = Eigen::ArrayXXd;
  static const std::vector<StateLayer> rows = {
      {"bank_m", "top of the undisturbed soil", [](S& s) -> Layer& { return s.terrain.bank.z; },
       -farthest_height, farthest_height, true},
      {"loose_m", "thickness of the loose soil on it",
       [](S& s) -> Layer& { return s.terrain.loose; }, 0.0, farthest_height, true},
      {"bank_void_ratio", "void ratio of the undisturbed soil",
       [](S& s) -> Layer& { return s.terrain.bank_void_ratio; }, 0.0, most_void_ratio, false},
      {"loose_void_ratio", "void ratio of the loose soil",
       [](S& s) -> Layer& { return s.terrain.loose_void_ratio; }, 0.0, most_void_ratio, false},
      {"obstacles_m", "top of what is no soil", [](S& s) -> Layer& { return s.terrain.obstacles; },
       -farthest_height, farthest_height, false},
      {"seen_s", "last seen, since 1970-01-01 UTC", [](S& s) -> Layer& { return s.seen; },
       -latest_time, latest_time, false},
      {"deviation_m", "standard deviation of the surface",
       [](S& s) -> Layer& { return s.deviation; }, 0.0, farthest_height, false}};
  return rows;
}

const Eigen::ArrayXXd& values_of(const StateLayer& layer, const GroundState& state) {
  return layer.of(const_cast<GroundState&>(state));
}

/// What is wrong with a state; nothing if it is one.
std::optional<std::string> fault_of_layer(const StateLayer& layer, const GroundState& state) {
  const Eigen::ArrayXXd& values = values_of(layer, state);
  const HeightMap& grid = state.terrain.bank;
  if (values.size() == 0 && !layer.is_always_there) return std::nullopt;
  if (values.rows() != grid.z.rows() || values.cols() != grid.z.cols()) {
    return std::string("layer ") + layer.band + " must be as large as the bank";
  }
  const auto is_within = (values >= layer.lowest && values <= layer.highest) || values.isNaN();
  if (is_within.all()) return std::nullopt;
  std::optional<std::string> fault;
  for_each_cell(values, [&](Cell cell) {
    const double value = values(cell.row, cell.col);
    if (fault || std::isnan(value) || (value >= layer.lowest && value <= layer.highest)) return;
    fault = std::string(layer.band) + " of the cell at x = " + number_text(grid.x(cell.col)) +
            " m, y = " + number_text(grid.y(cell.row)) + " m is " + number_text(value) +
            ", must be in " + plain_number(layer.lowest) + " .. " + plain_number(layer.highest) +
            " or not a number";
  });
  return fault;
}

std::optional<std::string> fault_of_names(const GroundState& state) {
  for (const auto& [what, text] : {std::pair("frame", &state.frame), {"soil", &state.soil}}) {
    const auto fault = fault_of_line(*text, longest_text);
    if (!text->empty() && fault) return std::string("name of the ") + what + " is " + *fault;
  }
  return std::nullopt;
}

// ---- file -------------------------------------------------------------------------------------

constexpr const char* format_name = "excavplan-ground";
constexpr const char* format_version = "1";
constexpr const char* seal_key = "checksum";

MapNotes notes_of(const GroundState& state) {
  const HeightMap& grid = state.terrain.bank;
  return {{"format", format_name},
          {"version", format_version},
          {"origin_x_m", number_text(grid.origin.x())},
          {"origin_y_m", number_text(grid.origin.y())},
          {"cell_size_m", number_text(grid.cell_size)},
          {"frame", state.frame},
          {"soil", state.soil}};
}

/// The layers of a state without their values.
LayeredMap bands_of(const GroundState& state) {
  LayeredMap map;
  map.ground = state.terrain.bank;
  for (const StateLayer& layer : layers()) {
    if (values_of(layer, state).size() > 0) map.layers.push_back({layer.band, layer.meaning, {}});
  }
  return map;
}

/// The rows of a file in their order: of the largest y first, layer by layer.
template <typename Visit>
void for_each_row(const GroundState& state, Visit visit) {
  for (const StateLayer& layer : layers()) {
    const Eigen::ArrayXXd& values = values_of(layer, state);
    for (Eigen::Index row = values.rows() - 1; row >= 0; --row) visit(layer, row);
  }
}

/// Checksum of names, grid and rows, so that no bit of a file can turn unnoticed.
class Seal {
 public:
  explicit Seal(const GroundState& state)
      : text_(checksum_text(geotiff_metadata(bands_of(state), notes_of(state)))) {}
  void add(const std::string& row) { text_ = checksum_text(text_ + row); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string head_of(const GroundState& state, const std::string& seal) {
  MapNotes notes = notes_of(state);
  notes.push_back({seal_key, seal});
  return geotiff_head(bands_of(state), notes);
}

/// What the notes of a file say.
class FileNotes {
 public:
  FileNotes(const InputFile& file, MapNotes notes) : file_(file), notes_(std::move(notes)) {
    require("format", format_name);
    require("version", format_version);
  }
  const std::string& text(const std::string& key) const {
    for (const MapNote& note : notes_) {
      if (note.key == key) return note.value;
    }
    file_.refuse("has no '" + key + "' in its metadata: no ground file of excavplan");
  }
  double number(const std::string& key) const {
    const std::string& digits = text(key);
    double value = 0.0;
    const char* const end = digits.data() + digits.size();
    const auto [behind, fault] = read_double(digits.data(), end, value);
    if (fault != std::errc{} || behind != end || !std::isfinite(value)) {
      file_.refuse(key + " of its metadata is " + in_quotes(digits) + ", must be a number");
    }
    return value;
  }

 private:
  void require(const std::string& key, const std::string& expected) const {
    if (text(key) == expected) return;
    file_.refuse(key + " of its metadata is " + in_quotes(text(key)) + ", must be '" + expected +
                 "'");
  }

  const InputFile& file_;
  MapNotes notes_;
};

void require_bytes(const InputFile& file, std::uint64_t bytes) {
  if (file.size() == bytes) return;
  file.refuse("has " + std::to_string(file.size()) + " bytes, must have " + std::to_string(bytes) +
              ": it is cut off or damaged");
}

/// The layers that a file has, as large as it says and not yet read.
void make_layers(const InputFile& file, const GeotiffSummary& summary, GroundState& state) {
  const std::uint64_t cells = std::uint64_t{summary.rows} * summary.cols;
  if (cells == 0 || cells > file.size() / 8 || static_cast<double>(cells) > most_cells) {
    file.refuse("is said to have " + std::to_string(summary.rows) + " x " +
                std::to_string(summary.cols) + " cells in " + std::to_string(file.size()) +
                " bytes; it must have 1 .. " + plain_number(most_cells) + " and room for them");
  }
  std::size_t band = 0;
  for (const StateLayer& layer : layers()) {
    const bool is_there = band < summary.bands.size() && summary.bands[band] == layer.band;
    if (!is_there && layer.is_always_there) {
      file.refuse(std::string("has no band ") + layer.band + " where it must be");
    }
    if (!is_there) continue;
    ++band;
    layer.of(state).resize(summary.rows, summary.cols);
  }
  if (band == summary.bands.size()) return;
  file.refuse("band " + std::to_string(band + 1) + ", " + in_quotes(summary.bands[band]) +
              ", is none of a ground file, or not in its order");
}

/// @throws Error (bad_file) unless the file begins as save_ground() writes a state's
std::uint64_t require_head(const InputFile& file, const std::string& head) {
  std::string found(std::min<std::uint64_t>(head.size(), file.size()), '\0');
  file.read(0, found.data(), found.size());
  const auto [differs, ignored] = std::mismatch(found.begin(), found.end(), head.begin());
  if (differs != found.end()) {
    file.refuse("byte " + std::to_string(differs - found.begin()) +
                " of its head is not as excavplan writes it: the file was changed");
  }
  return head.size();
}

/// @return their seal
std::string read_rows(const InputFile& file, std::uint64_t at, GroundState& state) {
  Seal seal(state);
  const auto width = static_cast<std::size_t>(state.terrain.bank.z.cols());
  std::string bytes(8 * width, '\0');
  for_each_row(state, [&](const StateLayer& layer, Eigen::Index row) {
    file.read(at, bytes.data(), bytes.size());
    at += bytes.size();
    seal.add(bytes);
    for (std::size_t col = 0; col < width; ++col) {
      layer.of(state)(row, static_cast<Eigen::Index>(col)) =
          load<double>(bytes.data() + 8 * col, false);
    }
  });
  file.require_end();
  return seal.text();
}

std::string seal_of(const GroundState& state) {
  Seal seal(state);
  for_each_row(state, [&](const StateLayer& layer, Eigen::Index row) {
    seal.add(geotiff_row(values_of(layer, state), row));
  });
  return seal.text();
}

}  // namespace

void require_ground_state(const GroundState& state, const char* what) {
  require_grid(state.terrain.bank, what);
  require_in(std::string(what) + ": number of cells",
             static_cast<double>(state.terrain.bank.z.size()), 1.0, most_cells);
  for (const StateLayer& layer : layers()) {
    if (const auto fault = fault_of_layer(layer, state)) refuse(std::string(what) + ": " + *fault);
  }
  if (const auto fault = fault_of_names(state)) refuse(std::string(what) + ": " + *fault);
}

GroundState after_dig(GroundState state, const Terrain& after) {
  require_terrain(state.terrain, "ground before a dig");
  require_terrain(after, "ground after a dig");
  require(same_grid(state.terrain.bank, after.bank), "a dig leaves the grid of its ground");
  if (state.deviation.size() > 0) {
    constexpr double rounding = 1e-9;  // [m]
    const Eigen::ArrayXXd change = after.surface().z - state.terrain.surface().z;
    state.deviation = (change.abs() > rounding).select(nan, state.deviation).eval();
  }
  Eigen::ArrayXXd told = std::move(state.terrain.bank_void_ratio);
  state.terrain = after;
  state.terrain.bank_void_ratio = std::move(told);
  return state;
}

void save_ground(const std::string& file, const GroundState& state) {
  require_ground_state(state, "state of the ground");
  const std::string head = head_of(state, seal_of(state));
  write_file(file, [&](const std::function<void(std::string_view)>& append) {
    append(head);
    for_each_row(state, [&](const StateLayer& layer, Eigen::Index row) {
      append(geotiff_row(values_of(layer, state), row));
    });
  });
}

GroundState load_ground(const std::string& path) {
  const InputFile file(path);
  const GeotiffSummary summary = read_geotiff_summary(file);
  const FileNotes notes(file, summary.notes);
  GroundState state;
  state.terrain.bank.origin = {notes.number("origin_x_m"), notes.number("origin_y_m")};
  state.terrain.bank.cell_size = notes.number("cell_size_m");
  state.frame = notes.text("frame");
  state.soil = notes.text("soil");
  make_layers(file, summary, state);
  const std::string& seal = notes.text(seal_key);
  const std::uint64_t begin = require_head(file, head_of(state, seal));
  const auto cells = static_cast<std::uint64_t>(state.terrain.bank.z.size());
  require_bytes(file, begin + 8 * summary.bands.size() * cells);
  if (read_rows(file, begin, state) != seal) {
    file.refuse("its numbers do not have the checksum " + in_quotes(seal) +
                " of its metadata: the file was changed");
  }
  try {
    require_ground_state(state, "its state");
  } catch (const Error& error) {
    file.refuse(error.what());
  }
  return state;
}

}  // namespace excavplan
