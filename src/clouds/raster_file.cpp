// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/clouds/raster_file.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <excavplan/ground/ascii_grid.hpp>

#include "base/non_finite.hpp"
#include "base/text.hpp"
#include "clouds/cloud_formats.hpp"
#include "clouds/las_system.hpp"
#include "clouds/tiff_file.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"

namespace excavplan {
namespace {

bool holds_tiff(FileStream& file) {
  const std::string_view start = file.peek(4);
  for (const std::string_view known :
       {std::string_view("II*\0", 4), std::string_view("MM\0*", 4), std::string_view("II+\0", 4),
        std::string_view("MM\0+", 4)}) {
    if (start == known) return true;
  }
  return false;
}

bool holds_ascii_grid(FileStream& file) {
  std::string_view start = file.peek(256);
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  const std::string word = small_letters(start.substr(0, start.find_first_of(" \t")));
  return word == "ncols" || word == "nrows";
}

/// The keys of a GeoTIFF (OGC GeoTIFF 1.1), those that are one number.
class GeoKeys {
 public:
  explicit GeoKeys(const TiffFile& tiff)
      : words_(tiff.numbers(34735)), reals_(tiff.numbers(34736)) {}

  std::optional<double> find(double key) const {
    for (std::size_t i = 4; i + 3 < words_.size(); i += 4) {
      if (words_[i] != key) continue;
      if (words_[i + 1] == 0.0) return words_[i + 3];
      const auto place = static_cast<std::size_t>(words_[i + 3]);
      if (words_[i + 1] == 34736.0 && place < reals_.size()) return reals_[place];
    }
    return std::nullopt;
  }
  /// Of a key for a unit of length [m], whose own units have their size in another key.
  std::optional<double> unit(double key, std::optional<double> size_key) const {
    const auto code = find(key);
    if (!code) return std::nullopt;
    const auto known = length_of_epsg(static_cast<unsigned>(*code));
    return known || !size_key ? known : find(*size_key);
  }

 private:
  std::vector<double> words_, reals_;
};

/// The outer corner of the first cell, at the top left, and the edge of a cell.
struct RasterPlace {
  double x, y, cell;
};

RasterPlace place_of(const TiffFile& tiff, bool is_point) {
  const std::vector<double> scale = tiff.numbers(33550);
  const std::vector<double> tie = tiff.numbers(33922);
  const std::vector<double> matrix = tiff.numbers(34264);
  double dx = 0.0, dy = 0.0, x = 0.0, y = 0.0;
  if (matrix.size() == 16) {
    if (matrix[1] != 0.0 || matrix[4] != 0.0) tiff.refuse_tag(34264, "turns the raster");
    dx = matrix[0], dy = -matrix[5], x = matrix[3], y = matrix[7];
  } else if (scale.size() >= 2 && tie.size() >= 6) {
    dx = scale[0], dy = scale[1];
    x = tie[3] - tie[0] * dx, y = tie[4] + tie[1] * dy;
  } else {
    tiff.refuse_tag(33550, "or 33922, which place a GeoTIFF, is missing or too short");
  }
  if (!(dx > 0.0 && std::abs(dx - dy) <= 1e-6 * dx)) {
    tiff.refuse_tag(33550, "makes cells of " + number_text(dx) + " by " + number_text(dy) +
                               ", must be squares with north up");
  }
  if (is_point) x -= 0.5 * dx, y += 0.5 * dx;
  return {x, y, dx};
}

double nodata_of(const TiffFile& tiff) {
  const std::string text = tiff.text(42113);
  std::string_view rest = text;
  return parse_number(take_word(rest)).value_or(nan);
}

bool is_nodata(double value, double nodata) {
  return !std::isfinite(value) || value == nodata ||
         static_cast<float>(value) == static_cast<float>(nodata);
}

RasterFile read_geotiff(const std::string& path) {
  const TiffFile tiff(path);
  const TiffImage image(tiff);
  const GeoKeys keys(tiff);
  if (keys.find(1024) == 2.0) {
    tiff.refuse_tag(34735,
                    "says that x and y are degrees, must be lengths: project it by gdalwarp");
  }
  RasterFile raster;
  raster.unit = keys.unit(3076, 3077);
  raster.height_unit = keys.unit(4099, std::nullopt);
  const RasterPlace place = place_of(tiff, keys.find(1025) == 2.0);
  const auto rows = static_cast<Eigen::Index>(image.rows());
  const auto cols = static_cast<Eigen::Index>(image.cols());
  const double nodata = nodata_of(tiff);
  const std::vector<double> values = image.values();
  raster.map.cell_size = place.cell;
  raster.map.origin = {place.x, place.y - place.cell * static_cast<double>(rows)};
  raster.map.z.resize(rows, cols);
  for_each_cell(raster.map.z, [&](Cell at) {
    const Eigen::Index from_top = rows - 1 - at.row;
    const double value = values[static_cast<std::size_t>(from_top * cols + at.col)];
    if (!is_nodata(value, nodata) && !(std::abs(value) <= farthest_height)) {
      tiff.refuse_tag(42113, "is not the value " + number_text(value) + " of row " +
                                 std::to_string(from_top) + " and column " +
                                 std::to_string(at.col) + ", which is no height");
    }
    raster.map.z(at.row, at.col) = is_nodata(value, nodata) ? nan : value;
  });
  return raster;
}

/// Known cells as points at their centres, row after row from the one of smallest y.
CloudShape stream_cells(FileStream& file, PointSink& sink) {
  RasterFile raster = read_raster(file.path());
  const double rise =
      raster.height_unit.value_or(raster.unit.value_or(1.0)) / raster.unit.value_or(1.0);
  const HeightMap& map = raster.map;
  const auto known = static_cast<std::uint64_t>((!map.z.isNaN()).count());
  sink.require_memory(known, 8 * static_cast<std::uint64_t>(map.z.size()));
  PointBatch batch(sink);
  for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
      if (!std::isnan(map.z(row, col))) {
        batch.add({map.x(col), map.y(row), rise * map.z(row, col)});
      }
    }
  }
  batch.hand_on();
  CloudShape shape = {known, 1};
  shape.unit = raster.unit;
  return shape;
}

}  // namespace

bool is_raster(const std::string& path) {
  FileStream file(path);
  return holds_tiff(file) || holds_ascii_grid(file);
}

RasterFile read_raster(const std::string& path) {
  FileStream file(path);
  if (holds_tiff(file)) return read_geotiff(path);
  return {read_ascii_grid(path)};
}

CloudFileFormat geotiff_format() {
  return {"tif", "GeoTIFF", {".tif", ".tiff"}, holds_tiff, stream_cells, nullptr};
}
CloudFileFormat ascii_grid_format() {
  return {"grid", "ESRI ASCII grid", {}, holds_ascii_grid, stream_cells, nullptr};
}

}  // namespace excavplan
