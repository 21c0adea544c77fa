// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/soil/loose_soil.hpp>

namespace excavplan {

/// compacted_void_ratio() of a soil, void ratio and pressure that were checked before.
double checked_compaction(const SoilKind& soil, double void_ratio, double pressure);

}  // namespace excavplan
