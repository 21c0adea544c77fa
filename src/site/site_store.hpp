// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/belief/density_belief.hpp>
#include <excavplan/ground/ground_state.hpp>

#include "site/site_folder.hpp"
#include "site/site_manifest.hpp"

/// @file
/// States of a site in its folder. A new state is written to files of new names; then site.json,
/// which names them, is replaced, and before that kept for undo().

namespace excavplan {

/// All that a site remembers.
struct StoredSite {
  SiteManifest manifest = {};
  GroundState ground = {};  ///< as it is now; empty of an empty site
  DensityBelief belief{};
  GroundState first = {};  ///< as each cell was when it was first seen: bank and loose alone
};

class SiteStore {
 public:
  /// @throws Error (bad_file) as SiteFolder()
  SiteStore(const std::string& folder, bool locked);

  const std::string& path() const { return folder_.path(); }
  bool holds_site() const { return folder_.has(site_manifest); }
  /// @throws Error (bad_file) naming what is damaged
  StoredSite load() const;
  /// Sets generation, previous state and files of the manifest of `next` as well.
  void save(const StoredSite& now, StoredSite& next) const;
  /// @return the state before the last one
  /// @throws Error (bad_input) if there is none or it is not kept
  StoredSite undo(const SiteManifest& now) const;
  bool can_undo(const SiteManifest& now) const;  ///< whether that one is kept

 private:
  StoredFile save(const char* kind, const GroundState& ground, long long generation) const;
  GroundState load(const StoredFile& file) const;
  StoredSite load(const std::string& manifest) const;
  /// What a manifest names, and what the one before it does.
  std::vector<std::string> names_of(const SiteManifest& manifest) const;

  SiteFolder folder_;
  bool locked_;
};

}  // namespace excavplan
