// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "estimate_density/estimate_inputs.hpp"

namespace excavplan::tools {

/// estimate-density on a site that is remembered between digs: takes a scan in, or without scans
/// shows what the site holds. @throws Error as excavplan::Site
Outcome work_on_site(const EstimateInputs& inputs);

}  // namespace excavplan::tools
