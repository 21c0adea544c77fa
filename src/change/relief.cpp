// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/relief.hpp"

#include <cmath>
#include <vector>

#include "ground/grid_cells.hpp"
#include "ground/hole_filling.hpp"
#include "ground/noise_model.hpp"
#include "ground/plane_fit.hpp"

namespace excavplan {
namespace {

/// A plane over a map: least squares of values known in some cells.
class MapPlane {
 public:
  MapPlane(const Eigen::ArrayXXd& values, const Eigen::ArrayXXd& known) {
    PlaneFit fit;
    for_each_cell(values, [&](Cell at) {
      if (std::isnan(known(at.row, at.col))) return;
      fit.add(static_cast<double>(at.col), static_cast<double>(at.row), values(at.row, at.col));
    });
    plane_ = fit.plane();
  }
  double operator()(Cell at) const {
    return plane_.at(static_cast<double>(at.col), static_cast<double>(at.row));
  }

 private:
  GroundPlane plane_;
};

/// Share of the relief of the ground before that is in the difference: regression on stable ground.
double share_of_relief(const Eigen::ArrayXXd& relief, const Eigen::ArrayXXd& residual) {
  constexpr double significant = 0.35;  // ours: three sd with some 70 independent patches
  const MapPlane trend(residual, residual);
  double own = 0.0;
  double both = 0.0;
  double changes = 0.0;
  for_each_cell(relief, [&](Cell at) {
    const double change = residual(at.row, at.col) - trend(at);
    if (std::isnan(change)) return;
    own += relief(at.row, at.col) * relief(at.row, at.col);
    both += relief(at.row, at.col) * change;
    changes += change * change;
  });
  return std::abs(both) > significant * std::sqrt(own * changes) ? both / own : 0.0;
}

/// True if the relief under every zone is like that of stable ground: neither larger, nor higher
/// or lower in the mean than its covariance there allows. An older hole or heap is not an error.
bool is_alike(const Eigen::ArrayXXd& relief, const ChangedGround& ground, double cell_size) {
  constexpr double largest_ratio = 2.0;  // ours: of rms
  constexpr double largest_mean = 2.5;   // ours [sd]
  const std::size_t zones = ground.zone_is_cut.size();
  std::vector<double> sums(zones, 0.0);
  std::vector<double> squares(zones, 0.0);
  std::vector<double> counts(zones, 0.0);
  for_each_cell(relief, [&](Cell at) {
    const int zone = ground.zone(at.row, at.col);
    const double height = relief(at.row, at.col);
    if (zone < 0 || std::isnan(height)) return;
    const auto i = static_cast<std::size_t>(zone);
    sums[i] += height;
    squares[i] += height * height;
    counts[i] += 1.0;
  });
  const NoiseModel noise =
      find_noise(ground.residual.isNaN().select(ground.residual, relief), cell_size);
  const double variance = noise.white + noise.correlated;
  for (std::size_t i = 0; i < zones; ++i) {
    const double most =
        largest_mean * largest_mean * counts[i] * noise.large_area_variance(cell_size);
    if (squares[i] > largest_ratio * largest_ratio * variance * counts[i]) return false;
    if (sums[i] * sums[i] > most) return false;
  }
  return true;
}

}  // namespace

double take_relief_off(const HeightMap& before, ChangedGround& ground, Alignment& left) {
  const MapPlane plane(before.z, ground.residual);
  Eigen::ArrayXXd relief = before.z;
  for_each_cell(relief, [&](Cell at) { relief(at.row, at.col) -= plane(at); });
  fill_holes(relief);
  const double share = share_of_relief(relief, ground.residual);
  if (share == 0.0 || !is_alike(relief, ground, before.cell_size)) return 0.0;
  const Eigen::ArrayXXd taken = relief.isNaN().select(0.0, share * relief);
  ground.residual -= taken;
  ground.difference -= taken;
  const AlignmentOptions priors;
  const Eigen::Vector3d open(priors.shift_prior, priors.turn_prior, priors.turn_prior);
  left.left.block<3, 3>(2, 2) = open.cwiseAbs2().asDiagonal();
  return share;
}

}  // namespace excavplan
