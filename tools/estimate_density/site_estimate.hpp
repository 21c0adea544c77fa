// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/site/site.hpp>

#include "frame/arguments.hpp"
#include "frame/tool.hpp"
#include "inputs/site_folder.hpp"

/// @file
/// estimate-density on a site that is remembered between digs: --site and what belongs to it.

namespace excavplan::tools {

struct SiteEstimateInputs {
  SiteFolderInputs at;
  std::optional<std::string> dug;
  bool no_update = false;
  bool no_dig = false;
  bool stalled = false;
  bool undo = false;
  std::optional<double> time;  ///< of the scan, since 1970 [s]

  bool is_used() const { return at.folder.has_value(); }
};

void declare_site(Arguments& arguments, SiteEstimateInputs& inputs);

/// Puts what --dug tells into the event: path, start, foretold density and work.
/// @throws Error (bad_file) as stated_dig(), (bad_input) if the path is told twice
void add_told_dig(const SiteEstimateInputs& inputs, const Machine& machine, SiteEvent& event);

/// Takes the event in, or with --no-update looks at it alone.
SiteUpdate told_site(const SiteEstimateInputs& inputs, excavplan::Site& site,
                     const SiteEvent& event);
/// How the site is to be opened for that.
SiteAccess access_of(const SiteEstimateInputs& inputs);

/// Key `site`, and lines about it.
void add_site(const excavplan::Site& site, const SiteUpdate& update, Outcome& outcome);

/// Without scans: what the site holds, after --undo if it is asked for.
Outcome site_outcome(const SiteEstimateInputs& inputs);

}  // namespace excavplan::tools
