// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/site/site.hpp>

#include "frame/arguments.hpp"
#include "frame/tool.hpp"

/// @file
/// The options --site and --base: what is remembered between digs.

namespace excavplan::tools {

struct SiteFolderInputs {
  std::optional<std::string> folder;
  std::optional<std::string> base;  ///< X,Y,HEADING
};

/// @param what  the tool does with the site
void declare_site_folder(Arguments& arguments, SiteFolderInputs& inputs, const std::string& what);

/// "X,Y,HEADING". @throws Error (bad_input) naming --base
BasePose parse_base(const std::string& text);

/// Where the machine stands. @throws Error (bad_input) naming the option
BasePose base_of(const SiteFolderInputs& inputs);

/// Key `site` of a result: what holds for the whole site. @param density  where it was asked for
nlohmann::ordered_json site_json(const excavplan::Site& site,
                                 const std::optional<RelativeDensity>& density);

}  // namespace excavplan::tools
