// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/zone_parts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/non_finite.hpp"
#include "base/statistics.hpp"
#include "change/zone_shape.hpp"
#include "ground/grid_cells.hpp"
#include "ground/noise_model.hpp"
#include "ground/slopes.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

// Ours, by what digs, tracks and heaps look like.
constexpr double core_share = 0.3;       // of a zone's own height, above which it is no edge [-]
constexpr double gentlest_edge = 0.27;   // slope of 15 degrees, below that of any dug or loose soil
constexpr double edge_margin = 0.05;     // that a zone was widened by [m]
constexpr double least_tail_area = 0.1;  // [m^2]
constexpr double like_tail_low = 0.3;    // of a tail's height, between which the edge is the tail's
constexpr double like_tail_high = 1.5;
constexpr double highest_churn = 0.10;         // change of a cell of stirred ground [m]
constexpr double highest_churned_zone = 0.04;  // mean height of a zone of it [m]
constexpr double churn_window = 0.6;           // half width of what is looked at together [m]
constexpr double least_churn = 0.005;          // rms of stirred ground [m]
constexpr double churn_to_noise = 3.0;         // likewise, over the quietest tenth of the ground
constexpr double largest_lean = 0.6;           // of its mean to its rms: else it rose or fell
constexpr double least_both_ways = 0.07;       // of its squares, in what rose and in what fell
constexpr double least_known_window = 0.3;     // share of the cells of a window
constexpr double least_churned_area = 3.0;     // [m^2]
constexpr double churn_height = 2.2;           // of its rms, up to which a zone is part of it
constexpr double churn_share = 0.6;            // of the cells of such a zone that lie in it
constexpr double track_room = 0.3;             // around tracks, which are not stirred ground [m]
constexpr double least_exposure = 0.05;        // of the ground around a zone

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

/// Means over the known cells of a square around each cell.
struct Windows {
  Eigen::ArrayXXd mean;
  Eigen::ArrayXXd square;
  Eigen::ArrayXXd raised;  ///< the part of `square` that is above 0
  Eigen::ArrayXXd share;   ///< of the window that is known
};

Windows windows_of(const Eigen::ArrayXXd& field, Eigen::Index half) {
  const Eigen::ArrayXXd known = 1.0 - field.isNaN().cast<double>();
  const Eigen::ArrayXXd filled = field.isNaN().select(0.0, field);
  const AreaSums counts(known);
  const AreaSums sums(filled);
  const AreaSums squares(filled.square());
  const AreaSums raised(filled.max(0.0).square());
  Windows windows{filled, filled, filled, known};
  const double whole = std::pow(2.0 * static_cast<double>(half) + 1.0, 2);
  for_each_cell(field, [&](Cell at) {
    const double known_here = counts.around(at, half);
    const double count = std::max(known_here, 1.0);
    windows.mean(at.row, at.col) = sums.around(at, half) / count;
    windows.square(at.row, at.col) = squares.around(at, half) / count;
    windows.raised(at.row, at.col) = raised.around(at, half) / count;
    windows.share(at.row, at.col) = known_here / whole;
  });
  return windows;
}

class Parter {
 public:
  Parter(ChangedGround& ground, double cell_size) : ground_(ground), cell_size_(cell_size) {
    parts_.part.assign(ground.zone_is_cut.size(), Part::whole);
    parts_.parent.assign(ground.zone_is_cut.size(), -1);
  }

  ZoneParts find() {
    const std::vector<std::vector<Cell>> zones = cells_of(ground_);
    const std::vector<bool> was_cut = ground_.zone_is_cut;
    for (std::size_t i = 0; i < zones.size(); ++i) cut_tails(static_cast<int>(i), zones[i]);
    find_cut_parts(was_cut);
    parts_.stirred.assign(parts_.part.size(), 0.0);
    find_churn();
    return std::move(parts_);
  }

 private:
  double reach_of(double height) const {
    return core_share * height / gentlest_edge + edge_margin + 2.0 * cell_size_;
  }

  /// The cells of a zone that are no edge.
  Mask core_of(const std::vector<Cell>& cells, double height) const {
    Mask core = Mask::Constant(ground_.zone.rows(), ground_.zone.cols(), false);
    for (const Cell at : cells) {
      core(at.row, at.col) = std::abs(ground_.difference(at.row, at.col)) > core_share * height;
    }
    return core;
  }

  void cut_tails(int index, const std::vector<Cell>& cells) {
    const double height = height_of(ground_, cells);
    const double reach = reach_of(height) / cell_size_;
    const Eigen::ArrayXXd away = distance_to(core_of(cells, height));
    Eigen::ArrayXXi label = Eigen::ArrayXXi::Constant(away.rows(), away.cols(), -2);
    for (const Cell at : cells) label(at.row, at.col) = away(at.row, at.col) > reach ? -1 : -3;
    for (const Cell seed : cells) {
      if (label(seed.row, seed.col) != -1) continue;
      const auto tail = mark_connected(label, seed, 0, [](Cell) { return true; });
      if (is_tail(tail)) add_tail(index, tail, label, reach);
    }
  }

  /// Of a zone that the edge of the survey cuts, the parts that lie at that edge.
  void find_cut_parts(const std::vector<bool>& was_cut) {
    constexpr double rim = 3.0;  // cells that a zone ends before the edge, at most
    const Mask outside = ground_.difference.isNaN();
    const Eigen::ArrayXXd away = distance_to(outside);
    std::vector<bool> at_edge(parts_.part.size(), false);
    const Eigen::Index rows = outside.rows();
    const Eigen::Index cols = outside.cols();
    for_each_cell(ground_.zone, [&](Cell at) {
      const int zone = ground_.zone(at.row, at.col);
      if (zone < 0) return;
      const auto from_border =
          static_cast<double>(std::min({at.row, at.col, rows - 1 - at.row, cols - 1 - at.col}) + 1);
      if (std::min(away(at.row, at.col), from_border) <= rim) {
        at_edge[static_cast<std::size_t>(zone)] = true;
      }
    });
    for (std::size_t i = 0; i < at_edge.size(); ++i) {
      const int parent = parts_.parent[i];
      const bool is_cut = was_cut[parent < 0 ? i : static_cast<std::size_t>(parent)];
      ground_.zone_is_cut[i] = is_cut && at_edge[i];
    }
  }

  bool is_tail(const std::vector<Cell>& cells) const {
    const double area = static_cast<double>(cells.size()) * cell_size_ * cell_size_;
    return area >= least_tail_area && height_of(ground_, cells) > ground_.noise_sd;
  }

  /// A tail reaches through the zone's edge up to where the zone is higher than it.
  void add_tail(int index, std::vector<Cell> cells, Eigen::ArrayXXi& label, double reach) {
    std::vector<double> heights;
    heights.reserve(cells.size());
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
    for (const Cell at : cells) ground_.zone(at.row, at.col) = tail;
    ground_.zone_is_cut.push_back(false);
    ground_.zone_is_layer.push_back(false);
    parts_.part.push_back(Part::tail);
    parts_.parent.push_back(index);
  }

  // ---- Stirred ground -------------------------------------------------------------------------

  void find_churn() {
    const std::vector<std::vector<Cell>> zones = cells_of(ground_);
    const Mask stirred = stirred_ground(zones);
    if (!stirred.any()) return;
    const Eigen::ArrayXXd field = stirred.select(
        low_change(), Eigen::ArrayXXd::Constant(stirred.rows(), stirred.cols(), nan));
    const NoiseModel noise = find_noise(field, cell_size_);
    const double rms = std::sqrt(noise.white + noise.correlated);
    const int churn = static_cast<int>(zones.size());
    ground_.zone_is_cut.push_back(false);
    ground_.zone_is_layer.push_back(false);
    parts_.part.push_back(Part::churn);
    parts_.parent.push_back(-1);
    parts_.stirred.push_back(0.0);
    std::vector<std::size_t> rest;
    for (std::size_t i = 0; i < zones.size(); ++i) {
      if (zones[i].empty()) continue;
      if (is_churn(zones[i], stirred, rms)) {
        for (const Cell at : zones[i]) ground_.zone(at.row, at.col) = churn;
      } else {
        rest.push_back(i);
      }
    }
    const double per_area = noise.white * cell_size_ * cell_size_ + noise.integral();
    for (const std::size_t i : rest) take_in(static_cast<int>(i), zones[i], stirred, per_area);
  }

  Eigen::ArrayXXd low_change() const {
    return (ground_.difference.abs() < highest_churn).select(ground_.difference, nan);
  }

  /// Zones that are too high to be stirred ground, with their edges.
  Mask high_ground(const std::vector<std::vector<Cell>>& zones) const {
    Mask high = Mask::Constant(ground_.zone.rows(), ground_.zone.cols(), false);
    for (const std::vector<Cell>& cells : zones) {
      const double height = height_of(ground_, cells);
      if (height < highest_churned_zone) continue;
      const Eigen::ArrayXXd away = distance_to(core_of(cells, height));
      high = high || away * cell_size_ <= reach_of(height);
    }
    return high;
  }

  /// Ground whose change has a large rms and a small mean, away from tracks. Beside high zones,
  /// whose own edges hide it, it is taken to go on.
  Mask stirred_ground(const std::vector<std::vector<Cell>>& zones) const {
    Mask tracks = Mask::Constant(ground_.zone.rows(), ground_.zone.cols(), false);
    for (const std::vector<Cell>& cells : zones) {
      if (cells.empty() || !shape_of(ground_.difference, cells, cell_size_).is_track()) continue;
      for (const Cell at : cells) tracks(at.row, at.col) = true;
    }
    const Mask is_track = distance_to(tracks) * cell_size_ < track_room;
    const Mask high = high_ground(zones);
    Mask found = large_parts(churned_where(is_track || high));
    if (!found.any()) return found;
    const Mask beside = distance_to(found) * cell_size_ < 2.0 * churn_window;
    return (found || (high && beside)) && !is_track && !ground_.difference.isNaN();
  }

  Mask churned_where(const Mask& left_out) const {
    const auto half = static_cast<Eigen::Index>(std::ceil(churn_window / cell_size_));
    const Eigen::ArrayXXd field = left_out.select(
        Eigen::ArrayXXd::Constant(left_out.rows(), left_out.cols(), nan), low_change());
    const Windows windows = windows_of(field, half);
    const Mask is_known = windows.share > least_known_window;
    std::vector<double> squares;
    for_each_cell(left_out, [&](Cell at) {
      if (is_known(at.row, at.col)) squares.push_back(windows.square(at.row, at.col));
    });
    if (squares.empty()) return Mask::Constant(left_out.rows(), left_out.cols(), false);
    const double least =
        std::max(churn_to_noise * std::sqrt(upper_quantile(squares, 0.1)), least_churn);
    return is_known && !left_out && windows.square > least * least &&
           windows.mean.square() < largest_lean * largest_lean * windows.square &&
           windows.raised.min(windows.square - windows.raised) > least_both_ways * windows.square;
  }

  /// The connected parts of at least the area of stirred ground.
  Mask large_parts(const Mask& found) const {
    Eigen::ArrayXXi label = found.select(Eigen::ArrayXXi::Constant(found.rows(), found.cols(), -1),
                                         Eigen::ArrayXXi::Zero(found.rows(), found.cols()));
    Mask large = Mask::Constant(found.rows(), found.cols(), false);
    for_each_cell(found, [&](Cell seed) {
      if (label(seed.row, seed.col) != -1) return;
      const auto cells = mark_connected(label, seed, 0, [](Cell) { return true; });
      if (static_cast<double>(cells.size()) * cell_size_ * cell_size_ < least_churned_area) return;
      for (const Cell at : cells) large(at.row, at.col) = true;
    });
    return large;
  }

  bool is_churn(const std::vector<Cell>& cells, const Mask& stirred, double rms) const {
    double inside = 0.0;
    for (const Cell at : cells) inside += stirred(at.row, at.col) ? 1.0 : 0.0;
    return inside > churn_share * static_cast<double>(cells.size()) &&
           height_of(ground_, cells) < churn_height * rms;
  }

  /// A zone in stirred ground ends where its own edge does, takes in all that lies within that
  /// reach, and has the variance of the ground around it.
  void take_in(int index, const std::vector<Cell>& cells, const Mask& stirred, double per_area) {
    const double height = height_of(ground_, cells);
    const Eigen::ArrayXXd away = distance_to(core_of(cells, height));
    const double reach = reach_of(height) / cell_size_;
    double around = 0.0;
    double exposed = 0.0;
    for_each_cell(ground_.zone, [&](Cell at) {
      if (away(at.row, at.col) > 2.0 * reach || away(at.row, at.col) < reach) return;
      around += 1.0;
      exposed += stirred(at.row, at.col) ? 1.0 : 0.0;
    });
    if (!(exposed > least_exposure * around)) return;
    parts_.stirred[static_cast<std::size_t>(index)] = per_area * exposed / around;
    const int churn = static_cast<int>(parts_.part.size()) - 1;
    for_each_cell(ground_.zone, [&](Cell at) {
      int& zone = ground_.zone(at.row, at.col);
      if (!stirred(at.row, at.col)) return;
      const bool is_near = away(at.row, at.col) <= reach;
      if (is_near && (zone < 0 || zone == churn)) zone = index;
      if (!is_near && zone == index) zone = churn;
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

std::vector<std::vector<Cell>> cells_of(const ChangedGround& ground) {
  std::vector<std::vector<Cell>> cells(ground.zone_is_cut.size());
  for_each_cell(ground.zone, [&](Cell at) {
    const int index = ground.zone(at.row, at.col);
    if (index >= 0) cells[static_cast<std::size_t>(index)].push_back(at);
  });
  return cells;
}

}  // namespace excavplan
