// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/design/design_surface.hpp>
#include <excavplan/design/job_design.hpp>
#include <excavplan/scans/scan_surface.hpp>
#include <excavplan/site/site_settings.hpp>

namespace excavplan {

/// What a job is to do, and with what.
struct JobSettings {
  SiteSettings site;      ///< soil, machine, law and cells
  JobDesign design;       ///< where soil goes, what must not be touched, tolerance, start
  DesignSurface surface;  ///< that the ground is to have
  /// Relative density of the ground as told, in 0 .. 100 [%]: the plans begin with it.
  double density_percent = 50.0;
  /// What a second of the machine is worth beside the energy of its joints [W], >= 0; ours: the
  /// bars for energy and time of a usual job are then met together.
  double time_price = 4000.0;
};

/// @throws Error (bad_input) as require_job(), require_machine() and require_soil(), or if a number
/// is out of range, there is no start, or the machine states no swing or engine
void require_job_settings(const JobSettings& settings);

/// The scan of the ground that a design's description names, in the frame of its site.
/// @throws Error (bad_input) if it names none
Scan first_scan(const JobDesign& design);

}  // namespace excavplan
