// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/unit_inputs.hpp"

#include <algorithm>
#include <vector>

#include "clouds/cloud_units.hpp"

namespace excavplan::tools {

void declare_unit(Arguments& arguments, const std::string& name, std::string& unit,
                  const std::string& help) {
  std::vector<std::string> words;
  for (const CloudUnit& each : cloud_units()) words.push_back(each.word);
  arguments.choice(name, unit, words, help);
}

double unit_length(const std::string& word) {
  const std::vector<CloudUnit>& all = cloud_units();
  return std::find_if(all.begin(), all.end(),
                      [&](const CloudUnit& unit) { return unit.word == word; })
      ->length;
}

}  // namespace excavplan::tools
