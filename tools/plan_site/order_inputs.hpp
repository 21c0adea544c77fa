// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/estimating/job_estimate.hpp>
#include <excavplan/job/job_order.hpp>

#include "frame/arguments.hpp"
#include "inputs/scans.hpp"

/// @file
/// What plan-site new is told: the design, the ground, what soil and machine, where soil goes.

namespace excavplan::tools {

/// A scan, and how it comes into the site's frame.
struct SiteScanInputs {
  std::optional<std::string> scan;
  ScanFrames frames;
  std::optional<double> time;  ///< since 1970 [s]; else now
};
void declare_scan(Arguments& arguments, SiteScanInputs& inputs);

/// A scan as it is taken in.
struct TimedScan {
  Scan scan;
  double time = 0.0;  ///< when it was made, since 1970 [s]
  ScanReport report;
};
/// @throws Error naming --scan if there is none
TimedScan scan_of(const SiteScanInputs& inputs);

struct OrderInputs {
  std::optional<std::string> site;  ///< description of a plain site
  std::optional<std::string> design, surface, trench, from, base;
  std::optional<double> heading;
  double grade = 0.0, batter = 0.0;
  std::string soil = "loam", machine = "zx120";
  std::vector<std::string> windrows, heaps, keep_out;
  std::optional<std::string> truck;
  double tolerance = 0.03;
  std::optional<double> density;  ///< [%]
};
void declare_order(Arguments& arguments, OrderInputs& inputs);

/// What a job begins with.
struct Order {
  JobSettings settings;
  OrderFiles files;
  TimedScan first;
};
/// @throws Error (bad_input), (bad_file) naming option, file, key and value
Order order_of(const OrderInputs& inputs, const SiteScanInputs& scan);

/// The design against the ground, for an estimate: where soil goes need not be told, and without a
/// scan a trench is one in level ground.
struct PlannedCut {
  SiteSettings site;  ///< soil and machine
  JobShape shape;
  std::optional<GroundDensity> density = {};  ///< as the site says
  std::optional<JobTruck> truck = {};
  std::optional<DesignWords> words = {};  ///< of a trench in level ground
};
/// @throws Error as order_of()
PlannedCut cut_of(const OrderInputs& inputs, const SiteScanInputs& scan);
/// Deviations of the heights of a first scan by its registration; ours.
GroundErrors errors_of_scan();

}  // namespace excavplan::tools
