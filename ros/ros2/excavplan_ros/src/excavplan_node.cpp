// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// The dig cycle as a node of ROS 2 (docs/ros.md): topics to DigCycleSession, its answers to topics
/// and services. Checked for syntax only: Debian has no rclcpp.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <excavplan/controller/dig_cycle_session.hpp>
#include <excavplan/survey/cloud.hpp>
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
  JointTrajectory message;
  message.joint_names = motion.names;
  for (const excavplan::JointPoint& point : motion.points) {
    trajectory_msgs::msg::JointTrajectoryPoint sent;
    sent.positions = point.positions;
    sent.velocities = point.velocities;
    sent.accelerations = point.accelerations;
    const double seconds = std::floor(point.time);
    sent.time_from_start.sec = static_cast<std::int32_t>(seconds);
    sent.time_from_start.nanosec = static_cast<std::uint32_t>(1e9 * (point.time - seconds));
    message.points.push_back(sent);
  }
  return message;
}

String text_message(const std::string& text) {
  String message;
  message.data = text;
  return message;
}

/// The settings that the parameters give (docs/ros.md#parameters).
excavplan::DigCycleSettings settings_of(rclcpp::Node& node) {
  const auto text = [&](const char* name, const std::string& value) {
    return node.declare_parameter<std::string>(name, value);
  };
  auto settings =
      excavplan::shipped_settings(text("machine", "zx120"), text("soil", "loam"), text("law", ""));
  settings.density = {
      node.declare_parameter<double>("density_percent", settings.density.percent),
      node.declare_parameter<double>("density_sd_percent", settings.density.sd_percent)};
  const auto scans =
      node.declare_parameter<std::int64_t>("scans", static_cast<std::int64_t>(settings.scans));
  settings.scans = static_cast<std::size_t>(std::max<std::int64_t>(scans, 0));
  settings.site_frame = text("site_frame", "");
  const std::string frame_file = text("frame_file", "");
  if (!frame_file.empty()) settings.site_from_scan = excavplan::read_frame(frame_file);
  excavplan::RobotJoints& joints = settings.machine.robot_joints;
  std::vector<std::string> names;
  for (const excavplan::RobotJoint& joint : joints) names.push_back(joint.name);
  names = node.declare_parameter<std::vector<std::string>>("joint_names", names);
  if (names.size() != joints.size()) {
    throw excavplan::Error(excavplan::ErrorKind::bad_input,
                           "parameter joint_names: has " + std::to_string(names.size()) +
                               " names, must have 4: boom, arm, bucket, swing");
  }
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i].name = names[i];
  settings.machine_in_view = node.declare_parameter<bool>("machine_in_view", false);
  settings.digs_as_planned = node.declare_parameter<bool>("digs_as_planned", true);
  if (node.declare_parameter<bool>("search", false)) {
    settings.plan.method = excavplan::PlanMethod::search;
  }
  settings.whole_cycle = node.declare_parameter<bool>("whole_cycle", settings.whole_cycle);
  excavplan::MotionOptions& motion = settings.motion;
  motion.rate = node.declare_parameter<double>("rate_hz", motion.rate);
  motion.max_jerk = node.declare_parameter<double>("max_jerk", motion.max_jerk);
  motion.speed_fraction = node.declare_parameter<double>("speed_fraction", motion.speed_fraction);
  settings.plan.trajectory.speed_fraction = motion.speed_fraction;
  return settings;
}

class ExcavplanNode : public rclcpp::Node {
 public:
  ExcavplanNode() : Node("excavplan"), session_(settings_of(*this)) {
    const rclcpp::QoS latched = rclcpp::QoS(1).transient_local();
    state_ = create_publisher<String>("~/state", latched);
    estimate_ = create_publisher<String>("~/estimate_result", latched);
    plan_ = create_publisher<String>("~/plan_result", latched);
    trajectory_ = create_publisher<JointTrajectory>("~/trajectory", latched);
    listen<sensor_msgs::msg::PointCloud2>("points", "sensor_msgs/msg/PointCloud2",
                                          rclcpp::SensorDataQoS());
    listen<tf2_msgs::msg::TFMessage>("/tf", "tf2_msgs/msg/TFMessage", rclcpp::QoS(100));
    listen<tf2_msgs::msg::TFMessage>("/tf_static", "tf2_msgs/msg/TFMessage",
                                     rclcpp::QoS(100).transient_local());
    listen<sensor_msgs::msg::JointState>("joint_states", "sensor_msgs/msg/JointState",
                                         rclcpp::SensorDataQoS());
    mark("start_dig", [this] { session_.start_dig(); });
    mark("end_dig", [this] { session_.end_dig(); });
    serve<Estimate>("~/estimate", [this](Estimate::Response& answer) { fill(answer); });
    serve<Plan>("~/plan", [this](Plan::Response& answer) { fill_plan(answer); });
    serve<DigAndPlan>("~/dig_and_plan", [this](DigAndPlan::Response& answer) { fill(answer); });
    tell_state();
  }

 private:
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
  void listen(const std::string& topic, const std::string& type, const rclcpp::QoS& qos) {
    const auto take = [this, topic, type](std::shared_ptr<const rclcpp::SerializedMessage> raw) {
      const rcl_serialized_message_t& message = raw->get_rcl_serialized_message();
      const std::string_view bytes(reinterpret_cast<const char*>(message.buffer),
                                   message.buffer_length);
      error_of([&] { session_.take({topic, type, true, bytes}); });
      tell_state();
    };
    subscriptions_.push_back(create_subscription<Message>(topic, qos, take));
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
  }

  void tell(const std::vector<excavplan::Warning>& warnings, std::vector<std::string>& texts) {
    for (const excavplan::Warning& warning : warnings) {
      texts.push_back(warning.code + ": " + warning.message);
      RCLCPP_WARN(get_logger(), "%s", texts.back().c_str());
    }
  }

  void fill(Estimate::Response& response) {
    response.success = response.trustworthy = false;
    response.density_percent = response.density_sd_percent = response.bulking_factor = unknown;
    response.message = error_of([&] {
      const CycleEstimate answer = session_.estimate();
      response.success = true;
      response.trustworthy = answer.adopted;
      if (answer.estimate.density) {
        response.density_percent = answer.estimate.density->percent;
        response.density_sd_percent = answer.estimate.density->sd_percent;
      }
      if (answer.estimate.bulking) response.bulking_factor = answer.estimate.bulking->value;
      tell(answer.warnings, response.warnings);
      response.json = to_json(answer);
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
    fill_plan(response);
  }

  /// What Plan and DigAndPlan have in common.
  template <typename Response>
  void fill_plan(Response& response) {
    response.success = response.trustworthy = response.previous_density = false;
    const std::string error = error_of([&] {
      const CyclePlan answer = session_.plan();
      response.success = answer.plan.dig.has_value();
      response.message = answer.plan.reason;
      response.trustworthy = answer.trustworthy;
      response.previous_density = answer.previous_density;
      response.density_percent = answer.density.percent;
      response.trajectory = message_of(answer.motion);
      tell(answer.warnings, response.warnings);
      response.json = to_json(answer);
      plan_->publish(text_message(response.json));
      trajectory_->publish(response.trajectory);
    });
    if (!error.empty()) response.message = error;
  }

  excavplan::DigCycleSession session_;
  std::string told_state_;
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
    rclcpp::spin(std::make_shared<ExcavplanNode>());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "excavplan_node: error: %s\n", error.what());
    code = 1;
  }
  rclcpp::shutdown();
  return code;
}
