// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "fingerprint.hpp"

#include <excavplan/simulation/height_map_simulator.hpp>

namespace excavplan {

std::string simulator_fingerprint() { return HeightMapSimulator::name(); }

}  // namespace excavplan
