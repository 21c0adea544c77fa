// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <excavplan/planning/rehearsal.hpp>
#include <excavplan/sensing/scene.hpp>

namespace excavplan {

/// A dig that was simulated, with its history.
struct DugDig {
  const Machine& machine;
  const DigPath& path;
  const DigResult& dig;
  GroundProfile before, after;  ///< ground in the plane of the boom
  std::string title;            ///< of the files
};

/// "Dig in loam at 40.0 % relative density"
std::string scene_title(const DigScene& scene);
/// "Planned dig in loam at 40.0 % relative density"
std::string plan_title(const DigPlan& plan, const PlanSite& site);

}  // namespace excavplan
