// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <excavplan/simulation/simulators.hpp>
#include <excavplan/simulation/soil_simulator.hpp>

/// @file
/// The one place where simulators are made and asked: they may be a user's, and are not trusted.
/// Private to the project.

namespace excavplan {

/// @throws Error (bad_input) with the name of the kind if it has no `make`, or that throws or gives
///         nothing
std::unique_ptr<const SoilSimulator> make_simulator(const SimulatorKind& kind,
                                                    const Machine& machine, const SoilKind& soil,
                                                    double density_percent);

/// SoilSimulator::identity(). @throws Error (bad_input) with the name of its class if it throws
std::string checked_identity(const SoilSimulator& simulator);

/// A dig whose result is one that a dig can have. Of ground that does not settle the patch is not
/// looked at: no search does.
/// @throws Error (bad_input) with the name of the simulator for anything else (SoilSimulator)
DigResult checked_dig(const SoilSimulator& simulator, const Machine& machine,
                      const Terrain& terrain, const DigPath& path, const DigOptions& options);

}  // namespace excavplan
