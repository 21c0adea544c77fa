// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/change_zones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "base/non_finite.hpp"
#include "base/statistics.hpp"
#include "ground/grid_cells.hpp"
#include "ground/hole_filling.hpp"
#include "ground/noise_model.hpp"
#include "ground/window.hpp"

namespace excavplan {
namespace {

constexpr double clip = 4.0;                     // residuals beyond are not noise [sd]
constexpr std::size_t fewest_stable_cells = 25;  // ours: fewest for noise and datum
constexpr int most_rounds = 8;
constexpr std::size_t most_by_chance = 16;  // ours: unknown cells together in a sparse scan
constexpr int stable = -1;

/// Half the edge of the windows in which soil is looked for that is too thin for a 3 x 3 mean
/// [cells], and what of them it fills at least; ours.
constexpr std::array<Eigen::Index, 3> layer_windows = {2, 5, 10};
constexpr double least_layer_share = 0.5;
constexpr std::size_t most_means = 4000;  // ours: that tell their scatter
constexpr double highest_crumb = 0.03;    // ours: of one cell among stable ones [m]

/// The densest quarter of the values: finds stable ground even where most of it changed. Where two
/// quarters are equally dense, as on maps without noise, the one nearer to zero is taken.
Spread densest_quarter(std::vector<double> values) {
  constexpr double quarter_of_normal = 0.3186;  // sd: half of the values within 0.3186 sd
  std::sort(values.begin(), values.end());
  const std::size_t count = std::max<std::size_t>(values.size() / 4, 1);
  double narrowest = std::numeric_limits<double>::infinity();
  double middle = 0.0;
  for (std::size_t i = 0; i + count < values.size(); ++i) {
    const double width = values[i + count] - values[i];
    const double centre = 0.5 * (values[i + count] + values[i]);
    const bool equal = std::abs(width - narrowest) < 0.01 * least_noise;
    if (equal ? std::abs(centre) < std::abs(middle) : width < narrowest) {
      narrowest = std::min(width, narrowest);
      middle = centre;
    }
  }
  return {middle, 0.5 * narrowest / quarter_of_normal};
}

/// Mean of the known cells of each 3 x 3 block; `evidence` is the square root of the share known.
struct Smoothed {
  Eigen::ArrayXXd mean;
  Eigen::ArrayXXd evidence;
};

Smoothed smooth(const Eigen::ArrayXXd& z) {
  Smoothed smoothed;
  smoothed.mean = Eigen::ArrayXXd::Constant(z.rows(), z.cols(), nan);
  smoothed.evidence = Eigen::ArrayXXd::Zero(z.rows(), z.cols());
  for_each_cell(z, [&](Cell cell) {
    if (std::isnan(z(cell.row, cell.col))) return;
    double sum = 0.0;
    int count = 0;
    for_each_around(z, cell, 1, [&](Cell n) {
      if (std::isnan(z(n.row, n.col))) return;
      sum += z(n.row, n.col);
      ++count;
    });
    smoothed.mean(cell.row, cell.col) = sum / count;
    smoothed.evidence(cell.row, cell.col) = std::sqrt(count / 9.0);
  });
  return smoothed;
}

/// Gives every free cell the label of the nearest labelled cell within `radius` cells.
Eigen::ArrayXXi widened(const Eigen::ArrayXXi& label, double radius) {
  const auto reach = static_cast<Eigen::Index>(
      std::min(std::floor(radius), static_cast<double>(std::max(label.rows(), label.cols()))));
  const double radius_squared = radius * radius;
  Eigen::ArrayXXi wide = label;
  Eigen::ArrayXXd nearest = Eigen::ArrayXXd::Constant(label.rows(), label.cols(),
                                                      std::numeric_limits<double>::infinity());
  const auto stamp = [&](Cell from) {
    for_each_around(label, from, reach, [&](Cell at) {
      const Eigen::Index rows = at.row - from.row;
      const Eigen::Index cols = at.col - from.col;
      const auto away = static_cast<double>(rows * rows + cols * cols);
      double& least = nearest(at.row, at.col);
      if (label(at.row, at.col) >= 0 || away > radius_squared || away >= least) return;
      least = away;
      wide(at.row, at.col) = label(from.row, from.col);
    });
  };
  for_each_cell(label, [&](Cell cell) {
    if (label(cell.row, cell.col) < 0) return;
    bool edge = false;
    for_each_neighbour(label, cell, [&](Cell n) { edge = edge || label(n.row, n.col) < 0; });
    if (edge) stamp(cell);
  });
  return wide;
}

/// Finds the zones and the noise of the ground between them by iteration.
class ChangeFinder {
 public:
  ChangeFinder(Eigen::ArrayXXd difference, const Eigen::ArrayXXd& variance, double cell_size,
               const ChangeOptions& options)
      : cell_size_(cell_size), options_(options) {
    found_.difference = std::move(difference);
    holes_ = fill_holes(found_.difference);
    find_rim();
    smoothed_ = smooth(at_rim_.select(nan, found_.difference));
    weigh(variance);
  }

  ChangedGround find() {
    std::vector<double> changes = values(smoothed_.mean, [](Cell) { return true; });
    known_cells_ = changes.size();
    const Spread start = densest_quarter(std::move(changes));
    found_.datum = start.middle;
    smooth_sd_ = std::max(start.sd, least_noise);
    found_.noise_sd = 3.0 * smooth_sd_;  // a mean of nine; replaced where stable ground is left
    for (int round = 0; round < most_rounds; ++round) {
      const Eigen::ArrayXXi before = found_.zone;
      find_zones();
      if (before.size() > 0 && (before == found_.zone).all()) break;
      learn_from_stable_ground();
    }
    find_layers();
    found_.difference -= found_.datum;
    found_.smooth_sd = smooth_sd_;
    find_residual();
    return std::move(found_);
  }

 private:
  bool is_known(Cell cell) const {
    return holes_.index(cell.row, cell.col) < 0 && !at_rim_(cell.row, cell.col);
  }
  bool is_stable(Cell cell) const {
    return is_known(cell) && found_.zone(cell.row, cell.col) == stable;
  }

  /// Cells at the rim of the survey contain only points that errors moved outwards; under a sensor
  /// that points out and down these lie too low. They are used neither for the change nor for the
  /// noise.
  void find_rim() {
    at_rim_ = found_.difference.isNaN();
    for_each_cell(found_.difference, [&](Cell cell) {
      if (!std::isnan(found_.difference(cell.row, cell.col))) return;
      for_each_neighbour(found_.difference, cell, [&](Cell n) { at_rim_(n.row, n.col) = true; });
    });
  }

  /// Cells whose points scatter more than most have less weight.
  void weigh(const Eigen::ArrayXXd& variance) {
    std::vector<double> told =
        values(variance, [&](Cell cell) { return !std::isnan(variance(cell.row, cell.col)); });
    if (told.empty()) return;
    const double usual = median(told);
    scatter_ = variance.isNaN().select(0.0, (variance - usual).max(0.0) / 9.0);
  }

  template <typename Wanted>
  std::vector<double> values(const Eigen::ArrayXXd& field, Wanted wanted) const {
    std::vector<double> taken;
    for_each_cell(field, [&](Cell cell) {
      if (is_known(cell) && wanted(cell)) taken.push_back(field(cell.row, cell.col));
    });
    return taken;
  }

  /// Change of the block around a cell in standard deviations of stable ground.
  double significance(Cell cell) const {
    const double excess = scatter_.size() > 0 ? scatter_(cell.row, cell.col) : 0.0;
    return (smoothed_.mean(cell.row, cell.col) - found_.datum) *
           smoothed_.evidence(cell.row, cell.col) / std::sqrt(smooth_sd_ * smooth_sd_ + excess);
  }

  void find_zones() {
    constexpr int unvisited = -1;
    constexpr int too_small = -2;
    Eigen::ArrayXXi label =
        Eigen::ArrayXXi::Constant(smoothed_.mean.rows(), smoothed_.mean.cols(), unvisited);
    found_.zone_is_cut.clear();
    for_each_cell(label, [&](Cell seed) {
      if (label(seed.row, seed.col) != unvisited || !is_known(seed)) return;
      const double change = significance(seed);
      if (std::abs(change) < options_.detection) return;
      const double sign = change > 0.0 ? 1.0 : -1.0;
      const int index = static_cast<int>(found_.zone_is_cut.size());
      const std::vector<Cell> cells = mark_connected(label, seed, index, [&](Cell cell) {
        return significance(cell) * sign >= options_.growth && !in_shadow(cell);
      });
      if (static_cast<double>(cells.size()) * cell_size_ * cell_size_ < options_.min_zone_area) {
        for (const Cell cell : cells) label(cell.row, cell.col) = too_small;
      } else {
        found_.zone_is_cut.push_back(reaches_the_edge(cells));
      }
    });
    label = (label < 0).select(stable, label);
    take_in_shadows(label);
    found_.zone = found_.difference.isNaN().select(
        stable, widened(label, zone_margin(options_, cell_size_, smooth_sd_) / cell_size_));
  }

  /// In a hole too large to be a chance gap between points.
  bool in_shadow(Cell cell) const {
    const int hole = holes_.index(cell.row, cell.col);
    return hole >= 0 && holes_.cells[static_cast<std::size_t>(hole)].size() > most_by_chance;
  }

  /// A cell in a shadow belongs to the zone of the nearest cell that was seen, if its filling has
  /// changed: there is no evidence from farther away.
  void take_in_shadows(Eigen::ArrayXXi& label) const {
    constexpr int unvisited = -3;
    for (const std::vector<Cell>& hole : holes_.cells) {
      if (hole.size() <= most_by_chance) continue;
      for (const Cell cell : hole) label(cell.row, cell.col) = unvisited;
      std::vector<Cell> front = rim_of(hole);
      for (std::size_t next = 0; next < front.size(); ++next) {
        const int nearest = label(front[next].row, front[next].col);
        for_each_neighbour(label, front[next], [&](Cell n) {
          if (label(n.row, n.col) != unvisited) return;
          label(n.row, n.col) = nearest;
          front.push_back(n);
        });
      }
      for (const Cell cell : hole) {
        if (std::abs(significance(cell)) < options_.growth) label(cell.row, cell.col) = stable;
      }
    }
  }

  /// The known cells around a hole, each once.
  std::vector<Cell> rim_of(const std::vector<Cell>& hole) const {
    std::vector<Cell> rim;
    for (const Cell cell : hole) {
      for_each_neighbour(holes_.index, cell, [&](Cell n) {
        if (holes_.index(n.row, n.col) < 0) rim.push_back(n);
      });
    }
    const auto place = [](Cell c) { return std::pair(c.col, c.row); };
    std::sort(rim.begin(), rim.end(), [&](Cell a, Cell b) { return place(a) < place(b); });
    rim.erase(
        std::unique(rim.begin(), rim.end(), [&](Cell a, Cell b) { return place(a) == place(b); }),
        rim.end());
    return rim;
  }

  bool reaches_the_edge(const std::vector<Cell>& cells) const {
    return std::any_of(cells.begin(), cells.end(), [&](Cell cell) {
      bool edge = on_border(found_.difference, cell);
      for_each_neighbour(at_rim_, cell, [&](Cell n) { edge = edge || at_rim_(n.row, n.col); });
      return edge;
    });
  }

  void learn_from_stable_ground() {
    const auto on_stable = [&](Cell cell) { return is_stable(cell); };
    const std::vector<double> changes = values(found_.difference, on_stable);
    found_.stable_share = static_cast<double>(changes.size()) / static_cast<double>(known_cells_);
    if (changes.size() < fewest_stable_cells) return;
    const Spread spread = robust_spread(changes);
    found_.noise_sd = std::max(spread.sd, least_noise);
    found_.datum = clipped_mean(changes, spread.middle);
    std::vector<double> weighted;
    for_each_cell(found_.zone, [&](Cell cell) {
      if (is_stable(cell)) weighted.push_back(significance(cell) * smooth_sd_);
    });
    smooth_sd_ = std::max(robust_spread(std::move(weighted)).sd, least_noise);
  }

  /// Soil strewn so thin that only the mean of a larger window tells it from noise: crumbs, layers,
  /// what wheels carry. What was taken as soil raises the mean of the ground that it was learned
  /// from, so that the search is repeated.
  void find_layers() {
    const Eigen::ArrayXXi thick = found_.zone;
    const std::size_t thick_zones = found_.zone_is_cut.size();
    for (int round = 0; round < most_rounds; ++round) {
      Mask layers = Mask::Constant(thick.rows(), thick.cols(), false);
      for (const Eigen::Index radius : layer_windows) add_layers(thick, radius, layers);
      const Eigen::ArrayXXi before = std::exchange(found_.zone, thick);
      found_.zone_is_cut.resize(thick_zones);
      label_layers(layers);
      if ((before == found_.zone).all()) break;
      learn_from_stable_ground();
    }
    found_.zone_is_layer.assign(thick_zones, false);
    found_.zone_is_layer.resize(found_.zone_is_cut.size(), true);
  }

  /// Sums of the change over windows, outliers clipped, and how many cells each has.
  struct WindowSums {
    AreaSums change;
    AreaSums count;
    double known(Cell at, Eigen::Index radius) const { return count.around(at, radius); }
    double mean(Cell at, Eigen::Index radius) const {
      return change.around(at, radius) / known(at, radius);
    }
  };

  template <typename Wanted>
  WindowSums window_sums(Wanted wanted) const {
    const double bound = std::max(clip * found_.noise_sd, highest_crumb);
    Eigen::ArrayXXd change = Eigen::ArrayXXd::Zero(found_.zone.rows(), found_.zone.cols());
    Eigen::ArrayXXd count = change;
    for_each_cell(change, [&](Cell cell) {
      if (!wanted(cell)) return;
      const double off = found_.difference(cell.row, cell.col) - found_.datum;
      change(cell.row, cell.col) = std::clamp(off, -bound, bound);
      count(cell.row, cell.col) = 1.0;
    });
    return {AreaSums(change), AreaSums(count)};
  }

  /// Marks ground beside the thick zones whose mean over a window rises above the scatter of such
  /// means on stable ground, correlated errors included.
  void add_layers(const Eigen::ArrayXXi& thick, Eigen::Index radius, Mask& layers) const {
    const auto is_open = [&](Cell cell) {
      return is_known(cell) && thick(cell.row, cell.col) == stable;
    };
    const auto cells = static_cast<double>((2 * radius + 1) * (2 * radius + 1));
    const Spread usual = scatter_of_means(radius);
    if (!(usual.sd > 0.0)) return;
    const WindowSums sums = window_sums(is_open);
    Eigen::ArrayXXd significance = Eigen::ArrayXXd::Constant(thick.rows(), thick.cols(), nan);
    for_each_cell(thick, [&](Cell cell) {
      if (!is_open(cell) || sums.known(cell, radius) < least_layer_share * cells) return;
      significance(cell.row, cell.col) = (sums.mean(cell, radius) - usual.middle) / usual.sd;
    });
    mark_layers(significance, cells, layers);
  }

  /// Of the means over windows of stable ground; 0 where there is too little.
  Spread scatter_of_means(Eigen::Index radius) const {
    const auto cells = static_cast<double>((2 * radius + 1) * (2 * radius + 1));
    const WindowSums sums = window_sums([&](Cell cell) { return is_stable(cell); });
    const std::size_t stride = 1 + known_cells_ / most_means;
    std::size_t seen = 0;
    std::vector<double> means;
    for_each_cell(found_.zone, [&](Cell cell) {
      if (!is_stable(cell) || sums.known(cell, radius) < least_layer_share * cells) return;
      if (seen++ % stride == 0) means.push_back(sums.mean(cell, radius));
    });
    if (means.size() < fewest_stable_cells) return {};
    Spread spread = robust_spread(std::move(means));
    spread.sd = std::max(spread.sd, found_.noise_sd / std::sqrt(cells));
    return spread;
  }

  void mark_layers(const Eigen::ArrayXXd& significance, double cells_of_window,
                   Mask& layers) const {
    constexpr int unvisited = -1;
    Eigen::ArrayXXi label =
        Eigen::ArrayXXi::Constant(significance.rows(), significance.cols(), unvisited);
    const double least =
        std::max(options_.min_zone_area, cells_of_window * cell_size_ * cell_size_);
    for_each_cell(label, [&](Cell seed) {
      if (label(seed.row, seed.col) != unvisited) return;
      if (!(significance(seed.row, seed.col) >= options_.detection)) return;
      const std::vector<Cell> cells = mark_connected(label, seed, 0, [&](Cell cell) {
        return significance(cell.row, cell.col) >= options_.growth;
      });
      if (static_cast<double>(cells.size()) * cell_size_ * cell_size_ < least) return;
      for (const Cell cell : cells) layers(cell.row, cell.col) = true;
    });
  }

  /// Makes zones of what hangs together.
  void label_layers(const Mask& layers) {
    for_each_cell(layers, [&](Cell seed) {
      if (!layers(seed.row, seed.col) || found_.zone(seed.row, seed.col) != stable) return;
      const int index = static_cast<int>(found_.zone_is_cut.size());
      const std::vector<Cell> cells = mark_connected(
          found_.zone, seed, index, [&](Cell cell) { return layers(cell.row, cell.col); });
      found_.zone_is_cut.push_back(reaches_the_edge(cells));
    });
  }

  double clipped_mean(const std::vector<double>& changes, double middle) const {
    double sum = 0.0;
    double count = 0.0;
    for (const double change : changes) {
      if (std::abs(change - middle) > clip * found_.noise_sd) continue;
      sum += change;
      count += 1.0;
    }
    return sum / count;
  }

  /// Differences of the stable ground, outliers clipped.
  void find_residual() {
    const double bound = clip * found_.noise_sd;
    found_.residual = found_.difference.max(-bound).min(bound);
    for_each_cell(found_.residual, [&](Cell cell) {
      if (!is_stable(cell)) found_.residual(cell.row, cell.col) = nan;
    });
  }

  double cell_size_;
  const ChangeOptions& options_;
  ChangedGround found_;
  Smoothed smoothed_;
  Mask at_rim_;  // of the survey
  Holes holes_;  // of the difference, filled by a membrane
  std::size_t known_cells_ = 0;
  Eigen::ArrayXXd scatter_;         // variance of a 3 x 3 mean by the scatter of the points [m^2]
  double smooth_sd_ = least_noise;  // of a 3 x 3 mean on stable ground [m]
};

}  // namespace

double zone_margin(const ChangeOptions& options, double cell_size, double smooth_sd) {
  constexpr double gentlest = 0.5;  // ours
  return std::max({options.margin, cell_size, options.growth * smooth_sd / gentlest});
}

ChangedGround find_change(Eigen::ArrayXXd difference, const Eigen::ArrayXXd& variance,
                          double cell_size, const ChangeOptions& options) {
  return ChangeFinder(std::move(difference), variance, cell_size, options).find();
}

std::vector<bool> zones_near(const Eigen::ArrayXXi& zone, const std::vector<bool>& chosen,
                             double distance_cells) {
  std::vector<bool> near = chosen;
  Eigen::ArrayXXi source = zone;
  for_each_cell(zone, [&](Cell cell) {
    const int index = zone(cell.row, cell.col);
    source(cell.row, cell.col) = index >= 0 && chosen[static_cast<std::size_t>(index)] ? 0 : stable;
  });
  const Eigen::ArrayXXi reached = widened(source, distance_cells);
  for_each_cell(zone, [&](Cell cell) {
    const int index = zone(cell.row, cell.col);
    if (index >= 0 && reached(cell.row, cell.col) == 0)
      near[static_cast<std::size_t>(index)] = true;
  });
  return near;
}

}  // namespace excavplan
