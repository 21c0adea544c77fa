// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <mutex>

#include <excavplan/belief/belief_file.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/site/plan_on_site.hpp>
#include <excavplan/soil/soil_scatter.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "clock.hpp"
#include "paths.hpp"
#include "plans.hpp"
#include "rooms.hpp"
#include "scans.hpp"
#include "texts.hpp"
#include "words.hpp"

namespace excavplan::python {
namespace {

using py::arg;

// ---- what a site is told ------------------------------------------------------------------------

/// SitePlan of Python.
struct SitePlanInPython : SitePlan {
  std::shared_ptr<const PlanContext> made_with;
};

void tell_dig(const std::optional<SitePlanInPython>& plan, const std::optional<DigParameters>& path,
              const std::optional<double>& start, const std::optional<Eigen::Vector2d>& dump_at,
              SiteEvent& event) {
  if (plan && path) throw Error(ErrorKind::bad_input, "plan and dug_path both tell the path");
  if (start && !path) throw Error(ErrorKind::bad_input, "dug_start needs dug_path");
  if (dump_at && !plan && !path) {
    throw Error(ErrorKind::bad_input, "dump_at needs plan or dug_path");
  }
  if (path) event.options.dug_path = DugPath{{}, *path, start, {}, dump_at};
  if (!plan) return;
  if (!plan->plan.dig) throw Error(ErrorKind::bad_input, "plan: it has no dig");
  const PlannedDig& dig = *plan->plan.dig;
  event.options.dug_path = DugPath{{}, dig.parameters, dig.start_x, {}, dump_at};
  event.foretold = ForetoldDig{plan->density.percent, dig.energy};
}

SiteEvent made_event(const py::object& scan, const py::object& before, bool dug,
                     const std::optional<double>& time, const BasePose& base,
                     const std::optional<SitePlanInPython>& plan,
                     const std::optional<DigParameters>& dug_path,
                     const std::optional<double>& dug_start,
                     const std::optional<Eigen::Vector2d>& dump_at,
                     const std::optional<Measured>& payload_mass,
                     const std::optional<Measured>& joint_work, bool stalled, unsigned threads) {
  SiteEvent event;
  event.scan = scan_of(scan, "the scan");
  if (!before.is_none()) event.before = scan_of(before, "the scan before");
  event.dug = dug;
  event.time = time ? *time : now();
  event.base = base;
  tell_dig(plan, dug_path, dug_start, dump_at, event);
  event.options.payload_mass = payload_mass;
  event.options.joint_work = joint_work;
  event.options.threads = threads;
  event.stalled = stalled;
  return event;
}

void bind_event(py::module_& module) {
  py::class_<BasePose>(module, "BasePose", "Where a machine stands in the frame of its site.")
      .def(py::init([](double x, double y, double z, double heading) {
             return BasePose{x, y, z, heading};
           }),
           arg("x") = 0.0, arg("y") = 0.0, arg("z") = 0.0, arg("heading") = 0.0,
           "x, y, z: of its swing axis at ground level [m]; heading: of its x axis from that of\n"
           "the site, to the left [rad].")
      .def_readonly("x", &BasePose::x, "[m]")
      .def_readonly("y", &BasePose::y, "[m]")
      .def_readonly("z", &BasePose::z, "[m]")
      .def_readonly("heading", &BasePose::heading, "[rad]")
      .def_property_readonly(
          "site_from_machine",
          [](const BasePose& base) { return array(base.site_from_machine().matrix()); },
          "Takes points of the machine's frame into that of the site, shape (4, 4).");
  py::class_<SitePlanInPython>(module, "SitePlan", "The next dig on a site.")
      .def_property_readonly(
          "plan",
          [](const SitePlanInPython& of) {
            return PlanInPython{{of.plan}, of.made_with};
          },
          "A DigPlan in the machine's frame.")
      .def_readonly("density", &SitePlan::density, "That it is for.")
      .def_readonly("ground", &SitePlan::ground, "That it is on, in the machine's frame.");
  py::class_<SiteEvent>(module, "SiteEvent", "A scan of the site, after one dig or after none.")
      .def(
          py::init(&made_event), arg("scan"), py::kw_only(), arg("before") = py::none(),
          arg("dug") = true, arg("time") = py::none(), arg("base") = BasePose{},
          arg("plan") = py::none(), arg("dug_path") = py::none(), arg("dug_start") = py::none(),
          arg("dump_at") = py::none(), arg("payload_mass") = py::none(),
          arg("joint_work") = py::none(), arg("stalled") = false, arg("threads") = 0,
          "scan: of the ground now, in the site's frame; before: of it before the dig, not needed\n"
          "once the site knows its ground; dug: false if nothing was dug; time: when it was\n"
          "scanned, since 1970-01-01 UTC, else now [s]; base: of the machine during the dig;\n"
          "plan: the SitePlan that was driven, or dug_path, dug_start as of estimate_density();\n"
          "dump_at: (x, y) where the bucket was emptied, in the machine's frame [m];\n"
          "payload_mass: Measured, moist [kg]; joint_work: Measured, of the joints in the dig\n"
          "[J]; stalled: the dig was given up; threads: 0 is one per core.")
      .def_readonly("dug", &SiteEvent::dug, "False: no density is sought.")
      .def_readonly("time", &SiteEvent::time, "Since 1970-01-01 UTC [s].")
      .def_readonly("base", &SiteEvent::base, "Of the machine.")
      .def_readonly("stalled", &SiteEvent::stalled, "The dig was given up.");
  py::class_<SiteUpdate>(module, "SiteUpdate", "What became of an event.")
      .def_readonly("estimate", &SiteUpdate::estimate, "Of this dig alone; None of no dig.")
      .def_readonly("density", &SiteUpdate::density,
                    "RelativeDensity that the site believes in where it dug, or None.")
      .def_readonly("digs", &SiteUpdate::digs, "Of the site that taught it a density.")
      .def_readonly("taken", &SiteUpdate::taken, "The site is changed; else it is as before.")
      .def_readonly("warnings", &SiteUpdate::warnings, "Of the estimate and of the scan.")
      .def_readonly("trustworthy", &SiteUpdate::trustworthy, "False: see the warnings.");
}

// ---- belief -------------------------------------------------------------------------------------

std::pair<Array, Array> arrays_of(const BelievedDensity& density) {
  const auto one = [](const Eigen::ArrayXd& numbers) {
    return array({numbers.data(), numbers.data() + numbers.size()}, {numbers.size()});
  };
  return {one(density.percent()), one(density.sd_percent)};
}

void bind_belief(py::module_& module) {
  py::class_<DensityBelief>(module, "DensityBelief",
                            "Where in the site's frame which density is believed in.")
      .def(
          "at",
          [](const DensityBelief& belief, const ArrayLike& places) {
            std::vector<GroundPlace> all;
            for (const auto& p : points_of("the places", places))
              all.push_back({p.x(), p.y(), p.z()});
            return arrays_of(call([&] { return belief.at(all); }));
          },
          arg("places"),
          "(means [%], standard deviations [points]) at places of shape (N, 3): x, y and depth\n"
          "below the ground as it was before the first dig [m].")
      .def(
          "map",
          [](const DensityBelief& belief, const HeightMap& grid, double depth) {
            const LayeredMap map = call([&] { return belief_map(belief, grid, depth); });
            return std::pair(array(map.layers.at(0).values), array(map.layers.at(1).values));
          },
          arg("grid"), arg("depth"),
          "(means [%], standard deviations [points]) at a depth [m] below each cell of a grid,\n"
          "each of shape (rows, columns).")
      .def(
          "to_json", [](const DensityBelief& belief) { return to_json(belief); },
          "The text of a belief file.")
      .def(
          "__len__", [](const DensityBelief& belief) { return belief.digs().size(); },
          "Digs that it remembers.");
}

// ---- site ---------------------------------------------------------------------------------------

/// A site that threads of Python share: one after the other, without the lock of the interpreter.
class SiteInPython {
 public:
  SiteInPython(const std::string& folder, const SiteSettings& settings, SiteAccess access)
      : site_(call([&] { return Site(folder, settings, access); })) {}

  template <typename Work>
  auto with(const Work& work) -> decltype(work(std::declval<Site&>())) {
    Call own;
    return with(own, work);
  }
  template <typename Work>
  auto with(Call& own, const Work& work) -> decltype(work(std::declval<Site&>())) {
    return own.run([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!site_) throw Error(ErrorKind::bad_input, "the site is closed");
      return work(*site_);
    });
  }
  void close() {
    call([&] {
      const std::lock_guard<std::mutex> lock(mutex_);
      site_.reset();
      return true;
    });
  }

 private:
  std::mutex mutex_;
  std::optional<Site> site_;
};

SiteEvent of_machine(const Site& site, const SiteEvent& given) {
  SiteEvent event = given;
  if (event.options.dug_path) event.options.dug_path->machine = site.settings().machine;
  return event;
}

std::unique_ptr<SiteInPython> opened(const File& folder, const Machine& machine,
                                     const SoilKind& soil, const std::optional<DensityLaw>& law,
                                     const std::optional<double>& cell_size,
                                     const std::string& frame, const std::string& access) {
  const auto how = of_word<SiteAccess>("the access", access,
                                       {{"read", SiteAccess::read}, {"write", SiteAccess::write}});
  const DensityLaw used =
      law ? *law : call([&] { return usual_law(machine, soil, shipped_soil_laws()); });
  return std::make_unique<SiteInPython>(folder.path,
                                        SiteSettings{soil, machine, used, cell_size, frame}, how);
}

template <typename Value>
auto asking(Value (Site::*question)() const) {
  return [question](SiteInPython& site) {
    return site.with([&](const Site& of) { return std::decay_t<Value>((of.*question)()); });
  };
}

using SiteClass = py::class_<SiteInPython>;

void bind_updates(SiteClass& site) {
  site.def(
          "update",
          [](SiteInPython& of, const SiteEvent& event) {
            return of.with([&](Site& own) { return own.update(of_machine(own, event)); });
          },
          arg("event"),
          "Takes in a scan and stores the site, whole or, if the process is killed, not at all.\n"
          "One that does not fit the ground where that did not change is not taken.")
      .def(
          "look",
          [](SiteInPython& of, const SiteEvent& event) {
            return of.with([&](Site& own) { return own.look(of_machine(own, event)); });
          },
          arg("event"), "What update() would answer. The site stays as it is.")
      .def(
          "undo",
          [](SiteInPython& of) {
            of.with([](Site& own) {
              own.undo();
              return true;
            });
          },
          "Takes the last update back; of all updates the last one is kept.")
      .def("close", &SiteInPython::close, "Lets other processes change the site.")
      .def(
          "__enter__", [](SiteInPython& of) -> SiteInPython& { return of; },
          py::return_value_policy::reference)
      .def(
          "__exit__",
          [](SiteInPython& of, const py::object&, const py::object&, const py::object&) {
            of.close();
          },
          arg("kind"), arg("error"), arg("trace"), "Closes the site.");
}

void bind_views(SiteClass& site) {
  site.def_property_readonly("is_empty", asking(&Site::is_empty), "No scan was taken in.")
      .def_property_readonly("updates", asking(&Site::updates), "Scans taken in.")
      .def_property_readonly("digs", asking(&Site::digs), "Those that gave a density.")
      .def_property_readonly("cell_size", asking(&Site::cell_size), "[m]")
      .def_property_readonly("ground", asking(&Site::ground),
                             "GroundState in the frame of the site; a copy.")
      .def_property_readonly("belief", asking(&Site::belief), "DensityBelief; a copy.")
      .def(
          "density_at",
          [](SiteInPython& of, const BasePose& base, const Rectangle& area, double depth) {
            return of.with([&](const Site& own) { return own.density_at(base, area, depth); });
          },
          arg("base"), arg("area"), arg("depth"),
          "The mean density of the undisturbed soil of an area, in the machine's frame, down to\n"
          "a depth [m].")
      .def(
          "ground_for",
          [](SiteInPython& of, const BasePose& base, const Rectangle& extent, double cell_size) {
            return of.with(
                [&](const Site& own) { return own.ground_for(base, extent, cell_size); });
          },
          arg("base"), arg("extent"), arg("cell_size") = 0.05,
          "The ground about a machine, in its frame: cells that no scan saw are unknown.");
}

SitePlanInPython planned_on_site(SiteInPython& site, const BasePose& base,
                                 const std::optional<GroundDensity>& density,
                                 const std::string& method,
                                 const std::optional<PathLibrary>& library,
                                 const std::optional<SearchOptionsInPython>& search,
                                 const py::object& simulator, double speed_fraction,
                                 const std::optional<HeightMap>& standing_on,
                                 const std::optional<Terrain>& present) {
  const auto own = std::make_shared<Call>();
  SitePlanOptions options;
  options.base = base;
  options.plan = plan_options(own, {method, library, search, simulator, speed_fraction});
  options.plan.standing_on = standing_on;
  options.density = density;
  options.present = present;
  const auto kept = shared(simulator);
  return site.with(*own, [&](const Site& of) {
    SitePlanInPython made{plan_on_site(of, options), {}};
    const SiteSettings& settings = of.settings();
    made.made_with = std::make_shared<const PlanContext>(
        PlanContext{settings.machine, settings.soil, made.density, made.ground, kept,
                    options.plan.search.objective});
    return made;
  });
}

}  // namespace

void bind_site(py::module_& module) {
  bind_event(module);
  bind_belief(module);
  SiteClass site(module, "Site",
                 "The ground as best known over all scans and digs, and the density that is\n"
                 "believed in, in a folder. Closed at the end of a `with` block.");
  site.def(py::init(&opened), arg("folder"), arg("machine"), arg("soil"), arg("law") = py::none(),
           py::kw_only(), arg("cell_size") = py::none(), arg("frame") = "", arg("access") = "read",
           "machine, soil, law (else the usual one) and cell_size [m]: of all digs of the site,\n"
           "others are refused; frame: name of its frame; access: 'read' or 'write', which makes\n"
           "the folder if need be and keeps other processes from changing the site.");
  bind_updates(site);
  bind_views(site);
  module.def(
      "plan_on_site", &planned_on_site, arg("site"), py::kw_only(), arg("base") = BasePose{},
      arg("density") = py::none(), arg("method") = "library", arg("library") = py::none(),
      arg("search") = py::none(), arg("simulator") = py::none(),
      arg("speed_fraction") = TrajectoryOptions{}.speed_fraction, arg("standing_on") = py::none(),
      arg("present") = py::none(),
      "Plans the next dig on the ground of a site, for the density that it believes in there.\n\n"
      "base: BasePose of the machine; density: as long as no dig told the site one; present:\n"
      "ground as a scan shows it now, of terrain_from_scan(): what stands on it is kept clear\n"
      "of; the rest as of plan_dig().");
}

}  // namespace excavplan::python
