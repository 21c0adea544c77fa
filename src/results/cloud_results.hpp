// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/clouds/cloud.hpp>

#include "base/json_fwd.hpp"

namespace excavplan {

Json cloud_json(const CloudSummary& summary);

}  // namespace excavplan
