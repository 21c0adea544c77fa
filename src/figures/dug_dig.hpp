// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/machine/dig_path.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

namespace excavplan {

/// A dig that was simulated, with its history.
struct DugDig {
  const Machine& machine;
  const DigPath& path;
  const DigResult& dig;
  GroundProfile before, after;  ///< ground in the plane of the boom
  std::string title;            ///< of the files
};

}  // namespace excavplan
