// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/change/bulking.hpp>
#include <excavplan/change/volume_change.hpp>
#include <excavplan/ground/height_map.hpp>
#include <excavplan/ground/resampling.hpp>
#include <excavplan/results/result_json.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "texts.hpp"

namespace excavplan::python {
namespace {

using py::arg;

Array centres(Eigen::Index count, const std::function<double(Eigen::Index)>& centre) {
  std::vector<double> numbers;
  for (Eigen::Index i = 0; i < count; ++i) numbers.push_back(centre(i));
  return array(std::move(numbers), {count});
}

HeightMap made_map(const ArrayLike& z, const Eigen::Vector2d& origin, double cell_size) {
  if (!(cell_size > 0.0) || !std::isfinite(cell_size) || !origin.allFinite()) {
    throw Error(ErrorKind::bad_input,
                "a height map: its cell_size must be positive and finite, its origin finite");
  }
  return {origin, cell_size, table_of("the heights z", z)};
}

void bind_height_map(py::module_& module) {
  py::class_<Rectangle>(module, "Rectangle", "A rectangle of the site in plan [m].")
      .def(py::init([](double x_min, double y_min, double x_max, double y_max) {
             return Rectangle{x_min, y_min, x_max, y_max};
           }),
           arg("x_min"), arg("y_min"), arg("x_max"), arg("y_max"))
      .def_readonly("x_min", &Rectangle::x_min, "[m]")
      .def_readonly("y_min", &Rectangle::y_min, "[m]")
      .def_readonly("x_max", &Rectangle::x_max, "[m]")
      .def_readonly("y_max", &Rectangle::y_max, "[m]")
      .def("contains", &Rectangle::contains, arg("x"), arg("y"),
           "True for points inside and on the lower edges.");
  py::class_<HeightMap> bound(
      module, "HeightMap",
      "Heights of the ground on a regular grid, seen from above.\n\n"
      "Cell (row, col) is the square whose corner of smallest x and y is at\n"
      "origin + cell_size * (col, row); NaN where no scan has seen it.");
  bind_numbers(bound, "The heights, shape (rows, columns), NaN where unknown [m].",
               [](const HeightMap& of) { return array(of.z); });
  bound
      .def(py::init(&made_map), arg("z"), arg("origin") = py::make_tuple(0.0, 0.0),
           arg("cell_size") = 0.05,
           "z: heights, shape (rows along y, columns along x) [m], copied; origin: corner of\n"
           "cell (0, 0), (x, y) [m]; cell_size: edge of a cell [m].")
      .def_property_readonly(
          "z", [](const HeightMap& map) { return array(map.z); },
          "Heights, shape (rows, columns), NaN where unknown [m]; a copy.")
      .def_readonly("origin", &HeightMap::origin, "Corner of cell (0, 0), (x, y) [m].")
      .def_readonly("cell_size", &HeightMap::cell_size, "Edge of a cell [m].")
      .def_property_readonly(
          "x",
          [](const HeightMap& map) {
            return centres(map.z.cols(), [&](auto i) { return map.x(i); });
          },
          "x of the centres of the columns, shape (columns,) [m].")
      .def_property_readonly(
          "y",
          [](const HeightMap& map) {
            return centres(map.z.rows(), [&](auto i) { return map.y(i); });
          },
          "y of the centres of the rows, shape (rows,) [m].")
      .def_property_readonly("extent", &HeightMap::extent, "All that the cells cover.")
      .def(
          "height_at",
          [](const HeightMap& map, double x, double y) { return height_at(map, x, y); }, arg("x"),
          arg("y"),
          "Height at a point [m], bilinear; NaN outside the map or beside an unknown cell.")
      .def(
          "resampled",
          [](const HeightMap& map, const Rectangle& extent, double cell_size, double widest_gap) {
            return resampled(map, extent, cell_size, widest_gap);
          },
          arg("extent"), arg("cell_size"), arg("widest_gap") = 0.0,
          "The surface on another grid, bilinear; gaps up to widest_gap [m] are filled first.")
      .def(
          "plot",
          [](const HeightMap& map, const std::optional<File>& file) {
            return plotted(file, [&](ImageFormat format) { return ground_image(map, format); });
          },
          arg("file") = py::none(), "A Picture; file: also written to, .svg, .png or .pdf.")
      .def("__repr__", [](const HeightMap& map) {
        return "<HeightMap of " + std::to_string(map.z.rows()) + " x " +
               std::to_string(map.z.cols()) + " cells of " + rounded(map.cell_size) + " m>";
      });
  module.def("flat_ground", &flat_ground, arg("extent"), arg("cell_size") = 0.05,
             arg("height") = 0.0, "Level ground [m] that covers at least `extent`.");
}

void bind_results(py::module_& module) {
  py::class_<Measured>(module, "Measured", "A figure with its standard deviation.")
      .def(py::init([](double value, double sd) {
             return Measured{value, sd};
           }),
           arg("value"), arg("sd") = 0.0)
      .def_readonly("value", &Measured::value, "In the unit of the figure.")
      .def_readonly("sd", &Measured::sd, "Standard deviation, likewise.");
  py::class_<ChangeZone>(module, "ChangeZone",
                         "A connected piece of ground that changed by more than the noise.")
      .def_property_readonly(
          "kind", [](const ChangeZone& zone) { return name(zone.kind); },
          "'dig', 'spill', 'dump' or 'other'.")
      .def_readonly("volume", &ChangeZone::volume,
                    "Of the change, > 0 where the ground rose [m^3].")
      .def_readonly("area", &ChangeZone::area, "[m^2]")
      .def_readonly("unknown_share", &ChangeZone::unknown_share,
                    "Share of its cells that no scan saw and that were filled [-].")
      .def_readonly("extent", &ChangeZone::extent, "Of all its cells.");
  py::class_<AreaChange>(module, "AreaChange", "Change of the ground in one surveyed area.")
      .def_readonly("difference", &AreaChange::difference,
                    "after - before, less datum, stripes and doming [m]; NaN where unknown.")
      .def_property_readonly(
          "zone", [](const AreaChange& area) { return array(area.zone); },
          "Index into VolumeChange.zones, shape (rows, columns); -1 for stable "
          "ground.")
      .def_readonly("noise_sd", &AreaChange::noise_sd, "Of one stable cell of the difference [m].")
      .def_readonly("datum", &AreaChange::datum,
                    "Robust mean change of the stable ground, taken off the difference [m].");
  py::class_<AttributedChange>(module, "AttributedChange",
                               "A change that might belong to the dig, or might not.")
      .def_property_readonly(
          "kind", [](const AttributedChange& c) { return name(c.kind); },
          "What it looks like: 'ruts', 'lump', ...")
      .def_readonly("what", &AttributedChange::what, "Likewise as text, and where.")
      .def_readonly("volume", &AttributedChange::volume, "[m^3], > 0 where the ground rose.")
      .def_readonly("counted", &AttributedChange::counted, "It is part of hole, spill or heap.")
      .def_readonly("probability", &AttributedChange::probability, "That it belongs to the dig.");
  py::class_<VolumeChange>(
      module, "VolumeChange",
      "Volumes of one dig [m^3]: before = excavated, after = spilled + dumped.")
      .def_readonly("excavated", &VolumeChange::excavated, "The hole [m^3].")
      .def_readonly("spilled", &VolumeChange::spilled, "Soil that rose beside it [m^3].")
      .def_readonly("dumped", &VolumeChange::dumped, "The heap [m^3].")
      .def_readonly("before", &VolumeChange::before, "Undisturbed volume of the dug soil [m^3].")
      .def_readonly("after", &VolumeChange::after, "Its loose volume [m^3].")
      .def_readonly("covariance_before_after", &VolumeChange::covariance_before_after, "[m^6]")
      .def_readonly("zones", &VolumeChange::zones, "Of all areas.")
      .def_readonly("areas", &VolumeChange::areas,
                    "One for a whole scene, two for a dig and a dump area.")
      .def_readonly("attribution", &VolumeChange::attribution, "Changes that are open.")
      .def_readonly("warnings", &VolumeChange::warnings)
      .def(
          "to_json", [](const VolumeChange& change) { return to_json(change); },
          "The volumes as estimate-density prints them with --json.")
      .def(
          "bulking_factor", [](const VolumeChange& change) { return bulking_factor(change); },
          "k = after / before with its standard deviation [-]; None without hole or heap.")
      .def(
          "bulking_interval", [](const VolumeChange& change) { return bulking_interval(change); },
          "Interval of 95 % of the bulking factor [-]; None where its error is not known.");
}

}  // namespace

void bind_ground(py::module_& module) {
  bind_height_map(module);
  bind_results(module);
  module.def(
      "measure_change",
      [](const HeightMap& before, const HeightMap& after, std::optional<Rectangle> dig_area,
         std::optional<Rectangle> dump_area) {
        ChangeOptions options;
        options.dig_area = dig_area;
        options.dump_area = dump_area;
        return call([&] { return measure_change(before, after, options); });
      },
      arg("before"), arg("after"), py::kw_only(), arg("dig_area") = py::none(),
      arg("dump_area") = py::none(),
      "Volumes from height maps of the whole scene on one grid. Only falling ground in dig_area\n"
      "is the hole, only rising ground in dump_area the heap. Scans: estimate_density().");
  module.def("free_of_fallback", &free_of_fallback, arg("bulking_measured"),
             arg("fallback_fraction"),
             "k = f + (1 - f) k_measured: corrects for soil that fell back into the cut.");
}

}  // namespace excavplan::python
