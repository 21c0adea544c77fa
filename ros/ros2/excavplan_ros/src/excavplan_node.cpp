// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The dig cycle as a node of ROS 2 (docs/ros.md): topics to DigCycleSession, its answers to topics
/// and services. Checked for syntax only: Debian has no rclcpp.

#include <limits>
#include <optional>

#include <std_msgs/msg/bool.hpp>

#include <excavplan_ros/srv/dig_and_plan.hpp>
#include <excavplan_ros/srv/estimate.hpp>
#include <excavplan_ros/srv/plan.hpp>

#include "node_parts.hpp"
#include "parameters.hpp"

namespace {

using excavplan::CycleEstimate;
using excavplan::CyclePlan;
using excavplan_ros::JointTrajectory;
using excavplan_ros::message_of;
using excavplan_ros::String;
using excavplan_ros::text_message;
using excavplan_ros::srv::DigAndPlan;
using excavplan_ros::srv::Estimate;
using excavplan_ros::srv::Plan;
using std_msgs::msg::Bool;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

excavplan::NodeSettings settings_of(rclcpp::Node& node) {
  excavplan_ros::Parameters parameters(node);
  return excavplan::settings_of(parameters);
}

class ExcavplanNode : public rclcpp::Node {
 public:
  ExcavplanNode()
      : Node("excavplan"),
        settings_(settings_of(*this)),
        session_(settings_.session),
        robot_(*this, [this](const excavplan::RobotMessage& message) { take(message); }) {
    const rclcpp::QoS latched = rclcpp::QoS(1).transient_local();
    state_ = create_publisher<String>("~/state", latched);
    estimate_ = create_publisher<String>("~/estimate_result", latched);
    plan_ = create_publisher<String>("~/plan_result", latched);
    trajectory_ = create_publisher<JointTrajectory>("~/trajectory", rclcpp::QoS(1));
    mark("start_dig", [this] { session_.start_dig(time_now()); });
    mark("end_dig", [this] { session_.end_dig(time_now()); });
    serve<Estimate>("~/estimate", [this](Estimate::Response& answer) { fill(answer); });
    serve<Plan>("~/plan", [this](Plan::Response& answer) { answer_plan(answer); });
    serve<DigAndPlan>("~/dig_and_plan", [this](DigAndPlan::Response& answer) { fill(answer); });
    tell_state();
  }

  void go_on() { robot_.take_joints(); }

 private:
  std::optional<std::int64_t> time_now() const { return excavplan_ros::time_now(*this); }

  template <typename Work>
  std::string error_of(const Work& work) {
    return excavplan_ros::error_of(*this, work);
  }

  void take(const excavplan::RobotMessage& message) {
    error_of([&] { session_.take(message); });
    tell_state();
  }

  template <typename Work>
  void mark(const std::string& topic, const Work& work) {
    const auto take = [this, work](const Bool& message) {
      if (message.data) error_of(work);
      tell_state();
    };
    subscriptions_.push_back(create_subscription<Bool>(topic, rclcpp::QoS(10), take));
  }

  template <typename Kind, typename Fill>
  void serve(const std::string& name, const Fill& fill) {
    const auto answer = [fill](std::shared_ptr<typename Kind::Request>,
                               std::shared_ptr<typename Kind::Response> response) {
      fill(*response);
    };
    services_.push_back(create_service<Kind>(name, answer));
  }

  void tell_state() {
    const std::string state = describe(session_);
    if (state != told_state_) state_->publish(text_message(state));
    told_state_ = state;
    if (early_.are_news(session_)) {
      RCLCPP_WARN(get_logger(), "%s", excavplan::early_text(session_).c_str());
    }
  }

  void fill(Estimate::Response& response) {
    response.success = response.trustworthy = false;
    response.density_percent = response.density_sd_percent = response.bulking_factor = unknown;
    response.message = error_of([&] {
      const CycleEstimate answer = session_.estimate();
      fill_estimate(answer, response);
      excavplan_ros::tell(*this, answer.warnings, response.warnings);
      estimate_->publish(text_message(response.json));
    });
  }

  void fill(DigAndPlan::Response& response) {
    response.estimate_message = error_of([&] {
      const CycleEstimate answer = session_.estimate();
      response.estimate_json = to_json(answer);
      excavplan_ros::tell(*this, answer.warnings, response.warnings);
      estimate_->publish(text_message(response.estimate_json));
    });
    answer_plan(response);
  }

  /// What Plan and DigAndPlan have in common.
  template <typename Response>
  void answer_plan(Response& response) {
    response.success = response.trustworthy = response.previous_density = false;
    const std::string error = error_of([&] {
      robot_.take_joints();
      CyclePlan answer = session_.plan(time_now());
      robot_.take_joints();
      session_.confirm_start(answer, time_now());
      excavplan::fill_plan(answer, response);
      response.trajectory = message_of(answer.motion);
      excavplan_ros::tell(*this, answer.warnings, response.warnings);
      plan_->publish(text_message(response.json));
      trajectory_->publish(
          message_of(settings_.send_doubtful ? answer.motion : safe_motion(answer)));
    });
    if (!error.empty()) response.message = error;
  }

  excavplan::NodeSettings settings_;
  excavplan::DigCycleSession session_;
  std::string told_state_;
  excavplan::EarlyPoints early_;
  rclcpp::Publisher<String>::SharedPtr state_, estimate_, plan_;
  rclcpp::Publisher<JointTrajectory>::SharedPtr trajectory_;
  excavplan_ros::RobotListener robot_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
  std::vector<rclcpp::ServiceBase::SharedPtr> services_;
};

}  // namespace

int main(int argc, char** argv) {
  return excavplan_ros::run_node<ExcavplanNode>(argc, argv, "excavplan_node");
}
