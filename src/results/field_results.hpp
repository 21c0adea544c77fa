// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/experiments/field_experiment.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// The digs of a soil along both paths, and the gains. @param name  of the soil's condition
Json field_json(const std::string& name, const FieldResult& result);

}  // namespace excavplan
