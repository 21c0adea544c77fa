// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <excavplan/estimating/job_estimate.hpp>

/// @file
/// What an estimated job costs. Prices and costs are in one currency, which nobody asks for.

namespace excavplan {

/// What is not told does not count.
struct JobPrices {
  std::optional<double> fuel = {};       ///< per litre, >= 0
  std::optional<double> hour = {};       ///< of machine and operator, without fuel, >= 0
  std::optional<double> truckload = {};  ///< haul and tip of one, >= 0
};

/// The cost of an estimated job and its parts.
struct JobCost {
  EstimatedFigure total;    ///< each source moves all parts together
  double fuel = 0.0;        ///< part of it
  double machine = 0.0;     ///< likewise, by the hour
  double truckloads = 0.0;  ///< likewise, of whole loads
};

/// Nothing if the prices that are told come to nothing.
/// @throws Error (bad_input) if a price is out of range
std::optional<JobCost> cost_of(const JobEstimate& estimate, const JobPrices& prices);

}  // namespace excavplan
