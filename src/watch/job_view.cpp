// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/watch/job_view.hpp>

#include <sys/stat.h>

#include <array>
#include <cmath>
#include <utility>

#include <excavplan/base/error.hpp>
#include <excavplan/ground/ground_state.hpp>

#include "job/job_ground.hpp"
#include "job/job_log.hpp"
#include "job/job_map.hpp"
#include "job/job_record.hpp"
#include "watch/settled.hpp"

namespace excavplan {
namespace {

/// Of a file that is replaced whole: another one has another.
using FileStamp = std::array<long long, 4>;
FileStamp stamp_of(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return {};
  return {static_cast<long long>(status.st_ino), status.st_size, status.st_mtim.tv_sec,
          status.st_mtim.tv_nsec};
}

/// Of a number of which the logarithm is learnt.
Measured factor_of(const LearntNumber& logarithm) {
  const double mean = std::exp(logarithm.mean);
  return {mean, mean * logarithm.sd()};
}

}  // namespace

struct JobView::State {
  std::string folder;
  JobSettings settings;
  GroundState first;
  JobMap map;
  Eigen::ArrayXXd design;  ///< JobMap::target as told
  JobRecord record = {};
  Terrain ground = {};
  JobProgress progress = {};
  std::optional<JobLog> log = {};
  int rewritten = 0;
  FileStamp stamp = {};

  JobLog new_log(const JobRecord& of) const {
    HeightMap target = map.target;
    target.z = design;
    return {folder, history_start(settings.design, target, first, of.progress.design_volume)};
  }
  /// As another process expects it.
  JobGround ground_of(const JobRecord& of) const {
    JobGround expected(folder, settings, SiteAccess::read);
    expected.load(of.grounds, of.site_updates, {of.unseen, of.learning.height_bias.mean});
    return expected;
  }
  void read(const FileStamp& at) {
    JobRecord now = load_record(folder);
    const JobGround expected = ground_of(now);
    const bool is_new = !log || !log->follow(now);
    if (is_new) {
      JobLog anew = new_log(now);
      anew.follow(now);
      if (log) ++rewritten;
      log.emplace(std::move(anew));
    }
    record = std::move(now);
    if (!settings.surface.hangs_on_scan)
      map.target.z = raised(design, map.target, record.learning.datum.plane());
    ground = expected.expected();
    progress = measured(record.progress, map, {ground, expected.seen()}, settings.design.tolerance);
    stamp = at;
  }
};

JobView::JobView(const std::string& folder, JobSettings settings) {
  require_job_settings(settings);
  if (!holds_record(folder)) {
    throw Error(ErrorKind::bad_file, folder + ": holds no job: it has no " + job_file);
  }
  GroundState first = load_ground(folder + '/' + first_ground_file);
  JobMap map = map_of(settings, first.terrain.bank);
  Eigen::ArrayXXd design = map.target.z;
  state_ = std::make_unique<State>(
      State{folder, std::move(settings), std::move(first), std::move(map), std::move(design)});
  refresh();
}
JobView::~JobView() = default;
JobView::JobView(JobView&&) noexcept = default;
JobView& JobView::operator=(JobView&&) noexcept = default;

bool JobView::refresh() {
  const auto stamp = [&] { return stamp_of(state_->folder + '/' + job_file); };
  if (state_->log && stamp() == state_->stamp) return false;
  read_settled(stamp, [&](const FileStamp& at) { state_->read(at); });
  return true;
}

const JobSettings& JobView::settings() const { return state_->settings; }
const JobHistory& JobView::history() const { return state_->log->history(); }
int JobView::rewritten() const { return state_->rewritten; }
const JobProgress& JobView::progress() const { return state_->progress; }
const Terrain& JobView::ground() const { return state_->ground; }
const std::optional<JobStep>& JobView::present() const { return state_->record.present; }

JobBelief JobView::belief() const {
  const JobLearning& learnt = state_->record.learning;
  return {factor_of(learnt.strength),
          factor_of(learnt.payload),
          factor_of(learnt.energy),
          {learnt.height_bias.mean, learnt.height_bias.sd()}};
}

}  // namespace excavplan
