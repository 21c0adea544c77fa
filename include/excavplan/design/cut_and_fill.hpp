// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/measured.hpp>
#include <excavplan/design/design_surface.hpp>
#include <excavplan/ground/surface.hpp>

namespace excavplan {

/// Errors that the cells of a scan have in common; those of each cell are in Surface::variance.
struct GroundErrors {
  double height_sd = 0.0;       ///< of all heights alike, by the registration [m], >= 0
  double tilt_sd = 0.0;         ///< about x and y through the middle of the scan [rad], >= 0
  double pattern_sd = 0.0;      ///< of the sensor, alike in neighbouring cells [m], >= 0
  double pattern_length = 0.5;  ///< along which that is correlated, exp(-distance / length) [m]
};

/// Settings of cut_and_fill().
struct CutOptions {
  GroundErrors errors = {};  ///< of the scan
  double tolerance = 0.03;   ///< of the finished ground, to either side [m], > 0
  /// The rim of the design and faces steeper than `steepest` do not count for the deviation, nor
  /// what is nearer to them than this [m], >= 0.
  double edge_margin = 0.1;
  double steepest = 1.0471975511965976;  ///< 60 degrees [rad], in 0 .. pi / 2
  /// Of a design that lies with less of its area on known ground nothing is measured [-]; ours.
  double least_known_share = 0.5;
};

/// How far the ground is from its design, where it counts.
struct Deviation {
  double area = 0.0;          ///< of the cells that count and are seen [m^2]
  double rms = 0.0;           ///< [m]; NaN without area
  double p95 = 0.0;           ///< of the absolute values [m]; likewise
  double beyond_twice = 0.0;  ///< share of cells beyond twice the tolerance [-]; likewise
  /// Of at least 95 % within the tolerance and at most 1 % beyond twice of it.
  bool is_within = false;
};

/// What is to be moved until the ground has the shape of its design.
struct CutAndFill {
  Measured cut;                    ///< ground above the design [m^3]
  Measured fill;                   ///< missing ground below it [m^3]; 0 of a design that only cuts
  double area = 0.0;               ///< in plan, of the part on the map of the ground [m^2]
  double unseen_area = 0.0;        ///< of it, of unknown ground, filled from around [m^2]
  double outside_area = 0.0;       ///< beside the map of the ground, not measured [m^2]
  Deviation deviation;             ///< of cut and fill by what they come from
  std::vector<std::string> notes;  ///< what of it is doubtful
};

/// The ground against a design, exact for plane triangles over cells of level ground.
///
/// A cell counts as cut or fill where the scan has an error by the sign of the mean over the cells
/// around, so that noise on finished ground takes itself off; else by parts of the cell. The
/// deviations are of the noise of the cells, what their errors have in common, and of unknown
/// ground a quarter of the largest height between ground and design (ours).
///
/// @throws Error (bad_file) if the design lies beside the known ground, far above or far below it,
/// with what would make it fit (x and y swapped, another unit); if triangles lie above one another;
/// (bad_input) if the surface or an option is out of range
CutAndFill cut_and_fill(const DesignSurface& design, const Surface& ground,
                        const CutOptions& options = {});
/// The same of heights without error.
CutAndFill cut_and_fill(const DesignSurface& design, const HeightMap& ground,
                        const CutOptions& options = {});

}  // namespace excavplan
