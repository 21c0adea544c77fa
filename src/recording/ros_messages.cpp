// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/ros_messages.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <excavplan/base/error.hpp>

#include "base/non_finite.hpp"
#include "base/scalar.hpp"
#include "base/text.hpp"
#include "images/depth_png.hpp"

namespace excavplan {
namespace {

constexpr std::size_t longest_name = 4096;  // of frames, fields, joints; ours [byte]

/// The fields of a message from front to back.
class FieldReader {
 public:
  FieldReader(const std::string& file, const RecordedMessage& message)
      : file_(file), message_(message), bytes_(message.bytes) {
    if (is_cdr()) read_encapsulation();
  }

  bool is_cdr() const { return message_.serialization == Serialization::cdr; }
  bool swapped() const { return swapped_; }

  template <typename T>
  T number() {
    align(sizeof(T));
    return load<T>(take(sizeof(T)).data(), swapped_);
  }
  template <int size>
  Eigen::Matrix<double, size, 1> numbers() {
    Eigen::Matrix<double, size, 1> values;
    for (int i = 0; i < size; ++i) values[i] = number<double>();
    return values;
  }
  std::string name() {
    std::size_t length = number<std::uint32_t>();
    if (length > longest_name) {
      fail("a name of " + std::to_string(length) + " bytes",
           "at most " + std::to_string(longest_name));
    }
    std::string_view text = take(length);
    if (is_cdr() && !text.empty() && text.back() == '\0') text.remove_suffix(1);
    return std::string(text);
  }
  /// Elements of a sequence, of which each takes so many bytes at least.
  std::size_t count(const char* what, std::size_t least_bytes) {
    const std::uint64_t elements = number<std::uint32_t>();
    if (elements * least_bytes > left()) {
      fail(std::to_string(elements) + " " + what + " in " + std::to_string(left()) + " bytes",
           "at least " + std::to_string(least_bytes) + " bytes each");
    }
    return elements;
  }
  std::string_view take(std::size_t bytes) {
    if (bytes > left()) {
      fail("the end of the message at byte " + std::to_string(bytes_.size()),
           std::to_string(bytes) + " more bytes at byte " + std::to_string(at_));
    }
    const std::string_view taken = bytes_.substr(at_, bytes);
    at_ += bytes;
    return taken;
  }
  /// Goes to the next multiple of `size` behind the encapsulation, in CDR.
  void align(std::size_t size) {
    if (is_cdr()) take((size - (at_ - origin_) % size) % size);
  }
  std::size_t left() const { return bytes_.size() - at_; }

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw Error(ErrorKind::bad_file,
                file_ + ": " + message_.place + ": found " + found + ", expected " + expected);
  }

 private:
  void read_encapsulation() {
    const std::string_view head = take(4);
    if (head[0] != 0 || (head[1] != 0 && head[1] != 1)) {
      const auto code = [&](std::size_t i) {
        return std::to_string(static_cast<unsigned char>(head[i]));
      };
      fail("the representation " + code(0) + " " + code(1), "plain CDR, 0 0 or 0 1");
    }
    swapped_ = head[1] == 0;
    origin_ = at_;
  }

  const std::string& file_;
  const RecordedMessage& message_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t origin_ = 0;
  bool swapped_ = false;
};

MessageHeader read_header(FieldReader& reader) {
  if (!reader.is_cdr()) reader.number<std::uint32_t>();  // seq
  MessageHeader header;
  std::int64_t seconds = 0;
  if (reader.is_cdr()) {
    seconds = reader.number<std::int32_t>();
  } else {
    seconds = reader.number<std::uint32_t>();
  }
  header.stamp = seconds * 1000000000 + reader.number<std::uint32_t>();
  header.frame = reader.name();
  if (!header.frame.empty() && header.frame.front() == '/') header.frame.erase(0, 1);
  return header;
}

FrameSize read_size(FieldReader& reader) {
  FrameSize size;
  size.height = reader.number<std::uint32_t>();
  size.width = reader.number<std::uint32_t>();
  return size;
}

std::string text_of(const FrameSize& size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
}

/// Elements that lie in rows with padding between them.
struct Grid {
  FrameSize size;
  std::size_t step = 0;      ///< from element to element [byte]
  std::size_t row_step = 0;  ///< from row to row [byte]
  std::string_view data;
};

/// Of uint32 numbers, which cannot overflow in 64 bits but for the product of three.
void require_fits(const FieldReader& reader, const Grid& grid, const std::string& what) {
  const std::size_t row = grid.size.width * grid.step;
  if (grid.size.height > 1 && grid.row_step < row) {
    reader.fail("rows of " + std::to_string(grid.row_step) + " bytes",
                std::to_string(row) + " for " + std::to_string(grid.size.width) + " " + what +
                    " of " + std::to_string(grid.step) + " bytes");
  }
  const std::size_t rows = grid.size.height;
  if (rows == 0 || row == 0) return;
  if (row > grid.data.size() || (rows - 1) * grid.row_step > grid.data.size() - row) {
    reader.fail(std::to_string(grid.data.size()) + " bytes of data",
                text_of(grid.size) + " " + what + " of " + std::to_string(grid.step) + " bytes");
  }
}

/// Calls `put(i, value)` with every element of a grid at `offset` in it.
template <typename T, typename Put>
void each_element(const Grid& grid, std::size_t offset, bool swapped, Put put) {
  if (grid.size.width == 0) return;  // of rows there may be any number
  std::size_t i = 0;
  for (std::size_t row = 0; row < grid.size.height; ++row) {
    const char* bytes = grid.data.data() + row * grid.row_step + offset;
    for (std::size_t column = 0; column < grid.size.width; ++column, bytes += grid.step) {
      put(i++, load<T>(bytes, swapped));
    }
  }
}

void forget_empty_returns(std::vector<Eigen::Vector3d>& points) {
  for (Eigen::Vector3d& point : points) {
    if (point.x() == 0.0 && point.y() == 0.0 && point.z() == 0.0) point.setConstant(nan);
  }
}

// ---- PointCloud2 ------------------------------------------------------------------------------

struct PointField {
  std::size_t offset = 0;
  ScalarType type = ScalarType::float32;
};

/// The numbers of sensor_msgs/PointField.
ScalarType type_of(const FieldReader& reader, const std::string& name, unsigned datatype) {
  constexpr std::array<ScalarType, 8> types = {
      ScalarType::int8,  ScalarType::uint8,  ScalarType::int16,   ScalarType::uint16,
      ScalarType::int32, ScalarType::uint32, ScalarType::float32, ScalarType::float64};
  if (datatype < 1 || datatype > types.size()) {
    reader.fail("datatype " + std::to_string(datatype) + " of field " + name, "1 to 8");
  }
  return types[datatype - 1];
}

std::array<PointField, 3> read_fields(FieldReader& reader) {
  constexpr std::size_t least_bytes = 13;  // no name, offset, datatype and count
  std::array<PointField, 3> xyz;
  std::array<int, 3> times{};
  for (std::size_t left = reader.count("fields", least_bytes); left > 0; --left) {
    const std::string name = reader.name();
    PointField field;
    field.offset = reader.number<std::uint32_t>();
    const unsigned datatype = reader.number<std::uint8_t>();
    reader.number<std::uint32_t>();  // count
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (name != std::string_view("xyz").substr(axis, 1)) continue;
      field.type = type_of(reader, name, datatype);
      xyz[axis] = field;
      ++times[axis];
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (times[axis] == 1) continue;
    reader.fail(
        "field " + std::string(1, "xyz"[axis]) + " " + std::to_string(times[axis]) + " times",
        "x, y and z once each");
  }
  return xyz;
}

/// Of a cloud, in the bytes that it was read from.
struct CloudLayout {
  Grid grid;
  std::array<PointField, 3> xyz;
  bool swapped = false;
};

CloudLayout read_layout(FieldReader& reader) {
  read_header(reader);
  CloudLayout layout;
  Grid& grid = layout.grid;
  grid.size = read_size(reader);
  layout.xyz = read_fields(reader);
  layout.swapped = reader.number<std::uint8_t>() != 0;
  grid.step = reader.number<std::uint32_t>();
  grid.row_step = reader.number<std::uint32_t>();
  for (const PointField& field : layout.xyz) {
    if (field.offset + size_of(field.type) <= grid.step) continue;
    reader.fail("points of " + std::to_string(grid.step) + " bytes",
                std::to_string(size_of(field.type)) + " bytes of a coordinate at byte " +
                    std::to_string(field.offset));
  }
  grid.data = reader.take(reader.count("bytes of data", 1));
  require_fits(reader, grid, "points");
  return layout;
}

PointMessage decode_cloud(FieldReader& reader) {
  const auto [grid, xyz, swapped] = read_layout(reader);
  PointMessage cloud;
  cloud.size = grid.size;
  cloud.points.resize(grid.size.pixels());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const PointField& field = xyz[axis];
    with_type(field.type, [&, &grid = grid, swapped = swapped](auto kind) {
      each_element<decltype(kind)>(grid, field.offset, swapped, [&](std::size_t i, auto value) {
        cloud.points[i][static_cast<Eigen::Index>(axis)] = static_cast<double>(value);
      });
    });
  }
  forget_empty_returns(cloud.points);
  return cloud;
}

// ---- Livox ------------------------------------------------------------------------------------

/// Up to the points, of which it gives the number.
std::size_t read_livox_head(FieldReader& reader) {
  constexpr std::size_t point_bytes = 19;
  read_header(reader);
  reader.number<std::uint64_t>();                      // timebase
  const auto points = reader.number<std::uint32_t>();  // again as the length of the sequence
  reader.take(4);                                      // lidar_id, 3 reserved
  const std::size_t count = reader.count("points", point_bytes);
  if (count != points) {
    reader.fail(std::to_string(count) + " points", "point_num = " + std::to_string(points));
  }
  return count;
}

/// offset_time, x, y, z, and three bytes: in CDR every point begins at a multiple of 4.
PointMessage decode_livox(FieldReader& reader) {
  PointMessage cloud;
  cloud.points.resize(read_livox_head(reader));
  cloud.size.width = cloud.points.size();
  for (Eigen::Vector3d& point : cloud.points) {
    reader.number<std::uint32_t>();
    for (int axis = 0; axis < 3; ++axis) point[axis] = reader.number<float>();
    reader.take(3);
  }
  forget_empty_returns(cloud.points);
  return cloud;
}

bool is_livox(const RecordedMessage& message) {
  return message.topic.type.find("CustomMsg") != std::string::npos;
}

// ---- Images -----------------------------------------------------------------------------------

float depth_or_unknown(float depth) {
  return std::isfinite(depth) && depth > 0.0F ? depth : static_cast<float>(nan);
}

template <typename T>
void read_depths(const Grid& grid, bool swapped, double unit, std::vector<float>& depths) {
  each_element<T>(grid, 0, swapped, [&](std::size_t i, T value) {
    depths[i] = depth_or_unknown(static_cast<float>(value) * static_cast<float>(unit));
  });
}

/// Of a raw image, in the bytes that it was read from.
struct ImageLayout {
  Grid grid;
  bool is_float = false;
  bool swapped = false;
};

ImageLayout read_image(FieldReader& reader) {
  read_header(reader);
  ImageLayout layout;
  Grid& grid = layout.grid;
  grid.size = read_size(reader);
  const std::string encoding = reader.name();
  layout.is_float = encoding == "32FC1";
  if (!layout.is_float && encoding != "16UC1" && encoding != "mono16") {
    reader.fail("an image of encoding " + in_quotes(encoding), "depths as 16UC1, mono16 or 32FC1");
  }
  grid.step = layout.is_float ? sizeof(float) : sizeof(std::uint16_t);
  layout.swapped = reader.number<std::uint8_t>() != 0;
  grid.row_step = reader.number<std::uint32_t>();
  grid.data = reader.take(reader.count("bytes of data", 1));
  require_fits(reader, grid, "pixels");
  return layout;
}

/// A PNG image in a message, and how its counts mean depths.
struct CompressedDepth {
  std::string_view png;
  FrameSize size;
  bool is_inverse =
      false;       ///< depth = a / (count - b), as compressed_depth_image_transport's codec
  double a = 0.0;  ///< [m]
  double b = 0.0;
};

CompressedDepth read_compressed(FieldReader& reader) {
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  constexpr std::size_t config = 12;   // before the PNG: its kind, a and b, 4 bytes each
  constexpr std::size_t size_at = 16;  // in the PNG: width and height, the higher bytes first
  constexpr std::size_t longest_side = 65535;
  read_header(reader);
  const std::string format = reader.name();
  const std::string_view data = reader.take(reader.count("bytes of data", 1));
  const bool has_config = data.substr(0, signature.size()) != signature;
  CompressedDepth image;
  image.png = data.substr(std::min(has_config ? config : 0, data.size()));
  const bool is_float = format.rfind("32FC1", 0) == 0;
  if (image.png.substr(0, signature.size()) != signature || image.png.size() < size_at + 8 ||
      (is_float && !has_config)) {
    reader.fail("an image compressed as " + in_quotes(format),
                "depths as PNG: 16UC1, or what compressedDepth writes; others play through "
                "image_transport's republish");
  }
  image.is_inverse = is_float;
  if (has_config) {
    image.a = static_cast<double>(load<float>(data.data() + 4, false));
    image.b = static_cast<double>(load<float>(data.data() + 8, false));
  }
  image.size.width = load<std::uint32_t>(image.png.data() + size_at, true);
  image.size.height = load<std::uint32_t>(image.png.data() + size_at + 4, true);
  if (image.size.width > longest_side || image.size.height > longest_side) {
    reader.fail("an image of " + text_of(image.size) + " pixels", "at most 65535 a side");
  }
  return image;
}

bool is_compressed(const RecordedMessage& message) {
  return use_of(message.topic.type) == MessageUse::compressed;
}

DepthMessage decode_compressed(const std::string& file, const RecordedMessage& message,
                               double unit) {
  FieldReader reader(file, message);
  const CompressedDepth compressed = read_compressed(reader);
  const DepthPng png = decode_depth_png(file + ": " + message.place, std::string(compressed.png));
  DepthMessage image;
  image.size.width = png.width;
  image.size.height = png.height;
  image.is_counted = !compressed.is_inverse;
  image.depths.resize(png.pixels());
  for (std::size_t i = 0; i < png.pixels(); ++i) {
    const double count = png.count(i);
    const double inverse = count > 0.0 ? compressed.a / (count - compressed.b) : 0.0;
    image.depths[i] =
        depth_or_unknown(static_cast<float>(compressed.is_inverse ? inverse : count * unit));
  }
  return image;
}

}  // namespace

MessageUse use_of(const std::string& type) {
  constexpr std::array<std::pair<const char*, MessageUse>, 9> known = {{
      {"sensor_msgs/msg/PointCloud2", MessageUse::points},
      {"livox_ros_driver2/msg/CustomMsg", MessageUse::points},
      {"livox_ros_driver/msg/CustomMsg", MessageUse::points},
      {"sensor_msgs/msg/Image", MessageUse::depth},
      {"sensor_msgs/msg/CompressedImage", MessageUse::compressed},
      {"sensor_msgs/msg/CameraInfo", MessageUse::camera},
      {"tf2_msgs/msg/TFMessage", MessageUse::transforms},
      {"tf/msg/tfMessage", MessageUse::transforms},
      {"sensor_msgs/msg/JointState", MessageUse::joints},
  }};
  for (const auto& [name, use] : known) {
    if (type == name) return use;
  }
  return MessageUse::none;
}

MessageHeader decode_header(const std::string& file, const RecordedMessage& message) {
  FieldReader reader(file, message);
  return read_header(reader);
}

FrameSize decode_size(const std::string& file, const RecordedMessage& message) {
  FieldReader reader(file, message);
  if (is_livox(message)) return {read_livox_head(reader), 1};
  const MessageUse use = use_of(message.topic.type);
  if (use == MessageUse::depth) return read_image(reader).grid.size;
  return use == MessageUse::compressed ? read_compressed(reader).size
                                       : read_layout(reader).grid.size;
}

PointMessage decode_points(const std::string& file, const RecordedMessage& message) {
  FieldReader reader(file, message);
  return is_livox(message) ? decode_livox(reader) : decode_cloud(reader);
}

DepthMessage decode_depths(const std::string& file, const RecordedMessage& message, double unit) {
  if (is_compressed(message)) return decode_compressed(file, message, unit);
  FieldReader reader(file, message);
  const auto [grid, is_float, swapped] = read_image(reader);
  DepthMessage image;
  image.size = grid.size;
  image.is_counted = !is_float;
  image.depths.resize(grid.size.pixels());
  is_float ? read_depths<float>(grid, swapped, 1.0, image.depths)
           : read_depths<std::uint16_t>(grid, swapped, unit, image.depths);
  return image;
}

CameraMessage decode_camera(const std::string& file, const RecordedMessage& message) {
  FieldReader reader(file, message);
  read_header(reader);
  CameraMessage camera;
  camera.size = read_size(reader);
  reader.name();  // of the distortion model
  camera.distortion.resize(reader.count("distortion coefficients", sizeof(double)));
  for (double& value : camera.distortion) value = reader.number<double>();
  camera.intrinsics = reader.numbers<9>();
  reader.numbers<9>();  // R
  camera.rectified_projection = reader.numbers<12>();
  return camera;
}

bool holds_static_transforms(const std::string& topic) {
  constexpr std::string_view end = "tf_static";
  return topic.size() >= end.size() &&
         topic.compare(topic.size() - end.size(), topic.npos, end) == 0;
}

std::vector<StampedTransform> decode_transforms(const std::string& file,
                                                const RecordedMessage& message) {
  constexpr std::size_t least_bytes = 72;  // two empty names, a time and seven float64
  const bool is_static = holds_static_transforms(message.topic.name);
  FieldReader reader(file, message);
  std::vector<StampedTransform> transforms(reader.count("transforms", least_bytes));
  for (StampedTransform& transform : transforms) {
    MessageHeader header = read_header(reader);
    transform.stamp = header.stamp;
    transform.parent = std::move(header.frame);
    transform.child = reader.name();
    if (!transform.child.empty() && transform.child.front() == '/') transform.child.erase(0, 1);
    transform.translation = reader.numbers<3>();
    transform.rotation = reader.numbers<4>();
    transform.is_static = is_static;
  }
  return transforms;
}

std::vector<std::pair<std::string, double>> decode_joints(const std::string& file,
                                                          const RecordedMessage& message) {
  constexpr std::size_t least_bytes = 4;
  FieldReader reader(file, message);
  read_header(reader);
  std::vector<std::pair<std::string, double>> joints(reader.count("names", least_bytes));
  for (auto& joint : joints) joint.first = reader.name();
  const std::size_t positions = reader.count("positions", sizeof(double));
  if (positions == 0) return {};
  if (positions != joints.size()) {
    reader.fail(std::to_string(positions) + " positions",
                std::to_string(joints.size()) + ", one for each name, or none");
  }
  for (auto& joint : joints) joint.second = reader.number<double>();
  return joints;
}

}  // namespace excavplan
