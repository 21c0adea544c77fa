// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/machine/machine.hpp>

#include "inputs/plots.hpp"

namespace excavplan::tools {

/// reach: the machine, how far its tip comes, and how hard it digs there.
const FigureTable<Machine>& kit_figures();

}  // namespace excavplan::tools
