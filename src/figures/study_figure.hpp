// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <excavplan/experiments/study.hpp>

#include "drawing/plot.hpp"

namespace excavplan {

/// A row per condition: gains of the planned dig with their 95 % intervals, by three objectives,
/// and the rms error of the density.
Figure study_figure(const std::vector<StudyResult>& results);

}  // namespace excavplan
