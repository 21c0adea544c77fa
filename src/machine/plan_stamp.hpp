// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/trajectory.hpp>

#include "base/json.hpp"

namespace excavplan {

/// As docs/formats.md#trajectory lists its keys.
nlohmann::ordered_json stamp_json(const PlanStamp& stamp);
/// @throws Error (bad_file) naming file, key, value and rule
PlanStamp read_stamp(JsonObject object);

}  // namespace excavplan
