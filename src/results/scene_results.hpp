// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/planned_dig.hpp>
#include <excavplan/sensing/scene.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// The dig of a scene with its cycle, if it did not stall.
PlannedDig dig_of(const Machine& machine, const DigScene& scene);

/// A simulated dig: payload, energy, loads of the joints, volumes.
/// @param scene  with the history of its dig
Json scene_json(const Machine& machine, const DigScene& scene);

}  // namespace excavplan
