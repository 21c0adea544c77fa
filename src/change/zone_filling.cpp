// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/zone_filling.hpp"

#include <cmath>
#include <utility>

#include "ground/hole_filling.hpp"

namespace excavplan {
namespace {

/// The holes of one field that reach into zones.
class ZoneHoles {
 public:
  ZoneHoles(const Eigen::ArrayXXd& z, const ChangedGround& ground)
      : ground_(ground), holes_(find_holes(z).cells) {}

  template <typename Visit>
  void for_each(Visit visit) const {
    const std::size_t zones = ground_.zone_is_cut.size();
    for (const std::vector<Cell>& hole : holes_) {
      std::vector<std::vector<Cell>> in_zone(zones);
      bool touches = false;
      for (const Cell cell : hole) {
        const int zone = ground_.zone(cell.row, cell.col);
        if (zone < 0) continue;
        in_zone[static_cast<std::size_t>(zone)].push_back(cell);
        touches = true;
      }
      if (touches) visit(hole, in_zone);
    }
  }

 private:
  const ChangedGround& ground_;
  std::vector<std::vector<Cell>> holes_;
};

class Filler {
 public:
  Filler(Eigen::ArrayXXd before, Eigen::ArrayXXd after, const ChangedGround& ground)
      : before_(std::move(before)), after_(std::move(after)), ground_(ground) {
    const std::size_t zones = ground.zone_is_cut.size();
    filling_.variance.assign(zones, 0.0);
    zone_cells_.resize(zones);
    for_each_cell(before_, [&](Cell cell) {
      const int zone = ground_.zone(cell.row, cell.col);
      if (zone >= 0) zone_cells_[static_cast<std::size_t>(zone)].push_back(cell);
      if (zone < 0 && !std::isnan(before_(cell.row, cell.col))) stable_cells_.push_back(cell);
    });
  }

  ZoneFilling fill_all() {
    fill_own(before_, true);
    fill_own(after_, false);
    Eigen::ArrayXXd difference = after_ - before_;
    std::vector<Cell> unknown;
    ZoneHoles(difference, ground_)
        .for_each([&](const std::vector<Cell>& hole, const auto& in_zone) {
          unknown.insert(unknown.end(), hole.begin(), hole.end());
          add(errors(difference, hole, in_zone, false));
        });
    fill(difference, unknown, Filling::thin_plate);
    filling_.difference = difference - ground_.datum;
    return std::move(filling_);
  }

 private:
  std::vector<double> errors(const Eigen::ArrayXXd& z, const std::vector<Cell>& hole,
                             const std::vector<std::vector<Cell>>& in_zone, bool anywhere) const {
    std::vector<double> variance(in_zone.size(), 0.0);
    for (std::size_t zone = 0; zone < in_zone.size(); ++zone) {
      if (in_zone[zone].empty()) continue;
      const std::vector<Cell>& tried = anywhere ? stable_cells_ : zone_cells_[zone];
      variance[zone] = error_of_filling(z, hole, in_zone[zone], tried);
    }
    return variance;
  }

  static double sum(const std::vector<double>& values) {
    double total = 0.0;
    for (const double value : values) total += value;
    return total;
  }

  void add(const std::vector<double>& variance) {
    for (std::size_t i = 0; i < variance.size(); ++i) filling_.variance[i] += variance[i];
  }

  /// Fills the holes of one scan that are better filled there than in the difference.
  void fill_own(Eigen::ArrayXXd& z, bool is_before) {
    const Eigen::ArrayXXd difference = after_ - before_;
    std::vector<Cell> unknown;
    ZoneHoles(z, ground_).for_each([&](const std::vector<Cell>& hole, const auto& in_zone) {
      const std::vector<double> own = errors(z, hole, in_zone, is_before);
      if (sum(own) >= sum(errors(difference, hole, in_zone, false))) return;
      unknown.insert(unknown.end(), hole.begin(), hole.end());
      add(own);
    });
    fill(z, unknown, Filling::thin_plate);
  }

  Eigen::ArrayXXd before_;
  Eigen::ArrayXXd after_;
  const ChangedGround& ground_;
  std::vector<std::vector<Cell>> zone_cells_;
  std::vector<Cell> stable_cells_;
  ZoneFilling filling_;
};

}  // namespace

ZoneFilling fill_zones(Eigen::ArrayXXd before, Eigen::ArrayXXd after, const ChangedGround& ground) {
  return Filler(std::move(before), std::move(after), ground).fill_all();
}

}  // namespace excavplan
