// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/results/result_json.hpp>
#include <excavplan/soil/compaction.hpp>
#include <excavplan/soil/density_fit.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "texts.hpp"

namespace excavplan::python {
namespace {

using py::arg;

void bind_soil_kind(py::module_& module) {
  py::class_<SoilState>(module, "SoilState", "A soil at one relative density.")
      .def_readonly("relative_density", &SoilState::relative_density, "0 .. 1 for the bank [-].")
      .def_readonly("void_ratio", &SoilState::void_ratio, "[-]")
      .def_readonly("dry_density", &SoilState::dry_density, "[kg/m^3]")
      .def_readonly("bulk_density", &SoilState::bulk_density, "Moist [kg/m^3].")
      .def_readonly("unit_weight", &SoilState::unit_weight, "[N/m^3]")
      .def_readonly("saturation", &SoilState::saturation, "[-]")
      .def_readonly("cohesion", &SoilState::cohesion, "[Pa]")
      .def_readonly("adhesion", &SoilState::adhesion, "[Pa]")
      .def_readonly("friction_angle", &SoilState::friction_angle, "[rad]")
      .def_readonly("tool_friction_angle", &SoilState::tool_friction_angle, "[rad]");
  py::class_<SoilKind>(
      module, "SoilKind",
      "A kind of soil: its numbers that do not depend on its density. load_soil()\n"
      "reads one; numbers can be changed, and are checked where they are used.")
      .def(
          "copy", [](const SoilKind& soil) { return SoilKind(soil); }, "A soil of its own.")
      .def_readwrite("name", &SoilKind::name, "'loam'")
      .def_readwrite("specific_gravity", &SoilKind::specific_gravity, "Of the grains [-].")
      .def_readwrite("water_content", &SoilKind::water_content, "Water per dry mass [-].")
      .def_readwrite("void_ratio_max", &SoilKind::void_ratio_max, "At a density of 0 % [-].")
      .def_readwrite("void_ratio_min", &SoilKind::void_ratio_min, "At a density of 100 % [-].")
      .def_readwrite("void_ratio_loose", &SoilKind::void_ratio_loose, "Of soil that was dug [-].")
      .def_readwrite("cohesion_loosest", &SoilKind::cohesion_loosest,
                     "c = cohesion_loosest * exp(cohesion_growth * d), d in 0 .. 1 [Pa].")
      .def_readwrite("cohesion_growth", &SoilKind::cohesion_growth, "[-]")
      .def_readwrite("friction_loosest", &SoilKind::friction_loosest,
                     "phi = friction_loosest + friction_gain * d [rad].")
      .def_readwrite("friction_gain", &SoilKind::friction_gain, "[rad]")
      .def_readwrite("tool_friction_ratio", &SoilKind::tool_friction_ratio,
                     "Soil-metal friction angle over phi [-].")
      .def_readwrite("adhesion_ratio", &SoilKind::adhesion_ratio, "Adhesion over c [-].")
      .def_readwrite("angle_of_repose", &SoilKind::angle_of_repose, "Of loose soil [rad].")
      .def(
          "fingerprint", [](const SoilKind& soil) { return fingerprint(soil); },
          "16 digits that depend on every number, but not on the name.")
      .def(
          "bank_state", [](const SoilKind& soil, double d) { return bank_state(soil, d); },
          arg("density_percent"), "State of undisturbed soil.")
      .def(
          "loose_state", [](const SoilKind& soil) { return loose_state(soil); },
          "State of dug soil.")
      .def(
          "compaction",
          [](const SoilKind& soil, double d, double proctor) {
            RelativeDensity density;
            density.percent = d;
            return compaction_of(soil, density, proctor).percent;
          },
          arg("density_percent"), arg("proctor_density"),
          "Dry density over the largest of a Proctor test of this soil [kg/m^3], in [%].")
      .def(
          "bulking_of_density",
          [](const SoilKind& soil, double d) { return bulking_of_density(soil, d); },
          arg("density_percent"), "Bulking factor if all soil goes to the loose state [-].")
      .def("__repr__", [](const SoilKind& soil) { return "<SoilKind " + soil.name + ">"; });
  module.def(
      "load_soil", [](const File& name) { return load_soil(shipped_or_file("soils", name.path)); },
      arg("name_or_file"), "'loam', 'sand', 'clay', 'gravel' or a soil file.");
}

void bind_density(py::module_& module) {
  py::class_<RelativeDensity>(module, "RelativeDensity",
                              "Relative density [%] with what is known about its error.")
      .def_readonly("percent", &RelativeDensity::percent, "Inside 0 .. 100 [%].")
      .def_readonly("raw_percent", &RelativeDensity::raw_percent, "As the law gives it [%].")
      .def_readonly("sd_given_law_percent", &RelativeDensity::sd_given_law_percent,
                    "By the error of the bulking factor alone [points].")
      .def_readonly("sd_percent", &RelativeDensity::sd_percent, "With that of the law [points].")
      .def_readonly("interval_percent", &RelativeDensity::interval_percent, "Of 95 % [%].")
      .def_readonly("trustworthy", &RelativeDensity::trustworthy,
                    "False: outside 0 .. 100 % by more than the error explains.")
      .def_readonly("warnings", &RelativeDensity::warnings)
      .def(
          "to_json", [](const RelativeDensity& density) { return to_json(density); },
          "The density as estimate-density prints it with --json.");
  py::class_<GroundDensity>(module, "GroundDensity",
                            "The relative density of the ground, as far as it is known, for plans.")
      .def(py::init([](double percent, double sd_percent, bool trustworthy, std::string soil) {
             GroundDensity density(percent, sd_percent);
             density.trustworthy = trustworthy;
             density.soil = std::move(soil);
             return density;
           }),
           arg("percent"), arg("sd_percent") = 0.0, arg("trustworthy") = true, arg("soil") = "",
           "percent: 0 .. 100; sd_percent: standard deviation [points], 0: taken as known;\n"
           "soil: name of the soil whose law gave it.")
      .def_readonly("percent", &GroundDensity::percent, "0 .. 100 [%]")
      .def_readonly("sd_percent", &GroundDensity::sd_percent, "Standard deviation [points].")
      .def_readonly("trustworthy", &GroundDensity::trustworthy,
                    "False: who estimated it does not trust it.")
      .def_readonly("soil", &GroundDensity::soil, "Of the law that gave it; empty: unknown.");
  py::implicitly_convertible<py::float_, GroundDensity>();
  py::implicitly_convertible<py::int_, GroundDensity>();
}

void bind_law(py::module_& module) {
  py::class_<DensityLaw>(module, "DensityLaw",
                         "From the bulking factor k [-] to the relative density d [%] and back.")
      .def_readonly("name", &DensityLaw::name, "'paper'")
      .def_readonly("source", &DensityLaw::source, "What it was fitted to.")
      .def_readonly("soil", &DensityLaw::soil, "Name of the soil it is for; empty: not known.")
      .def_readonly("machine", &DensityLaw::machine, "That dug; empty: not known.")
      .def_readonly("simulator", &DensityLaw::simulator, "That dug; empty: real digs.")
      .def_readonly("path", &DensityLaw::path,
                    "Penetration angle [rad], penetration and drag length [m] of the digs.")
      .def_readonly("any_path", &DensityLaw::any_path,
                    "Its scatter is that of digs along other paths too.")
      .def_property_readonly(
          "formula", [](const DensityLaw& law) { return formula(law.form); },
          "'d = a k + b', in the letters of its parameters.")
      .def(
          "density_of_bulking",
          [](const DensityLaw& law, double k) { return density_of_bulking(law.form, k); },
          arg("bulking_factor"), "Relative density [%], also outside 0 .. 100.")
      .def(
          "bulking_of_density",
          [](const DensityLaw& law, double d) { return bulking_of_density(law.form, d); },
          arg("density_percent"), "The inverse [-].")
      .def(
          "relative_density",
          [](const DensityLaw& law, double k, double sd) {
            return relative_density(law, Measured{k, sd});
          },
          arg("bulking_factor"), arg("sd") = 0.0,
          "The density with its error, from k and its standard deviation [-].")
      .def("__repr__", [](const DensityLaw& law) { return "<DensityLaw " + law.name + ">"; });
  module.def(
      "load_density_law",
      [](const File& name) { return load_density_law(shipped_or_file("laws", name.path)); },
      arg("name_or_file"), "'zx120-loam', ..., 'paper' or a law file.");
  module.def("density_law_of", &density_law_of, arg("soil"),
             "The law that conservation of solids gives a soil, without fallback and clods.");
}

// ---- calibration --------------------------------------------------------------------------------

using Sample = DensityCalibration::Sample;

template <double Sample::*Field>
Array samples(const DensityCalibration& calibration) {
  return array_of(calibration.samples, [](const Sample& sample) { return sample.*Field; });
}

DensityCalibration fitted(const ArrayLike& bulking_factors, const ArrayLike& densities_percent) {
  const std::vector<double> factors = numbers_of("the bulking factors", bulking_factors);
  const std::vector<double> densities = numbers_of("the densities", densities_percent);
  if (factors.size() != densities.size()) {
    throw Error(ErrorKind::bad_input,
                "found " + std::to_string(factors.size()) + " bulking factors and " +
                    std::to_string(densities.size()) + " densities, expected as many");
  }
  std::vector<BulkingSample> digs;
  for (std::size_t i = 0; i < factors.size(); ++i) digs.push_back({factors[i], densities[i]});
  return calibrate_density(digs);
}

}  // namespace

void bind_soil(py::module_& module) {
  bind_soil_kind(module);
  bind_density(module);
  bind_law(module);
  py::class_<DensityCalibration>(module, "DensityCalibration",
                                 "The forms of a law with the digs they were fitted to.")
      .def_property_readonly(
          "law", [](const DensityCalibration& c) { return law_of(c); }, "The law that it gives.")
      .def_readonly("use", &DensityCalibration::use, "Key of the form to use.")
      .def_property_readonly("density_percent", &samples<&Sample::density_percent>,
                             "Of the digs, shape (N,) [%].")
      .def_property_readonly("bulking_factor", &samples<&Sample::bulking_factor>,
                             "Of the digs, corrected for fallback, shape (N,) [-].")
      .def_property_readonly("bulking_factor_measured", &samples<&Sample::bulking_factor_measured>,
                             "From height maps, shape (N,) [-]; 0 where unknown.")
      .def_property_readonly("fallback_fraction", &samples<&Sample::fallback_fraction>,
                             "Of the cut, shape (N,) [-]; 0 where unknown.")
      .def(
          "to_json", [](const DensityCalibration& c) { return to_json(c); },
          "The text of a law file, which load_density_law() reads.")
      .def(
          "plot",
          [](const DensityCalibration& c, const std::optional<File>& file) {
            return plotted(file, [&](ImageFormat format) { return law_image(c, format); });
          },
          arg("file") = py::none(), "A Picture; file: also written to, .svg, .png or .pdf.");
  module.def("fit_density_law", &fitted, arg("bulking_factors"), arg("densities_percent"),
             "Fits a law to measured digs of known density: bulking factors [-] and relative\n"
             "densities [%], both of shape (N,).");
}

}  // namespace excavplan::python
