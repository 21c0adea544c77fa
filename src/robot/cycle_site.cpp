// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/cycle_site.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <excavplan/simulation/dig_ground.hpp>

#include "base/check.hpp"
#include "base/text.hpp"
#include "robot/live_scan.hpp"

namespace excavplan {
namespace {

SiteSettings site_settings(const DigCycleSettings& settings) {
  return {settings.soil, settings.machine, settings.law, settings.estimate.cell_size,
          settings.site_frame};
}

}  // namespace

BasePose base_on_site(const DigCycleSettings& settings) {
  if (settings.site_frame.empty()) return {};
  constexpr double most_tilt = 0.01;  // ours: 7 cm at the dig [rad]
  const Eigen::Isometry3d pose = Eigen::Isometry3d(settings.site_from_scan).inverse();
  const double tilt = std::acos(std::clamp(pose.linear()(2, 2), -1.0, 1.0));
  require(tilt <= most_tilt, "site_from_scan: the machine stands tilted on the site [rad]", tilt,
          "at most " + plain_number(most_tilt));
  const Eigen::Vector3d& at = pose.translation();
  return {at.x(), at.y(), at.z(), std::atan2(pose.linear()(1, 0), pose.linear()(0, 0))};
}

CycleSite::CycleSite(const DigCycleSettings& settings)
    : base_(base_on_site(settings)),
      site_(settings.site, site_settings(settings), SiteAccess::write) {}

Scan CycleSite::in_site(Scan scan) const {
  if (base_.is_origin()) return scan;
  Scan moved = without_machine(std::move(scan));
  moved.site_from_scan = base_.site_from_machine().matrix() * moved.site_from_scan;
  return moved;
}

void CycleSite::begin_dig() { was_current_ = std::exchange(is_current_, false); }

std::vector<Warning> CycleSite::look_around(const GroundScan& seen) {
  SiteEvent event;
  event.scan = in_site(seen.scan);
  event.dug = false;
  event.time = seen.time;
  event.base = base_;
  const SiteUpdate update = site_.update(event);
  is_current_ = update.taken;
  return update.warnings;
}

SiteUpdate CycleSite::survey(SiteEvent event, const std::optional<GroundScan>& before) {
  event.base = base_;
  event.scan = in_site(std::move(event.scan));
  std::vector<Warning> earlier;
  if (before && site_.is_empty()) {
    event.before = in_site(before->scan);
  } else if (before) {
    earlier = look_around({before->scan, std::min(before->time, event.time)});
    was_current_ = is_current_;
  }
  SiteUpdate update = site_.update(event);
  update.warnings.insert(update.warnings.begin(), earlier.begin(), earlier.end());
  is_current_ = update.taken;
  return update;
}

SitePlan CycleSite::plan(const PlanOptions& options, const GroundDensity& density,
                         const std::optional<Terrain>& present) const {
  return plan_on_site(site_, {base_, options, density, present});
}

Terrain CycleSite::around() const {
  const Machine& machine = site_.settings().machine;
  return site_.ground_for(base_, swing_extent(machine), usual_cell(machine)).terrain;
}

HeightMap CycleSite::at_tracks() const {
  const Machine& machine = site_.settings().machine;
  return site_.ground_for(base_, standing_extent(machine), 2.0 * usual_cell(machine))
      .terrain.highest();
}

}  // namespace excavplan
