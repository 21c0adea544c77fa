// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/soil/density_law.hpp>

#include "frame/tool.hpp"

namespace excavplan::tools {

/// What --plan-survey understands, for its help.
std::string survey_keys();

/// Predicted density error of the survey that `text` describes, "height=2.5,offset=1.2", and the
/// requirements for an error of `target` points.
/// @throws Error (bad_input) naming the key and its rule
Outcome planned_survey(const std::string& text, const DensityLaw& law);

}  // namespace excavplan::tools
