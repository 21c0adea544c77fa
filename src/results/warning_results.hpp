// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/warning.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// Key `warnings` of a result: code and message of each.
Json warnings_json(const std::vector<Warning>& warnings);

}  // namespace excavplan
