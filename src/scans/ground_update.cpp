// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/scans/ground_update.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/check.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"
#include "scans/map_sampling.hpp"

namespace excavplan {
namespace {

constexpr double sure = 2.0;       // ours: deviations that make a cell of a changed zone one
constexpr double telling = 5.0;    // ours: where nothing says which cells changed
constexpr double least_sd = 1e-4;  // of a height [m]

enum Cause : int { nothing = 0, dig = 1, something = 2 };

void require_seen(const SeenGround& seen) {
  require_map(seen.surface, "ground that was seen");
  require(std::isfinite(seen.time), "ground that was seen: time", seen.time, "finite");
  require(seen.common_sd >= 0.0 && std::isfinite(seen.common_sd), "ground that was seen: common_sd",
          seen.common_sd, "at least 0 m and finite");
  const auto fits = [&](Eigen::Index rows, Eigen::Index cols) {
    return rows * cols == 0 || (rows == seen.surface.z.rows() && cols == seen.surface.z.cols());
  };
  require(fits(seen.deviation.rows(), seen.deviation.cols()) &&
              fits(seen.changed.rows(), seen.changed.cols()) &&
              fits(seen.swept.rows(), seen.swept.cols()) &&
              fits(seen.filled.rows(), seen.filled.cols()) &&
              fits(seen.obstacles.rows(), seen.obstacles.cols()),
          "ground that was seen: a layer has another size than its surface");
}

/// What a survey says, on the grid of the state.
struct Survey {
  Eigen::ArrayXXd height, deviation, swept, filled, obstacles, changed;
  double common_sd;
  bool is_told;  ///< which cells changed

  Survey(const GroundState& state, const SeenGround& seen)
      : common_sd(seen.common_sd), is_told(seen.changed.size() > 0) {
    const HeightMap& grid = state.terrain.bank;
    const auto on_grid = [&](const Eigen::ArrayXXd& layer) {
      if (layer.size() == 0) return layer;
      return layer_on(grid, seen.surface, layer);
    };
    height = on_grid(seen.surface.z);
    deviation = on_grid(seen.deviation);
    swept = on_grid(seen.swept);
    filled = on_grid(seen.filled);
    obstacles = on_grid(seen.obstacles);
    changed = Eigen::ArrayXXd::Zero(height.rows(), height.cols());
    if (!is_told) return;
    const Eigen::ArrayXXd causes = seen.changed.cast<double>();
    for_each_cell(changed, [&](Cell at) {
      const double cause = cell_value(seen.surface, causes, {grid.x(at.col), grid.y(at.row)});
      changed(at.row, at.col) = std::isnan(cause) ? 0.0 : cause;
    });
  }
};

double known_at(const Eigen::ArrayXXd& layer, Cell at, double without) {
  if (layer.size() == 0) return without;
  const double value = layer(at.row, at.col);
  return std::isnan(value) ? without : value;
}

/// Updates a state cell by cell.
class Updater {
 public:
  Updater(GroundState& state, const Survey& survey, std::optional<double> loose_void_ratio)
      : state_(state), survey_(survey), fresh_(loose_void_ratio) {}

  void update(Cell at, double time) {
    double& bank = state_.terrain.bank.z(at.row, at.col);
    double& loose = state_.terrain.loose(at.row, at.col);
    const double top = known_at(survey_.obstacles, at, std::nan(""));
    if (!std::isnan(top)) {
      state_.terrain.obstacles(at.row, at.col) = top;
      state_.seen(at.row, at.col) = time;
      return;
    }
    const double z = survey_.height(at.row, at.col);
    if (std::isnan(z)) {
      const double filled = known_at(survey_.filled, at, std::nan(""));
      if (swept_below(at)) leave_as_swept(at, bank, loose);
      if (!std::isnan(filled + bank)) leave_as_filled(at, filled, bank, loose);
      return;
    }
    if (state_.terrain.obstacles.size() > 0) {
      state_.terrain.obstacles(at.row, at.col) = std::nan("");
    }
    state_.seen(at.row, at.col) = time;
    double& deviation = state_.deviation(at.row, at.col);
    const double sd = sd_at(at);
    if (std::isnan(bank)) {
      bank = z;
      loose = 0.0;
      deviation = std::hypot(sd, survey_.common_sd);
      return;
    }
    const double known_sd = std::isnan(deviation) ? sd : deviation;
    const double change = z - bank - loose;
    int cause = cause_of(at, change, std::hypot(sd, known_sd));
    if (cause == nothing && is_guess(sd, known_sd)) cause = dig;
    if (cause == nothing) {
      const double weight = weight_of(sd, known_sd);
      bank += weight * change;
      deviation = averaged_sd(weight, known_sd);
      return;
    }
    settle(at, z, bank, loose);
    deviation = std::hypot(sd, survey_.common_sd);
    if (cause == something) deviation = std::max(deviation, reopened_sd);
  }

 private:
  double sd_at(Cell at) const {
    return std::max(least_sd, known_at(survey_.deviation, at, survey_.common_sd));
  }

  int cause_of(Cell at, double change, double sd) const {
    if (!survey_.is_told) return std::abs(change) > telling * sd ? something : nothing;
    const auto cause = static_cast<int>(survey_.changed(at.row, at.col));
    if (cause != something && swept_below(at)) return dig;
    return std::abs(change) > sure * sd ? cause : static_cast<int>(nothing);
  }

  /// What was filled there gives way to what is seen.
  static bool is_guess(double sd, double known_sd) {
    return known_sd > reopened_sd && known_sd > 2.0 * sd;
  }

  /// The bucket cut bank there, whatever lies in its place now.
  bool swept_below(Cell at) const {
    const double floor = known_at(survey_.swept, at, std::nan(""));
    return floor < state_.terrain.bank.z(at.row, at.col);
  }

  /// Nobody saw what lies there now.
  void leave_as_swept(Cell at, double& bank, double& loose) {
    bank = survey_.swept(at.row, at.col);
    loose = 0.0;
    double& deviation = state_.deviation(at.row, at.col);
    deviation = std::max(known_at(state_.deviation, at, 0.0), reopened_sd);
  }

  void leave_as_filled(Cell at, double filled, double& bank, double& loose) {
    const double change = filled - bank - loose;
    settle(at, filled, bank, loose);
    double& deviation = state_.deviation(at.row, at.col);
    deviation = std::max({known_at(state_.deviation, at, 0.0), filled_sd, 0.5 * std::abs(change)});
  }

  /// Variance of what was known, without what the heights of a survey share.
  double own_variance(double known_sd) const {
    return std::max(known_sd * known_sd - survey_.common_sd * survey_.common_sd,
                    least_sd * least_sd);
  }
  /// Of what was seen in the mean of least variance.
  double weight_of(double sd, double known_sd) const {
    const double before = own_variance(known_sd);
    return before / (before + sd * sd);
  }
  double averaged_sd(double weight, double known_sd) const {
    return std::sqrt((1.0 - weight) * own_variance(known_sd) +
                     survey_.common_sd * survey_.common_sd);
  }

  void settle(Cell at, double z, double& bank, double& loose) {
    const double kept = loose;
    const double floor = known_at(survey_.swept, at, bank);
    bank = std::min({bank, floor, z});
    loose = z - bank;
    mix_void_ratio(at, kept, loose);
  }

  /// Of what lay there, as far as it is still there, and of what came.
  void mix_void_ratio(Cell at, double kept, double loose) {
    Eigen::ArrayXXd& ratios = state_.terrain.loose_void_ratio;
    if (ratios.size() == 0 || !fresh_ || !(loose > 0.0)) return;
    double& ratio = ratios(at.row, at.col);
    const double old = std::isnan(ratio) || swept_below(at) ? 0.0 : std::min(kept, loose);
    const double solids = old / (1.0 + ratio) + (loose - old) / (1.0 + *fresh_);
    ratio = old > 0.0 ? loose / solids - 1.0 : *fresh_;
  }

  GroundState& state_;
  const Survey& survey_;
  std::optional<double> fresh_;
};

void fill_layers(GroundState& state, bool has_obstacles) {
  const Eigen::Index rows = state.terrain.bank.z.rows();
  const Eigen::Index cols = state.terrain.bank.z.cols();
  const auto fill = [&](Eigen::ArrayXXd& layer) {
    if (layer.size() == 0) layer.setConstant(rows, cols, std::nan(""));
  };
  fill(state.seen);
  fill(state.deviation);
  if (has_obstacles) fill(state.terrain.obstacles);
}

}  // namespace

GroundState updated_ground(const GroundState& before, const SeenGround& seen,
                           std::optional<double> loose_void_ratio) {
  require_ground_state(before, "ground before");
  require_seen(seen);
  GroundState after = before;
  fill_layers(after, seen.obstacles.size() > 0);
  const Survey survey(after, seen);
  Updater updater(after, survey, loose_void_ratio);
  for_each_cell(survey.height, [&](Cell at) { updater.update(at, seen.time); });
  return after;
}

}  // namespace excavplan
