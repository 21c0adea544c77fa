// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/robot/job_session.hpp>

/// @file
/// The action of a node that does a step of a job, without its middleware (docs/ros.md#jobs).

namespace excavplan {

/// What is shown of a goal while it goes on.
struct StepFeedback {
  std::string state;        ///< "planning", then as describe(JobSession)
  long long step = 0;       ///< 0: not yet known
  std::string what;         ///< as name(JobAction); empty: not yet known
  double share_done = 0.0;  ///< of the design's volume, in 0 .. 1
};

/// What a goal ends with.
struct StepAnswer {
  bool success = false;           ///< the step is done, or the job is finished
  std::string message;            ///< why not
  long long step = 0;             ///< 0: not known
  std::string what;               ///< as name(JobAction)
  bool trustworthy = false;       ///< of the step, and of its scan
  bool finished = false;          ///< the job has ended, its ground within the tolerance
  std::vector<Warning> warnings;  ///< of the step, and of its scan
  std::string json;               ///< of the step
  std::string progress_json;      ///< of the job
};

/// How a goal ends.
enum class StepEnd { succeeded, aborted, cancelled };

/// What a node sends, and what it is asked for.
struct StepPort {
  std::function<void()> take_joints;  ///< hands joint states that wait to take(); may throw nothing
  /// Likewise goals and cancels to abandon(), begin() and cancel(). Called before a motion is sent.
  std::function<void()> take_requests;
  std::function<std::optional<std::int64_t>()> now;     ///< as of JobSession::plan()
  std::function<void(const std::string&)> step;         ///< as JSON, before it is driven
  std::function<void(const JointMotion&)> trajectory;   ///< of the step, for a controller
  std::function<void(const StepFeedback&)> feedback;    ///< of the goal
  std::function<void(StepEnd, const StepAnswer&)> end;  ///< of the goal
};

/// One goal at a time does one step: it plans, sends the trajectory if the step may be driven,
/// waits for report(), collects the scan if the step asks for one, and ends.
class StepAction {
 public:
  /// @throws Error as JobSession()
  StepAction(JobSessionSettings settings, StepPort port);

  /// A goal was accepted, and no other is active. One that comes within the call, by
  /// StepPort::take_requests, is planned for in that.
  void begin();
  /// Another goal came: the active one, if there is one, is aborted as by cancel().
  void abandon();
  /// The goal was cancelled: a trajectory without points is sent, the step stays as it is.
  void cancel();
  /// With or without a goal. @throws Error as JobSession::report() and finish()
  void report(const MotionReport& report);
  /// As JobSession::take(). @throws Error likewise, and as JobSession::finish(), which ends the
  /// goal
  void take(const RobotMessage& message);
  /// To be called ten times a second: ends a scan whose transforms do not come.
  /// @throws Error as take()
  void poll();

  const JobSession& session() const { return session_; }  ///< of the job

 private:
  void do_step();
  std::optional<SessionStep> planned_step();
  void give_up(StepEnd how, const std::string& why);
  void go_on();
  void show(const std::string& state);
  void end(StepEnd how, const std::string& message = {});

  JobSession session_;
  StepPort port_;
  bool is_active_ = false;    // a goal
  bool is_planning_ = false;  // within begin()
  long long goals_ = 0;       // so far
  std::string shown_;         // of its states, the last
  StepAnswer answer_;
};

/// A report of the fields of StepDone.srv, in which a list without a number is not known.
template <typename Request>
MotionReport report_of(const Request& request) {
  const auto number = [](const auto& list, const char* name) {
    if (list.size() > 1) throw Error(ErrorKind::bad_input, std::string(name) + ": more than one");
    return list.empty() ? std::nullopt : std::optional<double>(list[0]);
  };
  MotionReport report;
  report.step = request.step;
  report.stalled = request.stalled;
  report.payload_mass = number(request.payload_kg, "payload_kg");
  report.joint_work = number(request.energy_kj, "energy_kj");
  if (report.joint_work) *report.joint_work *= 1000.0;
  if (request.base.empty()) return report;
  if (request.base.size() != 3) {
    throw Error(ErrorKind::bad_input, "base: must be x, y and heading, or empty");
  }
  report.base = BasePose{request.base[0], request.base[1], 0.0, request.base[2]};
  return report;
}

/// The feedback of DoStep.action.
template <typename Feedback>
void fill_feedback(const StepFeedback& shown, Feedback& feedback) {
  feedback.state = shown.state;
  feedback.step = shown.step;
  feedback.what = shown.what;
  feedback.share_done = shown.share_done;
}

/// The result of DoStep.action, but for its warnings.
template <typename Result>
void fill_result(const StepAnswer& answer, Result& result) {
  result.success = answer.success;
  result.message = answer.message;
  result.step = answer.step;
  result.what = answer.what;
  result.trustworthy = answer.trustworthy;
  result.finished = answer.finished;
  result.json = answer.json;
  result.progress_json = answer.progress_json;
}

}  // namespace excavplan
