// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "frame/arguments.hpp"
#include "inputs/site_folder.hpp"

namespace excavplan::tools {

/// --site and what belongs to it.
struct SiteEstimateInputs {
  SiteFolderInputs at;
  std::optional<std::string> dug;
  std::optional<Eigen::Vector2d> dump_at;  ///< of the bucket
  bool no_update = false;
  bool no_dig = false;
  bool stalled = false;
  bool undo = false;
  std::optional<double> time;  ///< of the scan, since 1970 [s]

  bool is_used() const { return at.folder.has_value(); }
};

void declare_site(Arguments& arguments, SiteEstimateInputs& inputs);

}  // namespace excavplan::tools
