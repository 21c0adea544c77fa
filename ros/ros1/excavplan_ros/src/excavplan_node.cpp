// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The dig cycle as a node of ROS 1 (docs/ros.md): topics to DigCycleSession, its answers to topics
/// and services.

#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Bool.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <excavplan/robot/robot_node.hpp>

#include <excavplan_ros/DigAndPlan.h>
#include <excavplan_ros/Estimate.h>
#include <excavplan_ros/Plan.h>

#include "parameters.hpp"
#include "raw_message.hpp"

namespace excavplan_ros {
namespace {

using excavplan::CycleEstimate;
using excavplan::CyclePlan;
using excavplan::Warning;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

trajectory_msgs::JointTrajectory message_of(const excavplan::JointMotion& motion) {
  return excavplan::joint_trajectory_message<trajectory_msgs::JointTrajectory>(
      motion, [](ros::Duration& time, std::int64_t ns) { time.fromNSec(ns); });
}

std_msgs::String text_message(const std::string& text) {
  std_msgs::String message;
  message.data = text;
  return message;
}

/// Shows warnings, and gives their texts.
std::vector<std::string> told(const std::vector<Warning>& warnings) {
  std::vector<std::string> texts = excavplan::texts_of(warnings);
  for (const std::string& text : texts) ROS_WARN("%s", text.c_str());
  return texts;
}

std::optional<std::int64_t> known_time(const ros::Time& time) {
  return excavplan::known_time(static_cast<std::int64_t>(time.toNSec()));
}

std::optional<std::int64_t> time_now() { return known_time(ros::Time::now()); }

class Node {
 public:
  Node(ros::NodeHandle topics, const ros::NodeHandle& own) : Node(topics, own, settings_of(own)) {}

  void spin() {
    constexpr double longest_wait = 0.02;  // for joint states [s]; ours
    while (ros::ok()) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(longest_wait));
      joint_queue_.callAvailable();
    }
  }

 private:
  Node(ros::NodeHandle topics, const ros::NodeHandle& own, const excavplan::NodeSettings& settings)
      : session_(settings.session),
        send_doubtful_(settings.send_doubtful),
        topics_(topics),
        own_(own) {
    listen<sensor_msgs::PointCloud2>("points", "sensor_msgs/msg/PointCloud2", 10);
    listen<tf2_msgs::TFMessage>("/tf", "tf2_msgs/msg/TFMessage", 1000);
    listen<tf2_msgs::TFMessage>("/tf_static", "tf2_msgs/msg/TFMessage", 1000);
    listen_to_joints();
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

  /// Does the work; an error goes to rosout and is returned.
  template <typename Work>
  std::string error_of(const Work& work) {
    try {
      work();
      return "";
    } catch (const std::exception& error) {
      ROS_ERROR("%s", error.what());
      return error.what();
    }
  }

  template <typename Message>
  void listen(const std::string& topic, const std::string& type, unsigned queue) {
    const std::string name = topics_.resolveName(topic);
    const boost::function<void(const boost::shared_ptr<const Raw<Message>>&)> take =
        [this, name, type](const boost::shared_ptr<const Raw<Message>>& message) {
          error_of([&] { session_.take({name, type, false, message->bytes, time_now()}); });
          tell_state();
        };
    subscribers_.push_back(topics_.subscribe<Raw<Message>>(name, queue, take));
  }

  /// In a queue of their own, so that they can be taken before and after a plan, within its call.
  void listen_to_joints() {
    using Event = ros::MessageEvent<const Raw<sensor_msgs::JointState>>;
    const std::string name = topics_.resolveName("joint_states");
    const boost::function<void(const Event&)> take = [this, name](const Event& event) {
      error_of([&] {
        session_.take({name, "sensor_msgs/msg/JointState", false, event.getConstMessage()->bytes,
                       known_time(event.getReceiptTime())});
      });
    };
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(name, 100, take);
    options.callback_queue = &joint_queue_;
    subscribers_.push_back(topics_.subscribe(options));
  }

  template <typename Work>
  void mark(const std::string& topic, const Work& work) {
    const boost::function<void(const std_msgs::Bool::ConstPtr&)> take =
        [this, work](const std_msgs::Bool::ConstPtr& message) {
          joint_queue_.callAvailable();  // which were received before it
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
    const bool any_early = session_.early_scans() > 0;
    if (any_early && !told_early_) ROS_WARN("%s", excavplan::early_text(session_).c_str());
    told_early_ = any_early;
  }

  CycleEstimate make_estimate() {
    CycleEstimate answer = session_.estimate();
    estimate_.publish(text_message(to_json(answer)));
    return answer;
  }

  CyclePlan make_plan() {
    joint_queue_.callAvailable();
    CyclePlan answer = session_.plan(time_now());
    joint_queue_.callAvailable();
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
  ros::CallbackQueue joint_queue_;
  std::vector<ros::Subscriber> subscribers_;
  std::string told_state_;
  bool told_early_ = false;
  ros::Publisher state_, estimate_, plan_, trajectory_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace
}  // namespace excavplan_ros

int main(int argc, char** argv) {
  ros::init(argc, argv, "excavplan");
  try {
    excavplan_ros::Node node(ros::NodeHandle(), ros::NodeHandle("~"));
    node.spin();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "excavplan_node: error: %s\n", error.what());
    return 1;
  }
}
