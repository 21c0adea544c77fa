// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/dig_outcome.hpp>

#include <cmath>
#include <string>

#include "base/text.hpp"

namespace excavplan {

std::string describe(const DigFailure& failure) {
  if (const auto* infeasible = std::get_if<Infeasible>(&failure)) return infeasible->message;
  const auto& stall = std::get<Stall>(failure);
  const std::string where = std::string(" in the phase ") + name(stall.phase) + " after " +
                            decimals(stall.travelled, 3) + " m: ";
  const auto kilo = [](double value) { return decimals(value / 1000.0, 1); };
  const auto tips = [&](const char* end, const char* edge) {
    return std::string("the machine's ") + end + " lifts" + where +
           "the moment of soil and payload about its " + edge + " edge is " + kilo(stall.needed) +
           " kN m, its weight holds " + kilo(stall.held) + " kN m";
  };
  switch (stall.cause) {
    case Stall::Cause::front_lifts:
      return tips("front", "rear");
    case Stall::Cause::rear_lifts:
      return tips("rear", "front");
    case Stall::Cause::slides:
      return "the machine slides on its tracks" + where + "the soil pulls with " +
             kilo(stall.needed) + " kN, the ground holds " + kilo(stall.held) + " kN";
    case Stall::Cause::torque:
      break;
  }
  return std::string("the ") + name(stall.joint) + " stalls" + where + "the required torque is " +
         kilo(std::abs(stall.torque)) + " kN m";
}

}  // namespace excavplan
