#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The excavplan authors
# SPDX-License-Identifier: Apache-2.0
"""stub_headers.py PACKAGE OUT: as much of the headers of ROS 2 (Humble) as the nodes of PACKAGE
use, to check their syntax without ROS 2. The messages have the fields of their definitions, rclcpp and
rclcpp_action the signatures of their documentation, without any code but that of parameters."""

import pathlib
import re
import sys

MESSAGES = {
    "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec",
    "sensor_msgs/JointState": "string[] name",
    "sensor_msgs/PointCloud2": "uint32 height",
    "std_msgs/Bool": "bool data",
    "std_msgs/String": "string data",
    "tf2_msgs/TFMessage": "",
    "trajectory_msgs/JointTrajectoryPoint":
        "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n"
        "builtin_interfaces/Duration time_from_start",
    "trajectory_msgs/JointTrajectory":
        "string[] joint_names\ntrajectory_msgs/JointTrajectoryPoint[] points",
}

PLAIN = {"bool": "bool", "string": "std::string", "float64": "double", "int32": "std::int32_t",
         "int64": "std::int64_t", "uint32": "std::uint32_t"}

RCLCPP = """#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>
namespace rcl_interfaces::msg { struct ParameterDescriptor { bool dynamic_typing = false; }; }
struct rcl_serialized_message_t { std::uint8_t* buffer; std::size_t buffer_length; };
namespace rclcpp {
struct SerializedMessage { const rcl_serialized_message_t& get_rcl_serialized_message() const; };
struct QoS {
  explicit QoS(std::size_t depth);
  QoS& transient_local();
  QoS& reliable();
  QoS& best_effort();
};
struct SensorDataQoS : QoS { SensorDataQoS(); };
struct NodeOptions {};
enum class ParameterType { PARAMETER_INTEGER, PARAMETER_DOUBLE, PARAMETER_OTHER };
class ParameterValue {
 public:
  explicit ParameterValue(std::int64_t value) : value_(value) {}
  explicit ParameterValue(double value) : value_(value) {}
  explicit ParameterValue(bool value) : value_(value) {}
  explicit ParameterValue(const std::string& value) : value_(value) {}
  explicit ParameterValue(const std::vector<std::string>& value) : value_(value) {}
  ParameterType get_type() const {
    return value_.index() == 0   ? ParameterType::PARAMETER_INTEGER
           : value_.index() == 1 ? ParameterType::PARAMETER_DOUBLE
                                 : ParameterType::PARAMETER_OTHER;
  }
  template <typename T> const T& get() const { return std::get<T>(value_); }
 private:
  std::variant<std::int64_t, double, bool, std::string, std::vector<std::string>> value_;
};
enum class CallbackGroupType { MutuallyExclusive, Reentrant };
struct CallbackGroup { using SharedPtr = std::shared_ptr<CallbackGroup>; };
struct SubscriptionOptions { CallbackGroup::SharedPtr callback_group; };
namespace node_interfaces { struct NodeBaseInterface; }
struct Logger {};
struct Time { std::int64_t nanoseconds() const; };
struct SubscriptionBase { using SharedPtr = std::shared_ptr<SubscriptionBase>; };
struct ServiceBase { using SharedPtr = std::shared_ptr<ServiceBase>; };
template <typename M> struct Subscription : SubscriptionBase {
  using SharedPtr = std::shared_ptr<Subscription>;
  const char* get_topic_name() const;
};
template <typename M> struct Publisher {
  using SharedPtr = std::shared_ptr<Publisher>;
  void publish(const M& message);
};
template <typename S> struct Service : ServiceBase {
  using SharedPtr = std::shared_ptr<Service>;
};
class Node {
 public:
  explicit Node(const std::string& name, const NodeOptions& options = NodeOptions());
  Logger get_logger() const;
  Time now() const;
  const ParameterValue& declare_parameter(
      const std::string& name, const ParameterValue& value,
      const rcl_interfaces::msg::ParameterDescriptor& descriptor = {});
  template <typename T> T declare_parameter(const std::string& name, const T& value) {
    return declare_parameter(name, ParameterValue(value)).template get<T>();
  }
  CallbackGroup::SharedPtr create_callback_group(CallbackGroupType type, bool add_to_executor = true);
  std::shared_ptr<node_interfaces::NodeBaseInterface> get_node_base_interface();
  template <typename M>
  typename Publisher<M>::SharedPtr create_publisher(const std::string& topic, const QoS& qos);
  template <typename M, typename Callback>
  typename Subscription<M>::SharedPtr create_subscription(const std::string& topic, const QoS& qos,
                                                          Callback&& callback,
                                                          const SubscriptionOptions& = {}) {
    using ofSerialized = std::function<void(std::shared_ptr<const SerializedMessage>)>;
    using ofMessage = std::function<void(const M&)>;
    static_assert(std::is_constructible_v<ofSerialized, Callback> ||
                  std::is_constructible_v<ofMessage, Callback>);
    return {};
  }
  template <typename S, typename Callback>
  typename Service<S>::SharedPtr create_service(const std::string& name, Callback&& callback) {
    using Take = std::function<void(std::shared_ptr<typename S::Request>,
                                    std::shared_ptr<typename S::Response>)>;
    static_assert(std::is_constructible_v<Take, Callback>);
    return {};
  }
};
void init(int argc, const char* const* argv);
namespace executors {
struct SingleThreadedExecutor {
  void add_node(std::shared_ptr<Node> node);
  void add_callback_group(CallbackGroup::SharedPtr group,
                          std::shared_ptr<node_interfaces::NodeBaseInterface> node);
  void spin_once(std::chrono::nanoseconds timeout);
  void spin_all(std::chrono::nanoseconds longest);
};
}  // namespace executors
bool ok();
bool shutdown();
}  // namespace rclcpp
[[gnu::format(printf, 2, 3)]] void stub_log(const rclcpp::Logger& logger, const char* form, ...);
#define RCLCPP_ERROR(...) stub_log(__VA_ARGS__)
#define RCLCPP_WARN(...) stub_log(__VA_ARGS__)
#define RCLCPP_INFO(...) stub_log(__VA_ARGS__)
"""

RCLCPP_ACTION = """#pragma once
#include <array>
#include <rclcpp/rclcpp.hpp>
struct rcl_action_server_options_t {};
rcl_action_server_options_t rcl_action_server_get_default_options();
namespace rclcpp_action {
using GoalUUID = std::array<std::uint8_t, 16>;
enum class GoalResponse : std::int8_t { REJECT = 1, ACCEPT_AND_EXECUTE = 2, ACCEPT_AND_DEFER = 3 };
enum class CancelResponse : std::int8_t { REJECT = 1, ACCEPT = 2 };
template <typename A> struct ServerGoalHandle {
  bool is_canceling() const;
  bool is_active() const;
  bool is_executing() const;
  void publish_feedback(std::shared_ptr<typename A::Feedback> feedback);
  void abort(std::shared_ptr<typename A::Result> result);
  void succeed(std::shared_ptr<typename A::Result> result);
  void canceled(std::shared_ptr<typename A::Result> result);
};
template <typename A> struct Server {
  using SharedPtr = std::shared_ptr<Server>;
  using GoalCallback =
      std::function<GoalResponse(const GoalUUID&, std::shared_ptr<const typename A::Goal>)>;
  using CancelCallback = std::function<CancelResponse(std::shared_ptr<ServerGoalHandle<A>>)>;
  using AcceptedCallback = std::function<void(std::shared_ptr<ServerGoalHandle<A>>)>;
};
template <typename A, typename N>
typename Server<A>::SharedPtr create_server(N, const std::string&,
                                            typename Server<A>::GoalCallback,
                                            typename Server<A>::CancelCallback,
                                            typename Server<A>::AcceptedCallback,
                                            const rcl_action_server_options_t&,
                                            rclcpp::CallbackGroup::SharedPtr) {
  return nullptr;
}
}  // namespace rclcpp_action
"""


def small(name):
    """As rosidl names the header of a type: point_cloud2, tf_message."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()


def cpp_type(name):
    element = name.removesuffix("[]")
    if element not in PLAIN:
        element = element.replace("/", "::msg::")
    else:
        element = PLAIN[element]
    return f"std::vector<{element}>" if name.endswith("[]") else element


def fields(text):
    for line in text.splitlines():
        words = line.split("#")[0].split()
        if words:
            yield words[0], words[1]


def struct(name, text):
    body = "".join(f"  {cpp_type(kind)} {field};\n" for kind, field in fields(text))
    return f"struct {name} {{\n{body}}};\n"


def includes(text):
    names = {kind.removesuffix("[]") for kind, _ in fields(text)}
    return "".join(f"#include <{package}/msg/{small(name)}.hpp>\n"
                   for package, _, name in (n.partition("/") for n in sorted(names)) if name)


def write(folder, package, kind, name, text, body):
    path = folder / package / kind / (small(name) + ".hpp")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#pragma once\n#include <cstdint>\n#include <string>\n#include <vector>\n"
                    f"{includes(text)}namespace {package}::{kind} {{\n{body}}}\n",
                    encoding="utf-8")


def main():
    package, out = map(pathlib.Path, sys.argv[1:3])
    for name, text in (("rclcpp", RCLCPP), ("rclcpp_action", RCLCPP_ACTION)):
        (out / name).mkdir(parents=True, exist_ok=True)
        (out / name / (name + ".hpp")).write_text(text, encoding="utf-8")
    for full, text in MESSAGES.items():
        owner, name = full.split("/")
        write(out, owner, "msg", name, text, struct(name, text))
    for kind, parts in (("srv", ("Request", "Response")), ("action", ("Goal", "Result", "Feedback"))):
        for file in sorted(package.glob(f"{kind}/*.{kind}")):
            texts = file.read_text(encoding="utf-8").split("---")
            body = "".join(map(struct, parts, texts))
            write(out, "excavplan_ros", kind, file.stem, "".join(texts),
                  f"struct {file.stem} {{\n{body}}};\n")


main()
