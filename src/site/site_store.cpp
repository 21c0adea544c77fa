// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "site/site_store.hpp"

#include <algorithm>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "site/stored_belief.hpp"

namespace excavplan {
namespace {

bool same(const Eigen::ArrayXXd& a, const Eigen::ArrayXXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && (a == b || (a.isNaN() && b.isNaN())).all();
}

bool same_heights(const GroundState& a, const GroundState& b) {
  return same_grid(a.terrain.bank, b.terrain.bank) && same(a.terrain.bank.z, b.terrain.bank.z) &&
         same(a.terrain.loose, b.terrain.loose);
}

std::vector<std::string> files_of(const SiteManifest& manifest) {
  return {manifest.ground.name, manifest.first.name, manifest.belief.name};
}

}  // namespace

SiteStore::SiteStore(const std::string& folder, bool locked)
    : folder_(folder, locked), locked_(locked) {
  if (locked && holds_site()) {
    folder_.keep_only(
        names_of(manifest_of(folder_.path_of(site_manifest), folder_.read(site_manifest))));
  }
}

std::vector<std::string> SiteStore::names_of(const SiteManifest& manifest) const {
  std::vector<std::string> names = files_of(manifest);
  const StoredFile& previous = manifest.previous;
  names.push_back(previous.name);
  if (previous.name.empty() || !folder_.has(previous.name)) return names;
  const SiteManifest before = manifest_of(folder_.path_of(previous.name), folder_.read(previous));
  for (const std::string& each : files_of(before)) names.push_back(each);
  return names;
}

StoredFile SiteStore::save(const char* kind, const GroundState& ground,
                           long long generation) const {
  const std::string name = stored_name(kind, generation, ".tif");
  folder_.clear(name);
  save_ground(folder_.path_of(name), ground);
  return folder_.stored(name);
}

GroundState SiteStore::load(const StoredFile& file) const {
  folder_.require_stored(file);
  return load_ground(folder_.path_of(file.name));
}

StoredSite SiteStore::load(const std::string& manifest) const {
  StoredSite site;
  site.manifest = manifest_of(folder_.path_of(site_manifest), manifest);
  if (site.manifest.generation == 0) return site;
  site.ground = load(site.manifest.ground);
  site.first = load(site.manifest.first);
  site.belief =
      belief_of(folder_.path_of(site.manifest.belief.name), folder_.read(site.manifest.belief));
  return site;
}

StoredSite SiteStore::load() const {
  constexpr int most_tries = 3;  // a reader may meet a process that changes the site
  std::string manifest = folder_.read(site_manifest);
  for (int i = 1;; ++i) {
    try {
      return load(manifest);
    } catch (const Error&) {
      std::string now = folder_.read(site_manifest);
      if (locked_ || now == manifest || i == most_tries) throw;
      manifest = std::move(now);
    }
  }
}

void SiteStore::save(const StoredSite& now, StoredSite& next) const {
  SiteManifest& manifest = next.manifest;
  manifest.generation = now.manifest.generation + 1;
  if (manifest.latest.size() > most_records) manifest.latest.erase(manifest.latest.begin());
  manifest.ground = save("ground", next.ground, manifest.generation);
  const bool is_kept = now.manifest.generation > 0 && same_heights(now.first, next.first);
  if (!is_kept) manifest.first = save("first", next.first, manifest.generation);
  manifest.belief =
      folder_.write(stored_name("belief", manifest.generation, ".json"), belief_text(next.belief));
  manifest.previous = folder_.write(stored_name("site", now.manifest.generation, ".json"),
                                    manifest_text(now.manifest));
  folder_.write(site_manifest, manifest_text(manifest));
  folder_.keep_only(names_of(manifest));
}

bool SiteStore::can_undo(const SiteManifest& now) const {
  return !now.previous.name.empty() && folder_.has(now.previous.name);
}

StoredSite SiteStore::undo(const SiteManifest& now) const {
  const StoredFile& previous = now.previous;
  require(can_undo(now),
          path() + ": there is no update to undo: of all updates the last one is kept");
  StoredSite before = load(folder_.read(previous));
  folder_.rename(previous.name, site_manifest);
  folder_.keep_only(names_of(before.manifest));
  return before;
}

}  // namespace excavplan
