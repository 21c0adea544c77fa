// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <excavplan/experiments/study_result.hpp>

namespace excavplan {

/// Fills numbers and means from the runs; the first condition is what gains are compared with.
void summarise(std::vector<StudyResult>& results, std::uint64_t seed);

}  // namespace excavplan
