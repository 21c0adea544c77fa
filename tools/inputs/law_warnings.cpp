// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/law_warnings.hpp"

namespace excavplan::tools {

std::vector<Warning> unlike_law(const DensityLaw& law, const std::string& machine,
                                const std::string& soil) {
  std::vector<Warning> warnings;
  const std::string measured = "the law '" + law.name + "' was measured on digs ";
  if (!law.machine.empty() && law.machine != machine) {
    warnings.emplace_back(WarningCode::law_of_other_machine,
                          measured + "of " + law.machine + ", not of " + machine +
                              ": how much soil falls back into the cut may differ; "
                              "calibrate-density makes a law for a machine");
  }
  if (!soil.empty() && !law.soil.empty() && law.soil != soil) {
    warnings.emplace_back(
        WarningCode::law_of_other_soil,
        measured + "in " + law.soil + ", not in " + soil + ": the estimated densities are biased");
  }
  return warnings;
}

}  // namespace excavplan::tools
