// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_progress.hpp>
#include <excavplan/job/job_step.hpp>
#include <excavplan/results/result_json.hpp>
#include <excavplan/simulation/dig_along.hpp>

#include "arrays.hpp"
#include "clock.hpp"
#include "rooms.hpp"
#include "scans.hpp"
#include "texts.hpp"

namespace excavplan::python {
namespace {

using py::arg;

Eigen::Vector2d ends(const std::array<double, 2>& interval) { return {interval[0], interval[1]}; }

std::string place(const BasePose& base) {
  return "x " + rounded(base.x) + " m, y " + rounded(base.y) + " m, heading " +
         rounded(base.heading) + " rad";
}

// ---- steps --------------------------------------------------------------------------------------

std::string foretold(const ForetoldStep& step) {
  const auto& payload = step.payload_interval;
  const auto& energy = step.energy_interval;
  return rounded(step.payload_mass) + " kg (" + rounded(payload[0]) + " .. " + rounded(payload[1]) +
         "), " + rounded(1e-3 * step.energy) + " kJ (" + rounded(1e-3 * energy[0]) + " .. " +
         rounded(1e-3 * energy[1]) + "), " + rounded(step.time) + " s";
}

std::string shown_step(const JobStep& step) {
  std::string text = "<JobStep " + std::to_string(step.id) + ": " + name(step.what);
  if (step.digs()) text += " " + foretold(step.predicted);
  if (step.what == JobAction::move) text += " to " + place(step.base);
  if (!step.reason.empty()) text += ", " + step.reason;
  return text + (step.trustworthy ? ">" : ", not trustworthy>");
}

Eigen::Matrix4d site_from_line(const JobStep& step) {
  const DigLine line = dig_line(step.base, step.swung, step.lane);
  return BasePose{line.origin.x(), line.origin.y(), line.z, line.heading}
      .site_from_machine()
      .matrix();
}

void bind_step(py::module_& module) {
  py::class_<ForetoldStep>(module, "ForetoldStep", "What a dig of a job is expected to do.")
      .def_readonly("payload_mass", &ForetoldStep::payload_mass, "[kg]")
      .def_readonly("energy", &ForetoldStep::energy, "Of the joints over the whole cycle [J].")
      .def_readonly("time", &ForetoldStep::time, "Of the whole cycle [s].")
      .def_property_readonly(
          "payload_interval", [](const ForetoldStep& s) { return ends(s.payload_interval); },
          "95 % [kg].")
      .def_property_readonly(
          "energy_interval", [](const ForetoldStep& s) { return ends(s.energy_interval); },
          "95 % [J].")
      .def("__repr__",
           [](const ForetoldStep& step) { return "<ForetoldStep: " + foretold(step) + ">"; });
  py::class_<JobStep>(module, "JobStep", "What a job asks of its machine.")
      .def_readonly("id", &JobStep::id, "Rises from step to step.")
      .def_property_readonly(
          "what", [](const JobStep& step) { return name(step.what); },
          "'dig', 'finish', 'move', 'scan', 'wait' or 'stop'.")
      .def_readonly("base", &JobStep::base, "Where the machine stands; of a move: where it goes.")
      .def_readonly(
          "swung", &JobStep::swung,
          "Of the line of the dig or the middle of a scan, to the left of the base [rad].")
      .def_readonly("lane", &JobStep::lane,
                    "Of that line, so far to the left of the swing axis [m].")
      .def_property_readonly(
          "path",
          [](const JobStep& step) { return step.digs() ? std::optional(step.path) : std::nullopt; },
          "DigPath in the frame of its line; None of another step.")
      .def_property_readonly(
          "site_from_line", [](const JobStep& step) { return array(site_from_line(step)); },
          "Takes points of that frame into that of the site, shape (4, 4).")
      .def_readonly(
          "dump", &JobStep::dump,
          "Of the bucket pin where the bucket opens, if it does, in the site's frame [m].")
      .def_readonly("keeps_load", &JobStep::keeps_load,
                    "The bucket does not open: it goes back with its load.")
      .def_readonly("dumps_first", &JobStep::dumps_first,
                    "What earlier passes left in the bucket is dumped before all else.")
      .def_property_readonly(
          "carried", [](const JobStep& step) { return step.carried ? step.carried->volume : 0.0; },
          "Loose soil in the bucket as the step begins [m^3].")
      .def_readonly("truck", &JobStep::truck, "That is loaded, from 1, or None.")
      .def_readonly("predicted", &JobStep::predicted, "Of a dig.")
      .def_readonly("trustworthy", &JobStep::trustworthy, "False: see the warnings.")
      .def_readonly("warnings", &JobStep::warnings)
      .def_property_readonly(
          "reason", [](const JobStep& step) { return text(step.reason); },
          "Of a scan, a wait or a stop.")
      .def(
          "to_json", [](const JobStep& step) { return to_json(step); },
          "The text that plan-site prints with --json, but for its options.")
      .def("__repr__", &shown_step);
}

// ---- reports ------------------------------------------------------------------------------------

std::string shown_report(const StepReport& report) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (report.payload_mass) add(rounded(*report.payload_mass) + " kg");
  if (report.joint_work) add(rounded(1e-3 * *report.joint_work) + " kJ");
  if (report.base) add(place(*report.base));
  if (report.stalled) add("stalled");
  if (report.scan) add("with a scan");
  return "<StepReport: " + (text.empty() ? "done" : text) + ">";
}

StepReport made_report(const py::object& scan, const std::optional<double>& time,
                       const std::optional<double>& payload_mass,
                       const std::optional<double>& joint_work, bool stalled,
                       const std::optional<BasePose>& base) {
  StepReport report;
  if (!scan.is_none()) report.scan = scan_of(scan, "the scan");
  report.time = time.value_or(now());
  report.payload_mass = payload_mass;
  report.joint_work = joint_work;
  report.stalled = stalled;
  report.base = base;
  return report;
}

void bind_report(py::module_& module) {
  py::class_<StepReport>(module, "StepReport", "What became of a step.")
      .def(py::init(&made_report), py::kw_only(), arg("scan") = py::none(),
           arg("time") = py::none(), arg("payload_mass") = py::none(),
           arg("joint_work") = py::none(), arg("stalled") = false, arg("base") = py::none(),
           "scan: of the ground after it, in the site's frame; time: when, since 1970-01-01 UTC,\n"
           "else now [s]; payload_mass: by the scale [kg]; joint_work: over the whole cycle [J];\n"
           "stalled: the path was not finished; base: BasePose, where it stands.")
      .def_readonly("scan", &StepReport::scan, "Or None.")
      .def_readonly("time", &StepReport::time, "Since 1970-01-01 UTC [s].")
      .def_readonly("payload_mass", &StepReport::payload_mass, "By the scale [kg], or None.")
      .def_readonly("joint_work", &StepReport::joint_work, "Over the whole cycle [J], or None.")
      .def_readonly("stalled", &StepReport::stalled, "The machine could not finish the path.")
      .def_readonly("base", &StepReport::base, "Where the machine stands now, or None.")
      .def("__repr__", &shown_report);
}

std::string shown_progress(const JobProgress& progress) {
  return "<JobProgress: " + rounded(progress.left_volume) + " of " +
         rounded(progress.design_volume) + " m^3 left, p95 " + rounded(1e3 * progress.p95) +
         " mm, " + rounded(100.0 * progress.seen) + " % seen, " + std::to_string(progress.digs) +
         " digs, " + std::to_string(progress.finishing_passes) + " finishing passes" +
         (progress.is_finished ? ", finished>" : ", not finished>");
}

void bind_progress(py::module_& module) {
  py::class_<JobProgress>(module, "JobProgress", "How far a job has come.")
      .def_readonly("design_volume", &JobProgress::design_volume,
                    "To be taken out when the job began [m^3].")
      .def_readonly("left_volume", &JobProgress::left_volume, "Still above the design [m^3].")
      .def_readonly("rms", &JobProgress::rms, "Of the deviation where it counts [m].")
      .def_readonly("p95", &JobProgress::p95, "Of its absolute value [m].")
      .def_readonly("beyond_twice", &JobProgress::beyond_twice,
                    "Share of what counts beyond twice the tolerance [-].")
      .def_readonly("seen", &JobProgress::seen, "Share of the design that was seen [-].")
      .def_readonly("is_finished", &JobProgress::is_finished, "Within the tolerance, and seen.")
      .def_readonly("digs", &JobProgress::digs, "For volume.")
      .def_readonly("finishing_passes", &JobProgress::finishing_passes)
      .def_readonly("moves", &JobProgress::moves)
      .def_readonly("scans", &JobProgress::scans)
      .def_readonly("stalls", &JobProgress::stalls)
      .def_readonly("payload_mass", &JobProgress::payload_mass, "Lifted in all [kg].")
      .def(
          "to_json", [](const JobProgress& progress) { return to_json(progress); },
          "The text that plan-site prints with --json, but for its options.")
      .def("__repr__", &shown_progress);
}

}  // namespace

void bind_job_steps(py::module_& module) {
  bind_step(module);
  bind_report(module);
  bind_progress(module);
}

}  // namespace excavplan::python
