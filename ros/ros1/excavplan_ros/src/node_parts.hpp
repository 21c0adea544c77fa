// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// What the nodes of a dig cycle and of a job have in common.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <trajectory_msgs/JointTrajectory.h>
#include <excavplan/robot/robot_node.hpp>

#include "raw_message.hpp"

namespace excavplan_ros {

inline trajectory_msgs::JointTrajectory message_of(const excavplan::JointMotion& motion) {
  return excavplan::joint_trajectory_message<trajectory_msgs::JointTrajectory>(
      motion, [](ros::Duration& time, std::int64_t ns) { time.fromNSec(ns); });
}

inline std_msgs::String text_message(const std::string& text) {
  std_msgs::String message;
  message.data = text;
  return message;
}

/// Shows warnings, and gives their texts.
inline std::vector<std::string> told(const std::vector<excavplan::Warning>& warnings) {
  std::vector<std::string> texts = excavplan::texts_of(warnings);
  for (const std::string& text : texts) ROS_WARN("%s", text.c_str());
  return texts;
}

inline std::optional<std::int64_t> known_time(const ros::Time& time) {
  return excavplan::known_time(static_cast<std::int64_t>(time.toNSec()));
}

inline std::optional<std::int64_t> time_now() { return known_time(ros::Time::now()); }

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

/// Hands on the messages of a robot as they were sent.
class RobotListener {
 public:
  using Take = std::function<void(const excavplan::RobotMessage&)>;

  RobotListener(ros::NodeHandle topics, Take take) : topics_(topics), take_(std::move(take)) {
    listen<sensor_msgs::PointCloud2>("points", "sensor_msgs/msg/PointCloud2", 10);
    listen<tf2_msgs::TFMessage>("/tf", "tf2_msgs/msg/TFMessage", 1000);
    listen<tf2_msgs::TFMessage>("/tf_static", "tf2_msgs/msg/TFMessage", 1000);
    listen_to_joints();
  }

  /// Those that wait. They are in a queue of their own, so that they can be taken before and after
  /// a plan, within its call.
  void take_joints() { joint_queue_.callAvailable(); }

  /// @param more  to be done at least every 20 ms (ours)
  void spin(const std::function<void()>& more = [] {}) {
    constexpr double longest_wait = 0.02;  // [s]
    while (ros::ok()) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(longest_wait));
      take_joints();
      more();
    }
  }

 private:
  template <typename Message>
  void listen(const std::string& topic, const std::string& type, unsigned queue) {
    const std::string name = topics_.resolveName(topic);
    const boost::function<void(const boost::shared_ptr<const Raw<Message>>&)> take =
        [this, name, type](const boost::shared_ptr<const Raw<Message>>& message) {
          take_({name, type, false, message->bytes, time_now()});
        };
    subscribers_.push_back(topics_.subscribe<Raw<Message>>(name, queue, take));
  }

  void listen_to_joints() {
    using Event = ros::MessageEvent<const Raw<sensor_msgs::JointState>>;
    const std::string name = topics_.resolveName("joint_states");
    const boost::function<void(const Event&)> take = [this, name](const Event& event) {
      take_({name, "sensor_msgs/msg/JointState", false, event.getConstMessage()->bytes,
             known_time(event.getReceiptTime())});
    };
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(name, 100, take);
    options.callback_queue = &joint_queue_;
    subscribers_.push_back(topics_.subscribe(options));
  }

  ros::NodeHandle topics_;
  Take take_;
  ros::CallbackQueue joint_queue_;
  std::vector<ros::Subscriber> subscribers_;
};

/// The program of a node. @return its exit code
template <typename Node>
int run_node(int argc, char** argv, const char* name) {
  ros::init(argc, argv, name);
  try {
    Node node(ros::NodeHandle(), ros::NodeHandle("~"));
    node.spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s_node: error: %s\n", name, error.what());
    return 1;
  }
}

}  // namespace excavplan_ros
