// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "clouds/cloud_formats.hpp"
#include "clouds/las_system.hpp"

// LAS 1.0 to 1.4 as the American Society for Photogrammetry and Remote Sensing specifies it ("LAS
// Specification 1.4 - R15", 2019, sections 2.4 to 2.7). All numbers are little-endian.

namespace excavplan {
namespace {

constexpr const char* uncompressed =
    "uncompressed LAS: convert it by pdal translate in.laz out.las, or laszip -i in.laz -o out.las";

/// Where the public header block holds a value [byte].
enum Place : std::size_t {
  version_major = 24,
  version_minor = 25,
  header_size = 94,
  offset_to_points = 96,
  number_of_records = 100,
  point_format = 104,
  point_size = 105,
  legacy_count = 107,
  scale_factors = 131,
  coordinate_offsets = 155,
  start_of_waveforms = 227,
  first_extended = 235,
  number_of_extended = 243,
  count_of_points = 247
};

/// Of versions 1.0 to 1.4 [byte].
constexpr std::array<std::size_t, 5> header_sizes = {227, 227, 227, 235, 375};
/// Of point data record formats 0 to 10 [byte].
constexpr std::array<std::size_t, 11> point_sizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::size_t first_new_format = 6;  ///< whose class has a byte of its own
constexpr std::size_t record_head = 54;      ///< of a variable length record [byte]
constexpr std::size_t extended_head = 60;    ///< of an extended one [byte]

struct LasHeader {
  std::size_t format = 0;
  std::size_t size = 0;         ///< of the header [byte]
  std::uint64_t points_at = 0;  ///< [byte]
  std::size_t row = 0;          ///< of a point [byte]
  std::uint64_t count = 0;      ///< of points
  Eigen::Array3d scale;
  Eigen::Array3d offset;
};

std::uint64_t whole_at(std::string_view bytes, std::size_t place, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = size; i > 0; --i) {
    value = value << 8U | static_cast<unsigned char>(bytes[place + i - 1]);
  }
  return value;
}

Eigen::Array3d numbers_at(std::string_view bytes, std::size_t place) {
  const auto number = [&](std::size_t i) {
    return load_scalar(ScalarType::float64, bytes.data() + place + 8 * i, false);
  };
  return {number(0), number(1), number(2)};
}

[[noreturn]] void refuse(const FileStream& file, std::uint64_t place, const std::string& found,
                         const std::string& expected) {
  file.fail("byte " + std::to_string(place), found, expected);
}

/// The minor version. All of the header that it has is there then.
std::size_t read_version(const FileStream& file, std::string_view head) {
  if (head.size() < header_sizes[0]) {
    refuse(file, head.size(), "the end of the file",
           "a LAS header of " + std::to_string(header_sizes[0]) + " bytes");
  }
  const std::uint64_t major = whole_at(head, version_major, 1);
  const std::uint64_t minor = whole_at(head, version_minor, 1);
  if (major != 1 || minor >= header_sizes.size()) {
    refuse(file, version_major, "LAS " + std::to_string(major) + "." + std::to_string(minor),
           "1.0 to 1.4");
  }
  const std::uint64_t size = whole_at(head, header_size, 2);
  if (size < header_sizes[minor] || size > file.size()) {
    refuse(file, header_size, "a header of " + std::to_string(size) + " bytes",
           std::to_string(header_sizes[minor]) + " or more, and no more than the file has");
  }
  return minor;
}

void read_layout(const FileStream& file, std::string_view head, LasHeader& header) {
  header.size = whole_at(head, header_size, 2);
  header.points_at = whole_at(head, offset_to_points, 4);
  if (header.points_at < header.size || header.points_at > file.size()) {
    refuse(file, offset_to_points, "points at byte " + std::to_string(header.points_at),
           "behind the header of " + std::to_string(header.size) + " bytes, within the file of " +
               std::to_string(file.size()));
  }
  header.format = whole_at(head, point_format, 1);
  const std::string name = "point format " + std::to_string(header.format);
  if ((header.format & 0xC0U) != 0) {  // what LASzip adds to the number of the format
    refuse(file, point_format, "points compressed as LAZ", uncompressed);
  }
  if (header.format >= point_sizes.size()) refuse(file, point_format, name, "0 to 10");
  header.row = whole_at(head, point_size, 2);
  if (header.row < point_sizes[header.format]) {
    refuse(file, point_size, "points of " + std::to_string(header.row) + " bytes",
           std::to_string(point_sizes[header.format]) + " or more for " + name);
  }
}

/// Since 1.4 there are two counts, of which the older one is 0 where it cannot hold the number.
std::uint64_t read_count(const FileStream& file, std::string_view head, std::size_t minor) {
  const std::uint64_t legacy = whole_at(head, legacy_count, 4);
  const std::uint64_t count = minor < 4 ? 0 : whole_at(head, count_of_points, 8);
  if (count == 0 || legacy == 0) return std::max(count, legacy);
  if (count != legacy) {
    refuse(file, count_of_points, std::to_string(count) + " points",
           std::to_string(legacy) + ", as at byte " + std::to_string(legacy_count));
  }
  return count;
}

void read_scale(const FileStream& file, std::string_view head, LasHeader& header) {
  header.scale = numbers_at(head, scale_factors);
  header.offset = numbers_at(head, coordinate_offsets);
  if (!header.scale.allFinite() || !(header.scale > 0.0).all()) {
    refuse(file, scale_factors, "a scale factor that is 0, negative or not finite",
           "three above 0");
  }
  if (!header.offset.allFinite()) {
    refuse(file, coordinate_offsets, "an offset that is not finite", "finite numbers");
  }
}

/// Behind the points there may be nothing but what the header tells of.
void check_end(const FileStream& file, std::string_view head, std::size_t minor,
               const LasHeader& header) {
  const std::uint64_t room = file.size() - header.points_at;
  if (header.count > room / header.row) {
    refuse(file, header.points_at, std::to_string(room) + " bytes of points",
           std::to_string(header.count) + " of " + std::to_string(header.row) + " bytes");
  }
  const std::uint64_t end = header.points_at + header.count * header.row;
  const std::uint64_t extended = minor < 4 ? 0 : whole_at(head, number_of_extended, 4);
  const bool has_waveforms = minor >= 3 && whole_at(head, start_of_waveforms, 8) != 0;
  if (extended == 0 && !has_waveforms) file.require_end(end);
  if (extended == 0) return;
  const std::uint64_t begin = whole_at(head, first_extended, 8);
  if (begin < end || begin > file.size() || extended > (file.size() - begin) / extended_head) {
    refuse(file, first_extended,
           std::to_string(extended) + " extended records from byte " + std::to_string(begin),
           "them between the points, which end at byte " + std::to_string(end) +
               ", and the end of the file at " + std::to_string(file.size()));
  }
}

/// What a record of the coordinate system says; of two the well-known text counts.
void read_system(std::string_view head, std::string_view content, LasSystem& system) {
  constexpr std::uint64_t geokeys = 34735, wkt = 2112;
  const std::uint64_t kind = whole_at(head, 18, 2);
  if (head.substr(2, 15) != "LASF_Projection" || (kind != geokeys && kind != wkt)) return;
  const bool is_known = system.plan_unit || system.not_plane != nullptr;
  if (kind == wkt || !is_known) {
    system = kind == wkt ? system_of_wkt(content) : system_of_geokeys(content);
  }
}

/// Goes to the first point, past records in which a LAZ file says what it is.
LasSystem read_records(FileStream& file, std::uint64_t records, const LasHeader& header) {
  LasSystem system;
  file.skip(header.size);
  for (std::uint64_t i = 0; i < records; ++i) {
    const std::uint64_t left = header.points_at - file.offset();
    const std::string_view head = file.peek(std::min<std::uint64_t>(record_head, left));
    const std::uint64_t size =
        head.size() < record_head ? left : record_head + whole_at(head, 20, 2);
    if (head.size() < record_head || size > left) {
      file.fail_here("variable length record " + std::to_string(i + 1) + " of " +
                         std::to_string(records) + " reaching past the first point",
                     "its end by byte " + std::to_string(header.points_at));
    }
    if (head.substr(2, 14) == "laszip encoded") file.fail_here("a record of LASzip", uncompressed);
    const std::string_view whole = file.peek(size);
    read_system(whole.substr(0, record_head), whole.substr(record_head), system);
    file.skip(size);
  }
  file.skip(header.points_at - file.offset());
  return system;
}

/// The unit of all coordinates, where the coordinate system tells one [m].
std::optional<double> require_lengths(const FileStream& file, const LasSystem& system) {
  constexpr double alike = 1e-5;  // of a foot and a US survey foot, which differ by 2e-6
  if (system.not_plane != nullptr) {
    file.refuse(std::string("found ") + system.not_plane +
                " by its coordinate system, expected lengths with z up: project them, e.g. pdal "
                "translate in.las out.las reprojection --filters.reprojection.out_srs=EPSG:32632");
  }
  const std::optional<double> plan = system.plan_unit;
  if (plan && system.up_unit && std::abs(*system.up_unit / *plan - 1.0) > alike) {
    file.refuse("found z in units of " + number_text(*system.up_unit) + " m and x, y in units of " +
                number_text(*plan) +
                " m by its coordinate system, expected one unit: convert it, e.g. pdal translate "
                "in.las out.las assign --filters.assign.value=\"Z = Z * FACTOR\"");
  }
  return plan;
}

/// False of a point that another program withheld or classified as noise: 7 "low point (noise)" and
/// 18 "high noise".
bool counts(const char* point, std::size_t format) {
  const bool is_new = format >= first_new_format;
  const auto flags = static_cast<unsigned char>(point[15]);
  const unsigned kind = is_new ? static_cast<unsigned char>(point[16]) : flags & 31U;
  const bool is_withheld = (flags & (is_new ? 4U : 128U)) != 0;
  return !is_withheld && kind != 7 && kind != 18;
}

/// Counts coordinates at an end of the range of 32 bits, where writers leave what lies beyond it.
class Saturation {
 public:
  void add(const std::array<std::int32_t, 3>& raw) {
    constexpr auto highest = std::numeric_limits<std::int32_t>::max();
    constexpr auto lowest = std::numeric_limits<std::int32_t>::min();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (raw[axis] == highest || raw[axis] == lowest) ++points_[axis];
    }
  }
  /// @throws Error (bad_file) where they are more than stray points
  void check(const FileStream& file, const LasHeader& header) const {
    constexpr std::uint64_t fewest = 10;  // ours
    constexpr double most = 0.01;         // ours, of the points
    const auto worst = std::max_element(points_.begin(), points_.end());
    if (*worst < fewest ||
        static_cast<double>(*worst) <= most * static_cast<double>(header.count)) {
      return;
    }
    const auto axis = worst - points_.begin();
    const std::string name(1, "xyz"[axis]);
    file.refuse("found " + std::to_string(*worst) + " of " + std::to_string(header.count) +
                " points at the limit of a 32-bit integer in " + name + ": its offset " +
                number_text(header.offset[axis]) + " with the scale factor " +
                number_text(header.scale[axis]) +
                " cannot hold the coordinates, which are lost; write it anew from its source with "
                "an offset near the points, e.g. pdal translate in.laz out.las "
                "--writers.las.offset_" +
                name + "=auto");
  }

 private:
  std::array<std::uint64_t, 3> points_{};  ///< by axis
};

std::uint64_t stream_points(FileStream& file, const LasHeader& header, PointSink& sink) {
  constexpr std::size_t at_a_time = std::size_t{1} << 18;  // [byte]
  const std::size_t most = std::max<std::size_t>(1, at_a_time / header.row);
  PointBatch batch(sink);
  std::uint64_t kept = 0;
  Saturation saturation;
  for (std::uint64_t left = header.count; left > 0;) {
    const auto rows = static_cast<std::size_t>(std::min<std::uint64_t>(most, left));
    const char* const block = file.peek(rows * header.row).data();
    for (const char* p = block; p != block + rows * header.row; p += header.row) {
      if (!counts(p, header.format)) continue;
      std::array<std::int32_t, 3> raw;
      std::memcpy(raw.data(), p, sizeof raw);
      saturation.add(raw);
      const Eigen::Array3d steps(raw[0], raw[1], raw[2]);
      batch.add((steps * header.scale + header.offset).matrix());
      ++kept;
    }
    file.skip(rows * header.row);
    left -= rows;
  }
  batch.hand_on();
  saturation.check(file, header);
  return kept;
}

CloudShape stream_las(FileStream& file, PointSink& sink) {
  const std::string_view head = file.peek(header_sizes.back());
  const std::size_t minor = read_version(file, head);
  LasHeader header;
  read_layout(file, head, header);
  header.count = read_count(file, head, minor);
  read_scale(file, head, header);
  check_end(file, head, minor, header);
  const std::uint64_t records = whole_at(head, number_of_records, 4);
  sink.require_memory(header.count, 0);
  const auto unit = require_lengths(file, read_records(file, records, header));
  const std::uint64_t kept = stream_points(file, header, sink);
  return {kept, 1, {}, header.count - kept, unit};
}

bool holds_las(FileStream& file) { return file.peek(4) == "LASF"; }

}  // namespace

CloudFileFormat las_format() {
  return {"las", "LAS", {".las", ".laz"}, holds_las, stream_las, nullptr};
}

}  // namespace excavplan
