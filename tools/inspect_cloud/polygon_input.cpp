// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inspect_cloud/polygon_input.hpp"

#include <string>

#include <excavplan/scans/polygon_volume.hpp>

#include "base/text.hpp"
#include "frame/option_names.hpp"
#include "frame/quantity.hpp"

namespace excavplan::tools {

void declare_volume(Arguments& arguments, std::vector<Eigen::Vector2d>& polygon) {
  const std::string option = "--volume";
  Arguments::Entry entry;
  entry.name = "volume";
  entry.placeholder = "X1,Y1,X2,Y2,X3,Y3,...";
  entry.help =
      "volume of the pile or hole in this polygon, whose outline runs on the ground around it, "
      "against the surface that this ground spans; after --pose or --level [m]";
  entry.assign = [&polygon, option](const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() < 6 || parts.size() % 2 != 0) {
      usage_error(option + ": '" + text + "' is not X1,Y1,X2,Y2,X3,Y3 and more corners");
    }
    polygon.clear();
    for (std::size_t i = 0; i < parts.size(); i += 2) {
      polygon.emplace_back(parse_quantity(option, parts[i], Quantity::length),
                           parse_quantity(option, parts[i + 1], Quantity::length));
    }
  };
  arguments.add(entry);
}

void add_volume(const Scan& scan, const std::vector<Eigen::Vector2d>& polygon, Outcome& outcome) {
  if (polygon.empty()) return;
  Scan told = scan;
  told.doubts.clear();  // stated by the recording
  const OptionNames names = {{"volume:", "--volume:"}};
  const PolygonVolume found = naming_options(names, [&] { return volume_over(told, polygon); });
  outcome.json["volume"] = {{"above_m3", found.above.value},
                            {"above_sd_m3", found.above.sd},
                            {"below_m3", found.below.value},
                            {"below_sd_m3", found.below.sd},
                            {"area_m2", found.area}};
  const auto text = [](const Measured& volume) {
    return readable(volume.value, volume.sd) + " m^3";
  };
  outcome.lines.push_back("  volume in the polygon of " + readable(found.area) + " m^2: " +
                          text(found.above) + " above its rim, " + text(found.below) + " below");
  outcome.warnings.insert(outcome.warnings.end(), found.warnings.begin(), found.warnings.end());
}

}  // namespace excavplan::tools
