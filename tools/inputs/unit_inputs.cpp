// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/unit_inputs.hpp"

#include <algorithm>
#include <vector>

#include "base/text.hpp"
#include "clouds/cloud_units.hpp"
#include "frame/quantity.hpp"

namespace excavplan::tools {

void declare_unit(Arguments& arguments, const std::string& name, std::string& unit,
                  const std::string& help) {
  std::vector<std::string> words;
  for (const CloudUnit& each : cloud_units()) words.push_back(each.word);
  arguments.choice(name, unit, words, help);
}

void declare_depth_unit(Arguments& arguments, std::optional<double>& depth_unit,
                        const std::string& help) {
  constexpr double largest = 0.01;  // ours [m]: cameras count 0.1 to 1 mm
  const std::string option = "--depth-unit";
  Arguments::Entry entry;
  entry.name = "depth-unit";
  entry.placeholder = placeholder(Quantity::length);
  entry.help = help + " [m]";
  entry.assign = [&depth_unit, option](const std::string& text) {
    const double length = parse_quantity(option, text, Quantity::length);
    if (!(length > 0.0)) usage_error(option + " must be above 0 m");
    if (length > largest) {
      usage_error(option + ": a count of " + number_text(length) + " m must be at most " +
                  number_text(largest) + " m: of millimetres say so, as in 0.25mm");
    }
    depth_unit = length;
  };
  arguments.add(entry);
}

double unit_length(const std::string& word) {
  const std::vector<CloudUnit>& all = cloud_units();
  return std::find_if(all.begin(), all.end(),
                      [&](const CloudUnit& unit) { return unit.word == word; })
      ->length;
}

}  // namespace excavplan::tools
