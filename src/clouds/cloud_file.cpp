// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <excavplan/base/error.hpp>
#include <excavplan/clouds/cloud.hpp>

#include "base/files.hpp"
#include "base/text.hpp"
#include "clouds/cloud_formats.hpp"

namespace excavplan {
namespace {

/// The ending of a file name in small letters, with its dot.
std::string ending_of(const std::string& path) {
  const std::size_t dot = path.find_last_of("./");
  if (dot == path.npos || path[dot] == '/') return "";
  return small_letters(path.substr(dot));
}

/// "a, b or c"
std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  }
  return text;
}

CloudShape stream(FileStream& file, PointSink& sink) {
  std::vector<std::string> titles;
  for (const CloudFileFormat& format : cloud_file_formats()) {
    if (format.holds(file)) return format.stream(file, sink);
    titles.push_back(format.title);
  }
  const auto foreign = foreign_content(file);
  file.fail(foreign ? foreign->place : "byte 0", foreign ? foreign->found : "text",
            "a cloud as " + alternatives(titles) + (foreign ? foreign->hint : ""));
}

[[noreturn]] void refuse_size(const FileStream& file, std::uint64_t points, std::uint64_t limit) {
  file.refuse("found " + std::to_string(file.size()) + " bytes for " + std::to_string(points) +
              " points, expected what fits into " +
              decimals(static_cast<double>(limit) / (1 << 30), 3) + " GiB of memory");
}

/// Keeps all points. The limit counts them and the file.
class Collector : public PointSink {
 public:
  Collector(const FileStream& file, std::uint64_t limit, std::vector<Eigen::Vector3d>& points)
      : file_(file), limit_(limit), points_(points) {}

  void require_memory(std::uint64_t points, std::uint64_t more_bytes) override {
    const std::uint64_t free = limit_ > file_.size() ? limit_ - file_.size() : 0;
    const bool fits = file_.size() <= limit_ && more_bytes <= free &&
                      points <= (free - more_bytes) / sizeof(Eigen::Vector3d);
    if (!fits) refuse_size(file_, points, limit_);
    points_.reserve(points);
  }

  void take(const std::vector<Eigen::Vector3d>& points) override {
    const std::size_t needed = points_.size() + points.size();
    if (needed > points_.capacity()) {
      require_memory(std::max(needed, std::min(2 * points_.capacity(), most_points())), 0);
    }
    points_.insert(points_.end(), points.begin(), points.end());
  }

 private:
  std::size_t most_points() const {
    return (limit_ - std::min(limit_, file_.size())) / sizeof(Eigen::Vector3d);
  }

  const FileStream& file_;
  std::uint64_t limit_;
  std::vector<Eigen::Vector3d>& points_;
};

/// Keeps no point.
class Passage : public PointSink {
 public:
  Passage(const FileStream& file, const PointVisitor& visit) : file_(file), visit_(visit) {}

  void require_memory(std::uint64_t points, std::uint64_t more_bytes) override {
    constexpr std::uint64_t limit = std::uint64_t{4} << 30;
    if (more_bytes > limit) refuse_size(file_, points, limit);
  }
  void take(const std::vector<Eigen::Vector3d>& points) override { visit_(points); }

 private:
  const FileStream& file_;
  const PointVisitor& visit_;
};

/// @throws Error (bad_input) if none is written by this name
const CloudFileFormat& written_format(const std::string& path, const std::string& name) {
  const auto& formats = cloud_file_formats();
  const auto known = std::find_if(formats.begin(), formats.end(), [&](const CloudFileFormat& f) {
    return f.head != nullptr && f.name == name;
  });
  if (known != formats.end()) return *known;
  throw Error(ErrorKind::bad_input,
              path + ": " + in_quotes(name) + " is not a supported output format");
}

std::string rows_of(const std::vector<Eigen::Vector3d>& points, Numbers numbers) {
  if (numbers == Numbers::text) return text_rows(points);
  return binary_rows(points, numbers == Numbers::float64);
}

}  // namespace

Cloud read_cloud(const std::string& path, std::uint64_t memory_limit) {
  FileStream file(path);
  Cloud cloud;
  Collector collector(file, memory_limit, cloud.points);
  collector.require_memory(0, 0);
  const CloudShape shape = stream(file, collector);
  cloud.width = shape.width;
  cloud.height = shape.height;
  cloud.sensor_origin = shape.sensor;
  cloud.left_out = shape.left_out;
  return cloud;
}

std::optional<Eigen::Vector3d> read_sensor_origin(const std::string& path) {
  FileStream file(path);
  for (const CloudFileFormat& format : cloud_file_formats()) {
    if (format.holds(file)) return format.sensor ? format.sensor(file) : std::nullopt;
  }
  return std::nullopt;
}

CloudShape stream_shape(const std::string& path, const PointVisitor& visit) {
  FileStream file(path);
  Passage passage(file, visit);
  return stream(file, passage);
}

void stream_cloud(const std::string& path, const PointVisitor& visit) { stream_shape(path, visit); }

void write_points(const std::string& path, const OrderedPoints& source, const CloudFormat& format) {
  const CloudFileFormat& written = written_format(path, format.name);
  Numbers numbers = format.text || written.is_text ? Numbers::text : Numbers::float32;
  const CloudShape shape = source([&](const std::vector<Eigen::Vector3d>& points) {
    if (numbers == Numbers::float32 && needs_double(points)) numbers = Numbers::float64;
  });
  write_file(path, [&](const auto& append) {
    append(written.head(shape, numbers));
    const CloudShape again = source(
        [&](const std::vector<Eigen::Vector3d>& points) { append(rows_of(points, numbers)); });
    if (again.points() != shape.points()) refuse_change();
  });
}

void write_cloud(const std::string& path, const Cloud& cloud, const CloudFormat& format) {
  if (cloud.width * cloud.height != cloud.points.size()) {
    throw Error(ErrorKind::bad_input, path + ": a cloud of " + std::to_string(cloud.points.size()) +
                                          " points must be width x height, is " +
                                          std::to_string(cloud.width) + " x " +
                                          std::to_string(cloud.height));
  }
  const OrderedPoints source = [&cloud](const PointVisitor& visit) {
    visit_parts(cloud.points, visit);
    return CloudShape{cloud.width, cloud.height, cloud.sensor_origin};
  };
  write_points(path, source, format);
}

CloudFormat cloud_format_of_name(const std::string& path) {
  const std::string ending = ending_of(path);
  for (const CloudFileFormat& format : cloud_file_formats()) {
    const auto& own = format.endings;
    if (std::find(own.begin(), own.end(), ending) == own.end()) continue;
    if (format.head != nullptr) return {format.name};
    throw Error(ErrorKind::bad_input, path + ": " + format.title +
                                          " is read, not written; the name must end in " +
                                          cloud_endings());
  }
  throw Error(ErrorKind::bad_input, path + ": the name of a cloud must end in " + cloud_endings());
}

std::string cloud_endings() {
  std::vector<std::string> endings;
  for (const CloudFileFormat& format : cloud_file_formats()) {
    if (format.head == nullptr) continue;
    endings.insert(endings.end(), format.endings.begin(), format.endings.end());
  }
  return alternatives(endings);
}

}  // namespace excavplan
