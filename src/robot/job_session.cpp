// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/job_session.hpp>

#include <cmath>
#include <utility>

#include <excavplan/job/job_motion.hpp>
#include <excavplan/job/job_order.hpp>
#include <excavplan/job/site_job.hpp>
#include <excavplan/robot/dig_cycle_session.hpp>

#include "base/check.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "results/plan_results.hpp"
#include "robot/live_robot.hpp"

namespace excavplan {
namespace {

JobSettings named(JobSettings job, const JobSessionSettings& settings) {
  name_joints(settings.joint_names, job.site.machine.robot_joints, "joint_names: ");
  for (const RobotJoint& joint : job.site.machine.robot_joints) {
    require(!joint.name.empty(), "joint_names: a job needs one of each joint, the swing too");
  }
  return job;
}

LiveSettings live_settings(const Machine& machine, const JobSessionSettings& settings) {
  return {machine, settings.site_frame, settings.site_from_scan, settings.machine_in_view,
          settings.oldest_joints};
}

/// @param step  it is of
StepReport step_report(const MotionReport& told, const JobStep& step) {
  StepReport report;
  report.payload_mass = told.payload_mass;
  report.joint_work = told.joint_work;
  report.stalled = told.stalled;
  report.base = told.base;
  if (report.base) report.base->z = step.base.z;
  return report;
}

bool same(const StepReport& a, const StepReport& b) {
  if (a.base.has_value() != b.base.has_value()) return false;
  const bool same_base = !a.base || (a.base->x == b.base->x && a.base->y == b.base->y &&
                                     a.base->heading == b.base->heading);
  return same_base && a.payload_mass == b.payload_mass && a.joint_work == b.joint_work &&
         a.stalled == b.stalled;
}

}  // namespace

void check(const JobSessionSettings& settings) {
  require(!settings.folder.empty(), "folder: of the job is missing");
  require_in("scans", static_cast<double>(settings.scans), 1.0, DigCycleSession::most_scans);
  require(settings.oldest_joints > 0.0, "oldest_joints", settings.oldest_joints, "above 0");
  check(settings.motion);
}

bool may_be_driven(const SessionStep& step) {
  const bool begins_here = step.posture_known && !step.motion.points.empty();
  return step.step.trustworthy && (begins_here || !step.step.moves_front());
}

struct JobSession::State {
  State(JobSessionSettings given, JobSettings order)
      : settings(std::move(given)),
        job(SiteJob::resume(settings.folder, order)),
        driven(named(std::move(order), settings)),
        robot(live_settings(driven.site.machine, settings)) {}

  void add_motion(SessionStep& answer) const;
  void collect(LiveFrame points);
  bool may_settle() const;
  Scan scan(const BasePose& base);

  JobSessionSettings settings;
  SiteJob job;
  JobSettings driven;  ///< the order, with the joints as the settings name them
  LiveRobot robot;
  SessionStage stage = SessionStage::idle;
  std::optional<StepReport> reported;
  LiveTime ended;                 ///< when the motion did
  std::vector<LiveFrame> frames;  ///< of the scan
  LiveTime complete;              ///< when the last of them came
  std::size_t early = 0;          ///< messages of points from before the motion ended
};

void JobSession::State::add_motion(SessionStep& answer) const {
  JobStep& step = answer.step;
  const std::optional<FrontJoints> start = robot.start();
  answer.posture_known = start.has_value();
  if (!start) {
    step.warnings.emplace_back(WarningCode::posture_unknown,
                               robot.joint_problem({}) + ": from where the motion is to begin");
  } else if (const std::string moving = robot.moving_problem(); !moving.empty()) {
    step.warnings.emplace_back(WarningCode::not_standing, "the machine may be moving: " + moving);
  }
  const auto refuse = [&](const std::string& why) {
    step.warnings.emplace_back(WarningCode::no_motion, "the step has no motion: " + why);
  };
  try {
    const auto motion = motion_of(driven, job.ground(), step, settings.motion, start);
    if (const auto* blocked = std::get_if<BlockedWay>(&motion)) {
      return refuse("something is in the way: " + blocked->message);
    }
    const auto& timed = std::get<Trajectory>(motion);
    answer.motion = joint_motion(timed);
    add_new(timed.warnings, step.warnings);
  } catch (const Error& error) {
    refuse(error.what());
  }
}

void JobSession::State::collect(LiveFrame points) {
  if (points.measured && ended && *points.measured < *ended) {
    ++early;
    return;
  }
  frames.push_back(std::move(points));
  complete = robot.now();
}

/// Whether transforms and joint states of the scan are missing that may still come.
bool JobSession::State::may_settle() const {
  const LiveTime now = robot.now();
  if (!now || !complete || robot.is_settled(frames)) return false;
  return std::abs(seconds_between(*complete, *now)) < longest_wait;
}

/// In the frame of the site.
Scan JobSession::State::scan(const BasePose& base) {
  bool averaged = true;
  Scan seen = robot.scan_of(frames, "the scan", averaged);
  if (!seen.machine) return seen;
  seen.site_from_scan = base.site_from_machine().inverse().matrix();
  seen = without_machine(std::move(seen));
  seen.site_from_scan.setIdentity();
  return seen;
}

JobSession::JobSession(JobSessionSettings settings) {
  check(settings);
  JobSettings order = load_order(settings.folder);
  state_ = std::make_unique<State>(std::move(settings), std::move(order));
}
JobSession::~JobSession() = default;
JobSession::JobSession(JobSession&&) noexcept = default;
JobSession& JobSession::operator=(JobSession&&) noexcept = default;

void JobSession::take(const RobotMessage& message) {
  State& state = *state_;
  std::vector<LiveFrame>& frames = state.frames;
  std::optional<LiveFrame> points = state.robot.take(message);
  if (is_set_back(message, state.ended)) state.ended.reset();
  if (points && state.stage == SessionStage::scanning && frames.size() < state.settings.scans)
    state.collect(std::move(*points));
  if (frames.empty()) return;
  state.robot.settle(frames, false);
  state.robot.settle_postures(frames, false);
}

SessionStep JobSession::plan(std::optional<std::int64_t> time) {
  State& state = *state_;
  leave();
  state.robot.tell_time(time);
  SessionStep answer;
  answer.step = state.job.next();
  if (answer.step.moves_front()) state.add_motion(answer);
  if (any_ends_trust(answer.step.warnings)) answer.step.trustworthy = false;
  if (answer.step.what != JobAction::stop) state.stage = SessionStage::driving;
  return answer;
}

void JobSession::confirm_start(SessionStep& step, std::optional<std::int64_t> time) {
  const State& state = *state_;
  state_->robot.tell_time(time);
  if (step.motion.points.empty() || !step.posture_known) return;
  const std::string problem = state.robot.start_problem(step.motion);
  if (problem.empty()) return;
  step.step.trustworthy = false;
  step.step.warnings.emplace_back(
      WarningCode::start_left, "the machine may stand where the motion does not begin: " + problem);
}

void JobSession::report(const MotionReport& report, std::optional<std::int64_t> time) {
  State& state = *state_;
  const std::optional<JobStep> present = state.job.present();
  const std::string told = "the report is of step " + std::to_string(report.step);
  require(present.has_value(), told + ", and none is to be done: nothing is changed");
  require(present->id == report.step,
          told + ", the present one is " + std::to_string(present->id) + ": nothing is changed");
  require(present->what != JobAction::stop, told + ", the end of the job: nothing is changed");
  StepReport news = step_report(report, *present);
  require_report(*present, news);
  if (state.stage == SessionStage::scanning) {
    require(same(news, *state.reported),
            told +
                ", which was reported otherwise and whose scan is being collected: nothing is "
                "changed");
    return;
  }
  leave();
  state.robot.tell_time(time);
  state.reported = std::move(news);
  state.ended = time;
  if (present->what == JobAction::scan) state.stage = SessionStage::scanning;
}

std::optional<StepOutcome> JobSession::finish(std::optional<std::int64_t> time) {
  State& state = *state_;
  state.robot.tell_time(time);
  if (!state.reported) return {};
  const bool scans = state.stage == SessionStage::scanning;
  if (scans && (state.frames.size() < state.settings.scans || state.may_settle())) return {};
  StepOutcome outcome;
  StepReport report = *state.reported;
  try {
    outcome.step = *state.job.present();
    std::vector<LiveFrame> known = {LiveFrame()};
    known.front().time = state.robot.now().value_or(0);
    report.time = seconds_of(scans ? state.frames : known);
    if (scans) report.scan = state.scan(outcome.step.base);
    state.job.done(outcome.step.id, report);
  } catch (...) {
    leave();
    throw;
  }
  leave();
  if (scans) outcome.warnings = state.job.scan_warnings();
  outcome.progress = state.job.progress();
  return outcome;
}

void JobSession::leave() {
  state_->stage = SessionStage::idle;
  state_->reported.reset();
  state_->ended.reset();
  state_->frames.clear();
  state_->complete.reset();
  state_->early = 0;
}

SessionStage JobSession::stage() const { return state_->stage; }
std::size_t JobSession::scans() const { return state_->frames.size(); }
std::size_t JobSession::scans_wanted() const { return state_->settings.scans; }
std::size_t JobSession::early_scans() const { return state_->early; }
JobProgress JobSession::progress() const { return state_->job.progress(); }
const Machine& JobSession::machine() const { return state_->driven.site.machine; }

std::string describe(const JobSession& session) {
  switch (session.stage()) {
    case SessionStage::driving:
      return "driving";
    case SessionStage::scanning:
      return "scan " + scans_text(session.scans(), session.scans_wanted(), session.early_scans());
    default:
      return "idle";
  }
}

std::string to_json(const SessionStep& step) {
  Json json = job_step_json(step.step);
  json["trajectory_points"] = step.motion.points.size();
  json["warnings"] = warnings_json(step.step.warnings);
  return json_text(json);
}

}  // namespace excavplan
