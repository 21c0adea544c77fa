// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <excavplan/base/error.hpp>
#include <excavplan/clouds/cloud.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/json.hpp"
#include "base/text.hpp"
#include "clouds/file_stream.hpp"

namespace excavplan {
namespace {

constexpr const char* expected_frame =
    "4 rows of 4 numbers, or a transform or pose as ROS writes it (translation and rotation, or "
    "position and orientation)";

Eigen::Matrix4d checked_matrix(const FileStream& file, const std::vector<double>& numbers) {
  constexpr double tolerance = 1e-4;
  const auto refuse = [&](const std::string& found, const std::string& expected) {
    file.fail("a frame", found, expected);
  };
  if (numbers.size() != 16) refuse(std::to_string(numbers.size()) + " numbers", "4 rows of 4");
  Eigen::Matrix4d frame =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
  if (!frame.allFinite()) refuse("a number that is not finite", "finite numbers");
  if (frame.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    refuse("another last row", "0 0 0 1");
  }
  const Eigen::Matrix3d rotation = frame.topLeftCorner<3, 3>();
  const double error =
      (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (error > tolerance) {
    refuse("a matrix R with an entry " + number_text(error) + " off in R'R - 1",
           "a rotation to " + number_text(tolerance));
  }
  if (rotation.determinant() < 0.0) refuse("a mirroring (determinant -1)", "a rotation");
  return frame;
}

Eigen::Matrix4d read_matrix(FileStream& file) {
  LineReader lines(file);
  std::vector<double> numbers;
  while (lines.next_filled()) {
    for (const auto word : words_of(lines.line().substr(0, lines.line().find('#')))) {
      numbers.push_back(number_of(word, lines));
    }
  }
  return checked_matrix(file, numbers);
}

/// The pose within a message: TFMessage of one transform, TransformStamped, Transform, Odometry,
/// PoseWithCovarianceStamped, PoseStamped or Pose.
Eigen::Matrix4d pose_in(JsonObject object, const FileStream& file) {
  if (object.has("transforms")) {
    const std::vector<JsonObject> all = object.objects("transforms");
    if (all.size() != 1) {
      object.fail("transforms", "holds " + std::to_string(all.size()) + ", must be one");
    }
    object = all.front();
  }
  for (const char* key : {"transform", "pose", "pose"}) {
    if (object.has(key)) object = object.object(key);
  }
  const bool is_transform = object.has("translation");
  if (!is_transform && !object.has("position")) {
    file.fail("a frame", "neither translation nor position", expected_frame);
  }
  JsonObject place = object.object(is_transform ? "translation" : "position");
  JsonObject turn = object.object(is_transform ? "rotation" : "orientation");
  return pose_of_quaternion(
      {place.number("x"), place.number("y"), place.number("z")},
      {turn.number("x"), turn.number("y"), turn.number("z"), turn.number("w")});
}

/// The numbers in brackets behind a label of what `tf2_echo` prints.
std::vector<double> printed_numbers(const std::string& text, const std::string& label,
                                    const FileStream& file) {
  const std::size_t at = text.find(label);
  const std::size_t begin = text.find('[', at);
  const std::size_t end = text.find(']', begin);
  if (at == text.npos || end == text.npos) file.fail("a frame", "no " + label, expected_frame);
  std::string inner = text.substr(begin + 1, end - begin - 1);
  for (char& c : inner) c = c == ',' ? ' ' : c;
  std::vector<double> numbers;
  for (const auto word : words_of(inner)) {
    const auto number = parse_number(word);
    if (!number) file.fail("a frame", in_quotes(word), "a number");
    numbers.push_back(*number);
  }
  return numbers;
}

Eigen::Matrix4d printed_transform(const std::string& text, const FileStream& file) {
  const std::vector<double> place = printed_numbers(text, "Translation:", file);
  const std::vector<double> turn = printed_numbers(text, "in Quaternion", file);
  if (place.size() != 3 || turn.size() != 4) {
    file.fail("a frame",
              std::to_string(place.size()) + " and " + std::to_string(turn.size()) + " numbers",
              "a translation of 3 and a quaternion of 4");
  }
  return pose_of_quaternion(Eigen::Vector3d(place.data()), Eigen::Vector4d(turn.data()));
}

/// True if the first line that says something begins with a number.
bool holds_matrix(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const std::vector<std::string_view> words = words_of(line.substr(0, line.find_first_of("#\r")));
    if (!words.empty()) return parse_number(words[0]).has_value();
  }
  return true;  // of no numbers
}

}  // namespace

Eigen::Matrix4d read_frame(const std::string& path) {
  FileStream file(path);
  if (file.size() > most_foreign_bytes) {
    file.refuse("found " + std::to_string(file.size()) + " bytes, expected at most " +
                std::to_string(most_foreign_bytes) + " for a frame");
  }
  const std::string text(file.peek(file.size()));
  if (holds_matrix(text)) return read_matrix(file);
  if (text.find("ranslation") == text.npos && text.find("position") == text.npos) {
    file.fail("a frame", "neither numbers nor a translation or position", expected_frame);
  }
  try {
    if (text.find("in Quaternion") != text.npos) return printed_transform(text, file);
    return pose_in(JsonObject::of_others(path, text), file);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::bad_file) throw;
    file.refuse(error.what());
  }
}

Eigen::Matrix4d pose_of_quaternion(const Eigen::Vector3d& translation,
                                   const Eigen::Vector4d& quaternion) {
  constexpr double tolerance = 1e-3;
  const double norm = quaternion.norm();
  if (!translation.allFinite() || !quaternion.allFinite()) {
    refuse("pose of a scan: a number is not finite");
  }
  if (std::abs(norm - 1.0) > tolerance) {
    refuse("pose of a scan: the quaternion's norm is " + number_text(norm) +
           ", must be 1 to 0.001");
  }
  Eigen::Matrix4d pose = Eigen::Matrix4d::Identity();
  pose.topLeftCorner<3, 3>() = Eigen::Quaterniond(quaternion / norm).toRotationMatrix();
  pose.topRightCorner<3, 1>() = translation;
  return pose;
}

void write_frame(const std::string& path, const Eigen::Matrix4d& site_from_scan) {
  std::string text;
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index col = 0; col < 4; ++col) {
      text += number_text(site_from_scan(row, col)) + (col == 3 ? "\n" : " ");
    }
  }
  write_file(path, text);
}

void transform(Cloud& cloud, const Eigen::Matrix4d& site_from_scan) {
  if (!site_from_scan.allFinite()) refuse("transform: a number of site_from_scan is not finite");
  const Eigen::Matrix3d rotation = site_from_scan.topLeftCorner<3, 3>();
  const Eigen::Vector3d shift = site_from_scan.topRightCorner<3, 1>();
  for (Eigen::Vector3d& point : cloud.points) point = rotation * point + shift;
  if (cloud.sensor_origin) cloud.sensor_origin = rotation * *cloud.sensor_origin + shift;
}

}  // namespace excavplan
