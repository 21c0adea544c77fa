// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/design/design_words.hpp>
#include <excavplan/estimating/job_cost.hpp>
#include <excavplan/report/report_pages.hpp>
#include <excavplan/results/result_json.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "texts.hpp"

namespace excavplan::python {
namespace {

using py::arg;

/// JobEstimate of Python, with what it is of.
struct EstimateInPython : JobEstimate {
  JobOutline job;
  std::optional<JobCost> cost;
  Machine machine;
  SoilKind soil;
  std::string design;  ///< in words
};

/// A trench in words, or a design and the ground.
using Cut = std::variant<std::string, DesignSurface>;

JobShape shape_of_cut(const Cut& cut, const std::optional<HeightMap>& ground, double grade,
                      double batter) {
  if (const auto* size = std::get_if<std::string>(&cut)) {
    DesignWords words = trench_of_size(*size);
    words.grade = grade;
    words.batter = batter;
    return shape_on_level_ground(words);
  }
  if (!ground) throw Error(ErrorKind::bad_input, "ground is missing: a design is cut into it");
  const auto& design = std::get<DesignSurface>(cut);
  return shape_of(design, cut_and_fill(design, *ground));
}

EstimateInPython estimated_job(const Machine& machine, const SoilKind& soil, const Cut& cut,
                               const std::optional<HeightMap>& ground,
                               const std::optional<GroundDensity>& density, double truck_mass,
                               double grade, double batter, const std::optional<double>& fuel_price,
                               const std::optional<double>& hour_price,
                               const std::optional<double>& truckload_price) {
  return call([&] {
    JobOutline job;
    job.shape = shape_of_cut(cut, ground, grade, batter);
    job.density = density.value_or(job.density);
    job.truck_mass = truck_mass;
    const JobEstimate found = estimate_job(machine, soil, job, shipped_basis(machine));
    const auto cost = cost_of(found, {fuel_price, hour_price, truckload_price});
    const auto* size = std::get_if<std::string>(&cut);
    const std::string design =
        size != nullptr ? "Trench " + *size : "Design " + std::get<DesignSurface>(cut).name;
    return EstimateInPython{found, job, cost, machine, soil, design};
  });
}

void bind_figure(py::module_& module) {
  py::class_<EstimatedFigure>(module, "EstimatedFigure", "A figure of an estimate, log-normal.")
      .def_readonly("value", &EstimatedFigure::value, "In the unit of the figure.")
      .def_property_readonly(
          "interval",
          [](const EstimatedFigure& f) {
            return Eigen::Vector2d(f.interval()[0], f.interval()[1]);
          },
          "Of 95 %, likewise.")
      .def_property_readonly(
          "spread",
          [](const EstimatedFigure& f) {
            const EstimateSpread& s = f.spread;
            return std::map<std::string, double>{
                {"volume", s.volume},        {"density", s.density}, {"played_jobs", s.played},
                {"unlike_played", s.unlike}, {"fuel_model", s.fuel}, {"truck_fill", s.fill}};
          },
          "Deviations of its logarithm, by where they come from [-].")
      .def("__repr__", [](const EstimatedFigure& f) {
        return "<EstimatedFigure: " + rounded(f.value) + " (" + rounded(f.interval()[0]) + " .. " +
               rounded(f.interval()[1]) + ")>";
      });
}

std::string shown_figure(const char* name, const EstimatedFigure& figure, double scale,
                         const char* unit) {
  const auto interval = figure.interval();
  return std::string(name) + ' ' + rounded(scale * figure.value) + unit + " (" +
         rounded(scale * interval[0]) + " .. " + rounded(scale * interval[1]) + ")";
}

std::string shown_estimate(const EstimateInPython& of) {
  return "<JobEstimate of " + of.design + " in " + of.soil.name + ": " +
         shown_figure("digs", of.digs, 1.0, "") + ", " +
         shown_figure("time", of.time, 1.0 / 60.0, " min") + ", " +
         shown_figure("fuel", of.fuel, 1.0, " L") + ", " +
         shown_figure("truckloads", of.truckloads, 1.0, "") +
         (of.cost ? ", " + shown_figure("cost", of.cost->total, 1.0, "") : "") +
         (of.trustworthy() ? ">" : ", not trustworthy>");
}

using EstimateClass = py::class_<EstimateInPython>;

void bind_views(EstimateClass& estimate) {
  using E = EstimateInPython;
  estimate
      .def(
          "to_json", [](const E& of) { return to_json(of, of.job, of.cost); },
          "The text that plan-site estimate prints with --json, but for its options.")
      .def(
          "plot",
          [](const E& of, const std::optional<File>& file) {
            return plotted(
                file, [&](ImageFormat format) { return job_estimate_image(of, of.cost, format); });
          },
          arg("file") = py::none(), "A Picture; file: also written to, .svg, .png or .pdf.")
      .def(
          "report",
          [](const E& of, const File& file) {
            write_bytes(file, call([&] {
                          return report_page(of, of.job, of.cost,
                                             {of.design, of.soil.name, of.machine.name});
                        }));
          },
          arg("file"), "Writes a page to print, as plan-site estimate --report.")
      .def("__repr__", [](const E& of) { return text(shown_estimate(of)); });
}

}  // namespace

void bind_estimates(py::module_& module) {
  using E = EstimateInPython;
  bind_figure(module);
  EstimateClass estimate(module, "JobEstimate", "What a job takes, before its first bucket.");
  estimate
      .def_property_readonly(
          "digs", [](const E& of) { return of.digs; }, "With those that finish.")
      .def_property_readonly(
          "time", [](const E& of) { return of.time; }, "With moves and scans [s].")
      .def_property_readonly(
          "fuel", [](const E& of) { return of.fuel; }, "[L]")
      .def_property_readonly(
          "truckloads", [](const E& of) { return of.truckloads; }, "If all soil goes by truck.")
      .def_property_readonly(
          "cost",
          [](const E& of) { return of.cost ? std::optional(of.cost->total) : std::nullopt; },
          "In the currency of the prices; None without prices.")
      .def_property_readonly(
          "energy", [](const E& of) { return of.energy; }, "Of cycles and moves [J].")
      .def_property_readonly(
          "swollen", [](const E& of) { return of.swollen; }, "Volume as it lies loose [m^3].")
      .def_property_readonly(
          "mass", [](const E& of) { return of.mass; }, "Moist [kg].")
      .def_property_readonly(
          "dig", [](const E& of) { return of.dig; }, "The best full dig.")
      .def_property_readonly(
          "unlike", [](const E& of) { return of.unlike; },
          "In what the job differs from those that were played.")
      .def_property_readonly(
          "trustworthy", [](const E& of) { return of.trustworthy(); }, "False: see unlike.");
  bind_views(estimate);
  module.def(
      "estimate_job", &estimated_job, arg("machine"), arg("soil"), arg("design"),
      arg("ground") = py::none(), py::kw_only(), arg("density") = py::none(),
      arg("truck_mass") = JobOutline{}.truck_mass, arg("grade") = 0.0, arg("batter") = 0.0,
      arg("fuel_price") = py::none(), arg("hour_price") = py::none(),
      arg("truckload_price") = py::none(),
      "What a job is going to take: digs, time, fuel, truckloads, cost.\n\n"
      "design: a trench of \"10x0.7x1.2\", length x width x depth [m] in level ground, or a\n"
      "DesignSurface in `ground`, a HeightMap; density: else 50 +- 25 %; truck_mass: of a load\n"
      "[kg]; grade, batter: of a trench in words; prices: of a litre, of an hour of the machine\n"
      "without fuel, and of a truckload, in one currency.");
}

}  // namespace excavplan::python
