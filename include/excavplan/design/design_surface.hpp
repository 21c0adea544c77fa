// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <excavplan/ground/height_map.hpp>

namespace excavplan {

/// Triangles over the plane.
struct Tin {
  /// Of the points, in the site frame [m]: so that coordinates of 10^6 m lose nothing.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> points;                  ///< from the origin [m]
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< of points, from 0, in either sense
};

/// The surface that a job is to leave, in the site frame.
struct DesignSurface {
  std::string name;                    ///< as the file or its maker calls it
  std::variant<Tin, HeightMap> shape;  ///< outside of it nothing is asked for
  /// Parts above the ground ask for nothing: faces that end where they reach the ground.
  bool cuts_only = false;
  /// Its heights are told below the ground of a scan and share what that is off.
  bool hangs_on_scan = false;
  double unit = 1.0;               ///< of its file [m]
  std::string unit_told_by;        ///< "Units: foot", "$INSUNITS 6: metre", "nothing: metres taken"
  std::vector<std::string> notes;  ///< what of its file was left out, or is doubtful
};

/// All that the surface covers. @throws Error (bad_input) if it is empty
Rectangle extent_of(const DesignSurface& design);

/// Area in plan [m^2]: of the triangles, or of the cells that are known.
double area_in_plan(const DesignSurface& design);

/// What a design covers of each cell of a grid.
struct DesignCover {
  Eigen::ArrayXXd height;  ///< mean of the covered part, in the frame of the grid [m]; NaN of none
  Eigen::ArrayXXd share;   ///< of the cell [-]; more than 1 where triangles lie above one another
};
/// The design on the cells of a grid, exact for plane triangles; of a raster, each cell is level.
/// @throws Error (bad_input) if the grid is none
DesignCover cover_of(const DesignSurface& design, const HeightMap& grid);

}  // namespace excavplan
