// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace excavplan_ros {

/// A message that is left as it was sent, for DigCycleSession::take().
template <typename Message>
struct Raw {
  std::string bytes;
};

}  // namespace excavplan_ros

namespace ros {
namespace message_traits {

template <typename Message>
struct IsMessage<excavplan_ros::Raw<Message>> : TrueType {};
template <typename Message>
struct MD5Sum<excavplan_ros::Raw<Message>> : MD5Sum<Message> {
  static const char* value() { return MD5Sum<Message>::value(); }
  static const char* value(const excavplan_ros::Raw<Message>&) { return value(); }
};
template <typename Message>
struct DataType<excavplan_ros::Raw<Message>> : DataType<Message> {
  static const char* value() { return DataType<Message>::value(); }
  static const char* value(const excavplan_ros::Raw<Message>&) { return value(); }
};
template <typename Message>
struct Definition<excavplan_ros::Raw<Message>> : Definition<Message> {
  static const char* value() { return Definition<Message>::value(); }
  static const char* value(const excavplan_ros::Raw<Message>&) { return value(); }
};

}  // namespace message_traits

namespace serialization {

template <typename Message>
struct Serializer<excavplan_ros::Raw<Message>> {
  template <typename Stream>
  static void read(Stream& stream, excavplan_ros::Raw<Message>& message) {
    const std::size_t size = stream.getLength();
    message.bytes.assign(reinterpret_cast<const char*>(stream.advance(size)), size);
  }
};

}  // namespace serialization
}  // namespace ros
