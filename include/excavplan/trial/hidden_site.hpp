// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <Eigen/Core>

#include <excavplan/design/job_design.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/job/job_settings.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

/// @file
/// A plain site (docs/formats.md#plain-sites) in two parts: what a planner may know of it, and what
/// is true.

namespace excavplan {

/// The sensor of a site, on its machine.
struct SiteSensor {
  std::string name;            ///< "depth-camera"
  double noise = 0.0;          ///< sd at 1 m of a range, of each return by itself [m]
  double pattern = 0.0;        ///< sd at 1 m of what neighbouring returns share [m]
  double range_power = 0.0;    ///< both grow with the range to this power
  bool on_boom = false;        ///< else on the cab, or on a mast above it
  double height = 3.0;         ///< over the ground under the machine [m]
  double tilt = 0.0;           ///< of its axis, below the horizontal [rad]
  Eigen::Vector2d view{0, 0};  ///< field of view across and along the tilt [rad]
  double height_sd = 0.0;      ///< of all heights of a scan alike, by its registration [m]
  double tilt_sd = 0.0;        ///< of a scan about x and about y, likewise [rad]
};

/// What a planner may know of a site.
struct SiteBrief {
  JobDesign job;                      ///< what is asked for
  DesignSurface design;               ///< its surface
  SoilKind soil;                      ///< the product's of that name, with the site's own numbers
  GroundDensity density{50.0, 25.0};  ///< what is known of it before the first dig
  std::string machine = "zx120";      ///< name of its class
  SiteSensor sensor;                  ///< as it is mounted, with its errors
};

/// Where the bank is how dense.
struct TrueDensity {
  HeightMap percent;      ///< at no depth, in `z` [%]
  double gradient = 0.0;  ///< with depth [%/m]
  double datum = 0.0;     ///< height from which depth counts: mean of the ground on the axis [m]

  /// At a place, z [m] high: clipped to 0 .. 100, without a gradient to 10 .. 90.
  double at(double x, double y, double z) const;
};

/// What is off in a machine, its scale and its moves.
struct HiddenErrors {
  double payload_scale = 0.0;          ///< share by which the scale reads too much [-]
  double payload_noise = 0.01;         ///< sd of one reading [-]
  double height_bias = 0.0;            ///< of the tip over its path [m]
  double height_sd = 0.012;            ///< of a dig, and along it [m]
  double side_sd = 0.02;               ///< of a dig, sideways [m]
  double landing_sd = 0.05;            ///< of a move [m]
  double landing_turn_sd = 0.0174533;  ///< [rad]
  double pose_sd = 0.01;               ///< with which the place is known then [m]
  double pose_turn_sd = 0.00174533;    ///< [rad]
};

/// A site with its truth.
struct HiddenSite {
  SiteBrief known;       ///< what a planner is told
  Terrain ground;        ///< at the start, in the site's frame, with void ratios of the bank
  SoilKind soil;         ///< as it is
  TrueDensity density;   ///< of the bank
  HiddenErrors errors;   ///< of machine, scale and soil
  HeightMap first_scan;  ///< first scan as cells; NaN: not seen
};

/// Edge of the cells of the truth; ours [m].
inline constexpr double truth_cell = 0.025;

/// Reads the description of a plain site, its design and the soil that it names: site.json, or the
/// folder with it.
/// @throws Error (bad_file) naming file, key, value and rule
SiteBrief read_site_brief(const std::string& file_or_folder);
/// The job of a site, by a machine and a law.
JobSettings settings_of(const SiteBrief& site, const Machine& machine, const DensityLaw& law);

/// Reads a plain site with its folder `hidden`.
///
/// The strength of the true soil is that of the nominal one times `strength_factor`, in cohesion,
/// adhesion and cone index. Water beyond what fills the pores of the densest state is left out.
/// @param cell_size  of the true ground, <= 0.25 [m]
/// @throws Error (bad_file) naming file, key, value and rule; (bad_input) if the soil that comes of
/// it is none or the cell is out of range
HiddenSite read_hidden_site(const std::string& folder, double cell_size = truth_cell);

/// Void ratios of the bank of a cell: that of the density at its top, as a terrain has one over the
/// depth of a cell. So of a density that grows with depth they are set anew where the ground was
/// dug (TrueSite).
void set_void_ratios(const TrueDensity& density, const SoilKind& soil, Terrain& ground);

}  // namespace excavplan
