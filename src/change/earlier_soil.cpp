// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/earlier_soil.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <excavplan/base/error.hpp>
#include <excavplan/change/bulking.hpp>

#include "base/text.hpp"
#include "change/zone_shape.hpp"
#include "ground/grid_cells.hpp"
#include "ground/plane_fit.hpp"
#include "ground/slopes.hpp"

namespace excavplan {
namespace {

// All ours.
constexpr double ring_from = 0.1;       // around the hole [m]
constexpr double ring_to = 0.8;         // [m]
constexpr std::size_t least_ring = 50;  // cells
constexpr double least_height = 0.05;   // of a hump [m]
constexpr double least_excess = 3.0;    // of it, over the deviation of the ground around
constexpr double foot = 1.0;            // where it begins, likewise
constexpr double gentlest = 0.35;       // its slope: 19 degrees
constexpr double steepest = 1.2;        // 50 degrees; undisturbed walls are steeper
constexpr double least_share = 0.005;   // of the hole
constexpr double weight = 0.5;
constexpr double relative_sd = 0.2;  // of its volume
constexpr double telling = 0.03;     // of k

/// (column, row, height) of the ground around the hole.
std::vector<Eigen::Vector3d> ring_of(const HeightMap& before, const Area& area, const Mask& hole) {
  const Eigen::ArrayXXd away = distance_to(hole) * area.grid.cell_size;
  std::vector<Eigen::Vector3d> ring;
  for_each_cell(before.z, [&](Cell at) {
    const double distance = away(at.row, at.col);
    const double z = before.z(at.row, at.col);
    if (distance < ring_from || distance > ring_to || std::isnan(z)) return;
    if (area.ground.zone(at.row, at.col) >= 0) return;
    ring.emplace_back(static_cast<double>(at.col), static_cast<double>(at.row), z);
  });
  return ring;
}

/// Volume of the humps in the hole of one area [m^3].
double loose_volume(const HeightMap& before, const Area& area) {
  Mask hole = Mask::Constant(before.z.rows(), before.z.cols(), false);
  for_each_cell(hole, [&](Cell at) {
    const int zone = area.ground.zone(at.row, at.col);
    hole(at.row, at.col) = zone >= 0 && area.kinds[static_cast<std::size_t>(zone)] == ZoneKind::dig;
  });
  if (!hole.any()) return 0.0;
  const std::vector<Eigen::Vector3d> ring = ring_of(before, area, hole);
  if (ring.size() < least_ring) return 0.0;
  const RobustPlane fit = robust_plane(ring);
  Eigen::ArrayXXd above = Eigen::ArrayXXd::Zero(hole.rows(), hole.cols());
  std::vector<Cell> hump;
  for_each_cell(hole, [&](Cell at) {
    above(at.row, at.col) = before.z(at.row, at.col) -
                            fit.plane.at(static_cast<double>(at.col), static_cast<double>(at.row));
    if (hole(at.row, at.col) && above(at.row, at.col) > foot * fit.sd) hump.push_back(at);
  });
  const ZoneShape shape = shape_of(above, hump, area.grid.cell_size);
  const bool is_high = shape.height > std::max(least_height, least_excess * fit.sd);
  if (!is_high || shape.steepest < gentlest || shape.steepest > steepest) return 0.0;
  double volume = 0.0;
  for (const Cell at : hump) volume += above(at.row, at.col);
  return volume * area.grid.cell_size * area.grid.cell_size;
}

void state(double volume, double factor, double scans, VolumeChange& change) {
  const double hole = change.before.value;
  const double read = (change.after.value - volume) / (hole - volume);
  const double sd = std::hypot(scans, relative_sd * (read - factor));
  const std::string what = "loose soil of an earlier dig in the hole before";
  change.attribution.push_back(
      {ChangeKind::earlier_soil, what, {volume, relative_sd * volume}, true, 1.0 - weight});
  for (Reading& reading : change.readings) reading.weight *= 1.0 - weight;
  change.readings.push_back({{ChangeKind::earlier_soil}, "without " + what, weight, {read, sd}});
  const Eigen::Vector3d both(volume, 0.0, volume);
  change.errors.attribution += weight * both * both.transpose();
  change.warnings.emplace_back(
      WarningCode::earlier_soil,
      "the scan before shows " + readable(volume, 0.1 * volume) +
          " m^3 above the ground around, where the hole is, as steep as loose soil: if an earlier "
          "dig left it there, the bulking factor is " +
          readable(read, 0.01) + " instead of " + readable(factor, 0.01) +
          "; scan after loose soil was cleared, or dig beside it",
      std::abs(read - factor) > telling * factor);
}

// ---- In ground that is known -------------------------------------------------------------------

constexpr double sure_change = 2.0;   // ours: deviations that make a change one
constexpr double swelling_sd = 0.01;  // ours: of loose soil that is dug again, of its volume
constexpr double whole = 1.0 - 1e-9;  // of a cell

double value_at(const Eigen::ArrayXXd& layer, Cell at, double without) {
  if (layer.size() == 0) return without;
  const double value = layer(at.row, at.col);
  return std::isnan(value) ? without : value;
}

/// What a fall took of the loose soil of a cell. A fall within its error is no less loose soil for
/// its sign.
double taken_of(double loose, double fall, double sd) {
  if (fall < sure_change * sd) return std::min(fall, loose);
  return std::min(std::max(fall, 0.0), loose);
}

/// One cell of a dig, as heights [m].
struct CellCut {
  double loose = 0.0;    ///< that was dug again
  double bank = 0.0;     ///< cut
  double fallen = 0.0;   ///< loose soil above the cut; NaN where the surface after is not known
  double swept = 0.0;    ///< share of the cell where the bucket cut bank
  bool reached = false;  ///< the bank: the error of `loose` is that of the whole layer
};

class CutReader {
 public:
  CutReader(const KnownGround& known, const Area& area) : known_(known), area_(area) {}

  CellCut at(Cell cell) const {
    const double fall = -area_.ground.difference(cell.row, cell.col);
    const double loose = value_at(known_.loose, cell, 0.0);
    CellCut cut = under_bucket(cell, fall, loose);
    const bool in_hole = is_in_hole(cell);
    if (cut.swept >= whole || std::isnan(fall) || !(in_hole || cut.swept > 0.0)) return cut;
    const double sd = std::sqrt(area_.variance(cell.row, cell.col));
    if (in_hole && loose > 0.0) cut.loose = taken_of(loose, fall, sd);
    const double bank = fall - cut.loose;
    if (cut.swept > 0.0) {  // a cell at the edge of the bucket
      cut.fallen = std::max(0.0, cut.bank - bank);
      if (in_hole) cut.bank = std::max(cut.bank, bank);
    } else {
      cut.bank = bank;
    }
    cut.reached = cut.loose == loose;
    return cut;
  }

  bool is_in_hole(Cell at) const {
    const int zone = area_.ground.zone(at.row, at.col);
    return zone >= 0 && area_.kinds[static_cast<std::size_t>(zone)] == ZoneKind::dig;
  }

 private:
  CellCut under_bucket(Cell cell, double fall, double loose) const {
    CellCut cut;
    const double cover = value_at(known_.cover, cell, 0.0);
    const double bank = value_at(known_.cut, cell, 0.0);
    if (!(cover > 0.0 && bank > 0.0)) return cut;
    cut.swept = cover;
    cut.bank = bank;
    cut.fallen = std::isnan(fall) ? fall : 0.0;
    if (cover < whole) return cut;
    cut.loose = loose;
    cut.reached = true;
    cut.fallen = loose + bank - fall;
    return cut;
  }

  const KnownGround& known_;
  const Area& area_;
};

}  // namespace

void state_earlier_soil(const std::vector<const HeightMap*>& before, const std::vector<Area>& areas,
                        VolumeChange& change) {
  const auto k = bulking_factor(change);
  if (!k || change.readings.empty()) return;
  double volume = 0.0;
  for (std::size_t i = 0; i < areas.size(); ++i) volume += loose_volume(*before[i], areas[i]);
  const double hole = change.before.value;
  if (volume < least_share * hole || volume > 0.5 * std::min(hole, change.after.value)) return;
  state(volume, k->value, bulking_errors(change).scans, change);
}

void require_known_ground(const KnownGround& known, const HeightMap& before) {
  for (const Eigen::ArrayXXd* layer : {&known.loose, &known.loose_sd, &known.guessed_sd,
                                       &known.swelling, &known.cut, &known.cover}) {
    const bool fits = layer->size() == 0 ||
                      (layer->rows() == before.z.rows() && layer->cols() == before.z.cols());
    if (!fits) {
      throw Error(ErrorKind::bad_input,
                  "known ground: a layer of " + std::to_string(layer->rows()) + " x " +
                      std::to_string(layer->cols()) + " cells, must be as large as the surfaces, " +
                      std::to_string(before.z.rows()) + " x " + std::to_string(before.z.cols()));
    }
  }
  if (known.cover.size() != known.cut.size()) {
    throw Error(ErrorKind::bad_input, "known ground: cut and cover must be told together");
  }
}

void find_loose_soil(const KnownGround& known, Area& area) {
  area.is_cut_told = known.cut.size() > 0;
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  for_each_cell(area.ground.zone, [&](Cell at) {
    const int zone = area.ground.zone(at.row, at.col);
    const double loose = value_at(known.loose, at, 0.0);
    if (zone < 0 || !(loose > 0.0)) return;
    ZoneSum& sum = area.zones[static_cast<std::size_t>(zone)];
    const double fall = -area.ground.difference(at.row, at.col);
    if (!(sum.volume < 0.0) || std::isnan(fall)) return;
    sum.loose += cell_area * taken_of(loose, fall, std::sqrt(area.variance(at.row, at.col)));
  });
}

void take_loose_soil(const KnownGround& known, const Area& area, VolumeChange& change) {
  const CutReader reader(known, area);
  const double cell_area = area.grid.cell_size * area.grid.cell_size;
  KnownCut cut;
  double beyond = 0.0;    // bank cut beyond what the hole's own sum holds
  double swelling = 0.0;  // of loose soil
  double variance = 0.0;
  double reached = 0.0;
  for_each_cell(area.ground.zone, [&](Cell at) {
    const CellCut one = reader.at(at);
    const bool is_seen = area.swept_unseen.size() == 0 || area.swept_unseen(at.row, at.col) == 0;
    if (one.swept > 0.0 && (std::isnan(one.fallen) || !is_seen)) cut.unseen_area += cell_area;
    cut.swept_area += cell_area * one.swept;
    if (std::isnan(one.fallen)) return;
    cut.loose.value += cell_area * one.loose;
    cut.fallen += cell_area * one.fallen;
    swelling += cell_area * one.loose * value_at(known.swelling, at, 0.0);
    const double fall = reader.is_in_hole(at) ? -area.ground.difference(at.row, at.col) : 0.0;
    if (one.bank != 0.0 || one.loose != 0.0) beyond += cell_area * (one.bank - fall);
    if (!one.reached || !(one.loose > 0.0)) return;
    reached += cell_area;
    variance += std::pow(cell_area * value_at(known.loose_sd, at, 0.0), 2);
  });
  cut.loose.sd = std::sqrt(variance + std::pow(reached * known.common_sd, 2));
  change.before.value += beyond;
  change.after.value += beyond - swelling;
  const double swollen = swelling_sd * std::max(0.0, cut.loose.value);
  change.errors.loose(2, 2) += swollen * swollen;
  const Eigen::Vector3d both(cut.loose.sd, 0.0, cut.loose.sd);
  change.errors.loose += both * both.transpose();
  change.cut = cut;
}

}  // namespace excavplan
