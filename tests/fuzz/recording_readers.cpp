// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <excavplan/base/error.hpp>
#include <excavplan/recording/recording.hpp>

#include "base/files.hpp"
#include "fuzz/file_readers.hpp"
#include "recording/recording_file.hpp"
#include "recording/ros_messages.hpp"
#include "recording/transform_tree.hpp"

namespace excavplan::test {
namespace {

constexpr std::int64_t epoch = 1000000000000;  // [ns]

std::string time_of(std::int64_t time) { return std::to_string(time); }

/// What is read of the message itself has its own readers, and may be refused here.
void add_contents(const std::string& path, Said& said) {
  const RecordingContents contents = describe_recording(path);
  for (const RecordingTopic& topic : contents.topics) {
    said.add(topic.name, topic.type + ' ' + std::to_string(topic.messages) + ' ' + topic.frame);
    if (!topic.is_scan) continue;
    try {
      const RecordedScan scan = read_recorded_scan({path, topic.name, {}, 0.5, ""});
      said.add("scan", points_text(scan.cloud.points));
    } catch (const Error& error) {
      said.add("refused", error.what());
    }
  }
}

std::string read_recording(const std::string& path) {
  Said said;
  {
    const auto file = open_recording(path);
    std::vector<std::string> topics;
    for (const RecordedTopic& topic : file->topics()) topics.push_back(topic.name);
    file->visit(topics, 0, std::numeric_limits<std::int64_t>::max(),
                [&](const RecordedMessage& message) {
                  said.add(message.topic.name,
                           time_of(message.time) + ' ' + checksum_text(std::string(message.bytes)));
                  return true;
                });
    add_contents(path, said);
    // What is left out or missing is said, as an error says it.
    if (file->skipped().count() > 0) throw Error(ErrorKind::bad_file, file->skipped().first());
    if (file->is_cut_off()) throw Error(ErrorKind::bad_file, path + ": its end is missing");
  }
  return said.text();
}

/// A file of one message, after a byte: 1 that of ROS 1, else CDR.
class MessageFile {
 public:
  MessageFile(const std::string& path, const std::string& type)
      : path_(path), topic_{"/topic", type, 1, epoch, epoch}, content_(read_file(path)) {
    if (content_.empty()) throw Error(ErrorKind::bad_file, path + ": is empty");
  }
  RecordedMessage message() const {
    const bool is_ros1 = content_.front() == 1;
    return {topic_, epoch, is_ros1 ? Serialization::ros1 : Serialization::cdr,
            std::string_view(content_).substr(1), "message 1 of /topic"};
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  RecordedTopic topic_;
  std::string content_;
};

std::string points_of(const std::string& path, const std::string& type) {
  const MessageFile file(path, type);
  const RecordedMessage message = file.message();
  const MessageHeader header = decode_header(path, message);
  const FrameSize size = decode_size(path, message);
  const PointMessage points = decode_points(path, message);
  if (!(size == points.size)) throw std::logic_error("sizes of one message differ");
  return Said()
             .add("stamp", time_of(header.stamp))
             .add("frame", header.frame)
             .add("width", static_cast<double>(size.width))
             .text() +
         points_text(points.points);
}

std::string read_point_cloud(const std::string& path) {
  return points_of(path, "sensor_msgs/msg/PointCloud2");
}

std::string read_livox(const std::string& path) {
  return points_of(path, "livox_ros_driver2/msg/CustomMsg");
}

std::string depths_of(const std::string& path, const std::string& type) {
  const MessageFile file(path, type);
  const FrameSize size = decode_size(path, file.message());
  const DepthMessage image = decode_depths(path, file.message());
  if (!(size == image.size)) throw std::logic_error("sizes of one message differ");
  return Said()
      .add("width", static_cast<double>(image.size.width))
      .all("depth", image.depths)
      .text();
}

std::string read_image(const std::string& path) { return depths_of(path, "sensor_msgs/msg/Image"); }

std::string read_compressed_image(const std::string& path) {
  return depths_of(path, "sensor_msgs/msg/CompressedImage");
}

std::string read_camera_info(const std::string& path) {
  const MessageFile file(path, "sensor_msgs/msg/CameraInfo");
  const CameraMessage camera = decode_camera(path, file.message());
  return Said()
      .all("d", camera.distortion)
      .all("k", camera.intrinsics)
      .all("p", camera.rectified_projection)
      .text();
}

std::string read_joints(const std::string& path) {
  const MessageFile file(path, "sensor_msgs/msg/JointState");
  Said said;
  for (const auto& [name, position] : decode_joints(path, file.message())) said.add(name, position);
  return said.text();
}

/// With what the tree says between all its frames.
std::string read_transforms(const std::string& path) {
  const MessageFile file(path, "tf2_msgs/msg/TFMessage");
  const std::vector<StampedTransform> transforms = decode_transforms(path, file.message());
  Said said;
  for (const StampedTransform& each : transforms) {
    said.add(each.parent, each.child)
        .add("stamp", time_of(each.stamp))
        .all("turn", each.rotation)
        .all("move", each.translation);
  }
  const TransformTree tree(path, epoch, transforms);
  std::vector<std::string> frames = tree.frames();
  frames.resize(std::min<std::size_t>(frames.size(), 6));
  for (const std::string& a : frames) {
    for (const std::string& b : frames) {
      try {
        const double sum = tree.lookup(a, b, transforms.front().stamp).matrix().sum();
        if (tree.moved(a, b, epoch, epoch + 1)) said.add("moved", b);
        said.add(a + " from " + b, sum);
      } catch (const Error&) {
        said.add(a + " from " + b, "unknown");
      }
    }
  }
  return said.text();
}

}  // namespace

std::vector<FileReader> recording_readers() {
  return {{"mcap", read_recording},
          {"bag", read_recording},
          {"db3", read_recording},
          {"point_cloud2", read_point_cloud},
          {"livox", read_livox},
          {"image_message", read_image},
          {"compressed_image", read_compressed_image},
          {"camera_info", read_camera_info},
          {"joint_state", read_joints},
          {"transforms", read_transforms}};
}

}  // namespace excavplan::test
