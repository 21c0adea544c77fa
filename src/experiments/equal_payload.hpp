// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/experiments/experiment.hpp>

namespace excavplan {

/// An experiment like one that was made, with its estimate, for a goal at no less payload than that
/// of its fixed dig. Searched with so many digs, from the dig found there.
ExperimentOptions at_equal_payload(DigObjective::Goal goal, const ExperimentResult& found, int digs,
                                   ExperimentOptions options);

}  // namespace excavplan
