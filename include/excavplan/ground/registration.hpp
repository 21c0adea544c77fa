// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include <excavplan/ground/surface.hpp>

namespace excavplan {

/// A small rigid motion: translation x, y, z [m], then rotation about x, y, z [rad].
using Motion = Eigen::Matrix<double, 6, 1>;
using MotionCovariance = Eigen::Matrix<double, 6, 6>;

/// Position of the scan after the dig against the scan before.
///
/// A point p of the ground appears in the scan after at centre + R (p - centre) + t. By default
/// nothing has moved, but the height of the scans against each other (the datum) is not known.
struct Alignment {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the rotation [m]
  Motion motion = Motion::Zero();  ///< to correct for: `found` as far as it is significant
  Motion found = Motion::Zero();   ///< best estimate
  MotionCovariance covariance = MotionCovariance::Zero();  ///< of `found`
  /// Covariance of what is left after the correction, for measure_change(): wide for what the
  /// ground around the zones determines again (height and tilts), `covariance` for the rest.
  MotionCovariance left = default_left();
  std::array<bool, 6> supported = {};    ///< the scene determines it: sd below half the prior's
  bool vertical_is_significant = false;  ///< height and tilts, at 99 % against correlated error
  bool lateral_is_significant = false;   ///< shift and turn in plan, likewise
  double residual_sd = 0.0;              ///< robust, of one cell on ground that did not change [m]
  double stable_share = 0.0;             ///< of the cells known in both surfaces [-]

  /// Takes points of the scan after back to the frame of the scan before.
  Eigen::Matrix4d correction() const;
  /// Largest displacement of a point of the map in plan by `motion` [m].
  double largest_shift(const HeightMap& map) const;

  /// The default of `left`: the prior of the height, zero for the rest.
  static MotionCovariance default_left();
};

/// Surfaces of one area before and after a dig, on one grid, and their alignment.
struct SurfacePair {
  Surface before;       ///< before the dig
  Surface after;        ///< after it
  Alignment alignment;  ///< align(before, after), or what is known otherwise
};

/// Settings of align(). Priors as in `docs/methods.md#volumes`.
struct AlignmentOptions {
  double shift_prior = 0.020;     ///< sd of each translation [m], > 0
  double turn_prior = 0.0052360;  ///< sd of each rotation (0.3 degrees) [rad], > 0
  double steepest = 1.0;  ///< cells of a larger gradient (walls, edges) are not used [-], > 0
  /// Of ground that was known: where the machine worked. Not used, nor is ground about a change;
  /// shift and turn in plan then need pieces of relief that agree on all sides
  /// (`docs/methods.md#known-ground`).
  std::optional<Rectangle> left_out = {};
};

/// Finds the motion of the after surface on the ground that did not change.
///
/// Linear in the six unknowns by the gradient of the ground (Nuth and Kaab 2011 with rotations);
/// starts at the half-sample mode of the height change (Robertson and Cryer 1974), which survives
/// more than 40 % of changed area, then reweights by Tukey's biweight. The variance of a cell is
/// inflated by the correlation of the residuals, so that what the scene does not determine (a shift
/// on level ground) stays at zero by its prior.
///
/// @throws Error (bad_input) if the surfaces are not on one grid, share fewer than 100 known cells
///         with known neighbours, or an option is out of range
Alignment align(const Surface& before, const Surface& after, const AlignmentOptions& options = {});

/// The map after, corrected for the motion by its gradients. For motions that displace no point by
/// more than half a cell in plan; for larger ones transform the points by correction() and
/// rasterise them again.
HeightMap realigned(const HeightMap& after, const Alignment& alignment);

}  // namespace excavplan
