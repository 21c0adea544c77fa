// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/job_design.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/files.hpp"
#include "base/json.hpp"
#include "clouds/file_stream.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

constexpr std::size_t most_corners = 1000;  // ours
constexpr double farthest_corner = 1e9;     // [m]; that of a map
constexpr double highest_thing = 100.0;     // obstacle, truck or depth [m]; ours
constexpr double heaviest_load = 1e6;       // [kg]; ours
constexpr double most_turned = 1e3;         // of the machine at the start [rad]; ours

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool is_crossed(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  const auto side = [](const Vector2d& p, const Vector2d& q, const Vector2d& r) {
    return cross(q - p, r - p);
  };
  return side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
}

/// Why corners make no polygon; empty if they do.
std::string fault_of(const SitePolygon& polygon) {
  const std::size_t n = polygon.size();
  if (n < 3 || n > most_corners)
    return "has " + std::to_string(n) + " corners, must have 3 .. 1000";
  double area = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(polygon[i].cwiseAbs().maxCoeff() <= farthest_corner)) {
      return "has a corner farther than 1e9 m";
    }
    area += 0.5 * cross(polygon[i] - polygon[0], polygon[(i + 1) % n] - polygon[0]);
  }
  if (!(std::abs(area) > 1e-6)) return "has no area";
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = i + 2; k < n; ++k) {
      if (is_crossed(polygon[i], polygon[i + 1], polygon[k], polygon[(k + 1) % n])) {
        return "has sides that cross";
      }
    }
  }
  return {};
}

void require_polygon(const std::string& what, const SitePolygon& polygon) {
  const std::string fault = fault_of(polygon);
  require(fault.empty(), what + ": its polygon " + fault);
}

/// An object of the description; errors name file, key and rule.
SitePolygon polygon_of(JsonObject& object, const char* key, const nlohmann::json& file_part) {
  SitePolygon polygon;
  const auto found = file_part.find(key);
  if (found == file_part.end() || !found->is_array()) object.fail(key, "must be a list of corners");
  for (const nlohmann::json& corner : *found) {
    if (!corner.is_array() || corner.size() != 2 || !corner[0].is_number() ||
        !corner[1].is_number()) {
      object.fail(key, "has the corner " + shown(corner) + ", must be [x, y]");
    }
    polygon.emplace_back(corner[0].get<double>(), corner[1].get<double>());
  }
  const std::string fault = fault_of(polygon);
  if (!fault.empty()) object.fail(key, fault);
  return polygon;
}

/// The description, as objects with good errors and as plain values for lists of lists.
class PlainSite {
 public:
  explicit PlainSite(const std::string& path)
      : path_(path),
        content_(read_file(path, most_foreign_bytes)),
        json_(parse_json(path, content_)),
        top_(JsonObject::of_others(path, content_)) {}

  JobDesign read() {
    top_.require_format("plain-site");
    JobDesign job;
    job.name = top_.text_or("id", "");
    job.tolerance = top_.number_or("tolerance_m", job.tolerance, 1e-4, 10.0);
    job.edge_margin = top_.number_or("edge_margin_m", job.edge_margin, 0.0, 100.0);
    if (top_.states("design")) job.words = words_of(top_.object("design"));
    if (top_.states("files")) read_files(job);
    if (top_.states("start_pose")) {
      JsonObject pose = top_.object("start_pose");
      const auto place = [&](const char* key) {
        return pose.number(key, -farthest_corner, farthest_corner);
      };
      job.start = BasePose{place("x"), place("y"), 0.0,
                           pose.number("heading_rad", -most_turned, most_turned)};
    }
    each("keep_out", [&](JsonObject& object, const nlohmann::json& part) {
      KeepOut keep_out = {object.text_or("kind", ""), polygon_of(object, "polygon", part), {}};
      if (object.states("depth_m")) {
        keep_out.depth = object.number("depth_m", 0.0, highest_thing);
      }
      job.keep_out.push_back(keep_out);
    });
    each("obstacles", [&](JsonObject& object, const nlohmann::json& part) {
      job.obstacles.push_back({object.text_or("kind", ""), polygon_of(object, "polygon", part),
                               object.number("height_m", 0.01, highest_thing)});
    });
    each("dump_areas", [&](JsonObject& object, const nlohmann::json& part) {
      const std::string kind = object.text("kind");
      if (kind != "windrow" && kind != "heap") {
        object.fail("kind", "is " + in_quotes(kind) + ", must be windrow or heap");
      }
      job.dump_areas.push_back({kind == "heap" ? DumpArea::Kind::heap : DumpArea::Kind::windrow,
                                polygon_of(object, "polygon", part)});
    });
    if (top_.states("truck")) {
      JsonObject truck = top_.object("truck");
      job.truck = JobTruck{polygon_of(truck, "bed_polygon", json_["truck"]),
                           truck.number("bed_height_m", 0.1, highest_thing),
                           truck.number("target_kg", 1.0, heaviest_load)};
    }
    if (top_.states("sensor")) {
      JsonObject sensor = top_.object("sensor");
      job.sensor = SensorErrors{sensor.number_or("noise_sd_at_1m_m", 0.0, 0.0, 10.0),
                                sensor.number_or("pattern_sd_at_1m_m", 0.0, 0.0, 10.0),
                                sensor.number_or("range_power", 0.0, 0.0, 4.0)};
    }
    return job;
  }

 private:
  template <typename Take>
  void each(const char* key, Take take) {
    if (!top_.states(key)) return;
    std::vector<JsonObject> objects = top_.objects(key);
    for (std::size_t i = 0; i < objects.size(); ++i) take(objects[i], json_[key][i]);
  }

  static DesignWords words_of(JsonObject design) {
    const std::string kind = design.text("kind");
    DesignWords words;
    const bool is_slope = kind == "slope" || kind == "slope cut";
    if (!is_slope && kind != "trench" && kind != "pit" && kind != "truck") {
      design.fail("kind", "is " + in_quotes(kind) + ", must be trench, pit or slope cut");
    }
    words.kind = is_slope           ? DesignKind::slope
                 : kind == "trench" ? DesignKind::trench
                                    : DesignKind::pit;
    words.length = design.number("length_m", 0.1, 1e4);
    words.floor_width = design.number("floor_width_m", 0.05, 1e4);
    words.grade = design.number_or("grade_along", 0.0, -1.0, 1.0);
    words.heading = design.number("heading_rad", -100.0, 100.0);
    const char* const batter =
        is_slope ? "face_horizontal_per_vertical" : "wall_horizontal_per_vertical";
    words.batter = design.number_or(batter, 0.0, 0.0, 20.0);
    const std::vector<double> origin = design.numbers("origin_m", 2);
    words.from = {origin[0], origin[1]};
    const bool has_floor = design.states("floor_z_at_middle_m");
    if (has_floor) words.floor_z = design.number("floor_z_at_middle_m", -1e6, 1e6);
    if (!has_floor || design.has("depth_m")) {
      words.depth = design.number("depth_m", 0.01, highest_thing);
    }
    if (has_floor) words.depth.reset();
    return words;
  }

  void read_files(JobDesign& job) {
    JsonObject files = top_.object("files");
    const std::string tin = files.text_or("design_tin", "");
    const std::string design = tin.empty() ? files.text_or("design", "") : tin;
    job.design_file = beside(files, "design", design);
    job.scan_file = beside(files, "first_scan", files.text_or("first_scan", ""));
  }
  std::string beside(const JsonObject& files, const char* key, const std::string& name) const {
    if (name.empty()) return {};
    const std::filesystem::path named = name;
    if (named.is_absolute() || *named.lexically_normal().begin() == "..") {
      files.fail(key, in_quotes(name) + " must be a file in the folder of the description");
    }
    return (std::filesystem::path(path_).parent_path() / named).string();
  }

  const std::string& path_;
  std::string content_;
  nlohmann::json json_;
  JsonObject top_;
};

/// Parts of a text between colons.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end = text.find(':'); end != text.npos; end = text.find(':', begin)) {
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

double number_in(const std::string& what, const std::string& word, double lowest, double highest) {
  const auto value = parse_number(word);
  require(value.has_value(), what + " is " + in_quotes(word) + ", must be a number");
  require_in(what, *value, lowest, highest);
  return *value;
}

}  // namespace

JobDesign read_plain_site(const std::string& path) { return PlainSite(path).read(); }

SitePolygon polygon_of_text(const std::string& text) {
  std::vector<double> numbers;
  std::string_view rest = text;
  while (true) {
    const std::size_t end = rest.find(',');
    const auto value = parse_number(rest.substr(0, end));
    require(value.has_value(),
            "polygon " + in_quotes(text) + ": must be X1,Y1,X2,Y2,X3,Y3 and so on");
    numbers.push_back(*value);
    if (end == rest.npos) break;
    rest.remove_prefix(end + 1);
  }
  require(numbers.size() % 2 == 0, "polygon " + in_quotes(text) + ": has an x without a y");
  SitePolygon polygon;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    polygon.emplace_back(numbers[i], numbers[i + 1]);
  }
  require_polygon(in_quotes(text), polygon);
  return polygon;
}

KeepOut keep_out_of_text(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  require(parts.size() <= 2, "keep-out " + in_quotes(text) + ": must be POLYGON or POLYGON:DEPTH");
  KeepOut keep_out = {"", polygon_of_text(parts[0]), {}};
  if (parts.size() == 2) {
    keep_out.depth = number_in("depth of a keep-out [m]", parts[1], 0.0, highest_thing);
  }
  return keep_out;
}

JobTruck truck_of_text(const std::string& text) {
  const std::vector<std::string> parts = parts_of(text);
  require(parts.size() == 3, "truck " + in_quotes(text) + ": must be POLYGON:HEIGHT:KG");
  return {polygon_of_text(parts[0]),
          number_in("height of a truck's bed [m]", parts[1], 0.1, highest_thing),
          number_in("load of a truck [kg]", parts[2], 1.0, heaviest_load)};
}

void require_job(const JobDesign& job) {
  require_in("job: tolerance [m]", job.tolerance, 1e-4, 10.0);
  require_in("job: edge margin [m]", job.edge_margin, 0.0, 100.0);
  if (job.start) {
    for (const double place : {job.start->x, job.start->y})
      require_in("job: start of the machine [m]", place, -farthest_corner, farthest_corner);
    require_in("job: heading at the start [rad]", job.start->heading, -most_turned, most_turned);
  }
  for (const KeepOut& keep_out : job.keep_out) {
    require_polygon("keep-out " + keep_out.kind, keep_out.polygon);
    if (keep_out.depth) {
      require_in("depth of a keep-out [m]", *keep_out.depth, 0.0, highest_thing);
    }
  }
  for (const JobObstacle& obstacle : job.obstacles) {
    require_polygon("obstacle " + obstacle.kind, obstacle.polygon);
    require_in("height of an obstacle [m]", obstacle.height, 0.01, highest_thing);
  }
  for (const DumpArea& area : job.dump_areas) require_polygon("dump area", area.polygon);
  if (job.truck) {
    require_polygon("truck", job.truck->bed);
    require_in("height of a truck's bed [m]", job.truck->bed_height, 0.1, highest_thing);
    require_in("load of a truck [kg]", job.truck->target_mass, 1.0, heaviest_load);
  }
  require(!job.dump_areas.empty() || job.truck.has_value(),
          "job: there is no dump area and no truck, so soil has no place to go");
}

}  // namespace excavplan
