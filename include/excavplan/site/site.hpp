// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/belief/density_belief.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/site/site_event.hpp>
#include <excavplan/site/site_settings.hpp>

/// @file
/// What is remembered between digs, in a folder (docs/guide/site.md).

namespace excavplan {

/// Whether a site is to be changed.
enum class SiteAccess {
  read,    ///< as it is when it is opened; needs no lock
  write,   ///< by this process alone, until the object ends
  of_job,  ///< likewise, by the job that the folder holds or will hold
};
/// The file by which a folder holds a job, which alone takes in the scans of its site.
inline constexpr const char* job_file = "job.json";

/// The ground as best known over all scans and digs, and the density that is believed in. Every
/// change is stored in the folder at once: whole or, if the process is killed, not at all.
class Site {
 public:
  /// Opens the site of a folder. For SiteAccess::write the folder is made if it is not there and a
  /// site begins with the first update.
  /// @throws Error (bad_file) if the folder holds no site, another process changes it, it is to be
  /// written though it holds a job, or a file is damaged; (bad_input) if its soil, machine, law or
  /// cell are not those of `settings`
  Site(const std::string& folder, SiteSettings settings, SiteAccess access = SiteAccess::read);
  ~Site();
  Site(Site&&) noexcept;             ///< the other may only be destroyed then
  Site& operator=(Site&&) noexcept;  ///< the same

  /// Takes in a scan. One that does not fit the ground where that did not change is not taken.
  /// @throws Error (bad_input) if the site is open for reading, or the scan was taken in before, is
  /// older than the last one, or would make the site larger than most_site_cells; as
  /// estimate_density()
  SiteUpdate update(const SiteEvent& event);
  /// What update() would answer. The site stays as it is.
  SiteUpdate look(const SiteEvent& event) const;
  /// Takes the last update back: all of the site is again as before it.
  /// @throws Error (bad_input) if the site is open for reading, or that one is not kept: of all
  /// updates the last is
  void undo();

  bool is_empty() const;                  ///< no scan was taken in
  bool was_last(const Scan& scan) const;  ///< whether its latest update is of that scan
  bool can_undo() const;                  ///< whether undo() has an update to take back
  long long updates() const;              ///< scans taken in, less those undone
  long long digs() const;                 ///< those that gave a density
  double cell_size() const;               ///< [m]
  const SiteSettings& settings() const;   ///< with which it was opened
  const GroundState& ground() const;  ///< in the site's frame. @throws Error (bad_input) if empty

  const DensityBelief& belief() const;  ///< where in the site's frame which density is believed in

  /// The mean density of the undisturbed soil of an area down to a depth [m].
  /// @param area  in the machine's frame
  /// @throws Error (bad_input) if there is no such soil that a scan saw
  GroundDensity density_at(const BasePose& base, const Rectangle& area, double depth) const;
  /// The ground about a machine, in its frame: cells that no scan saw are unknown.
  /// @param extent  in the machine's frame
  /// @throws Error (bad_input) as flat_ground(), or if the site is empty
  GroundState ground_for(const BasePose& base, const Rectangle& extent, double cell_size) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace excavplan
