// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/trial_history.hpp>

#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "ground/window.hpp"
#include "trial/scored_design.hpp"
#include "trial/seen_first.hpp"

namespace excavplan {
namespace {

constexpr double least_cell = 0.05;  // ours [m]

Eigen::Index coarsening(double cell) {
  return static_cast<Eigen::Index>(std::ceil(least_cell / cell - 1e-9));
}

JobHistory start(const HiddenSite& site, const ScoredDesign& design) {
  const HeightMap surface = site.ground.surface();
  const Eigen::Index by = coarsening(surface.cell_size);
  JobHistory history;
  history.design = site.known.job;
  history.design_volume = design.below(surface.z);
  history.target = coarser(design.height, by);
  history.before = coarser(surface, by);
  history.seen_at = middle_cells(seen_at_first(site, trial_begin), by);
  history.begin = trial_begin;
  return history;
}

}  // namespace

struct TrialRecorder::State {
  explicit State(const HiddenSite& site)
      : design(scored_design(site.known, site.ground.surface())), recorder(start(site, design)) {}
  ScoredDesign design;
  JobRecorder recorder;
};

TrialRecorder::TrialRecorder(const HiddenSite& site) : state_(std::make_unique<State>(site)) {}
TrialRecorder::~TrialRecorder() = default;
TrialRecorder::TrialRecorder(TrialRecorder&&) noexcept = default;
TrialRecorder& TrialRecorder::operator=(TrialRecorder&&) noexcept = default;

void TrialRecorder::add(const TrialStep& at) {
  require(at.site != nullptr, "history of a trial: the step has no ground");
  const HeightMap surface = at.site->ground().surface();
  JobEvent event = event_of(at.step, at.done.report);
  event.time = at.done.time;
  if (at.done.energy > 0.0) event.energy = at.done.energy;
  event.left_volume = state_->design.below(surface.z);
  const Eigen::Index by = coarsening(surface.cell_size);
  state_->recorder.add(std::move(event),
                       {coarser(surface, by), middle_cells(at.site->seen_at(), by)});
}

const JobHistory& TrialRecorder::history() const { return state_->recorder.history(); }

}  // namespace excavplan
