// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/efficiency/efficiency.hpp>

#include <cmath>

#include "base/check.hpp"

namespace excavplan {

Measured DigEfficiency::per(double other_cost) const {
  const double value = payload.amount.value / other_cost;
  return {value, value * std::hypot(payload.amount.sd / payload.amount.value, cost_sd / cost)};
}

Measured DigEfficiency::value() const { return per(cost); }

std::string DigEfficiency::unit() const {
  return std::string(payload.kind == Lifted::volume ? "m3" : "kg") + "_per_" +
         (spent == Spent::fuel ? "ml" : "kj");
}

std::string DigEfficiency::symbol() const {
  return std::string(payload.kind == Lifted::volume ? "m3" : "kg") + "/" +
         (spent == Spent::fuel ? "mL" : "kJ");
}

Measured efficiency_gain(const DigEfficiency& first, const DigEfficiency& second, bool own_meters) {
  if (first.unit() != second.unit()) {
    throw Error(ErrorKind::bad_input, "the runs cannot be compared: " + first.file + " is in " +
                                          first.symbol() + ", " + second.file + " in " +
                                          second.symbol());
  }
  const Measured a = first.value();
  const Measured b = second.value();
  for (const Measured& value : {a, b}) {
    require(value.value > 0.0 && std::isfinite(value.value), "payload per cost of a run",
            value.value, "above 0 and finite");
  }
  const auto relative = [own_meters](const DigEfficiency& run) {
    const Measured& payload = run.payload.amount;
    return std::hypot(payload.sd / payload.value, own_meters ? run.cost_sd / run.cost : 0.0);
  };
  const double ratio = b.value / a.value;
  return {100.0 * (ratio - 1.0), 100.0 * ratio * std::hypot(relative(first), relative(second))};
}

}  // namespace excavplan
