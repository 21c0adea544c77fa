// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/ground/registration.hpp>

#include "change/change_zones.hpp"

namespace excavplan {

/// On even ground the relief of the scan before is its error, which is in the difference too. The
/// share of it that stable ground shows is subtracted (a control variate). The ground under the
/// zones is then known by its plane alone, so that height and tilts are unknown again.
///
/// @return the share of the relief that was subtracted: about -1 on even ground, 0 on rough ground
double take_relief_off(const HeightMap& before, ChangedGround& ground, Alignment& left);

}  // namespace excavplan
