// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <excavplan/robot/dig_cycle_settings.hpp>
#include <excavplan/site/plan_on_site.hpp>

/// @file The site of a session. Private to the library.

namespace excavplan {

/// Where the machine stands on the site of the settings.
/// @throws Error (bad_input) unless it stands level there
BasePose base_on_site(const DigCycleSettings& settings);

/// A scan of the ground, in the frame of the machine.
struct GroundScan {
  Scan scan;
  double time = 0.0;  ///< when it was scanned, since 1970-01-01 UTC [s]
};

/// What is remembered between the digs of a session, and by later ones.
class CycleSite {
 public:
  /// @throws Error as Site() for writing and base_on_site()
  explicit CycleSite(const DigCycleSettings& settings);

  bool knows_ground() const { return !site_.is_empty(); }
  bool has_density() const { return !site_.belief().digs().empty(); }
  /// Whether it took a scan since the last dig of this session.
  bool is_current() const { return is_current_; }
  /// Whether the scan before the dig that began has news for it.
  bool needs_before() const { return !was_current_; }

  void begin_dig();
  /// Takes a scan that is of no dig. @return its warnings, that it is not taken among them
  std::vector<Warning> look_around(const GroundScan& seen);
  /// Takes the scan after a dig.
  /// @param event  of base and before nothing is told
  /// @param before  if needs_before(), and there is one
  SiteUpdate survey(SiteEvent event, const std::optional<GroundScan>& before);

  /// @param density  as SitePlanOptions::density
  /// @param present  the same
  SitePlan plan(const PlanOptions& options, const GroundDensity& density,
                const std::optional<Terrain>& present) const;
  /// The ground that the machine can swing over, on the cells of level_swing_ground().
  Terrain around() const;
  HeightMap at_tracks() const;  ///< as standing_ground_from_scan()

 private:
  Scan in_site(Scan scan) const;

  BasePose base_;
  Site site_;
  bool is_current_ = false, was_current_ = false;
};

}  // namespace excavplan
