// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/trial/job_trial.hpp>

#include <excavplan/base/data_files.hpp>
#include <excavplan/report/report_pages.hpp>
#include <excavplan/results/result_json.hpp>
#include <excavplan/trial/plain_planners.hpp>
#include <excavplan/trial/trial_history.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "jobs.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "texts.hpp"

namespace excavplan::python {
namespace {

using py::arg;

Machine machine_of(const std::optional<Machine>& given, const HiddenSite& site) {
  return given ? *given : load_machine(shipped_or_file("machines", site.known.machine));
}

void bind_hidden_site(py::module_& module) {
  py::class_<HiddenSite>(module, "HiddenSite", "A plain site with what it hides.")
      .def_readonly("ground", &HiddenSite::ground, "Terrain at the start, in the site's frame.")
      .def_readonly("soil", &HiddenSite::soil, "SoilKind as it is.")
      .def_readonly("first_scan", &HiddenSite::first_scan, "As cells; NaN: not seen.")
      .def_property_readonly(
          "machine", [](const HiddenSite& site) { return text(site.known.machine); },
          "Name of its class.")
      .def(
          "density_at",
          [](const HiddenSite& site, double x, double y, double z) {
            return site.density.at(x, y, z);
          },
          arg("x"), arg("y"), arg("z"), "True relative density of the bank at a place [m] [%].")
      .def_property_readonly(
          "mean_density",
          [](const HiddenSite& site) { return call([&] { return mean_density(site); }); },
          "True one over what the design takes out [%].")
      .def("__repr__", [](const HiddenSite& site) {
        return text("<HiddenSite " + site.known.job.name + ": " + site.soil.name + ">");
      });
  module.def(
      "read_hidden_site",
      [](const File& folder, double cell_size) {
        return call([&] { return read_hidden_site(folder.path, cell_size); });
      },
      arg("folder"), arg("cell_size") = truth_cell,
      "A plain site with its folder `hidden`; cell_size: of the true ground, <= 0.25 [m].");
}

// ---- scores -------------------------------------------------------------------------------------

std::string shown_score(const JobScore& score) {
  return std::string(score.finished ? "finished" : "not finished") + ", rms " +
         rounded(1e3 * score.rms) + " mm, p95 " + rounded(1e3 * score.p95) + " mm, left " +
         rounded(score.left_percent()) + " %, overdig " + rounded(score.overdig_percent()) +
         " %, spill " + rounded(score.spill_percent()) + " %";
}

void bind_score(py::module_& module) {
  py::class_<JobScore>(module, "JobScore", "How a job left the true ground.")
      .def_readonly("finished", &JobScore::finished, "Within every limit of the job.")
      .def_readonly("rms", &JobScore::rms, "Of ground less design, in the zone [m].")
      .def_readonly("p95", &JobScore::p95, "Of its absolute value [m].")
      .def_readonly("beyond_twice", &JobScore::beyond_twice,
                    "Share of the zone beyond twice the tolerance [-].")
      .def_readonly("seen", &JobScore::seen, "Share of the footprint [-].")
      .def_readonly("design_cut", &JobScore::design_cut, "In the footprint [m^3].")
      .def_readonly("left", &JobScore::left, "Of it, still there [m^3].")
      .def_readonly("overdig_inside", &JobScore::overdig_inside, "Below the design [m^3].")
      .def_readonly("overdig_beside", &JobScore::overdig_beside,
                    "By which ground fell outside of the footprint [m^3].")
      .def_readonly("risen", &JobScore::risen, "By which ground rose [m^3].")
      .def_readonly("spilled", &JobScore::spilled, "Of it, outside of the dump areas [m^3].")
      .def_readonly("removed", &JobScore::removed, "By which ground fell [m^3].")
      .def_readonly("keep_out", &JobScore::keep_out, "Volume that changed in it [m^3].")
      .def_property_readonly("left_percent", &JobScore::left_percent, "Of the design cut.")
      .def_property_readonly("overdig_percent", &JobScore::overdig_percent,
                             "Inside and beside, of the design cut.")
      .def_property_readonly("spill_percent", &JobScore::spill_percent,
                             "Of what rose; with a truck: of what was removed.")
      .def("__repr__",
           [](const JobScore& score) { return "<JobScore: " + shown_score(score) + ">"; });
}

// ---- truth --------------------------------------------------------------------------------------

/// The true ground that threads of Python share.
class TruthInPython {
 public:
  TruthInPython(const HiddenSite& site, const Machine& machine, const TruthOptions& options)
      : site_(site), truth_(site, machine, options) {}

  template <typename Work>
  auto with(const Work& work) -> decltype(work(std::declval<TrueSite&>())) {
    return call([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return work(truth_);
    });
  }
  JobScore score() {
    return with([this](const TrueSite& truth) {
      return score_job(site_, truth.ground().surface(), truth.seen_share(footprint_of(site_)));
    });
  }
  std::string name() const { return site_.known.job.name; }

 private:
  std::mutex mutex_;
  HiddenSite site_;
  TrueSite truth_;
};

void bind_true_step(py::module_& module) {
  py::class_<TrueStep>(module, "TrueStep", "What a step did on the true ground, and cost.")
      .def_readonly("report", &TrueStep::report, "StepReport: what the planner is told.")
      .def_readonly("time", &TrueStep::time, "Of the cycle, the move or the scan [s].")
      .def_readonly("scan_time", &TrueStep::scan_time, "Of a scan, part of it [s].")
      .def_readonly("energy", &TrueStep::energy, "Of the joints over it [J].")
      .def_readonly("payload_mass", &TrueStep::payload_mass, "True [kg].")
      .def_readonly("stall", &TrueStep::stall, "Or None.")
      .def("__repr__", [](const TrueStep& done) {
        return "<TrueStep: " + rounded(done.payload_mass) + " kg, " + rounded(1e-3 * done.energy) +
               " kJ, " + rounded(done.time) + (done.stall ? " s, stalled>" : " s>");
      });
  py::class_<SolidsLedger>(module, "SolidsLedger",
                           "Dry mass that was moved: cut = lying + hauled + held.")
      .def_readonly("cut", &SolidsLedger::cut, "From the bank [kg].")
      .def_readonly("lying", &SolidsLedger::lying, "Gained by the loose soil of the site [kg].")
      .def_readonly("hauled", &SolidsLedger::hauled, "By trucks [kg].")
      .def_readonly("held", &SolidsLedger::held, "By the bucket, since it was dumped last [kg].")
      .def("__repr__", [](const SolidsLedger& solids) {
        return "<SolidsLedger: " + rounded(solids.cut) + " kg cut, " + rounded(solids.lying) +
               " kg lying, " + rounded(solids.hauled) + " kg hauled>";
      });
}

using TruthClass = py::class_<TruthInPython>;

void bind_doing(TruthClass& truth) {
  truth
      .def(py::init([](const HiddenSite& site, const std::optional<Machine>& machine,
                       std::uint64_t seed, bool scans_each_dig) {
             TruthOptions options;
             options.seed = seed;
             options.scans_each_dig = scans_each_dig;
             return call([&] {
               return std::make_unique<TruthInPython>(site, machine_of(machine, site), options);
             });
           }),
           arg("site"), arg("machine") = py::none(), py::kw_only(), arg("seed") = 1,
           arg("scans_each_dig") = false, "machine: else that of the site; seed: of all draws.")
      .def(
          "execute",
          [](TruthInPython& of, const JobStep& step) {
            return of.with([&](TrueSite& own) { return own.execute(step); });
          },
          arg("step"), "Does a JobStep.")
      .def(
          "scan",
          [](TruthInPython& of) { return of.with([](TrueSite& own) { return own.scan(); }); },
          "A Scan from where the machine stands.")
      .def("score", &TruthInPython::score, "JobScore of the ground as it is now.");
}

void bind_views(TruthClass& truth) {
  truth
      .def_property_readonly(
          "ground",
          [](TruthInPython& of) {
            return of.with([](TrueSite& own) { return Terrain(own.ground()); });
          },
          "The true Terrain; a copy.")
      .def_property_readonly(
          "known_base",
          [](TruthInPython& of) {
            return of.with([](TrueSite& own) { return BasePose(own.known_base()); });
          },
          "Where the machine is said to stand.")
      .def_property_readonly(
          "time",
          [](TruthInPython& of) { return of.with([](TrueSite& own) { return own.time(); }); },
          "Since 1970-01-01 UTC [s].")
      .def_property_readonly(
          "solids",
          [](TruthInPython& of) {
            return of.with([](TrueSite& own) { return SolidsLedger(own.solids()); });
          },
          "SolidsLedger.")
      .def("__repr__",
           [](const TruthInPython& of) { return text("<TrueSite " + of.name() + ">"); });
}

// ---- whole jobs ---------------------------------------------------------------------------------

/// JobTrial of Python.
struct TrialInPython : JobTrial {
  std::shared_ptr<const JobHistory> history;
  std::shared_ptr<const Machine> machine;
};

TrialInPython played(const HiddenSite& site, const py::object& planner,
                     const std::optional<Machine>& machine, std::uint64_t seed,
                     long long most_steps, const py::object& progress) {
  const auto shared_progress = shared(progress);
  TrialOptions options;
  options.truth.seed = seed;
  options.most_steps = most_steps;
  Call own;
  TrialRecorder recorder = call([&] { return TrialRecorder(site); });
  options.each = [&](const TrialStep& step) {
    recorder.add(step);
    if (!goes_on(own, *shared_progress, step) || own.failed()) {
      throw Error(ErrorKind::bad_input, "the trial was ended by its progress callback");
    }
  };
  const auto digger = std::make_shared<const Machine>(machine_of(machine, site));
  const auto with_history = [&](JobTrial trial) -> TrialInPython {
    return {std::move(trial), std::make_shared<const JobHistory>(recorder.history()), digger};
  };
  if (py::isinstance<JobInPython>(planner)) {
    auto& job = planner.cast<JobInPython&>();
    return with_history(own.run([&] { return run_trial(site, *digger, job, options); }));
  }
  if (!py::isinstance<py::str>(planner)) throw py::type_error("planner: a SiteJob or a word");
  const auto word = planner.cast<std::string>();
  std::string known;
  for (const PlainPolicy& policy : plain_policies()) {
    known += (known.empty() ? "" : ", ") + policy.word;
    if (policy.word != word) continue;
    return with_history(own.run([&] {
      const auto plain = plain_planner(policy, site.known, site.first_scan, *digger);
      return run_trial(site, *digger, *plain, options);
    }));
  }
  throw Error(ErrorKind::bad_input,
              "the planner: '" + word + "' is no SiteJob and none of " + known);
}

std::string shown_trial(const TrialInPython& trial) {
  return "<JobTrial: " + shown_score(trial.score) + ", " + std::to_string(trial.digs) + " digs, " +
         rounded(1e-3 * trial.energy_per_design()) + " kJ/m^3, " + rounded(trial.time / 60.0) +
         " min>";
}

void bind_trial_results(py::module_& module) {
  py::class_<TrialStep>(module, "TrialStep", "One step of a trial.")
      .def_readonly("step", &TrialStep::step, "JobStep.")
      .def_readonly("done", &TrialStep::done, "TrueStep.")
      .def_readonly("planning_time", &TrialStep::planning_time, "By the clock [s].");
  py::class_<TrialInPython>(module, "JobTrial", "What became of a job on hidden ground.")
      .def_readonly("score", &JobTrial::score, "JobScore.")
      .def_property_readonly(
          "reason", [](const TrialInPython& trial) { return text(trial.reason); }, "Of its end.")
      .def_readonly("stopped", &JobTrial::stopped, "By the planner.")
      .def_readonly("digs", &JobTrial::digs, "With those that finish.")
      .def_readonly("finishing", &JobTrial::finishing)
      .def_readonly("moves", &JobTrial::moves)
      .def_readonly("scans", &JobTrial::scans)
      .def_readonly("stalls", &JobTrial::stalls)
      .def_readonly("untrusted", &JobTrial::untrusted, "Steps done though they are not trusted.")
      .def_readonly("energy", &JobTrial::energy, "Of cycles and moves [J].")
      .def_readonly("time", &JobTrial::time, "Of cycles, moves, scans and waits [s].")
      .def_readonly("planning_time", &JobTrial::planning_time, "By the clock [s].")
      .def_readonly("hauled", &JobTrial::hauled, "True, into trucks [kg].")
      .def_readonly("trucks", &JobTrial::trucks, "True mass of each load by its number [kg].")
      .def_readonly("solids", &JobTrial::solids, "SolidsLedger.")
      .def_readonly("after", &JobTrial::after, "The true Terrain.")
      .def_property_readonly("energy_per_design", &JobTrial::energy_per_design,
                             "Over the volume of the design that was taken out [J/m^3].")
      .def_property_readonly(
          "history", [](const TrialInPython& trial) { return JobHistory(*trial.history); },
          "JobHistory of the true ground.")
      .def(
          "to_json", [](const TrialInPython& trial) { return to_json(trial); },
          "The text that simulate-site prints with --json.")
      .def(
          "report",
          [](const TrialInPython& trial, const File& file) {
            write_bytes(file,
                        call([&] { return report_page(trial, *trial.history, *trial.machine); }));
          },
          arg("file"), "Writes the page of simulate-site --report.")
      .def("__repr__", &shown_trial);
}

}  // namespace

void bind_trial(py::module_& module) {
  bind_hidden_site(module);
  bind_score(module);
  bind_true_step(module);
  TruthClass truth(module, "TrueSite", "A machine on the true ground of a site.");
  bind_doing(truth);
  bind_views(truth);
  bind_trial_results(module);
  module.def("play_job", &played, arg("site"), arg("planner"), arg("machine") = py::none(),
             py::kw_only(), arg("seed") = 1, arg("most_steps") = TrialOptions{}.most_steps,
             arg("progress") = py::none(),
             "Does a whole job on the true ground of a HiddenSite.\n\n"
             "planner: a SiteJob that begins, or a plain policy: 'operator', 'fixed' or 'greedy';\n"
             "machine: else that of the site; progress: called with a TrialStep after each step,\n"
             "false ends the trial with an error.");
}

}  // namespace excavplan::python
