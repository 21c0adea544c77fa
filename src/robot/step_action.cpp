// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/robot/step_action.hpp>

#include <algorithm>
#include <utility>

#include <excavplan/results/result_json.hpp>

namespace excavplan {
namespace {

double share_done(const JobProgress& progress) {
  if (progress.is_finished || !(progress.design_volume > 0.0)) return progress.is_finished;
  return std::clamp(1.0 - progress.left_volume / progress.design_volume, 0.0, 1.0);
}

JointMotion without_points(const Machine& machine) {
  JointMotion motion;
  for (const RobotJoint& joint : machine.robot_joints) motion.names.push_back(joint.name);
  return motion;
}

/// Why a step may not be driven.
std::string doubts_of(const SessionStep& step) {
  std::string text = "the step is not to be driven";
  for (const Warning& each : step.step.warnings) {
    if (!each.ends_trust && each.code != WarningCode::posture_unknown) continue;
    text += "; " + code_text(each.code) + ": " + each.message;
  }
  return text;
}

}  // namespace

StepAction::StepAction(JobSessionSettings settings, StepPort port)
    : session_(std::move(settings)), port_(std::move(port)) {}

void StepAction::begin() {
  is_active_ = true;
  ++goals_;
  answer_ = {};
  shown_.clear();
  show("planning");
  if (is_planning_) return;
  is_planning_ = true;
  try {
    do_step();
  } catch (const std::exception& error) {
    session_.leave();
    end(StepEnd::aborted, error.what());
  }
  is_planning_ = false;
}

/// Nothing if the goal was given up meanwhile. For another one that came meanwhile it plans anew.
std::optional<SessionStep> StepAction::planned_step() {
  for (;;) {
    const long long goal = goals_;
    port_.take_joints();
    SessionStep planned = session_.plan(port_.now());
    port_.take_joints();
    session_.confirm_start(planned, port_.now());
    port_.take_requests();
    if (!is_active_) return std::nullopt;
    if (goal == goals_) return planned;
  }
}

void StepAction::do_step() {
  const std::optional<SessionStep> planned = planned_step();
  if (!planned) return;
  const JobStep& step = planned->step;
  const bool may = may_be_driven(*planned);
  answer_ = {false, "", step.id, name(step.what), step.trustworthy, false, step.warnings, "", ""};
  answer_.finished = step.ends_finished();
  answer_.json = to_json(*planned);
  port_.step(answer_.json);
  port_.trajectory(may && step.moves_front() ? planned->motion
                                             : without_points(session_.machine()));
  if (step.what == JobAction::stop) {
    return answer_.finished ? end(StepEnd::succeeded) : end(StepEnd::aborted, step.reason);
  }
  if (!may) return end(StepEnd::aborted, doubts_of(*planned));
  show(describe(session_));
}

void StepAction::abandon() { give_up(StepEnd::aborted, "another goal came"); }
void StepAction::cancel() { give_up(StepEnd::cancelled, "cancelled"); }

void StepAction::give_up(StepEnd how, const std::string& why) {
  if (!is_active_) return;
  session_.leave();
  port_.trajectory(without_points(session_.machine()));
  end(how, why + ": the step stays as it is");
}

void StepAction::report(const MotionReport& report) {
  session_.report(report, port_.now());
  go_on();
}

void StepAction::take(const RobotMessage& message) {
  session_.take(message);
  poll();
}

void StepAction::poll() {
  if (session_.stage() == SessionStage::scanning) go_on();
}

/// Ends the step if it can.
void StepAction::go_on() {
  if (session_.stage() == SessionStage::scanning) show(describe(session_));
  try {
    const auto outcome = session_.finish(port_.now());
    if (!outcome) return;
    const auto& more = outcome->warnings;
    answer_.step = outcome->step.id;
    answer_.what = name(outcome->step.what);
    answer_.warnings.insert(answer_.warnings.end(), more.begin(), more.end());
    if (any_ends_trust(more)) answer_.trustworthy = false;
    end(StepEnd::succeeded);
  } catch (const std::exception& error) {
    end(StepEnd::aborted, std::string(error.what()) + ": the step is to be reported again");
    throw;
  }
}

/// Of the goal, when it changes.
void StepAction::show(const std::string& state) {
  if (!is_active_ || state == shown_) return;
  shown_ = state;
  port_.feedback({state, answer_.step, answer_.what, share_done(session_.progress())});
}

void StepAction::end(StepEnd how, const std::string& message) {
  if (!is_active_) return;
  is_active_ = false;
  const JobProgress progress = session_.progress();
  answer_.success = how == StepEnd::succeeded;
  answer_.message = message;
  answer_.progress_json = to_json(progress);
  port_.end(how, answer_);
}

}  // namespace excavplan
