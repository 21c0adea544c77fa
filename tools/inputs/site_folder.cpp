// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "inputs/site_folder.hpp"

#include "base/text.hpp"

namespace excavplan::tools {

void declare_site_folder(Arguments& arguments, SiteFolderInputs& inputs, const std::string& what) {
  arguments.text("site", "FOLDER", inputs.folder, what);
  arguments.only_if({[&inputs] { return inputs.folder.has_value(); }, "it is of --site"}, [&] {
    arguments.text("base", "X,Y,HEADING", inputs.base,
                   "where the machine stands in the frame of the site, such as 12,-3.5,90deg: its "
                   "swing axis, and its x axis from that of the site (default: 0,0,0)");
  });
}

BasePose parse_base(const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 3) {
    usage_error("--base: '" + text + "' is not X,Y,HEADING such as 12,-3.5,90deg");
  }
  return {parse_quantity("--base", parts[0], Quantity::length),
          parse_quantity("--base", parts[1], Quantity::length), 0.0,
          parse_quantity("--base", parts[2], Quantity::angle)};
}

BasePose base_of(const SiteFolderInputs& inputs) {
  return inputs.base ? parse_base(*inputs.base) : BasePose();
}

nlohmann::ordered_json site_json(const excavplan::Site& site,
                                 const std::optional<RelativeDensity>& density) {
  nlohmann::ordered_json json = {{"updates", site.updates()},
                                 {"digs", site.digs()},
                                 {"density_percent", nullptr},
                                 {"density_sd_percent", nullptr},
                                 {"density_interval_percent", nullptr}};
  if (density) {
    json["density_percent"] = density->percent;
    json["density_sd_percent"] = density->sd_percent;
    json["density_interval_percent"] = density->interval_percent;
  }
  json["cell_size_m"] = site.cell_size();
  return json;
}

}  // namespace excavplan::tools
