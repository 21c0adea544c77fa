// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The dig cycle as a node of ROS 2 (docs/ros.md): topics to DigCycleSession, its answers to topics
/// and services. Checked for syntax only: Debian has no rclcpp.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>

#include <excavplan/robot/robot_node.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <std_msgs/msg/bool.hpp>
#include <std_msgs/msg/string.hpp>
#include <tf2_msgs/msg/tf_message.hpp>
#include <trajectory_msgs/msg/joint_trajectory.hpp>

#include <excavplan_ros/srv/dig_and_plan.hpp>
#include <excavplan_ros/srv/estimate.hpp>
#include <excavplan_ros/srv/plan.hpp>

#include "parameters.hpp"

namespace {

using excavplan::CycleEstimate;
using excavplan::CyclePlan;
using excavplan_ros::srv::DigAndPlan;
using excavplan_ros::srv::Estimate;
using excavplan_ros::srv::Plan;
using std_msgs::msg::Bool;
using std_msgs::msg::String;
using trajectory_msgs::msg::JointTrajectory;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

JointTrajectory message_of(const excavplan::JointMotion& motion) {
  return excavplan::joint_trajectory_message<JointTrajectory>(
      motion, [](auto& time, std::int64_t ns) {
        constexpr std::int64_t second = 1'000'000'000;
        time.sec = static_cast<std::int32_t>(ns / second);
        time.nanosec = static_cast<std::uint32_t>(ns % second);
      });
}

String text_message(const std::string& text) {
  String message;
  message.data = text;
  return message;
}

excavplan::NodeSettings settings_of(rclcpp::Node& node) {
  excavplan_ros::Parameters parameters(node);
  return excavplan::settings_of(parameters);
}

class ExcavplanNode : public rclcpp::Node {
 public:
  ExcavplanNode() : Node("excavplan"), settings_(settings_of(*this)), session_(settings_.session) {
    const rclcpp::QoS latched = rclcpp::QoS(1).transient_local();
    state_ = create_publisher<String>("~/state", latched);
    estimate_ = create_publisher<String>("~/estimate_result", latched);
    plan_ = create_publisher<String>("~/plan_result", latched);
    trajectory_ = create_publisher<JointTrajectory>("~/trajectory", rclcpp::QoS(1));
    listen<sensor_msgs::msg::PointCloud2>("points", "sensor_msgs/msg/PointCloud2",
                                          rclcpp::SensorDataQoS());
    listen<tf2_msgs::msg::TFMessage>("/tf", "tf2_msgs/msg/TFMessage", rclcpp::QoS(100));
    listen<tf2_msgs::msg::TFMessage>("/tf_static", "tf2_msgs/msg/TFMessage",
                                     rclcpp::QoS(100).transient_local());
    joint_group_ = create_callback_group(rclcpp::CallbackGroupType::MutuallyExclusive, false);
    joint_executor_.add_callback_group(joint_group_, get_node_base_interface());
    listen<sensor_msgs::msg::JointState>("joint_states", "sensor_msgs/msg/JointState",
                                         rclcpp::SensorDataQoS(), joint_group_);
    mark("start_dig", [this] { session_.start_dig(time_now()); });
    mark("end_dig", [this] { session_.end_dig(time_now()); });
    serve<Estimate>("~/estimate", [this](Estimate::Response& answer) { fill(answer); });
    serve<Plan>("~/plan", [this](Plan::Response& answer) { answer_plan(answer); });
    serve<DigAndPlan>("~/dig_and_plan", [this](DigAndPlan::Response& answer) { fill(answer); });
    tell_state();
  }

  /// Those that wait. They have an executor of their own, so that they can be taken before and
  /// after a plan, within its call.
  void take_joints() { joint_executor_.spin_all(std::chrono::milliseconds(100)); }

 private:
  std::optional<std::int64_t> time_now() const {
    return excavplan::known_time(now().nanoseconds());
  }

  /// Does the work; an error goes to rosout and is returned.
  template <typename Work>
  std::string error_of(const Work& work) {
    try {
      work();
      return "";
    } catch (const std::exception& error) {
      RCLCPP_ERROR(get_logger(), "%s", error.what());
      return error.what();
    }
  }

  template <typename Message>
  void listen(const std::string& topic, const std::string& type, const rclcpp::QoS& qos,
              const rclcpp::CallbackGroup::SharedPtr& group = nullptr) {
    const auto take = [this, topic, type](std::shared_ptr<const rclcpp::SerializedMessage> raw) {
      const rcl_serialized_message_t& message = raw->get_rcl_serialized_message();
      const std::string_view bytes(reinterpret_cast<const char*>(message.buffer),
                                   message.buffer_length);
      error_of([&] { session_.take({topic, type, true, bytes, time_now()}); });
      tell_state();
    };
    rclcpp::SubscriptionOptions options;
    options.callback_group = group;
    subscriptions_.push_back(create_subscription<Message>(topic, qos, take, options));
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
    const bool any_early = session_.early_scans() > 0;
    if (any_early && !told_early_) {
      RCLCPP_WARN(get_logger(), "%s", excavplan::early_text(session_).c_str());
    }
    told_early_ = any_early;
  }

  void tell(const std::vector<excavplan::Warning>& warnings, std::vector<std::string>& texts) {
    for (const std::string& text : excavplan::texts_of(warnings)) {
      texts.push_back(text);
      RCLCPP_WARN(get_logger(), "%s", text.c_str());
    }
  }

  void fill(Estimate::Response& response) {
    response.success = response.trustworthy = false;
    response.density_percent = response.density_sd_percent = response.bulking_factor = unknown;
    response.message = error_of([&] {
      const CycleEstimate answer = session_.estimate();
      fill_estimate(answer, response);
      tell(answer.warnings, response.warnings);
      estimate_->publish(text_message(response.json));
    });
  }

  void fill(DigAndPlan::Response& response) {
    response.estimate_message = error_of([&] {
      const CycleEstimate answer = session_.estimate();
      response.estimate_json = to_json(answer);
      tell(answer.warnings, response.warnings);
      estimate_->publish(text_message(response.estimate_json));
    });
    answer_plan(response);
  }

  /// What Plan and DigAndPlan have in common.
  template <typename Response>
  void answer_plan(Response& response) {
    response.success = response.trustworthy = response.previous_density = false;
    const std::string error = error_of([&] {
      take_joints();
      CyclePlan answer = session_.plan(time_now());
      take_joints();
      session_.confirm_start(answer, time_now());
      excavplan::fill_plan(answer, response);
      response.trajectory = message_of(answer.motion);
      tell(answer.warnings, response.warnings);
      plan_->publish(text_message(response.json));
      trajectory_->publish(
          message_of(settings_.send_doubtful ? answer.motion : safe_motion(answer)));
    });
    if (!error.empty()) response.message = error;
  }

  excavplan::NodeSettings settings_;
  excavplan::DigCycleSession session_;
  rclcpp::CallbackGroup::SharedPtr joint_group_;
  rclcpp::executors::SingleThreadedExecutor joint_executor_;
  std::string told_state_;
  bool told_early_ = false;
  rclcpp::Publisher<String>::SharedPtr state_, estimate_, plan_;
  rclcpp::Publisher<JointTrajectory>::SharedPtr trajectory_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
  std::vector<rclcpp::ServiceBase::SharedPtr> services_;
};

}  // namespace

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  int code = 0;
  try {
    constexpr std::chrono::milliseconds longest_wait(20);  // for joint states; ours
    const auto node = std::make_shared<ExcavplanNode>();
    rclcpp::executors::SingleThreadedExecutor executor;
    executor.add_node(node);
    while (rclcpp::ok()) {
      executor.spin_once(longest_wait);
      node->take_joints();
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "excavplan_node: error: %s\n", error.what());
    code = 1;
  }
  rclcpp::shutdown();
  return code;
}
