// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/change/volume_change.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// The five volumes, each with its standard deviation.
Json volumes_json(const VolumeChange& change);

/// A value and its standard deviation, as KEY and KEY_sd with `unit` after both.
void add_measured(Json& json, const std::string& key, const Measured& measured,
                  const std::string& unit = "");

}  // namespace excavplan
