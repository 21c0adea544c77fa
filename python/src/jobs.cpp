// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "jobs.hpp"

#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/job/job_motion.hpp>
#include <excavplan/job/job_order.hpp>
#include <excavplan/report/report_pages.hpp>
#include <excavplan/soil/soil_scatter.hpp>
#include <excavplan/trial/hidden_site.hpp>

#include "arrays.hpp"
#include "clock.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "scans.hpp"
#include "texts.hpp"

namespace excavplan::python {

namespace {

using py::arg;

/// What a plain site, its machine and its usual law order.
JobSettings settings_of_site(const std::string& description) {
  const SiteBrief brief = read_site_brief(description);
  const Machine machine = load_machine(shipped_or_file("machines", brief.machine));
  return settings_of(brief, machine, usual_law(machine, brief.soil, shipped_soil_laws()));
}

// ---- orders -------------------------------------------------------------------------------------

JobDesign made_design(const BasePose& start, const std::vector<SitePolygon>& windrows,
                      const std::vector<SitePolygon>& heaps, const std::optional<JobTruck>& truck,
                      const std::vector<KeepOut>& keep_out,
                      const std::vector<JobObstacle>& obstacles, double tolerance,
                      double edge_margin, const std::string& name) {
  JobDesign design;
  design.name = name;
  design.start = start;
  for (const SitePolygon& area : windrows) {
    design.dump_areas.push_back({DumpArea::Kind::windrow, area});
  }
  for (const SitePolygon& area : heaps) design.dump_areas.push_back({DumpArea::Kind::heap, area});
  design.truck = truck;
  design.keep_out = keep_out;
  design.obstacles = obstacles;
  design.tolerance = tolerance;
  design.edge_margin = edge_margin;
  require_job(design);
  return design;
}

void bind_places(py::module_& module) {
  py::class_<KeepOut>(module, "KeepOut", "A place that the bucket must not reach.")
      .def(py::init([](const SitePolygon& polygon, std::optional<double> depth,
                       const std::string& kind) {
             return KeepOut{kind, polygon, depth};
           }),
           arg("polygon"), arg("depth") = py::none(), arg("kind") = "",
           "polygon: corners in plan, shape (N, 2) [m]; depth: from where on, below the ground\n"
           "[m], else nothing there is touched; kind: 'cable'.")
      .def_readonly("polygon", &KeepOut::polygon, "[m]")
      .def_readonly("depth", &KeepOut::depth, "[m], or None.")
      .def_readonly("kind", &KeepOut::kind);
  py::class_<JobObstacle>(module, "JobObstacle", "What stands on the ground.")
      .def(py::init([](const SitePolygon& polygon, double height, const std::string& kind) {
             return JobObstacle{kind, polygon, height};
           }),
           arg("polygon"), arg("height"), arg("kind") = "",
           "polygon: corners in plan, shape (N, 2) [m]; height: over the ground [m].")
      .def_readonly("polygon", &JobObstacle::polygon, "[m]")
      .def_readonly("height", &JobObstacle::height, "[m]")
      .def_readonly("kind", &JobObstacle::kind);
  py::class_<JobTruck>(module, "JobTruck", "A truck that is loaded.")
      .def(py::init([](const SitePolygon& bed, double bed_height, double target_mass) {
             return JobTruck{bed, bed_height, target_mass};
           }),
           arg("bed"), arg("bed_height"), arg("target_mass"),
           "bed: corners in plan, shape (N, 2) [m]; bed_height: of its upper edge over the\n"
           "ground [m]; target_mass: of a load [kg].")
      .def_readonly("bed", &JobTruck::bed, "[m]")
      .def_readonly("bed_height", &JobTruck::bed_height, "[m]")
      .def_readonly("target_mass", &JobTruck::target_mass, "[kg]");
}

std::vector<SitePolygon> areas(const JobDesign& design, DumpArea::Kind kind) {
  std::vector<SitePolygon> all;
  for (const DumpArea& area : design.dump_areas) {
    if (area.kind == kind) all.push_back(area.polygon);
  }
  return all;
}

void bind_job_design(py::module_& module) {
  bind_places(module);
  py::class_<JobDesign>(module, "JobDesign",
                        "What a job asks for beside its surface: where soil goes, and what must\n"
                        "not be touched.")
      .def(py::init(&made_design), arg("start"), py::kw_only(),
           arg("windrows") = std::vector<SitePolygon>{}, arg("heaps") = std::vector<SitePolygon>{},
           arg("truck") = py::none(), arg("keep_out") = std::vector<KeepOut>{},
           arg("obstacles") = std::vector<JobObstacle>{}, arg("tolerance") = JobDesign{}.tolerance,
           arg("edge_margin") = JobDesign{}.edge_margin, arg("name") = "",
           "start: BasePose of the machine; windrows, heaps: where soil is laid, corners of each\n"
           "in plan [m], or a truck; tolerance, edge_margin: as of cut_and_fill() [m].")
      .def_property_readonly("name", [](const JobDesign& design) { return text(design.name); })
      .def_readonly("start", &JobDesign::start, "BasePose, or None.")
      .def_property_readonly(
          "windrows",
          [](const JobDesign& design) { return areas(design, DumpArea::Kind::windrow); }, "[m]")
      .def_property_readonly(
          "heaps", [](const JobDesign& design) { return areas(design, DumpArea::Kind::heap); },
          "[m]")
      .def_readonly("truck", &JobDesign::truck, "Or None.")
      .def_readonly("keep_out", &JobDesign::keep_out)
      .def_readonly("obstacles", &JobDesign::obstacles)
      .def_readonly("tolerance", &JobDesign::tolerance, "[m]")
      .def_readonly("edge_margin", &JobDesign::edge_margin, "[m]")
      .def_property_readonly(
          "scan_file", [](const JobDesign& design) { return File{design.scan_file}; },
          "The first scan that its description names; may be empty.")
      .def("__repr__", [](const JobDesign& design) {
        return text("<JobDesign " + design.name + ": tolerance " + rounded(1e3 * design.tolerance) +
                    " mm, " + std::to_string(design.dump_areas.size()) + " dump areas" +
                    (design.truck ? " and a truck>" : ">"));
      });
  module.def(
      "read_plain_site",
      [](const File& file) { return call([&] { return read_plain_site(file.path); }); },
      arg("file"), "The JobDesign of a plain site, site.json.");
}

JobSettings made_settings(const Machine& machine, const SoilKind& soil, const JobDesign& design,
                          const DesignSurface& surface, const std::optional<DensityLaw>& law,
                          double density_percent, double time_price,
                          const std::optional<double>& cell_size) {
  return call([&] {
    JobSettings settings;
    settings.site.soil = soil;
    settings.site.machine = machine;
    settings.site.law = law ? *law : usual_law(machine, soil, shipped_soil_laws());
    settings.site.cell_size = cell_size;
    settings.design = design;
    settings.surface = surface;
    settings.density_percent = density_percent;
    settings.time_price = time_price;
    require_job_settings(settings);
    return settings;
  });
}

void bind_settings(py::module_& module) {
  py::class_<JobSettings>(module, "JobSettings", "What a job is to do, and with what.")
      .def(py::init(&made_settings), arg("machine"), arg("soil"), arg("design"), arg("surface"),
           py::kw_only(), arg("law") = py::none(),
           arg("density_percent") = JobSettings{}.density_percent,
           arg("time_price") = JobSettings{}.time_price, arg("cell_size") = py::none(),
           "design: JobDesign; surface: DesignSurface that the ground is to have, of\n"
           "design_trench() or read_design(); law: else the usual one; density_percent: of the\n"
           "ground as told; time_price: what a second of the machine is worth beside the energy\n"
           "of its joints [W]; cell_size: of the site [m].")
      .def_static(
          "of_site",
          [](const File& file, std::optional<double> density_percent) {
            return call([&] {
              JobSettings settings = settings_of_site(file.path);
              if (density_percent) settings.density_percent = *density_percent;
              require_job_settings(settings);
              return settings;
            });
          },
          arg("file"), arg("density_percent") = py::none(),
          "Of a plain site, site.json, with the usual law; density_percent: else as it says.")
      .def_static(
          "of_order",
          [](const File& folder) { return call([&] { return load_order(folder.path); }); },
          arg("folder"), "Of a job that plan-site began in this folder.")
      .def_property_readonly(
          "machine", [](const JobSettings& s) { return s.site.machine; }, "A Machine.")
      .def_property_readonly(
          "soil", [](const JobSettings& s) { return s.site.soil; }, "A SoilKind.")
      .def_readonly("design", &JobSettings::design, "JobDesign.")
      .def_readonly("surface", &JobSettings::surface, "DesignSurface.")
      .def_readonly("density_percent", &JobSettings::density_percent, "As told [%].")
      .def_readonly("time_price", &JobSettings::time_price, "[W]")
      .def("__repr__", [](const JobSettings& s) {
        return text("<JobSettings of " + s.design.name + ": " + s.site.machine.name + " in " +
                    s.site.soil.name + " of " + rounded(s.density_percent) + " %>");
      });
}

// ---- history ------------------------------------------------------------------------------------

std::string shown_event(const JobEvent& event) {
  std::string shown = "<JobEvent " + std::to_string(event.step) + ": " + name(event.what);
  if (event.payload_mass) shown += ", " + rounded(*event.payload_mass) + " kg";
  if (event.energy) shown += ", " + rounded(1e-3 * *event.energy) + " kJ";
  return shown + ", " + rounded(event.time) + " s, " + rounded(event.left_volume) + " m^3 left>";
}

void bind_job_event(py::module_& module) {
  py::class_<JobEvent>(module, "JobEvent", "A step that was done, or a scan between steps.")
      .def_property_readonly(
          "what", [](const JobEvent& event) { return name(event.what); }, "As of a JobStep.")
      .def_readonly("step", &JobEvent::step, "JobStep.id; 0: no step asked for it.")
      .def_readonly("at", &JobEvent::at, "When it was over, since 1970-01-01 UTC [s].")
      .def_readonly("time", &JobEvent::time, "That it took [s].")
      .def_readonly("energy", &JobEvent::energy, "Of the joints, and of a move [J], or None.")
      .def_readonly("payload_mass", &JobEvent::payload_mass, "By the scale [kg], or None.")
      .def_readonly("predicted", &JobEvent::predicted, "Of a dig.")
      .def_readonly("base", &JobEvent::base, "Where the machine stood; after a move: stands.")
      .def_readonly("dump", &JobEvent::dump, "As of a JobStep [m].")
      .def_readonly("keeps_load", &JobEvent::keeps_load, "As of a JobStep.")
      .def_readonly("truck", &JobEvent::truck, "That was loaded, or None.")
      .def_readonly("stalled", &JobEvent::stalled)
      .def_readonly("scanned", &JobEvent::scanned, "In it or after it.")
      .def_readonly("trustworthy", &JobEvent::trustworthy)
      .def_readonly("warnings", &JobEvent::warnings)
      .def_property_readonly(
          "reason", [](const JobEvent& event) { return text(event.reason); }, "As of a JobStep.")
      .def_readonly("left_volume", &JobEvent::left_volume, "Of the design after it [m^3].")
      .def("__repr__", &shown_event);
}

void bind_job_history(py::module_& module) {
  bind_job_event(module);
  py::class_<JobHistory>(module, "JobHistory", "What was done in a job, with the ground after it.")
      .def_readonly("design", &JobHistory::design, "JobDesign.")
      .def_readonly("design_volume", &JobHistory::design_volume,
                    "To be taken out before the first step [m^3].")
      .def_readonly("target", &JobHistory::target, "Height of the design; NaN beside it.")
      .def_readonly("before", &JobHistory::before, "Surface before the first step.")
      .def_readonly("begin", &JobHistory::begin, "Since 1970-01-01 UTC [s].")
      .def_readonly("events", &JobHistory::events, "JobEvents.")
      .def(
          "ground",
          [](const JobHistory& history, std::size_t events_done) {
            return call([&] { return history.ground(events_done).surface; });
          },
          arg("events_done"), "Surface after so many events.")
      .def(
          "seen_at",
          [](const JobHistory& history, std::size_t events_done) {
            return array(call([&] { return history.ground(events_done).seen_at; }));
          },
          arg("events_done"),
          "When each cell was last seen then, since 1970-01-01 UTC [s], shape (rows, columns);\n"
          "NaN: never.")
      .def("__len__", [](const JobHistory& history) { return history.events.size(); })
      .def("__repr__", [](const JobHistory& history) {
        return text("<JobHistory of " + history.design.name + ": " +
                    std::to_string(history.events.size()) + " events>");
      });
}

// ---- the job ------------------------------------------------------------------------------------

std::unique_ptr<JobInPython> begun(const File& folder, const JobSettings& settings,
                                   const py::object& scan, const std::optional<double>& time) {
  const Scan first = scan.is_none() ? first_scan(settings.design) : scan_of(scan, "the scan");
  const double when = time.value_or(now());
  return call([&] {
    return std::make_unique<JobInPython>(settings,
                                         SiteJob::begin(folder.path, settings, first, when));
  });
}

std::variant<Trajectory, BlockedWay> motion(JobInPython& job, const JobStep& step, double rate,
                                            double speed_fraction, double corner_tolerance,
                                            double max_jerk) {
  const MotionOptions options{rate, speed_fraction, corner_tolerance, max_jerk};
  return job.with(
      [&](SiteJob& own) { return motion_of(job.settings(), own.ground(), step, options); });
}

using JobClass = py::class_<JobInPython>;

void bind_making(JobClass& job) {
  job.def_static("begin", &begun, arg("folder"), arg("settings"), arg("scan") = py::none(),
                 arg("time") = py::none(),
                 "Begins a job in a folder that holds none.\n\n"
                 "scan: of the ground before it, in the site's frame, else the one that the plain\n"
                 "site names; time: of the scan, since 1970-01-01 UTC, else now [s].")
      .def_static(
          "resume",
          [](const File& folder, const std::optional<JobSettings>& settings) {
            return call([&] {
              const JobSettings used = settings ? *settings : load_order(folder.path);
              return std::make_unique<JobInPython>(used, SiteJob::resume(folder.path, used));
            });
          },
          arg("folder"), arg("settings") = py::none(),
          "Goes on with the job of a folder; settings: else those of plan-site, which began it.");
}

void bind_doing(JobClass& job) {
  const MotionOptions usual;
  job.def(
         "next", [](JobInPython& of) { return of.with([](SiteJob& own) { return own.next(); }); },
         "The JobStep to do now; the same until it is done.")
      .def(
          "done",
          [](JobInPython& of, long long step, const StepReport& report) {
            of.with([&](SiteJob& own) {
              own.done(step, report);
              return true;
            });
          },
          arg("step"), arg("report"),
          "step: JobStep.id; of another than the present one nothing changes.")
      .def(
          "look",
          [](JobInPython& of, const py::object& scan, const std::optional<double>& time) {
            const Scan seen = scan_of(scan, "the scan");
            const double when = time.value_or(now());
            of.with([&](SiteJob& own) {
              own.look(seen, when);
              return true;
            });
          },
          arg("scan"), arg("time") = py::none(),
          "Takes in a scan that no step asked for; time: as of begin().")
      .def(
          "undo",
          [](JobInPython& of) {
            of.with([](SiteJob& own) {
              own.undo();
              return true;
            });
          },
          "Takes the last done() or look() back; of all of them the last is kept.")
      .def("motion", &motion, arg("step"), py::kw_only(), arg("rate") = usual.rate,
           arg("speed_fraction") = usual.speed_fraction,
           arg("corner_tolerance") = usual.corner_tolerance, arg("max_jerk") = usual.max_jerk,
           "The whole cycle of a dig for a controller, in the machine's frame; without points of\n"
           "a step that is no dig; BlockedWay: what is in the way. Options as of plan_motion().");
}

void bind_looking(JobClass& job) {
  job.def_property_readonly(
         "progress",
         [](JobInPython& of) { return of.with([](SiteJob& own) { return own.progress(); }); },
         "JobProgress.")
      .def_property_readonly(
          "history",
          [](JobInPython& of) {
            return of.with([](SiteJob& own) { return JobHistory(own.history()); });
          },
          "JobHistory; a copy.")
      .def_property_readonly(
          "ground",
          [](JobInPython& of) {
            return of.with([](SiteJob& own) { return Terrain(own.ground()); });
          },
          "Terrain as expected now: as scanned, and what was dug since; a copy.")
      .def_property_readonly(
          "scan_warnings",
          [](JobInPython& of) {
            return of.with([](SiteJob& own) { return std::vector(own.scan_warnings()); });
          },
          "Of the last scan that was taken in.")
      .def_property_readonly(
          "design_warnings",
          [](JobInPython& of) {
            return of.with([](SiteJob& own) { return own.design_warnings(); });
          },
          "What of the design cannot be done or is not asked for rightly: design_above_ground,\n"
          "design_beyond_scan, design_out_of_reach, dump_on_design, wide_tolerance.")
      .def_property_readonly(
          "wall_warnings",
          [](JobInPython& of) { return of.with([](SiteJob& own) { return own.wall_warnings(); }); },
          "unstable_wall, if a wall of the design would not stand.")
      .def_property_readonly(
          "settings", [](const JobInPython& of) { return of.settings(); }, "JobSettings.")
      .def(
          "report",
          [](JobInPython& of, const File& file) {
            write_bytes(file, of.with([&](SiteJob& own) {
              return report_page(own.progress(), own.history(), of.settings().site.machine);
            }));
          },
          arg("file"), "Writes the page of plan-site show --report.")
      .def("__repr__", [](const JobInPython& of) {
        const JobSettings& settings = of.settings();
        return text("<SiteJob " + settings.design.name + ": " + settings.site.machine.name +
                    " in " + settings.site.soil.name + ">");
      });
}

}  // namespace

void bind_jobs(py::module_& module) {
  bind_job_design(module);
  bind_settings(module);
  bind_job_history(module);
  JobClass job(module, "SiteJob",
               "Decides the steps of a job. All that it knows is in a folder, written\n"
               "after every step.");
  bind_making(job);
  bind_doing(job);
  bind_looking(job);
}

}  // namespace excavplan::python
