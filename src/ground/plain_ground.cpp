// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/plain_ground.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/ground/ascii_grid.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/non_finite.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string>& keys() {
  static const std::vector<std::string> list = {"bank", "loose", "bank_density_percent",
                                                "loose_density_percent", "frame"};
  return list;
}

/// A JSON of another program and the grids in its folder.
class PlainFile {
 public:
  explicit PlainFile(const std::string& path)
      : path_(path), json_(parse_json(path, read_file(path, most_foreign_bytes))) {
    if (!json_.is_object()) {
      throw Error(ErrorKind::bad_file, path + ": expected a JSON object that names grids");
    }
    for (const auto& [key, value] : json_.items()) {
      const auto meant = nearest_word(key, keys());
      if (meant && *meant != key) fail(key, "is not known; " + *meant + " is");
    }
  }

  std::string text_or_empty(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end() || found->is_null()) return {};
    if (!found->is_string()) fail(key, "is " + shown(*found) + ", must be a text");
    std::string text = found->get<std::string>();
    if (const auto fault = fault_of_line(text, longest_text)) fail(key, "is " + *fault);
    return text;
  }

  /// Nothing if the key is not there. @param like  grid that it must have; null: any
  std::optional<HeightMap> grid(const char* key, const HeightMap* like) const {
    const std::string name = text_or_empty(key);
    if (name.empty()) return std::nullopt;
    HeightMap map = read_ascii_grid(in_folder(key, name));
    if (like == nullptr || same_grid(map, *like)) return map;
    fail(key, in_quotes(name) + " has another origin, cell or size than the grid of bank: " +
                  grid_text(map) + " instead of " + grid_text(*like));
  }

  /// @throws Error (bad_file) unless every value that is known is in these bounds
  void require_in(const char* key, const HeightMap& grid, double lowest, double highest) const {
    for_each_cell(grid.z, [&](Cell cell) {
      const double value = grid.z(cell.row, cell.col);
      if (std::isnan(value) || (value >= lowest && value <= highest)) return;
      fail(key, "is " + number_text(value) + " in the cell at x = " +
                    number_text(grid.x(cell.col)) + " m, y = " + number_text(grid.y(cell.row)) +
                    " m, must be in " + plain_number(lowest) + " .. " + plain_number(highest));
    });
  }

  [[noreturn]] void fail(const std::string& key, const std::string& why) const {
    throw Error(ErrorKind::bad_file, path_ + ": " + safe_text(key, 40) + ": " + why);
  }

 private:
  static std::string grid_text(const HeightMap& map) {
    return std::to_string(map.z.cols()) + " x " + std::to_string(map.z.rows()) + " cells of " +
           number_text(map.cell_size) + " m from " + number_text(map.origin.x()) + ", " +
           number_text(map.origin.y());
  }

  /// The file of this name with all links followed.
  std::string in_folder(const char* key, const std::string& name) const {
    std::error_code fault;
    const fs::path named = name;
    const fs::path folder = fs::canonical(fs::absolute(path_).parent_path(), fault);
    const fs::path found = fault ? fs::path() : fs::canonical(folder / named, fault);
    if (fault) fail(key, in_quotes(name) + ": " + fault.message());
    const fs::path inside = found.lexically_relative(folder);
    if (named.is_absolute() || inside.empty() || *inside.begin() == "..") {
      fail(key, in_quotes(name) + " is or leads to a file outside of the folder of the JSON");
    }
    return found.string();
  }

  const std::string& path_;
  nlohmann::json json_;
};

/// Thickness of the loose soil; less than nothing by no more than rounding is nothing.
Eigen::ArrayXXd loose_of(const PlainFile& file, const HeightMap& bank) {
  constexpr double rounding = 1e-6;  // of heights of which one was taken from the other [m]; ours
  const char* const key = "loose";
  std::optional<HeightMap> loose = file.grid(key, &bank);
  if (!loose) return Eigen::ArrayXXd::Zero(bank.z.rows(), bank.z.cols());
  file.require_in(key, *loose, -rounding, std::numeric_limits<double>::infinity());
  return (loose->z < 0.0).select(0.0, loose->z);
}

Eigen::ArrayXXd density_of(const PlainFile& file, const char* key, const HeightMap& bank) {
  std::optional<HeightMap> density = file.grid(key, &bank);
  if (!density) return {};
  file.require_in(key, *density, 0.0, 100.0);
  return std::move(density->z);
}

}  // namespace

PlainGround load_plain_ground(const std::string& path) {
  const PlainFile file(path);
  PlainGround plain;
  std::optional<HeightMap> bank = file.grid("bank", nullptr);
  if (!bank) file.fail("bank", "is missing: the file of the grid of heights");
  plain.ground.frame = file.text_or_empty("frame");
  plain.bank_density_percent = density_of(file, "bank_density_percent", *bank);
  plain.loose_density_percent = density_of(file, "loose_density_percent", *bank);
  Terrain& terrain = plain.ground.terrain;
  terrain.loose = loose_of(file, *bank);
  terrain.bank = std::move(*bank);
  const Mask unknown = terrain.bank.z.isNaN() || terrain.loose.isNaN();
  terrain.bank.z = unknown.select(nan, terrain.bank.z);
  terrain.loose = unknown.select(0.0, terrain.loose);
  return plain;
}

}  // namespace excavplan
