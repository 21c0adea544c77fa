// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/job/job_settings.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/simulation/dig_along.hpp>
#include <excavplan/simulation/soil_simulator.hpp>
#include <excavplan/site/site.hpp>

#include "ground/grid_cells.hpp"

/// @file
/// The ground of a job: as a site remembers it, and what was dug since its last scan. Private to
/// the project.

namespace excavplan {

/// The ground before the job.
inline constexpr const char* first_ground_file = "job-first-ground.tif";

/// What a scan tells besides the ground.
struct ScanNews {
  /// Median of how far the cuts since the last scan lie above where they were expected [m]; nothing
  /// of too few cells.
  std::optional<double> cut_off;
  double cut_sd = 0.0;                 ///< of that, by what the scan's points share [m]
  std::optional<Alignment> alignment;  ///< SiteUpdate
  bool taken = false;                  ///< likewise
};

/// A dig of a job to its end: where the soil as told would stall it, in one as much softer as lets
/// it through. @param swung  of the front from the tracks [rad]
DigResult whole_dig(const JobSettings& settings, const Terrain& ground, const DigLine& line,
                    const DigPath& path, double swung);

/// What was dug and dumped since the last scan.
struct UnseenDigs {
  const std::vector<JobStep>& steps;  ///< in their order
  double height_bias;                 ///< of the edge over where it should be [m]
};

/// The site of a job with the digs that no scan has shown yet: where a scan does not see what was
/// dug, it stays as foretold.
class JobGround {
 public:
  /// Opens the site of a folder. @param access  read: for load(), expect() and what they tell
  JobGround(const std::string& folder, const JobSettings& settings,
            SiteAccess access = SiteAccess::of_job);

  const Site& site() const { return site_; }
  const Terrain& expected() const { return expected_; }
  /// When each cell was last seen as it is now, since 1970-01-01 UTC [s]; NaN: never, or dug since.
  const Eigen::ArrayXXd& seen() const { return seen_; }
  /// One scan is not enough for the tolerance, as its sensor is stated to err.
  bool is_noisy() const;
  /// Deviation of expected(), if scans are noisy and one has told it; else 0 [m].
  double sd_at(Cell at) const;
  /// Digs and dumps since the last scan, in their order.
  const std::vector<JobStep>& unseen() const { return unseen_; }
  /// @param kind  of these alone
  std::size_t unseen_digs(std::optional<JobAction> kind = {}) const;

  /// What the simulator foretells of a step, with the edge so far above the path [m].
  void expect(const JobStep& step, double height_bias);
  /// Takes in a scan of the ground.
  ScanNews take_in(const SiteEvent& scanned);

  /// Writes the ground at the last scan. @param number  of such files; the last two are kept
  void save(long long number) const;
  /// Goes on from what was written at that scan. A later one of the site, whose job was not written
  /// yet or any more, is taken back, or left alone by one who only reads.
  /// @param updates  that the site had taken in
  /// @param since  expected on it
  /// @throws Error (bad_file) if the site has taken in others
  void load(long long number, long long updates, const UnseenDigs& since);
  /// Whether load() would find what it reads.
  bool can_load(long long number, long long updates) const;
  /// Takes the first scan back, as no job begins with it.
  void forget() noexcept;
  /// Of the last scan taken in.
  const std::vector<Warning>& warnings() const { return warnings_; }

 private:
  void dig(const JobStep& step, double height_bias);
  void heap(const JobStep& step, double volume);
  ScanNews take_in_noisy(const SiteEvent& event, const SiteUpdate& update);
  void doubt_changed(const Eigen::ArrayXXd& before);
  std::string file_of(long long number) const;
  void begin_at_scan();

  std::string folder_;
  const JobSettings& settings_;
  SiteAccess access_;
  Site site_;
  GroundState scanned_;  ///< at the last scan, on the grid of the first
  Terrain expected_;     ///< with what was dug since
  Eigen::ArrayXXd seen_;
  Eigen::ArrayXXd sd_;  ///< of `expected_`, where scans are noisy; NaN: seen by the first alone [m]
  std::vector<JobStep> unseen_;
  std::vector<Warning> warnings_;
};

}  // namespace excavplan
