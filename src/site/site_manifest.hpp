// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "site/site_folder.hpp"

/// @file
/// What site.json says (docs/formats.md#site).

namespace excavplan {

/// An update as the site remembers it.
struct SiteRecord {
  std::string scan = {};  ///< digest of its points
  double time = 0.0;      ///< of the scan, since 1970-01-01 UTC [s]
  bool dug = false;       ///< and gave a density
};

/// One state of a site. What is in no file that it names is no part of the site.
struct SiteManifest {
  long long generation = 0;  ///< rises by one with each update; 0: empty
  long long digs = 0;        ///< updates that gave a density
  std::string soil = {}, machine = {}, law = {}, frame = {};
  double cell_size = 0.0;  ///< [m]
  StoredFile ground = {};
  StoredFile first = {};  ///< as each cell was when it was first seen
  StoredFile belief = {};
  StoredFile previous = {};             ///< site.json of the state before; no name: the first
  std::vector<SiteRecord> latest = {};  ///< updates, the last one last; at most most_records
};

/// Updates that a site remembers by their scans; ours.
inline constexpr std::size_t most_records = 64;
/// Of a scan, to either side of 1970; as in a ground file [s].
inline constexpr double latest_time = 1e11;

std::string manifest_text(const SiteManifest& manifest);

/// @param name  of the file, for messages
/// @throws Error (bad_file) naming file, key, value and rule
SiteManifest manifest_of(const std::string& name, const std::string& content);

}  // namespace excavplan
