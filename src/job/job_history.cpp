// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_history.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.hpp"
#include "ground/grid_cells.hpp"
#include "site/cell_codes.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;

ArrayXXd in_millimetres(const ArrayXXd& z) { return heights_of(millimetres_of(z)); }

bool same_size(const ArrayXXd& a, const ArrayXXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols();
}

bool differ(double a, double b) { return std::isnan(a) ? !std::isnan(b) : a != b; }

/// The smallest block that holds all changes.
CellPatch change(const ArrayXXd& before, const ArrayXXd& after) {
  Index row0 = after.rows(), row1 = -1, col0 = after.cols(), col1 = -1;
  for_each_cell(after, [&](Cell at) {
    if (!differ(before(at.row, at.col), after(at.row, at.col))) return;
    row0 = std::min(row0, at.row);
    row1 = std::max(row1, at.row);
    col0 = std::min(col0, at.col);
    col1 = std::max(col1, at.col);
  });
  if (row1 < 0) return {};
  return {row0, col0, after.block(row0, col0, row1 - row0 + 1, col1 - col0 + 1)};
}

void enter(const CellPatch& patch, ArrayXXd& layer) {
  if (patch.z.size() == 0) return;
  require(patch.row >= 0 && patch.col >= 0 && patch.row + patch.z.rows() <= layer.rows() &&
              patch.col + patch.z.cols() <= layer.cols(),
          "history of a job: a change lies beside its ground");
  layer.block(patch.row, patch.col, patch.z.rows(), patch.z.cols()) = patch.z;
}

void enter(const JobEvent& event, JobHistory::Ground& ground) {
  enter(event.surface, ground.surface.z);
  enter(event.seen_at, ground.seen_at);
}

}  // namespace

JobEvent event_of(const JobStep& step, const StepReport& report) {
  JobEvent event;
  event.what = step.what;
  event.step = step.id;
  event.at = report.time;
  event.time = step.predicted.time;
  event.energy = report.joint_work;
  event.payload_mass = report.payload_mass;
  event.predicted = step.predicted;
  event.base = report.base.value_or(step.base);
  event.dump = step.dump;
  event.keeps_load = step.keeps_load;
  event.truck = step.truck;
  event.stalled = report.stalled;
  event.scanned = report.scan.has_value();
  event.trustworthy = step.trustworthy;
  event.warnings = step.warnings;
  event.reason = step.reason;
  return event;
}

void JobHistory::play(const std::function<void(std::size_t, const Ground&)>& visit) const {
  Ground ground{before, seen_at};
  visit(0, ground);
  for (std::size_t i = 0; i < events.size(); ++i) {
    enter(events[i], ground);
    visit(i + 1, ground);
  }
}

JobHistory::Ground JobHistory::ground(std::size_t events_done) const {
  require(events_done <= events.size(), "history of a job: it has fewer events");
  Ground ground{before, seen_at};
  for (std::size_t i = 0; i < events_done; ++i) enter(events[i], ground);
  return ground;
}

JobRecorder::JobRecorder(JobHistory history) : history_(std::move(history)) {
  require(history_.events.empty(), "history of a job: it has begun");
  require(
      same_grid(history_.before, history_.target) && same_size(history_.seen_at, history_.before.z),
      "history of a job: its layers are not on one grid");
  history_.before.z = in_millimetres(history_.before.z);
  now_ = {history_.before, history_.seen_at};
}

void JobRecorder::add(JobEvent event, const JobHistory::Ground& after) {
  require(same_grid(after.surface, now_.surface) && same_size(after.seen_at, now_.seen_at),
          "history of a job: its ground after a step is on another grid");
  event.surface = change(now_.surface.z, in_millimetres(after.surface.z));
  event.seen_at = change(now_.seen_at, after.seen_at);
  add(std::move(event));
}

void JobRecorder::add(JobEvent event) {
  enter(event, now_);
  history_.events.push_back(std::move(event));
}

void JobRecorder::cut(std::size_t events) {
  if (events >= history_.events.size()) return;
  history_.events.resize(events);
  now_ = history_.ground(events);
}

}  // namespace excavplan
