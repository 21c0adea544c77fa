// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <excavplan/clouds/sensor_errors.hpp>
#include <excavplan/design/design_words.hpp>
#include <excavplan/machine/base_pose.hpp>

/// @file
/// What a job asks for beside its surface: where soil goes, and what must not be touched.

namespace excavplan {

/// Corners in plan, in either sense [m].
using SitePolygon = std::vector<Eigen::Vector2d>;

/// A place that the bucket must not reach.
struct KeepOut {
  std::string kind;     ///< "cable", "manhole"; may be empty
  SitePolygon polygon;  ///< at least three corners
  /// From where on, below the ground [m], >= 0; unset: nothing there is touched at all.
  std::optional<double> depth = {};
};

/// What stands on the ground.
struct JobObstacle {
  std::string kind;     ///< as it is told, such as "pole"
  SitePolygon polygon;  ///< in plan [m]
  double height = 0.0;  ///< over the ground [m], > 0
};

/// Where soil is laid on the ground.
struct DumpArea {
  /// A ridge along its longer side, or one pile.
  enum class Kind { windrow, heap };
  Kind kind = Kind::windrow;  ///< of what is laid
  SitePolygon polygon;        ///< where soil may lie, in plan [m]
};

/// A truck that is loaded.
struct JobTruck {
  SitePolygon bed;           ///< in plan [m]
  double bed_height = 0.0;   ///< of its upper edge over the ground [m], > 0
  double target_mass = 0.0;  ///< of a load [kg], > 0
};

/// A job as its description says it.
struct JobDesign {
  std::string name;                         ///< of the job, for people
  std::optional<DesignWords> words = {};    ///< the design in words
  std::string design_file = {};             ///< or its file; empty: none
  std::string scan_file = {};               ///< the first scan; empty: none
  double tolerance = 0.03;                  ///< [m], > 0
  double edge_margin = 0.1;                 ///< CutOptions::edge_margin [m]
  std::optional<BasePose> start = {};       ///< z: 0
  std::vector<KeepOut> keep_out = {};       ///< what is not touched
  std::vector<JobObstacle> obstacles = {};  ///< what stands there
  std::vector<DumpArea> dump_areas = {};    ///< where soil is laid; in their order
  std::optional<JobTruck> truck = {};       ///< to which soil goes instead, if there is one
  std::optional<SensorErrors> sensor = {};  ///< of the scans during the job
};

/// Reads the description of a plain site (docs/formats.md#plain-sites). Its files are found beside
/// it. What is not read of it is no error.
/// @throws Error (bad_file) naming file, key, value and rule
JobDesign read_plain_site(const std::string& path);

/// Reads "X1,Y1,X2,Y2,X3,Y3…". @throws Error (bad_input) if it is no polygon
SitePolygon polygon_of_text(const std::string& text);
/// Reads "X1,Y1,…" or "X1,Y1,…:DEPTH". @throws Error (bad_input)
KeepOut keep_out_of_text(const std::string& text);
/// Reads "X1,Y1,…:HEIGHT:KG". @throws Error (bad_input)
JobTruck truck_of_text(const std::string& text);

/// @throws Error (bad_input) unless a polygon has three corners at least, all finite, an area and
/// no crossings; depths, heights and masses are in range; soil has a place to go
void require_job(const JobDesign& job);

}  // namespace excavplan
