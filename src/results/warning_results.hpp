// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/base/warning.hpp>

#include "results/json_fwd.hpp"

namespace excavplan {

/// Key `warnings` of a result: of each its code, its message and whether it ends trust.
Json warnings_json(const std::vector<Warning>& warnings);

}  // namespace excavplan
