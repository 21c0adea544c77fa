// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <excavplan/planning/rehearsal.hpp>
#include <excavplan/sensing/scene.hpp>

#include "figures/change_figure.hpp"
#include "report/report.hpp"

/// @file
/// The pages about digs.

namespace excavplan {

/// What was measured of a dig.
Report survey_report(const ChangeSheet& sheet);

/// A simulated dig. @param scene  with the history of its dig
Report scene_report(const Machine& machine, const DigScene& scene);

/// A plan. @param dig  by rehearse(); without one, only the ground
Report plan_report(const Machine& machine, const DigPlan& plan, const PlanSite& site,
                   const std::optional<DigResult>& dig);

}  // namespace excavplan
