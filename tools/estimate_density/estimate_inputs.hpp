// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/density/density_estimate.hpp>

#include "estimate_density/estimate_outcome.hpp"
#include "estimate_density/method_inputs.hpp"
#include "estimate_density/second_densities.hpp"
#include "estimate_density/site_inputs.hpp"
#include "estimate_density/soil_inputs.hpp"
#include "frame/tool.hpp"
#include "inputs/maps.hpp"
#include "inputs/plots.hpp"
#include "inputs/scans.hpp"

/// @file
/// The command line of estimate-density, and what every survey does with it.

namespace excavplan::tools {

struct EstimateInputs {
  std::optional<std::string> before, after;
  std::optional<std::string> dump_before;
  std::optional<std::string> dump_after;
  ScanFrames frames;
  DensityOptions options;
  MethodInputs method;
  bool still = false;
  std::optional<std::string> plan_survey;
  SoilInputs soil;
  SecondDensities second;
  SiteEstimateInputs site;
  Plots plots;
  Maps maps;
  std::optional<std::string> report;
};

/// All options but those of a planned survey.
void declare_estimate(Arguments& arguments, EstimateInputs& inputs);

/// What is known of the dig beside its scans.
struct KnownDig {
  Machine machine;
  DensityOptions options;
  DensityLaw law;
};
KnownDig known_dig(const EstimateInputs& inputs);

/// A result with all that is asked to be shown of it.
Outcome shown_estimate(const EstimateInputs& inputs, const KnownDig& dig,
                       const DensityEstimate& counts, const TakenUnits& units);

}  // namespace excavplan::tools
