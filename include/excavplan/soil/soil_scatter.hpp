// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/base/data_files.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// How soils of one kind differ from site to site, and the kinds that a site may have
/// (docs/methods.md#soil-scatter).

namespace excavplan {

/// Standard deviations of a kind of soil from site to site, each a share of its value. All normal.
struct SoilScatter {
  /// Of the water content; ours. Phoon and Kulhawy 1999 give 8 .. 30 % (recalled) within a site;
  /// between sites it is not less.
  double water_content = 0.2;
  /// Of the dry densities at void_ratio_max and void_ratio_min, each on its own; ours. It makes 5
  /// points of relative density in sand, whose reproducibility is 10 points (Holtz 1973, ASTM STP
  /// 523: taken as two standard deviations).
  double limit_density = 0.015;
  /// Of the dry density of loose soil beside that at void_ratio_max. The R^2 of Yajima et al. 2026,
  /// 0.9811, leaves 1.3 points of d beside the 0.98294 that the curvature of the law explains:
  /// 0.008 of k, which is 0.65 % at k = 1.25.
  double loose_density = 0.0065;
};

/// A soil of this kind at another site. The same seed gives the same soil.
SoilKind drawn_soil(const SoilKind& soil, const SoilScatter& scatter, std::uint64_t seed);

/// The density of ground from what it weighs: e = G_s rho_w (1 + w) / rho - 1, d = (e_max - e) /
/// (e_max - e_min) [%], also outside 0 .. 100.
double density_of_bulk_density(const SoilKind& soil, double bulk_density);

/// Covariance [points^2] of what a law says from k freed of fallback, and of
/// density_of_bulk_density(), in soils that differ from this kind by the scatter: 400 draws. Both
/// depend on the same void ratios.
Eigen::Matrix2d density_scatter(const SoilKind& soil, const DensityForm& freed_form,
                                double density_percent, const SoilScatter& scatter);

/// A kind of soil with its law and how likely it is to be met.
struct SoilLaw {
  SoilKind soil;        ///< the kind
  DensityLaw law;       ///< for it
  double weight = 0.0;  ///< its probability before anything is measured; those of all add up to 1
};

/// The soils that excavplan ships with the laws of the ZX120. The weights are ours: loam 0.4, sand,
/// clay and gravel 0.2 each.
/// @throws Error (bad_file) as load_soil() and load_density_law()
std::vector<SoilLaw> shipped_soil_laws(const std::string& data_folder = data_folder_of_package);

}  // namespace excavplan
