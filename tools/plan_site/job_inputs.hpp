// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/estimating/job_cost.hpp>

#include "frame/arguments.hpp"
#include "plan_site/order_inputs.hpp"

namespace excavplan::tools {

/// What only an estimate asks for.
struct EstimateInputs {
  std::optional<double> density_sd;  ///< [points]
  std::optional<double> truck_mass;  ///< of a load [kg]
  std::string fuel = "zx120";        ///< name or file of a fuel model
  JobPrices prices;
};

struct JobInputs {
  std::string command, folder;
  OrderInputs order;
  SiteScanInputs scan;
  std::optional<int> step;
  std::optional<double> payload_mass, energy;
  std::optional<std::string> loads, base, report, serve;
  bool stalled = false;
  EstimateInputs estimate;
};

/// @param words  all commands, between bars
void declare(Arguments& arguments, JobInputs& inputs, const std::string& words);

}  // namespace excavplan::tools
