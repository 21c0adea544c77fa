// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/design/design_file.hpp>
#include <excavplan/design/design_words.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "rooms.hpp"
#include "texts.hpp"

namespace excavplan::python {
namespace {

using py::arg;

void bind_surface(py::module_& module) {
  py::class_<DesignSurface>(module, "DesignSurface", "The surface that a job is to leave.")
      .def_readonly("name", &DesignSurface::name)
      .def_readonly("unit", &DesignSurface::unit, "Of its file [m].")
      .def_readonly("unit_told_by", &DesignSurface::unit_told_by)
      .def_readonly("notes", &DesignSurface::notes, "What was left out or is doubtful.")
      .def_property_readonly(
          "extent", [](const DesignSurface& design) { return extent_of(design); }, "In plan.")
      .def_property_readonly(
          "area", [](const DesignSurface& design) { return area_in_plan(design); },
          "In plan [m^2].")
      .def(
          "heights_on",
          [](const DesignSurface& design, const HeightMap& grid) {
            return HeightMap{grid.origin, grid.cell_size, cover_of(design, grid).height};
          },
          arg("grid"), "Mean heights of what it covers of each cell of a map; NaN of none.");
  module.def(
      "read_design",
      [](const File& file, const std::string& surface, const std::vector<std::string>& layers,
         std::optional<double> unit, const std::optional<ArrayLike>& site_from_design) {
        DesignFileOptions options;
        options.surface = surface;
        options.layers = layers;
        options.unit = unit;
        if (site_from_design) {
          options.site_from_design = transform_of("site_from_design", *site_from_design);
        }
        return call([&] { return read_design(file.path, options); });
      },
      arg("file"), py::kw_only(), arg("surface") = "", arg("layers") = std::vector<std::string>{},
      arg("unit") = py::none(), arg("site_from_design") = py::none(),
      "Reads LandXML, DXF, PLY, OBJ, STL, an ESRI ASCII grid or a GeoTIFF.\n\n"
      "surface: of several of a LandXML file; layers: of a DXF drawing; unit: of the\n"
      "coordinates [m], where the file does not tell it.");
  module.def(
      "design_trench",
      [](const std::string& size, const HeightMap& ground, const Eigen::Vector2d& start,
         double heading, double grade, double batter) {
        DesignWords words = trench_of_size(size);
        words.from = start;
        words.heading = heading;
        words.grade = grade;
        words.batter = batter;
        return call([&] { return design_of_words(words, ground); });
      },
      arg("size"), arg("ground"), py::kw_only(), arg("start"), arg("heading") = 0.0,
      arg("grade") = 0.0, arg("batter") = 0.0,
      "A trench of \"15x1x0.5\", length x width x depth [m], below the ground's mean along it.\n\n"
      "start: middle of its end, (x, y) [m]; heading [rad]; batter: horizontal per vertical.");
}

void bind_volumes(py::module_& module) {
  py::class_<Deviation>(module, "Deviation", "How far the ground is from its design.")
      .def_readonly("area", &Deviation::area, "That counts and is seen [m^2].")
      .def_readonly("rms", &Deviation::rms, "[m]")
      .def_readonly("p95", &Deviation::p95, "[m]")
      .def_readonly("beyond_twice", &Deviation::beyond_twice, "Share beyond twice the tolerance.")
      .def_readonly("is_within", &Deviation::is_within);
  py::class_<CutAndFill>(module, "CutAndFill", "What is to be moved to the design.")
      .def_readonly("cut", &CutAndFill::cut, "[m^3]")
      .def_readonly("fill", &CutAndFill::fill, "[m^3]")
      .def_readonly("area", &CutAndFill::area, "[m^2]")
      .def_readonly("unseen_area", &CutAndFill::unseen_area, "[m^2]")
      .def_readonly("outside_area", &CutAndFill::outside_area, "[m^2]")
      .def_readonly("deviation", &CutAndFill::deviation)
      .def_readonly("notes", &CutAndFill::notes);
  module.def(
      "cut_and_fill",
      [](const DesignSurface& design, const HeightMap& ground, double tolerance, double height_sd) {
        CutOptions options;
        options.tolerance = tolerance;
        options.errors.height_sd = height_sd;
        return call([&] { return cut_and_fill(design, ground, options); });
      },
      arg("design"), arg("ground"), py::kw_only(), arg("tolerance") = CutOptions{}.tolerance,
      arg("height_sd") = 0.0,
      "The ground against a design; height_sd: error that all heights have in common [m].");
}

}  // namespace

void bind_design(py::module_& module) {
  bind_surface(module);
  bind_volumes(module);
}

}  // namespace excavplan::python
