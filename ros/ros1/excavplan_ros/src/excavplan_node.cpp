// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The dig cycle as a node of ROS 1 (docs/ros.md): topics to DigCycleSession, its answers to topics
/// and services.

#include <limits>

#include <std_msgs/Bool.h>

#include <excavplan_ros/DigAndPlan.h>
#include <excavplan_ros/Estimate.h>
#include <excavplan_ros/Plan.h>

#include "node_parts.hpp"
#include "parameters.hpp"

namespace excavplan_ros {
namespace {

using excavplan::CycleEstimate;
using excavplan::CyclePlan;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class Node {
 public:
  Node(ros::NodeHandle topics, const ros::NodeHandle& own) : Node(topics, own, settings_of(own)) {}

  void spin() { robot_.spin(); }

 private:
  Node(ros::NodeHandle topics, const ros::NodeHandle& own, const excavplan::NodeSettings& settings)
      : session_(settings.session),
        send_doubtful_(settings.send_doubtful),
        topics_(topics),
        own_(own),
        robot_(topics, [this](const excavplan::RobotMessage& message) { take(message); }) {
    mark("start_dig", [this] { session_.start_dig(time_now()); });
    mark("end_dig", [this] { session_.end_dig(time_now()); });
    state_ = own_.advertise<std_msgs::String>("state", 1, true);
    estimate_ = own_.advertise<std_msgs::String>("estimate_result", 1, true);
    plan_ = own_.advertise<std_msgs::String>("plan_result", 1, true);
    trajectory_ = own_.advertise<trajectory_msgs::JointTrajectory>("trajectory", 1);
    services_ = {own_.advertiseService("estimate", &Node::estimate, this),
                 own_.advertiseService("plan", &Node::plan, this),
                 own_.advertiseService("dig_and_plan", &Node::dig_and_plan, this)};
    tell_state();
  }

  void take(const excavplan::RobotMessage& message) {
    error_of([&] { session_.take(message); });
    tell_state();
  }

  template <typename Work>
  void mark(const std::string& topic, const Work& work) {
    const boost::function<void(const std_msgs::Bool::ConstPtr&)> take =
        [this, work](const std_msgs::Bool::ConstPtr& message) {
          robot_.take_joints();  // which were received before it
          if (message->data) error_of(work);
          tell_state();
        };
    subscribers_.push_back(topics_.subscribe<std_msgs::Bool>(topic, 10, take));
  }

  /// "after 2 of 5", when it changes.
  void tell_state() {
    const std::string state = excavplan::describe(session_);
    if (state != told_state_) state_.publish(text_message(state));
    told_state_ = state;
    if (early_.are_news(session_)) ROS_WARN("%s", excavplan::early_text(session_).c_str());
  }

  CycleEstimate make_estimate() {
    CycleEstimate answer = session_.estimate();
    estimate_.publish(text_message(to_json(answer)));
    return answer;
  }

  CyclePlan make_plan() {
    robot_.take_joints();
    CyclePlan answer = session_.plan(time_now());
    robot_.take_joints();
    session_.confirm_start(answer, time_now());
    plan_.publish(text_message(to_json(answer)));
    trajectory_.publish(message_of(send_doubtful_ ? answer.motion : safe_motion(answer)));
    return answer;
  }

  /// What Plan and DigAndPlan have in common.
  template <typename Response>
  void answer_plan(Response& response) {
    const std::string error = error_of([&] {
      const CyclePlan answer = make_plan();
      fill_plan(answer, response);
      response.trajectory = message_of(answer.motion);
      for (std::string& text : told(answer.warnings)) response.warnings.push_back(text);
    });
    if (!error.empty()) response.message = error;
  }

  bool estimate(Estimate::Request&, Estimate::Response& response) {
    response.density_percent = response.density_sd_percent = response.bulking_factor = unknown;
    response.message = error_of([&] {
      const CycleEstimate answer = make_estimate();
      fill_estimate(answer, response);
      response.warnings = told(answer.warnings);
    });
    return true;
  }

  bool plan(Plan::Request&, Plan::Response& response) {
    answer_plan(response);
    return true;
  }

  bool dig_and_plan(DigAndPlan::Request&, DigAndPlan::Response& response) {
    response.estimate_message = error_of([&] {
      const CycleEstimate answer = make_estimate();
      response.estimate_json = to_json(answer);
      response.warnings = told(answer.warnings);
    });
    answer_plan(response);
    return true;
  }

  excavplan::DigCycleSession session_;
  bool send_doubtful_;
  ros::NodeHandle topics_, own_;
  RobotListener robot_;
  std::vector<ros::Subscriber> subscribers_;
  std::string told_state_;
  excavplan::EarlyPoints early_;
  ros::Publisher state_, estimate_, plan_, trajectory_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace
}  // namespace excavplan_ros

int main(int argc, char** argv) {
  return excavplan_ros::run_node<excavplan_ros::Node>(argc, argv, "excavplan");
}
