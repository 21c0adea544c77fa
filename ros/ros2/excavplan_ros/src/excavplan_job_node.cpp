// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// A job as a node of ROS 2 (docs/ros.md#jobs): an action that does one step, by StepAction.
/// Checked for syntax only: Debian has no rclcpp.

#include <chrono>
#include <deque>
#include <memory>

#include <excavplan/robot/step_action.hpp>
#include <rclcpp_action/rclcpp_action.hpp>

#include <excavplan_ros/action/do_step.hpp>
#include <excavplan_ros/srv/step_done.hpp>

#include "node_parts.hpp"
#include "parameters.hpp"

namespace {

using excavplan_ros::JointTrajectory;
using excavplan_ros::String;
using excavplan_ros::action::DoStep;
using excavplan_ros::srv::StepDone;
using GoalHandle = rclcpp_action::ServerGoalHandle<DoStep>;

excavplan::JobSessionSettings settings_of(rclcpp::Node& node) {
  excavplan_ros::Parameters parameters(node);
  return excavplan::job_settings_of(parameters);
}

class ExcavplanJobNode : public rclcpp::Node {
 public:
  ExcavplanJobNode()
      : Node("excavplan_job"),
        step_(create_publisher<String>("~/step", rclcpp::QoS(1).transient_local())),
        trajectory_(create_publisher<JointTrajectory>("~/trajectory", rclcpp::QoS(1))),
        action_(settings_of(*this), port()),
        robot_(*this, [this](const excavplan::RobotMessage& message) { take(message); }) {
    service_ = create_service<StepDone>(
        "~/step_done", [this](std::shared_ptr<StepDone::Request> request,
                              std::shared_ptr<StepDone::Response> response) {
          response->message = excavplan_ros::error_of(
              *this, [&] { action_.report(excavplan::report_of(*request)); });
          response->success = response->message.empty();
        });
    request_group_ = create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive, false);
    request_executor_.add_callback_group(request_group_, get_node_base_interface());
    server_ = rclcpp_action::create_server<DoStep>(
        this, "~/do_step",
        [](const rclcpp_action::GoalUUID&, std::shared_ptr<const DoStep::Goal>) {
          return rclcpp_action::GoalResponse::ACCEPT_AND_EXECUTE;
        },
        [](std::shared_ptr<GoalHandle>) { return rclcpp_action::CancelResponse::ACCEPT; },
        [this](std::shared_ptr<GoalHandle> goal) { accepted_.push_back(goal); },
        rcl_action_server_get_default_options(), request_group_);
  }

  void go_on() {
    robot_.take_joints();
    take_requests();
    excavplan_ros::error_of(*this, [&] { action_.poll(); });
  }

 private:
  /// Goals and cancels that wait. They have an executor of their own, so that they can be taken
  /// while a step is planned; the step is planned outside of it, as no executor spins within
  /// itself.
  void take_requests() {
    request_executor_.spin_all(std::chrono::milliseconds(100));
    while (!accepted_.empty()) {
      action_.abandon();
      goal_ = accepted_.front();
      accepted_.pop_front();
      action_.begin();
    }
    if (goal_ && goal_->is_canceling()) action_.cancel();
  }

  void take(const excavplan::RobotMessage& message) {
    excavplan_ros::error_of(*this, [&] { action_.take(message); });
    const excavplan::JobSession& session = action_.session();
    if (early_.are_news(session)) {
      RCLCPP_WARN(get_logger(), "%s", excavplan::early_text(session).c_str());
    }
  }

  excavplan::StepPort port() {
    excavplan::StepPort port;
    port.take_joints = [this] { robot_.take_joints(); };
    port.take_requests = [this] { take_requests(); };
    port.now = [this] { return excavplan_ros::time_now(*this); };
    port.step = [this](const std::string& json) {
      step_->publish(excavplan_ros::text_message(json));
    };
    port.trajectory = [this](const excavplan::JointMotion& motion) {
      trajectory_->publish(excavplan_ros::message_of(motion));
    };
    port.feedback = [this](const excavplan::StepFeedback& shown) {
      const auto feedback = std::make_shared<DoStep::Feedback>();
      excavplan::fill_feedback(shown, *feedback);
      if (goal_->is_executing()) goal_->publish_feedback(feedback);
    };
    port.end = [this](excavplan::StepEnd how, const excavplan::StepAnswer& answer) {
      const auto result = std::make_shared<DoStep::Result>();
      excavplan::fill_result(answer, *result);
      excavplan_ros::tell(*this, answer.warnings, result->warnings);
      end(how, result);
    };
    return port;
  }

  void end(excavplan::StepEnd how, const std::shared_ptr<DoStep::Result>& result) {
    const std::shared_ptr<GoalHandle> goal = std::move(goal_);
    switch (how) {
      case excavplan::StepEnd::succeeded:
        return goal->succeed(result);
      case excavplan::StepEnd::aborted:
        RCLCPP_ERROR(get_logger(), "%s", result->message.c_str());
        return goal->abort(result);
      case excavplan::StepEnd::cancelled:
        return goal->canceled(result);
    }
  }

  rclcpp::Publisher<String>::SharedPtr step_;
  rclcpp::Publisher<JointTrajectory>::SharedPtr trajectory_;
  rclcpp::CallbackGroup::SharedPtr request_group_;
  rclcpp::executors::SingleThreadedExecutor request_executor_;
  std::deque<std::shared_ptr<GoalHandle>> accepted_;  // that did not begin yet
  std::shared_ptr<GoalHandle> goal_;                  // the active one
  excavplan::StepAction action_;
  excavplan_ros::RobotListener robot_;
  excavplan::EarlyPoints early_;
  rclcpp::Service<StepDone>::SharedPtr service_;
  rclcpp_action::Server<DoStep>::SharedPtr server_;
};

}  // namespace

int main(int argc, char** argv) {
  return excavplan_ros::run_node<ExcavplanJobNode>(argc, argv, "excavplan_job_node");
}
