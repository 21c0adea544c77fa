// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/job/job_settings.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/site/site.hpp>

/// @file
/// The ground of a job: as a site remembers it, and what was dug since its last scan. Private to
/// the project.

namespace excavplan {

/// The site of a job with the digs that no scan has shown yet: where a scan does not see what was
/// dug, it stays as foretold.
class JobGround {
 public:
  /// Opens the site of a folder.
  JobGround(const std::string& folder, const JobSettings& settings);

  const Site& site() const { return site_; }
  const Terrain& expected() const { return expected_; }
  /// When each cell was last seen as it is now, since 1970-01-01 UTC [s]; NaN: never, or dug since.
  const Eigen::ArrayXXd& seen() const { return seen_; }
  /// Digs since the last scan, in their order.
  const std::vector<JobStep>& unseen() const { return unseen_; }

  /// The dig as the simulator foretells it, with the edge so far above the path [m].
  void expect(const JobStep& dig, double height_bias);
  /// Takes in a scan of the ground.
  /// @return the median of how far the cuts since the last scan lie above where they were expected
  /// [m], over cells without loose soil; nothing of too few
  std::optional<double> take_in(const SiteEvent& event);

  /// Writes the ground at the last scan. @param number  of the site's updates
  void save(long long number) const;
  /// Goes on from what was written at that scan. A later one of the site, whose job was not written
  /// any more, is taken back.
  void load(long long number);
  /// Of the last scan taken in.
  const std::vector<Warning>& warnings() const { return warnings_; }

 private:
  std::string file_of(long long number) const;
  void begin_at_scan();

  std::string folder_;
  const JobSettings& settings_;
  Site site_;
  GroundState scanned_;  ///< at the last scan, on the grid of the first
  Terrain expected_;     ///< with what was dug since
  Eigen::ArrayXXd seen_;
  std::vector<JobStep> unseen_;
  double kept_ = 0.0;  ///< loose, in the bucket, of digs since the last scan [m^3]
  std::vector<Warning> warnings_;
};

}  // namespace excavplan
