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

/// A dig that was done since the last scan.
struct UnseenDig {
  JobStep step;
  bool stalled = false;
};

class JobGround {
 public:
  /// Opens the site of a folder, whose first scan was taken in.
  JobGround(const std::string& folder, const JobSettings& settings);

  const Site& site() const { return site_; }
  const Terrain& expected() const { return expected_; }
  const std::vector<UnseenDig>& unseen() const { return unseen_; }

  /// The dig as the simulator foretells it, with the edge so far above the path [m].
  void expect(const UnseenDig& dig, double height_bias);
  /// Takes in a scan of the ground. Not if the site took it in already (SiteEvent of a step that
  /// was told twice).
  /// @return the median of how far the cuts since the last scan lie above where they were expected
  /// [m], over cells without loose soil; nothing of too few
  std::optional<double> take_in(const SiteEvent& event);

 private:
  void begin_anew();

  const JobSettings& settings_;
  Site site_;
  Terrain expected_;
  std::vector<UnseenDig> unseen_;
};

}  // namespace excavplan
