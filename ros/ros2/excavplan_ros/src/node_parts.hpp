// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// What the nodes of a dig cycle and of a job have in common.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/robot/robot_node.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_msgs/msg/string.hpp>
#include <tf2_msgs/msg/tf_message.hpp>
#include <trajectory_msgs/msg/joint_trajectory.hpp>

namespace excavplan_ros {

using std_msgs::msg::String;
using trajectory_msgs::msg::JointTrajectory;

inline JointTrajectory message_of(const excavplan::JointMotion& motion) {
  return excavplan::joint_trajectory_message<JointTrajectory>(
      motion, [](auto& time, std::int64_t ns) {
        constexpr std::int64_t second = 1'000'000'000;
        time.sec = static_cast<std::int32_t>(ns / second);
        time.nanosec = static_cast<std::uint32_t>(ns % second);
      });
}

inline String text_message(const std::string& text) {
  String message;
  message.data = text;
  return message;
}

/// Shows warnings, and adds their texts.
inline void tell(const rclcpp::Node& node, const std::vector<excavplan::Warning>& warnings,
                 std::vector<std::string>& texts) {
  for (const std::string& text : excavplan::texts_of(warnings)) {
    texts.push_back(text);
    RCLCPP_WARN(node.get_logger(), "%s", text.c_str());
  }
}

inline std::optional<std::int64_t> time_now(const rclcpp::Node& node) {
  return excavplan::known_time(node.now().nanoseconds());
}

/// Does the work; an error goes to rosout and is returned.
template <typename Work>
std::string error_of(const rclcpp::Node& node, const Work& work) {
  try {
    work();
    return "";
  } catch (const std::exception& error) {
    RCLCPP_ERROR(node.get_logger(), "%s", error.what());
    return error.what();
  }
}

/// Hands on the messages of a robot as they were sent.
class RobotListener {
 public:
  using Take = std::function<void(const excavplan::RobotMessage&)>;

  RobotListener(rclcpp::Node& node, Take take) : node_(node), take_(std::move(take)) {
    listen<sensor_msgs::msg::PointCloud2>("points", "sensor_msgs/msg/PointCloud2",
                                          rclcpp::SensorDataQoS());
    listen<tf2_msgs::msg::TFMessage>("/tf", "tf2_msgs/msg/TFMessage", rclcpp::QoS(100));
    listen<tf2_msgs::msg::TFMessage>("/tf_static", "tf2_msgs/msg/TFMessage",
                                     rclcpp::QoS(100).transient_local());
    joint_group_ = node.create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive, false);
    joint_executor_.add_callback_group(joint_group_, node.get_node_base_interface());
    listen<sensor_msgs::msg::JointState>("joint_states", "sensor_msgs/msg/JointState",
                                         rclcpp::SensorDataQoS(), joint_group_);
  }

  /// Those that wait. They have an executor of their own, so that they can be taken before and
  /// after a plan, within its call.
  void take_joints() { joint_executor_.spin_all(std::chrono::milliseconds(100)); }

 private:
  template <typename Message>
  void listen(const std::string& topic, const std::string& type, const rclcpp::QoS& qos,
              const rclcpp::CallbackGroup::SharedPtr& group = nullptr) {
    const auto take = [this, topic, type](std::shared_ptr<const rclcpp::SerializedMessage> raw) {
      const rcl_serialized_message_t& message = raw->get_rcl_serialized_message();
      const std::string_view bytes(reinterpret_cast<const char*>(message.buffer),
                                   message.buffer_length);
      take_({topic, type, true, bytes, time_now(node_)});
    };
    rclcpp::SubscriptionOptions options;
    options.callback_group = group;
    subscriptions_.push_back(node_.create_subscription<Message>(topic, qos, take, options));
  }

  rclcpp::Node& node_;
  Take take_;
  rclcpp::CallbackGroup::SharedPtr joint_group_;
  rclcpp::executors::SingleThreadedExecutor joint_executor_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
};

/// The program of a node, whose go_on() is called at least every 20 ms (ours). @return its exit
/// code
template <typename Node>
int run_node(int argc, char** argv, const char* name) {
  rclcpp::init(argc, argv);
  int code = 0;
  try {
    constexpr std::chrono::milliseconds longest_wait(20);
    const auto node = std::make_shared<Node>();
    rclcpp::executors::SingleThreadedExecutor executor;
    executor.add_node(node);
    while (rclcpp::ok()) {
      executor.spin_once(longest_wait);
      node->go_on();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: error: %s\n", name, error.what());
    code = 1;
  }
  rclcpp::shutdown();
  return code;
}

}  // namespace excavplan_ros
