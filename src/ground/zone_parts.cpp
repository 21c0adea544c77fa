// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/zone_parts.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ground/error_field.hpp"
#include "ground/grid_cells.hpp"
#include "ground/robust.hpp"

namespace excavplan {
namespace {

using Mask = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

// Ours, by what digs, tracks and heaps look like.
constexpr double core_share = 0.3;       // of a zone's own height, above which it is no edge [-]
constexpr double gentlest_edge = 0.27;   // slope of 15 degrees, below that of any dug or loose soil
constexpr double edge_margin = 0.05;     // that a zone was widened by [m]
constexpr double least_tail_area = 0.1;  // [m^2]
constexpr double like_tail_low = 0.3;    // of a tail's height, between which the edge is the tail's
constexpr double like_tail_high = 1.5;
constexpr double highest_churn = 0.10;  // of a stirred zone [m]
constexpr double widest_churn = 1.5;    // [m^2]
constexpr int fewest_churned = 8;       // zones of both signs
constexpr double least_balance = 0.25;  // of the smaller sign's volume to the larger's
constexpr double churn_reach = 0.3;     // ground this near to a stirred zone is stirred [m]
constexpr double least_exposure = 0.1;  // of the ground around a zone

/// Cells of each zone.
std::vector<std::vector<Cell>> cells_of(const ChangedGround& ground) {
  std::vector<std::vector<Cell>> cells(ground.zone_is_cut.size());
  for_each_cell(ground.zone, [&](Cell at) {
    const int index = ground.zone(at.row, at.col);
    if (index >= 0) cells[static_cast<std::size_t>(index)].push_back(at);
  });
  return cells;
}

/// Height of a zone as its soil sees it: the mean of |D| weighted by |D|.
double height_of(const ChangedGround& ground, const std::vector<Cell>& cells) {
  double sum = 0.0;
  double squares = 0.0;
  for (const Cell at : cells) {
    const double d = std::abs(ground.difference(at.row, at.col));
    sum += d;
    squares += d * d;
  }
  return sum > 0.0 ? squares / sum : 0.0;
}

double volume_of(const ChangedGround& ground, const std::vector<Cell>& cells, double cell_size) {
  double sum = 0.0;
  for (const Cell at : cells) sum += ground.difference(at.row, at.col);
  return sum * cell_size * cell_size;
}

class Parter {
 public:
  Parter(ChangedGround& ground, double cell_size) : ground_(ground), cell_size_(cell_size) {
    parts_.part.assign(ground.zone_is_cut.size(), Part::whole);
    parts_.parent.assign(ground.zone_is_cut.size(), -1);
  }

  ZoneParts find() {
    const std::vector<std::vector<Cell>> zones = cells_of(ground_);
    for (std::size_t i = 0; i < zones.size(); ++i) cut_tails(static_cast<int>(i), zones[i]);
    parts_.stirred.assign(parts_.part.size(), 0.0);
    find_churn();
    return std::move(parts_);
  }

 private:
  double reach_of(double height) const {
    return core_share * height / gentlest_edge + edge_margin + 2.0 * cell_size_;
  }

  void cut_tails(int index, const std::vector<Cell>& cells) {
    const double height = height_of(ground_, cells);
    Mask core = Mask::Constant(ground_.zone.rows(), ground_.zone.cols(), false);
    for (const Cell at : cells) {
      core(at.row, at.col) = std::abs(ground_.difference(at.row, at.col)) > core_share * height;
    }
    const double reach = reach_of(height) / cell_size_;
    const Eigen::ArrayXXd away = distance_to(core);
    Eigen::ArrayXXi label = Eigen::ArrayXXi::Constant(core.rows(), core.cols(), -2);
    for (const Cell at : cells) label(at.row, at.col) = away(at.row, at.col) > reach ? -1 : -3;
    for (const Cell seed : cells) {
      if (label(seed.row, seed.col) != -1) continue;
      const auto tail = mark_connected(label, seed, 0, [](Cell) { return true; });
      if (is_tail(tail)) add_tail(index, tail, label, reach);
    }
  }

  bool is_tail(const std::vector<Cell>& cells) const {
    const double area = static_cast<double>(cells.size()) * cell_size_ * cell_size_;
    return area >= least_tail_area && height_of(ground_, cells) > 2.0 * ground_.noise_sd;
  }

  /// A tail reaches through the zone's edge up to where the zone is higher than it.
  void add_tail(int index, std::vector<Cell> cells, Eigen::ArrayXXi& label, double reach) {
    std::vector<double> heights;
    for (const Cell at : cells) heights.push_back(std::abs(ground_.difference(at.row, at.col)));
    const double usual = median(heights);
    Mask own = Mask::Constant(label.rows(), label.cols(), false);
    for (const Cell at : cells) own(at.row, at.col) = true;
    const Eigen::ArrayXXd away = distance_to(own);
    for (std::size_t next = 0; next < cells.size(); ++next) {
      for_each_neighbour(label, cells[next], [&](Cell n) {
        const double d = std::abs(ground_.difference(n.row, n.col));
        if (label(n.row, n.col) != -3 || away(n.row, n.col) > 1.5 * reach) return;
        if (d < like_tail_low * usual || d > like_tail_high * usual) return;
        label(n.row, n.col) = 0;
        cells.push_back(n);
      });
    }
    const int tail = static_cast<int>(parts_.part.size());
    bool is_cut = false;
    for (const Cell at : cells) {
      ground_.zone(at.row, at.col) = tail;
      is_cut = is_cut || on_border(ground_.zone, at);
    }
    const bool parent_is_cut = ground_.zone_is_cut[static_cast<std::size_t>(index)];
    ground_.zone_is_cut.push_back(parent_is_cut && is_cut);
    parts_.part.push_back(Part::tail);
    parts_.parent.push_back(index);
  }

  // ---- Stirred ground -------------------------------------------------------------------------

  void find_churn() {
    const std::vector<std::vector<Cell>> zones = cells_of(ground_);
    std::vector<std::size_t> low;
    double rise = 0.0;
    double fall = 0.0;
    int risen = 0;
    for (std::size_t i = 0; i < zones.size(); ++i) {
      if (!may_be_churn(zones[i])) continue;
      const double volume = volume_of(ground_, zones[i], cell_size_);
      (volume > 0.0 ? rise : fall) += std::abs(volume);
      risen += volume > 0.0 ? 1 : 0;
      low.push_back(i);
    }
    const int count = static_cast<int>(low.size());
    const bool both = std::min(risen, count - risen) >= fewest_churned / 4;
    if (count < fewest_churned || !both) return;
    if (std::min(rise, fall) < least_balance * std::max(rise, fall)) return;
    Mask churned = Mask::Constant(ground_.zone.rows(), ground_.zone.cols(), false);
    for (const std::size_t i : low) {
      parts_.part[i] = Part::churn;
      for (const Cell at : zones[i]) churned(at.row, at.col) = true;
    }
    spread_over_zones(zones, churned);
  }

  bool may_be_churn(const std::vector<Cell>& cells) const {
    const double area = static_cast<double>(cells.size()) * cell_size_ * cell_size_;
    return !cells.empty() && area < widest_churn && height_of(ground_, cells) < highest_churn;
  }

  /// Zones in stirred ground take it in, and get its variance.
  void spread_over_zones(const std::vector<std::vector<Cell>>& zones, const Mask& churned) {
    const Eigen::ArrayXXd to_churn = distance_to(churned);
    Eigen::ArrayXXd field = ground_.difference;
    for_each_cell(field, [&](Cell at) {
      const int zone = ground_.zone(at.row, at.col);
      const bool is_stirred =
          to_churn(at.row, at.col) * cell_size_ <= churn_reach &&
          (zone < 0 || parts_.part[static_cast<std::size_t>(zone)] == Part::churn);
      if (!is_stirred) field(at.row, at.col) = std::numeric_limits<double>::quiet_NaN();
    });
    const NoiseModel noise = find_noise(field, cell_size_);
    const double per_area = noise.white * cell_size_ * cell_size_ + noise.integral();
    for (std::size_t i = 0; i < zones.size(); ++i) {
      if (parts_.part[i] == Part::churn || zones[i].empty()) continue;
      take_in(static_cast<int>(i), zones[i], field, per_area);
    }
  }

  void take_in(int index, const std::vector<Cell>& cells, const Eigen::ArrayXXd& stirred,
               double per_area) {
    Mask core = Mask::Constant(ground_.zone.rows(), ground_.zone.cols(), false);
    const double height = height_of(ground_, cells);
    for (const Cell at : cells) {
      core(at.row, at.col) = std::abs(ground_.difference(at.row, at.col)) > core_share * height;
    }
    const Eigen::ArrayXXd away = distance_to(core);
    const double reach = reach_of(height) / cell_size_;
    double around = 0.0;
    double exposed = 0.0;
    for_each_cell(ground_.zone, [&](Cell at) {
      if (away(at.row, at.col) > 2.0 * reach || ground_.zone(at.row, at.col) == index) return;
      around += 1.0;
      exposed += std::isnan(stirred(at.row, at.col)) ? 0.0 : 1.0;
    });
    if (!(exposed > least_exposure * around)) return;
    parts_.stirred[static_cast<std::size_t>(index)] = per_area * exposed / around;
    for_each_cell(ground_.zone, [&](Cell at) {
      if (away(at.row, at.col) <= reach && !std::isnan(stirred(at.row, at.col))) {
        ground_.zone(at.row, at.col) = index;
      }
    });
  }

  ChangedGround& ground_;
  double cell_size_;
  ZoneParts parts_;
};

}  // namespace

ZoneParts part_zones(ChangedGround& ground, double cell_size) {
  return Parter(ground, cell_size).find();
}

Eigen::ArrayXXd distance_to(const Mask& marked) {
  constexpr double diagonal = 1.4142;
  const Eigen::Index rows = marked.rows();
  const Eigen::Index cols = marked.cols();
  Eigen::ArrayXXd away =
      marked.select(Eigen::ArrayXXd::Zero(rows, cols),
                    Eigen::ArrayXXd::Constant(rows, cols, std::numeric_limits<double>::infinity()));
  const auto relax = [&](Eigen::Index r, Eigen::Index c, Eigen::Index dr, Eigen::Index dc) {
    const Eigen::Index row = r + dr;
    const Eigen::Index col = c + dc;
    if (row < 0 || col < 0 || row >= rows || col >= cols) return;
    away(r, c) = std::min(away(r, c), away(row, col) + (dr != 0 && dc != 0 ? diagonal : 1.0));
  };
  for (Eigen::Index c = 0; c < cols; ++c) {
    for (Eigen::Index r = 0; r < rows; ++r) {
      relax(r, c, -1, -1), relax(r, c, 0, -1), relax(r, c, 1, -1), relax(r, c, -1, 0);
    }
  }
  for (Eigen::Index c = cols; c-- > 0;) {
    for (Eigen::Index r = rows; r-- > 0;) {
      relax(r, c, 1, 1), relax(r, c, 0, 1), relax(r, c, -1, 1), relax(r, c, 1, 0);
    }
  }
  return away;
}

}  // namespace excavplan
