// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/estimating/job_cost.hpp>

#include <array>
#include <cmath>

#include "base/check.hpp"

namespace excavplan {
namespace {

double priced(const char* name, const std::optional<double>& price, double amount) {
  constexpr double most = 1e9;
  if (price) require_in(name, *price, 0.0, most);
  return price.value_or(0.0) * amount;
}

}  // namespace

std::optional<JobCost> cost_of(const JobEstimate& estimate, const JobPrices& prices) {
  JobCost cost;
  cost.fuel = priced("estimate: price of fuel", prices.fuel, estimate.fuel.value);
  cost.machine = priced("estimate: price of an hour", prices.hour, estimate.time.value / 3600.0);
  cost.truckloads = priced("estimate: price of a truckload", prices.truckload,
                           std::ceil(estimate.truckloads.value));
  cost.total.value = cost.fuel + cost.machine + cost.truckloads;
  if (!(cost.total.value > 0.0)) return std::nullopt;
  constexpr std::array<double EstimateSpread::*, 6> sources = {
      &EstimateSpread::volume, &EstimateSpread::density, &EstimateSpread::played,
      &EstimateSpread::unlike, &EstimateSpread::fuel,    &EstimateSpread::fill};
  for (double EstimateSpread::*source : sources) {
    cost.total.spread.*source =
        (cost.fuel * estimate.fuel.spread.*source + cost.machine * estimate.time.spread.*source +
         cost.truckloads * estimate.truckloads.spread.*source) /
        cost.total.value;
  }
  return cost;
}

}  // namespace excavplan
