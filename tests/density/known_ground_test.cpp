// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/data_files.hpp>
#include <excavplan/change/ground_update.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/soil/density_law.hpp>

#include "support/dig_series.hpp"

namespace excavplan {
namespace {

using test::DigSeries;
using test::Layout;
using test::SeriesDig;
using test::SeriesSettings;

/// How the digs of a series are surveyed.
struct Surveying {
  bool scans_before = true;  ///< else the known ground stands for them
  bool path_is_told = true;
  int digs = 10;
};

Scan scan_of_cloud(const std::shared_ptr<const Cloud>& cloud) {
  Scan scan;
  scan.clouds = {cloud};
  scan.z_is_up = true;
  return scan;
}

/// Nothing known of a site.
GroundState unknown_site() {
  GroundState state;
  state.terrain = undisturbed(flat_ground({-4.017, -20.017, 13.0, 9.0}, 0.05));
  state.terrain.bank.z.setConstant(std::nan(""));
  return state;
}

SeenGround seen(const Scan& scan, double time) {
  RasterOptions raster;
  raster.cell_size = 0.05;
  const Surface surface = survey_surface(scan, {2.2, -3.5, 9.5, 5.8}, raster);
  SeenGround seen;
  seen.surface = surface.height;
  seen.deviation = surface.variance.sqrt();
  seen.time = time;
  return seen;
}

/// Surveys of a series, in ground that is known better from dig to dig.
class SurveyedSeries {
 public:
  SurveyedSeries(const SeriesSettings& settings, const Surveying& surveying)
      : series_(settings), settings_(settings), surveying_(surveying), known_(unknown_site()) {}

  struct Answer {
    SeriesDig dig;
    DensityEstimate estimate;
    double truth = 0.0;

    bool is_trusted() const { return estimate.trustworthy && estimate.density; }
    bool is_inside() const {
      if (!estimate.density) return false;
      const auto& interval = estimate.density->interval_percent;
      return truth >= interval[0] - 1e-9 && truth <= interval[1] + 1e-9;
    }
    double error() const {
      return estimate.density ? estimate.density->percent - truth : std::nan("");
    }
  };

  std::optional<Answer> next(DensityOptions options = {}) {
    series_.move();
    const Scan before = scan_of_cloud(series_.scan());
    if (digs_++ == 0 || surveying_.scans_before == false) {
      // The machine looks around where it stands.
      known_ = series_.in_site(updated_ground(series_.in_frame(known_), seen(before, digs_)));
    }
    const auto dig = series_.dig();
    if (!dig) return std::nullopt;
    DigScans scans;
    if (surveying_.scans_before) scans.before = before;
    scans.after = scan_of_cloud(series_.scan());
    options.ground = series_.in_frame(known_);
    options.scan_time = digs_;
    options.soil.kind = series_.soil();
    options.threads = 1;
    if (surveying_.path_is_told) {
      options.dug_path = DugPath{series_.machine(), dig->path.parameters, dig->path.start_x,
                                 dig->path.ground_z};
    }
    Answer answer{*dig, estimate_density(scans, law(), options),
                  settings_.density_percent};
    known_ = series_.in_site(*answer.estimate.ground_after);
    if (std::getenv("DEBUG_BANK")) {
      const HeightMap truth = series_.ground().bank;
      const GroundState now = series_.in_frame(known_);
      double in = 0.0, near = 0.0, far = 0.0;
      for (Eigen::Index r = 0; r < now.terrain.bank.z.rows(); ++r)
        for (Eigen::Index c = 0; c < now.terrain.bank.z.cols(); ++c) {
          const double x = now.terrain.bank.x(c), y = now.terrain.bank.y(r);
          const double off = (now.terrain.bank.z(r, c) - height_at(truth, x, y)) * 0.0025;
          if (std::isnan(off)) continue;
          const bool strip = x > 3.0 && x < 7.2;
          if (strip && std::abs(y) < 0.45) in += off;
          else if (strip && std::abs(y) < 1.2) near += off;
          else far += off;
        }
      if (std::getenv("DUMP")) {
        std::map<int, double> by_col, by_row;
        for (Eigen::Index r = 0; r < now.terrain.bank.z.rows(); ++r)
          for (Eigen::Index c = 0; c < now.terrain.bank.z.cols(); ++c) {
            const double x = now.terrain.bank.x(c), y = now.terrain.bank.y(r);
            const double off = (now.terrain.bank.z(r, c) - height_at(truth, x, y)) * 0.0025;
            if (std::isnan(off) || x < 3.0 || x > 7.2 || std::abs(y) > 0.6) continue;
            by_col[static_cast<int>(std::floor(x / 0.05))] += off;
            by_row[static_cast<int>(std::floor(y / 0.05))] += off;
          }
        for (auto& [c, v] : by_col) std::cout << "c" << 0.05 * c << ":" << std::round(1e5 * v) << " ";
        std::cout << "\n";
        for (auto& [c, v] : by_row) std::cout << "r" << 0.05 * c << ":" << std::round(1e5 * v) << " ";
        std::cout << "\n";
      }
      std::cout << "   bank too high: in " << in << " near " << near << " far " << far << " half " << 0.5 * series_.machine().bucket.width_outside << "\n";
    }
    return answer;
  }

  /// Without the path what falls back is that of the law.
  DensityLaw law() const {
    return surveying_.path_is_told ? density_law_of(series_.soil())
                                   : load_density_law(find_data_file("laws/zx120-loam.json"));
  }
  const GroundState& known() const { return known_; }
  DigSeries& series() { return series_; }

 private:
  DigSeries series_;
  SeriesSettings settings_;
  Surveying surveying_;
  GroundState known_;
  int digs_ = 0;
};

std::string codes(const DensityEstimate& estimate) {
  std::string all;
  for (const Warning& warning : estimate.warnings) {
    all += " " + code_text(warning.code) + (warning.ends_trust ? "!" : "");
  }
  return all;
}

void print(const SurveyedSeries::Answer& answer, const std::string& where) {
  const DensityEstimate& e = answer.estimate;
  std::cout << where << " d " << answer.truth << " found "
            << (e.density ? e.density->raw_percent : -1.0) << " sd "
            << (e.density ? e.density->sd_percent : -1.0) << " k "
            << (e.bulking ? e.bulking->value : 0.0) << " B " << e.change.cut->bank.value << " true "
            << answer.dig.bank_cut << " L " << e.change.cut->loose.value << " F "
            << e.change.cut->fallen << " share " << e.change.cut->bank_share() << " shared "
            << e.shared_with_before << (answer.is_trusted() ? " T" : " -")
            << (answer.is_inside() ? "I" : "o") << codes(e) << "\n";
  if (std::getenv("DEBUG_N")) {
    const AreaChange& area = e.change.areas.front();
    double all = 0.0, stable = 0.0, other = 0.0; int unknown = 0;
    for (Eigen::Index r = 0; r < area.zone.rows(); ++r)
      for (Eigen::Index c = 0; c < area.zone.cols(); ++c) {
        const double d = area.difference.z(r, c) * area.difference.cell_size * area.difference.cell_size;
        const int z = area.zone(r, c);
        if (std::isnan(d)) { if (z >= 0) ++unknown; continue; }
        all += d;
        if (z < 0) stable += d;
        else if (e.change.zones[z].kind == ZoneKind::other) other += d;
      }
    int nan_before = 0; std::map<int,int> rows;
    for (Eigen::Index r = 0; r < area.zone.rows(); ++r)
      for (Eigen::Index c = 0; c < area.zone.cols(); ++c)
        if (std::isnan(area.difference.z(r, c)) && area.zone(r, c) >= 0) { ++rows[static_cast<int>(std::floor(area.difference.y(r) * 20))]; if (std::isnan(e.before.front().z(r, c))) ++nan_before; }
    std::cout << "    nan in before " << nan_before << " rows";
    for (auto& [y, n] : rows) std::cout << " " << y * 0.05 << ":" << n;
    std::cout << "\n";
    const double k = bulking_of_density(load_soil(find_data_file("soils/loam.json")), answer.truth);
    std::cout << "    N true " << (k - 1.0) * answer.dig.bank_cut << " zones " << e.change.spilled.value + e.change.dumped.value - e.change.excavated.value << " all " << all << " stable " << stable << " other " << other << " unknown cells " << unknown << " datum " << area.datum << " ex " << e.change.excavated.value << " sp " << e.change.spilled.value << " du " << e.change.dumped.value << " strewn " << e.change.strewn.value << "\n";
    for (const ChangeZone& z : e.change.zones) if (z.kind == ZoneKind::other || z.unknown_share > 0.1) std::cout << "      zone " << name(z.kind) << " V " << z.volume.value << " area " << z.area << " unk " << z.unknown_share << " at " << z.extent.x_min << ".." << z.extent.x_max << " " << z.extent.y_min << ".." << z.extent.y_max << "\n";
  }
}

TEST(KnownGround, Bench) {
  const char* seeds_text = std::getenv("SEEDS");
  const char* mode = std::getenv("MODE");
  const int seeds = seeds_text ? std::atoi(seeds_text) : 1;
  Surveying surveying;
  if (mode) {
    surveying.scans_before = std::string(mode).find('n') == std::string::npos;
    surveying.path_is_told = std::string(mode).find('p') == std::string::npos;
  }
  int all = 0, good = 0, near_trusted = 0, trusted = 0;
  double squares = 0.0, whitened = 0.0;
  for (const Layout layout : test::layouts) {
    int of_layout = 0, good_layout = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      SeriesSettings settings;
      settings.layout = layout;
      settings.seed = static_cast<std::uint64_t>(seed);
      settings.density_percent = 10.0 + 80.0 * std::fmod(0.37 * seed + 0.21 * static_cast<int>(layout), 1.0);
      SurveyedSeries series(settings, surveying);
      for (int i = 0; i < 10; ++i) {
        std::optional<SurveyedSeries::Answer> answer;
        try { answer = series.next(); } catch (const Error& error) {
          std::cout << name(layout) << " REFUSED " << error.what() << "\n";
          ++all; ++of_layout;
          continue;
        }
        if (!answer) { std::cout << name(layout) << " no dig\n"; continue; }
        print(*answer, std::string(name(layout)) + " " + std::to_string(i));
        ++all; ++of_layout;
        if (answer->is_trusted()) ++trusted;
        if (answer->is_trusted() && answer->is_inside()) { ++good; ++good_layout; }
        if (answer->is_trusted() && std::abs(answer->error()) < 5.0) ++near_trusted;
        if (answer->is_trusted()) {
          squares += std::pow(answer->error(), 2);
          whitened += std::pow(answer->error() / answer->estimate.density->sd_percent, 2);
        }
      }
    }
    std::cout << name(layout) << ": " << good_layout << " of " << of_layout << "\n";
  }
  std::cout << "all " << all << " trusted " << trusted << " good " << good << " within5 "
            << near_trusted << " rms " << std::sqrt(squares / trusted) << " whitened "
            << whitened / trusted << "\n";
}

}  // namespace
}  // namespace excavplan
