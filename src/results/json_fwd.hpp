// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

/// @file
/// JSON for headers that only name it; base/json.hpp reads and writes it. Private to the project.

namespace excavplan {

/// A value whose keys keep their order.
using Json = nlohmann::ordered_json;

}  // namespace excavplan
