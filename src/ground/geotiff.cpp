// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/geotiff.hpp"

#include <excavplan/error.hpp>

#include "base/check.hpp"

#ifdef EXCAVPLAN_WITH_GDAL
#include <dlfcn.h>

#include <array>
#include <atomic>
#include <limits>
#include <vector>

#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_frmts.h>
#endif

namespace excavplan {

#ifndef EXCAVPLAN_WITH_GDAL

std::string lack_of_geotiff() { return "this build of excavplan is without GDAL"; }

std::string geotiff_of(const LayeredMap&, const std::string& file) {
  refuse(file + ": " + lack_of_geotiff());
}

#else

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The functions of GDAL that are called.
class Gdal {
 public:
  Gdal() : library_(::dlopen(EXCAVPLAN_WITH_GDAL, RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) return;
    load(add_geotiff, "GDALRegister_GTiff");
    load(driver, "GDALGetDriverByName");
    load(create, "GDALCreate");
    load(set_place, "GDALSetGeoTransform");
    load(set_frame, "GDALSetProjection");
    load(band, "GDALGetRasterBand");
    load(set_name, "GDALSetDescription");
    load(set_meaning, "GDALSetMetadataItem");
    load(set_unit, "GDALSetRasterUnitType");
    load(set_nodata, "GDALSetRasterNoDataValue");
    load(pass, "GDALRasterIO");
    load(close, "GDALClose");
    load(buffer, "VSIGetMemFileBuffer");
    load(unlink, "VSIUnlink");
    load(quiet, "CPLQuietErrorHandler");
    load(push_handler, "CPLPushErrorHandler");
    load(pop_handler, "CPLPopErrorHandler");
    load(reset_error, "CPLErrorReset");
    load(error_type, "CPLGetLastErrorType");
    load(error_text, "CPLGetLastErrorMsg");
    if (is_complete_) add_geotiff();
  }

  bool is_there() const { return library_ != nullptr && is_complete_; }

  decltype(&::GDALRegister_GTiff) add_geotiff = nullptr;
  decltype(&::GDALGetDriverByName) driver = nullptr;
  decltype(&::GDALCreate) create = nullptr;
  decltype(&::GDALSetGeoTransform) set_place = nullptr;
  decltype(&::GDALSetProjection) set_frame = nullptr;
  decltype(&::GDALGetRasterBand) band = nullptr;
  decltype(&::GDALSetDescription) set_name = nullptr;
  decltype(&::GDALSetMetadataItem) set_meaning = nullptr;
  decltype(&::GDALSetRasterUnitType) set_unit = nullptr;
  decltype(&::GDALSetRasterNoDataValue) set_nodata = nullptr;
  decltype(&::GDALRasterIO) pass = nullptr;
  decltype(&::GDALClose) close = nullptr;
  decltype(&::VSIGetMemFileBuffer) buffer = nullptr;
  decltype(&::VSIUnlink) unlink = nullptr;
  decltype(&::CPLQuietErrorHandler) quiet = nullptr;
  decltype(&::CPLPushErrorHandler) push_handler = nullptr;
  decltype(&::CPLPopErrorHandler) pop_handler = nullptr;
  decltype(&::CPLErrorReset) reset_error = nullptr;
  decltype(&::CPLGetLastErrorType) error_type = nullptr;
  decltype(&::CPLGetLastErrorMsg) error_text = nullptr;

 private:
  template <typename Function>
  void load(Function& function, const char* name) {
    function = reinterpret_cast<Function>(::dlsym(library_, name));
    is_complete_ = is_complete_ && function != nullptr;
  }

  void* library_;
  bool is_complete_ = true;
};

const Gdal& gdal() {
  static const Gdal loaded;
  return loaded;
}

/// A GeoTIFF that is written to memory.
class TiffInMemory {
 public:
  explicit TiffInMemory(const std::string& file) : file_(file) {
    static std::atomic<unsigned> count{0};
    name_ = "/vsimem/excavplan-" + std::to_string(++count) + ".tif";
    gdal_.push_handler(gdal_.quiet);
    gdal_.reset_error();
  }
  ~TiffInMemory() {
    if (data_ != nullptr) gdal_.close(data_);
    gdal_.unlink(name_.c_str());
    gdal_.pop_handler();
  }
  TiffInMemory(const TiffInMemory&) = delete;
  TiffInMemory& operator=(const TiffInMemory&) = delete;

  void create(const HeightMap& grid, std::size_t bands) {
    char deflate[] = "COMPRESS=DEFLATE";
    char by_band[] = "INTERLEAVE=BAND";
    std::array<char*, 3> options = {deflate, by_band, nullptr};
    data_ = gdal_.create(gdal_.driver("GTiff"), name_.c_str(), static_cast<int>(grid.z.cols()),
                         static_cast<int>(grid.z.rows()), static_cast<int>(bands), GDT_Float64,
                         options.data());
    check(data_ != nullptr);
    const Rectangle all = grid.extent();
    std::array<double, 6> place = {all.x_min, grid.cell_size, 0.0, all.y_max, 0.0, -grid.cell_size};
    check(gdal_.set_place(data_, place.data()) == CE_None);
    check(gdal_.set_frame(data_, R"(LOCAL_CS["excavplan site frame",UNIT["metre",1]])") == CE_None);
  }

  void add(const MapLayer& layer, int number) {
    void* const band = gdal_.band(data_, number);
    check(band != nullptr);
    gdal_.set_name(band, layer.name.c_str());
    check(gdal_.set_meaning(band, "meaning", layer.meaning.c_str(), nullptr) == CE_None);
    const bool is_length =
        layer.name.size() > 2 && layer.name.substr(layer.name.size() - 2) == "_m";
    check(gdal_.set_unit(band, is_length ? "m" : "") == CE_None);
    check(gdal_.set_nodata(band, unknown) == CE_None);
    const auto width = static_cast<int>(layer.values.cols());
    const auto height = static_cast<int>(layer.values.rows());
    Eigen::ArrayXd row(width);
    for (int line = 0; line < height; ++line) {
      row = layer.values.row(height - 1 - line);
      row = row.isFinite().select(row, unknown);
      check(gdal_.pass(band, GF_Write, 0, line, width, 1, row.data(), width, 1, GDT_Float64, 0,
                       0) == CE_None);
    }
  }

  std::string bytes() {
    gdal_.close(data_);
    data_ = nullptr;
    check(gdal_.error_type() < CE_Failure);
    vsi_l_offset size = 0;
    const auto* const start =
        reinterpret_cast<const char*>(gdal_.buffer(name_.c_str(), &size, FALSE));
    check(start != nullptr);
    return {start, static_cast<std::size_t>(size)};
  }

 private:
  void check(bool holds) const {
    if (holds) return;
    throw Error(ErrorKind::bad_file, file_ + ": GDAL cannot make a GeoTIFF: " + gdal_.error_text());
  }

  const Gdal& gdal_ = gdal();
  std::string file_;
  std::string name_;
  GDALDatasetH data_ = nullptr;
};

}  // namespace

std::string lack_of_geotiff() {
  if (gdal().is_there()) return "";
  return "GDAL is not installed here (" EXCAVPLAN_WITH_GDAL ")";
}

std::string geotiff_of(const LayeredMap& map, const std::string& file) {
  require(lack_of_geotiff().empty(), file + ": " + lack_of_geotiff());
  TiffInMemory tiff(file);
  tiff.create(map.ground, map.layers.size());
  for (std::size_t i = 0; i < map.layers.size(); ++i) {
    tiff.add(map.layers[i], static_cast<int>(i) + 1);
  }
  return tiff.bytes();
}

#endif

}  // namespace excavplan
