// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/simulation/dig_along.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/non_finite.hpp"
#include "base/plan_geometry.hpp"
#include "earth/ground_window.hpp"
#include "earth/slump.hpp"
#include "ground/grid_cells.hpp"
#include "ground/terrain.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::Vector2d;

constexpr double room_along = 1.5;   // of a path, for the pile ahead and soil that slides; ours [m]
constexpr double room_beside = 1.5;  // of the bucket, likewise [m]
constexpr double unchanged = 1e-12;  // less is no change of a layer [m]
constexpr int sweeps_of_a_heap = 2000;
constexpr double largest_heap = 1e6;  // ours [m^3]
constexpr int places_a_side = 3;
constexpr std::size_t most_places = 9;

/// Void ratio of a cell: of the terrain's layer, or where it has none.
double void_ratio(const ArrayXXd& layer, double otherwise, Cell cell) {
  return layer.size() == 0 ? otherwise : layer(cell.row, cell.col);
}

PlanFrame frame_of(const DigLine& line) { return {line.origin, line.heading}; }

// ---- the view -----------------------------------------------------------------------------------

/// The cells of a site in a cell of the view, some of them several times.
class Places {
 public:
  Places(const HeightMap& site, const DigLine& line, const HeightMap& view)
      : site_(site), line_(frame_of(line)), view_(view) {}

  void look(Cell cell) {
    count_ = 0;
    for (int i = 0; i < places_a_side; ++i) {
      for (int j = 0; j < places_a_side; ++j) {
        const Vector2d at =
            line_.place(view_.x(cell.col) + offset(i), view_.y(cell.row) + offset(j));
        const auto found = cell_at(site_, at.x(), at.y());
        if (found && !std::isnan(site_.z(found->row, found->col))) known_[count_++] = *found;
      }
    }
  }

  bool is_known() const { return 2 * count_ > known_.size(); }
  /// Within the values that it is the mean of, rounding included.
  double mean(const ArrayXXd& layer) const {
    double sum = 0.0;
    double least = layer(known_[0].row, known_[0].col);
    double most = least;
    for (std::size_t i = 0; i < count_; ++i) {
      const double value = layer(known_[i].row, known_[i].col);
      sum += value;
      least = std::min(least, value);
      most = std::max(most, value);
    }
    return std::clamp(sum / static_cast<double>(count_), least, most);
  }

 private:
  double offset(int i) const { return view_.cell_size * ((i + 0.5) / places_a_side - 0.5); }

  const HeightMap& site_;
  PlanFrame line_;
  const HeightMap& view_;
  std::array<Cell, most_places> known_{};
  std::size_t count_ = 0;
};

const Terrain& checked(const Terrain& site) {
  require_terrain(site, "ground along a line");
  return site;
}

Terrain seen_along(const Terrain& site, const DigLine& line, HeightMap view) {
  Terrain along;
  const auto like_view = [&](const ArrayXXd& layer) {
    return layer.size() == 0 ? ArrayXXd() : ArrayXXd(view.z);
  };
  along.loose = view.z;
  along.bank_void_ratio = like_view(site.bank_void_ratio);
  along.loose_void_ratio = like_view(site.loose_void_ratio);
  along.bank = std::move(view);
  Places places(site.bank, line, along.bank);
  for_each_cell(along.loose, [&](Cell cell) {
    places.look(cell);
    const bool known = places.is_known();
    along.bank.z(cell.row, cell.col) = known ? places.mean(site.bank.z) - line.z : nan;
    if (!known) return;
    along.loose(cell.row, cell.col) = places.mean(site.loose);
    if (along.bank_void_ratio.size() > 0) {
      along.bank_void_ratio(cell.row, cell.col) = places.mean(site.bank_void_ratio);
    }
    if (along.loose_void_ratio.size() > 0) {
      along.loose_void_ratio(cell.row, cell.col) = places.mean(site.loose_void_ratio);
    }
  });
  return along;
}

// ---- the dig ------------------------------------------------------------------------------------

/// Thicknesses of one cell of the site, and what a dig takes from it and lays on it. Solids are
/// thicknesses without voids.
struct SiteCell {
  double bank_taken = 0.0;     ///< [m]
  double loose_taken = 0.0;    ///< [m]
  double pressed_to = 1.0;     ///< thickness of what stays of the loose layer, over that before [-]
  double solids_gained = 0.0;  ///< [m]
};

/// Takes a dig from the cells of a view to those of the site below them.
class Entry {
 public:
  Entry(const Terrain& site, const DigLine& line, const Terrain& along, const SoilVoids& voids)
      : site_(site), frame_(frame_of(line)), z_(line.z), along_(along), voids_(voids) {}

  void run(DigResult& dig) {
    find_cells(dig.patch);
    for_each_cell(cells_, [&](Cell at) { collect(dig.patch, at); });
    const double payload = dig.payload_volume / (1.0 + voids_.loose);
    const double area = site_.bank.cell_size * site_.bank.cell_size;
    const double arrived = payload + area * gained_;
    scale_ = arrived > 0.0 ? area * taken_ / arrived : 0.0;
    scale(dig);
    dig.patch = entered();
    weigh(dig);
  }

 private:
  using Cells = Eigen::Array<SiteCell, Eigen::Dynamic, Eigen::Dynamic>;

  /// The block of the site's cells around what changed in the view.
  void find_cells(const TerrainPatch& patch) {
    const HeightMap& view = along_.bank;
    const double left = view.origin.x() + view.cell_size * static_cast<double>(patch.col);
    const double low = view.origin.y() + view.cell_size * static_cast<double>(patch.row);
    const double right = left + view.cell_size * static_cast<double>(patch.bank.cols());
    const double high = low + view.cell_size * static_cast<double>(patch.bank.rows());
    Vector2d least = frame_.place(left, low);
    Vector2d most = least;
    for (const Vector2d& corner :
         {frame_.place(left, high), frame_.place(right, low), frame_.place(right, high)}) {
      least = least.cwiseMin(corner);
      most = most.cwiseMax(corner);
    }
    const auto index = [&](double value, double origin, Index count) {
      const double cell = std::floor((value - origin) / site_.bank.cell_size);
      return static_cast<Index>(std::clamp(cell, 0.0, static_cast<double>(count - 1)));
    };
    const HeightMap& bank = site_.bank;
    first_ = {index(least.y(), bank.origin.y(), bank.z.rows()),
              index(least.x(), bank.origin.x(), bank.z.cols())};
    cells_ = Cells(index(most.y(), bank.origin.y(), bank.z.rows()) - first_.row + 1,
                   index(most.x(), bank.origin.x(), bank.z.cols()) - first_.col + 1);
  }

  Cell of_site(Cell at) const { return {first_.row + at.row, first_.col + at.col}; }

  /// The cell of the view over the centre of one of the site.
  std::optional<Cell> in_view(Cell site) const {
    const Vector2d place = frame_.of({site_.bank.x(site.col), site_.bank.y(site.row)});
    return cell_at(along_.bank, place.x(), place.y());
  }

  void collect(const TerrainPatch& patch, Cell at) {
    const Cell cell = of_site(at);
    const double bank = site_.bank.z(cell.row, cell.col);
    const auto view = in_view(cell);
    if (!view || std::isnan(bank)) return;
    const Cell held = {view->row - patch.row, view->col - patch.col};
    const bool inside = held.row >= 0 && held.col >= 0 && held.row < patch.bank.rows() &&
                        held.col < patch.bank.cols();
    if (!inside || std::isnan(patch.bank(held.row, held.col))) return;
    SiteCell& to = cells_(at.row, at.col);
    change(patch, *view, held, cell, to);
    taken_ += to.bank_taken / (1.0 + bank_voids(cell)) + to.loose_taken / (1.0 + loose_voids(cell));
    gained_ += to.solids_gained;
  }

  /// What happened to a cell of the view happens to one of the site.
  void change(const TerrainPatch& patch, Cell view, Cell held, Cell cell, SiteCell& to) const {
    const double loose_after = patch.loose(held.row, held.col);
    const double voids_after = void_ratio(patch.loose_void_ratio, voids_.loose, held);
    const double voids_before = void_ratio(along_.loose_void_ratio, voids_.loose, view);
    const double level = patch.bank(held.row, held.col) + z_;
    const double loose = site_.loose(cell.row, cell.col);
    const double solids_before = along_.loose(view.row, view.col) / (1.0 + voids_before);
    const double solids_after = loose_after / (1.0 + voids_after);
    const double bank = site_.bank.z(cell.row, cell.col);
    if (patch.bank(held.row, held.col) < along_.bank.z(view.row, view.col) - unchanged) {
      to.bank_taken = std::max(0.0, bank - level);
      to.loose_taken = loose - std::min(loose, std::max(0.0, level - bank));
      to.solids_gained = solids_after;
    } else if (solids_after < solids_before - unchanged) {
      to.loose_taken = loose - std::min(loose, std::max(0.0, level + loose_after - bank));
    } else if (solids_after > solids_before + unchanged) {
      to.solids_gained = solids_after - solids_before;
    } else {
      to.pressed_to = (1.0 + voids_after) / (1.0 + voids_before);
    }
  }

  double bank_voids(Cell cell) const {
    return void_ratio(site_.bank_void_ratio, voids_.bank, cell);
  }
  double loose_voids(Cell cell) const {
    return void_ratio(site_.loose_void_ratio, voids_.loose, cell);
  }

  void scale(DigResult& dig) const {
    SoilLedger& soil = dig.soil;
    for (double* share : {&dig.payload_mass, &dig.payload_volume, &soil.bank_cut, &soil.loose_cut,
                          &soil.payload, &soil.spilled, &soil.fallen_back}) {
      *share *= scale_;
    }
  }

  TerrainPatch entered() const {
    TerrainPatch patch;
    patch.row = first_.row;
    patch.col = first_.col;
    const auto block = [&](const ArrayXXd& layer) {
      return ArrayXXd(layer.block(first_.row, first_.col, cells_.rows(), cells_.cols()));
    };
    patch.bank = block(site_.bank.z);
    patch.loose = block(site_.loose);
    if (site_.loose_void_ratio.size() > 0) patch.loose_void_ratio = block(site_.loose_void_ratio);
    for_each_cell(cells_, [&](Cell at) {
      const SiteCell& cell = cells_(at.row, at.col);
      patch.bank(at.row, at.col) -= cell.bank_taken;
      const double voids = loose_voids(of_site(at));
      const double kept = patch.loose(at.row, at.col) - cell.loose_taken;
      const double solids = kept / (1.0 + voids);
      const double gained = scale_ * cell.solids_gained;
      const bool keeps_voids = patch.loose_void_ratio.size() > 0;
      double& loose = patch.loose(at.row, at.col);
      loose = kept * (keeps_voids ? cell.pressed_to : 1.0) + gained * (1.0 + voids_.loose);
      if (keeps_voids && solids + gained > 0.0) {
        patch.loose_void_ratio(at.row, at.col) =
            std::min(loose / (solids + gained) - 1.0, std::max(voids, voids_.loose));
      }
    });
    return patch;
  }

  /// Dry mass of the patch above its lowest point, before and after with what is in the bucket.
  void weigh(DigResult& dig) const {
    const double lowest = dig.patch.bank.isNaN()
                              .select(std::numeric_limits<double>::infinity(), dig.patch.bank)
                              .minCoeff();
    const double area = site_.bank.cell_size * site_.bank.cell_size;
    double before = 0.0;
    double after = 0.0;
    for_each_cell(cells_, [&](Cell at) {
      const Cell cell = of_site(at);
      const double bank = site_.bank.z(cell.row, cell.col);
      if (std::isnan(bank)) return;
      const double voids = 1.0 + bank_voids(cell);
      before +=
          (bank - lowest) / voids + site_.loose(cell.row, cell.col) / (1.0 + loose_voids(cell));
      after += (dig.patch.bank(at.row, at.col) - lowest) / voids +
               dig.patch.loose(at.row, at.col) /
                   (1.0 + void_ratio(dig.patch.loose_void_ratio, voids_.loose, at));
    });
    const double grains = voids_.grain_density;
    dig.soil.solids_before = grains * area * before;
    dig.soil.solids_after = grains * (area * after + dig.payload_volume / (1.0 + voids_.loose));
  }

  const Terrain& site_;
  PlanFrame frame_;
  double z_;  ///< of the path's z = 0 [m]
  const Terrain& along_;
  const SoilVoids& voids_;
  Cell first_{};
  Cells cells_;
  double taken_ = 0.0;   ///< solids, a thickness summed over cells [m]
  double gained_ = 0.0;  ///< likewise
  double scale_ = 1.0;   ///< of payload and of soil that came to lie
};

}  // namespace

Vector2d DigLine::place(double x, double y) const { return frame_of(*this).place(x, y); }

DigLine dig_line(const BasePose& base, double swung, double lane) {
  DigLine line;
  line.heading = base.heading + swung;
  line.origin = {base.x, base.y};
  line.origin = line.place(0.0, lane);
  line.z = base.z;
  return line;
}

SoilVoids soil_voids(const SoilKind& soil, double density_percent) {
  return {bank_state(soil, density_percent).void_ratio, soil.void_ratio_loose,
          soil.specific_gravity * water_density};
}

GroundAlong::GroundAlong(const Terrain& site, DigLine line, const Rectangle& extent,
                         double cell_size)
    : line_(std::move(line)),
      along_(seen_along(checked(site), line_, flat_ground(extent, cell_size))) {}

void GroundAlong::enter(const Terrain& site, const SoilVoids& voids, DigResult& dig) const {
  require_terrain(site, "ground along a line");
  require(dig.patch.bank.size() > 0, "ground along a line: the dig has no patch");
  require_patch(dig.patch, along_);
  Entry(site, line_, along_, voids).run(dig);
}

Rectangle extent_along(const Machine& machine, const DigPath& path) {
  if (path.poses.empty()) refuse("ground along a line: the path has no pose");
  Rectangle extent = swept_strip(machine, path);
  extent.x_min -= room_along;
  extent.x_max += room_along;
  extent.y_min -= room_beside;
  extent.y_max += room_beside;
  return extent;
}

DigResult dig_along(const SoilSimulator& simulator, const Machine& machine, const Terrain& site,
                    const LineDig& dig, const DigOptions& options) {
  const double cell = site.bank.cell_size;
  const Rectangle extent = extent_along(machine, dig.path);
  const auto down = [&](double value) { return cell * std::floor(value / cell); };
  const Rectangle on_lines = {down(extent.x_min), down(extent.y_min), extent.x_max, extent.y_max};
  const GroundAlong along(site, dig.line, on_lines, cell);
  DigResult result = simulator.dig(along.terrain(), dig.path, options);
  along.enter(site, dig.voids, result);
  return result;
}

void heap_soil(Terrain& site, const SoilKind& soil, double density_percent, const Vector2d& place,
               double volume) {
  require_terrain(site, "heap of soil");
  require_in("volume of a heap [m^3]", volume, 0.0, largest_heap);
  const SoilState bank = bank_state(soil, density_percent);
  const SoilState loose = loose_state(soil);
  const auto at = cell_at(site.bank, place.x(), place.y());
  const Cell axis = at.value_or(Cell{0, 0});  // pour() refuses the place
  GroundWindow window(site, {soil, bank, loose}, {axis.row, axis.row + 1, axis.col, axis.col + 1});
  const double repose = std::tan(soil.angle_of_repose);
  pour(window, place, volume, repose);
  slump(window, window.cells(), {repose, false}, sweeps_of_a_heap);
  apply(window.patch(), site);
}

}  // namespace excavplan
