// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// A job as a node of ROS 1 (docs/ros.md#jobs): an action that does one step, by StepAction.

#include <actionlib/server/simple_action_server.h>

#include <excavplan/robot/step_action.hpp>

#include <excavplan_ros/DoStepAction.h>
#include <excavplan_ros/StepDone.h>

#include "node_parts.hpp"
#include "parameters.hpp"

namespace excavplan_ros {
namespace {

class JobNode {
 public:
  JobNode(ros::NodeHandle topics, ros::NodeHandle own)
      : step_(own.advertise<std_msgs::String>("step", 1, true)),
        trajectory_(own.advertise<trajectory_msgs::JointTrajectory>("trajectory", 1)),
        server_(with_queue(own, requests_), "do_step", false),
        action_(job_settings_of(own), port()),
        robot_(topics, [this](const excavplan::RobotMessage& message) { take(message); }) {
    service_ = own.advertiseService("step_done", &JobNode::step_done, this);
    server_.start();
  }

  void spin() {
    robot_.spin([this] {
      take_requests();
      error_of([&] { action_.poll(); });
    });
  }

 private:
  static ros::NodeHandle with_queue(ros::NodeHandle own, ros::CallbackQueue& queue) {
    own.setCallbackQueue(&queue);
    return own;
  }

  /// Goals and cancels that wait. They are in a queue of their own, so that they can be taken while
  /// a step is planned.
  void take_requests() {
    requests_.callAvailable();
    if (server_.isNewGoalAvailable()) {
      action_.abandon();
      server_.acceptNewGoal();
      action_.begin();
    }
    if (server_.isPreemptRequested()) action_.cancel();
  }

  void take(const excavplan::RobotMessage& message) {
    error_of([&] { action_.take(message); });
    const excavplan::JobSession& session = action_.session();
    if (early_.are_news(session)) ROS_WARN("%s", excavplan::early_text(session).c_str());
  }

  excavplan::StepPort port() {
    excavplan::StepPort port;
    port.take_joints = [this] { robot_.take_joints(); };
    port.take_requests = [this] { take_requests(); };
    port.now = [] { return time_now(); };
    port.step = [this](const std::string& json) { step_.publish(text_message(json)); };
    port.trajectory = [this](const excavplan::JointMotion& motion) {
      trajectory_.publish(message_of(motion));
    };
    port.feedback = [this](const excavplan::StepFeedback& shown) {
      DoStepFeedback feedback;
      fill_feedback(shown, feedback);
      server_.publishFeedback(feedback);
    };
    port.end = [this](excavplan::StepEnd how, const excavplan::StepAnswer& answer) {
      DoStepResult result;
      fill_result(answer, result);
      result.warnings = told(answer.warnings);
      end(how, result);
    };
    return port;
  }

  void end(excavplan::StepEnd how, const DoStepResult& result) {
    switch (how) {
      case excavplan::StepEnd::succeeded:
        return server_.setSucceeded(result);
      case excavplan::StepEnd::aborted:
        ROS_ERROR("%s", result.message.c_str());
        return server_.setAborted(result, result.message);
      case excavplan::StepEnd::cancelled:
        return server_.setPreempted(result, result.message);
    }
  }

  bool step_done(StepDone::Request& request, StepDone::Response& response) {
    response.message = error_of([&] { action_.report(excavplan::report_of(request)); });
    response.success = response.message.empty();
    return true;
  }

  ros::Publisher step_, trajectory_;
  ros::CallbackQueue requests_;
  actionlib::SimpleActionServer<DoStepAction> server_;
  excavplan::StepAction action_;
  RobotListener robot_;
  excavplan::EarlyPoints early_;
  ros::ServiceServer service_;
};

}  // namespace
}  // namespace excavplan_ros

int main(int argc, char** argv) {
  return excavplan_ros::run_node<excavplan_ros::JobNode>(argc, argv, "excavplan_job");
}
