// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/ground/ascii_grid.hpp>
#include <excavplan/ground/ground_state.hpp>
#include <excavplan/ground/terrain.hpp>
#include <excavplan/machine/dig_path.hpp>
#include <excavplan/report/report_pages.hpp>
#include <excavplan/results/result_json.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/simulation/height_map_simulator.hpp>
#include <excavplan/soil/ground_in_soil.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "simulators.hpp"
#include "texts.hpp"
#include "words.hpp"

namespace excavplan::python {
namespace {

using py::arg;

// ---- ground -------------------------------------------------------------------------------------

void take(const char* what, const std::optional<ArrayLike>& from, Eigen::ArrayXXd& to) {
  if (from) to = table_of(what, *from);
}

Terrain made_terrain(const HeightMap& bank, const std::optional<ArrayLike>& loose,
                     const std::optional<ArrayLike>& bank_void_ratio,
                     const std::optional<ArrayLike>& loose_void_ratio,
                     const std::optional<ArrayLike>& obstacles) {
  Terrain terrain = undisturbed(bank);
  take("the loose soil", loose, terrain.loose);
  take("the void ratio of the bank", bank_void_ratio, terrain.bank_void_ratio);
  take("the void ratio of the loose soil", loose_void_ratio, terrain.loose_void_ratio);
  take("the obstacles", obstacles, terrain.obstacles);
  terrain.highest();  // checks the sizes
  return terrain;
}

GroundState made_state(const Terrain& terrain, const std::optional<ArrayLike>& seen,
                       const std::optional<ArrayLike>& deviation, const std::string& frame,
                       const std::string& soil) {
  GroundState state = {terrain, {}, {}, frame, soil};
  take("the times when cells were seen", seen, state.seen);
  take("the deviation of the surface", deviation, state.deviation);
  require_ground_state(state, "state of the ground");
  return state;
}

/// A state is taken for its terrain, which is refused where a dig meets what it does not tell.
void bind_ground_state(py::module_& module, py::class_<GroundState>& state) {
  bind_numbers(state, "Heights of the surface, shape (rows, columns) [m].",
               [](const GroundState& s) { return array(s.terrain.surface().z); });
  state
      .def(py::init(&made_state), arg("terrain"), arg("seen") = py::none(),
           arg("deviation") = py::none(), arg("frame") = "", arg("soil") = "",
           "seen: when each cell was last seen [s since 1970-01-01 UTC], NaN: never; deviation:\n"
           "standard deviation of the surface [m], NaN: not known; frame: name of the site frame;\n"
           "soil: name of the kind that the void ratios are of.")
      .def_readonly("terrain", &GroundState::terrain, "Bank, loose soil, void ratios, obstacles.")
      .def_property_readonly(
          "seen", [](const GroundState& s) { return array(s.seen); },
          "When each cell was last seen, shape (rows, columns) [s since 1970-01-01 UTC], NaN:\n"
          "never; empty: not known.")
      .def_property_readonly(
          "deviation", [](const GroundState& s) { return array(s.deviation); },
          "Standard deviation of the surface, likewise [m]; empty: not known.")
      .def_readonly("frame", &GroundState::frame, "Name of the site frame.")
      .def_readonly("soil", &GroundState::soil, "Name of the kind that void ratios are of.")
      .def("terrain_to_dig", &terrain_to_dig, arg("soil"), arg("density_percent"),
           "The terrain with the void ratios that the state does not tell: those of this density\n"
           "for the bank, the loosest for loose soil.")
      .def(
          "plot",
          [](const GroundState& s, const std::optional<File>& file) {
            return plotted(file, [&](ImageFormat format) {
              return ground_image(s.terrain.surface(), format);
            });
          },
          arg("file") = py::none(), "A Picture; file: also written to, .svg, .png or .pdf.")
      .def("after_dig", &after_dig, arg("after"),
           "The state with the terrain that a dig leaves, on the same grid.");
  py::implicitly_convertible<GroundState, Terrain>();
  module.def(
      "load_ground",
      [](const File& file, const std::optional<SoilKind>& soil) {
        return call([&] { return soil ? load_ground(file.path, *soil) : load_ground(file.path); });
      },
      arg("file"), arg("soil") = py::none(),
      "Reads a file of save_ground(); with a soil also a JSON that names ESRI ASCII grids.");
  module.def(
      "save_ground",
      [](const File& file, const GroundState& known) { save_ground(file.path, known); },
      arg("file"), arg("state"),
      "Writes a state whole or not at all, as a GeoTIFF; every number comes back as it was.");
  module.def(
      "read_ascii_grid",
      [](const File& file) { return call([&] { return read_ascii_grid(file.path); }); },
      arg("file"), "Reads an ESRI ASCII grid; NODATA is NaN.");
}

TerrainPatch made_patch(Eigen::Index row, Eigen::Index col, const ArrayLike& bank,
                        const ArrayLike& loose) {
  return {row,
          col,
          table_of("the bank of a patch", bank),
          table_of("the loose soil of a patch", loose),
          {}};
}

void bind_terrain(py::module_& module) {
  py::class_<GroundState> state(module, "GroundState",
                                "What is known of the ground, carried from dig to dig.");
  py::class_<Terrain> bound(module, "Terrain", "Ground in two layers on one grid.");
  bind_numbers(bound, "Heights of the surface, shape (rows, columns) [m].",
               [](const Terrain& t) { return array(t.surface().z); });
  bound
      .def(py::init(&made_terrain), arg("bank"), arg("loose") = py::none(),
           arg("bank_void_ratio") = py::none(), arg("loose_void_ratio") = py::none(),
           arg("obstacles") = py::none(),
           "bank: top of the undisturbed soil, NaN where unknown; loose: thickness of the loose\n"
           "soil on it, shape (rows, columns) [m], else none; void ratios of both, else those of\n"
           "the simulator's density and of loose soil; obstacles: tops of what is no soil [m].")
      .def(py::init([](const GroundState& known) { return known.terrain; }), arg("state"))
      .def_readonly("bank", &Terrain::bank, "Top of the undisturbed soil.")
      .def_property_readonly(
          "loose", [](const Terrain& t) { return array(t.loose); },
          "Thickness of the loose soil, shape (rows, columns) [m].")
      .def_property_readonly(
          "bank_void_ratio", [](const Terrain& t) { return array(t.bank_void_ratio); },
          "Of the undisturbed soil, shape (rows, columns) [-]; empty: of the simulator's density.")
      .def_property_readonly(
          "loose_void_ratio", [](const Terrain& t) { return array(t.loose_void_ratio); },
          "Of the loose soil, likewise; empty: void_ratio_loose of the soil.")
      .def_property_readonly(
          "obstacles", [](const Terrain& t) { return array(t.obstacles); },
          "Top of what stands on the ground, NaN where nothing does, shape (rows, columns) [m];\n"
          "empty: nothing anywhere.")
      .def(
          "plot",
          [](const Terrain& t, const std::optional<File>& file) {
            return plotted(file,
                           [&](ImageFormat format) { return ground_image(t.surface(), format); });
          },
          arg("file") = py::none(), "A Picture; file: also written to, .svg, .png or .pdf.")
      .def("surface", &Terrain::surface, "bank + loose.");
  py::implicitly_convertible<HeightMap, Terrain>();
  bind_ground_state(module, state);
  py::class_<TerrainPatch>(module, "TerrainPatch", "A block of a terrain's cells in a new state.")
      .def(py::init<>(), "Of no cells.")
      .def(py::init(&made_patch), arg("row"), arg("col"), arg("bank"), arg("loose"),
           "row, col: of its first cell on the whole terrain; bank, loose: as of a Terrain [m].")
      .def_readonly("row", &TerrainPatch::row, "Of its first cell on the whole terrain.")
      .def_readonly("col", &TerrainPatch::col, "Likewise.")
      .def_property_readonly(
          "bank", [](const TerrainPatch& p) { return array(p.bank); },
          "Top of the undisturbed soil, shape (rows, columns) [m].")
      .def_property_readonly(
          "loose", [](const TerrainPatch& p) { return array(p.loose); },
          "Thickness of the loose soil, likewise [m].");
  module.def("planning_extent", &planning_extent, arg("machine"), "Ground that affects a dig.");
  module.def("swing_extent", &swing_extent, arg("machine"),
             "Ground that the front can pass over, swung all round: for plan_motion().");
  module.def("scene_extent", &scene_extent, arg("machine"), arg("dump_at") = default_dump_point(),
             "Ground for the digs of a machine and a heap at (x, y) [m].");
  module.def(
      "level_planning_ground",
      [](const Machine& machine, std::optional<double> cell_size) {
        return level_planning_ground(machine, cell_size.value_or(usual_cell(machine)));
      },
      arg("machine"), arg("cell_size") = py::none(),
      "planning_extent() as level ground; cell_size [m]: else 5 cm for the zx120, in proportion\n"
      "to the bucket for others.");
  module.def("sloped_planning_ground", &sloped_planning_ground, arg("machine"), arg("slope"),
             arg("cell_size") = 0.05,
             "Level up to the tracks, then rising by `slope` [rad]; cell_size in [m].");
}

// ---- one dig ------------------------------------------------------------------------------------

void bind_ledgers(py::module_& module) {
  py::class_<EnergyLedger>(module, "EnergyLedger",
                           "Energy of one dig [J]: positive work of the joints.")
      .def(py::init([](double total, double lift) {
             EnergyLedger energy;
             energy.total = total;
             energy.lift = lift;
             return energy;
           }),
           arg("total") = 0.0, arg("lift") = 0.0)
      .def_readwrite("total", &EnergyLedger::total, "Of the dig, without the lift [J].")
      .def_readwrite("by_phase", &EnergyLedger::by_phase, "Penetrate, drag, scoop [J].")
      .def_readwrite("by_joint", &EnergyLedger::by_joint, "Boom, arm, bucket [J].")
      .def_readwrite("soil", &EnergyLedger::soil, "Part against the resistance of the soil [J].")
      .def_readwrite("edge", &EnergyLedger::edge, "Of `soil`: against lip and teeth [J].")
      .def_readwrite("payload", &EnergyLedger::payload, "Part against the weight carried [J].")
      .def_readwrite("links", &EnergyLedger::links, "Part against the weight of the links [J].")
      .def_readwrite("lift", &EnergyLedger::lift, "Of the lift, not part of the total [J].");
  py::class_<SoilLedger>(module, "SoilLedger", "Where the soil went [m^3].")
      .def(py::init<>())
      .def_readwrite("bank_cut", &SoilLedger::bank_cut, "Undisturbed soil cut [m^3].")
      .def_readwrite("loose_cut", &SoilLedger::loose_cut, "Loose soil cut again [m^3].")
      .def_readwrite("payload", &SoilLedger::payload, "Loose, in the bucket [m^3].")
      .def_readwrite("spilled", &SoilLedger::spilled, "Loose, left on uncut ground [m^3].")
      .def_readwrite("fallen_back", &SoilLedger::fallen_back, "Loose, in the pit [m^3].")
      .def_readwrite("fallback_fraction", &SoilLedger::fallback_fraction,
                     "fallen_back over bank_cut [-].")
      .def_readwrite("solids_before", &SoilLedger::solids_before, "Dry mass [kg].")
      .def_readwrite("solids_after", &SoilLedger::solids_after, "The same with the bucket [kg].");
  py::class_<Stall>(module, "Stall", "The machine could not continue. It is false.")
      .def(py::init([](const std::string& phase, double travelled) {
             Stall stall;
             stall.phase = of_word<DigPhase>("the phase", phase,
                                             {{"penetrate", DigPhase::penetrate},
                                              {"drag", DigPhase::drag},
                                              {"scoop", DigPhase::scoop},
                                              {"lift", DigPhase::lift}});
             stall.travelled = travelled;
             return stall;
           }),
           arg("phase"), arg("travelled"),
           "Of a simulator of your own: the phase in which the dig ended, and how far the tip had\n"
           "come from its start [m].")
      .def_property_readonly(
          "cause", [](const Stall& stall) { return name(stall.cause); },
          "'torque', 'front_lifts', 'rear_lifts' or 'slides'.")
      .def_property_readonly(
          "phase", [](const Stall& stall) { return name(stall.phase); }, "In which the dig ended.")
      .def_property_readonly(
          "joint", [](const Stall& stall) { return name(stall.joint); },
          "That lacked torque; the boom for another cause.")
      .def_readonly("travelled", &Stall::travelled, "By the tip from the start [m].")
      .def_readonly("torque", &Stall::torque, "That the joint needed [N m]; 0 for another cause.")
      .def_readonly("needed", &Stall::needed, "What the dig takes [N m] or [N].")
      .def_readonly("held", &Stall::held, "What the machine holds, likewise.")
      .def("__bool__", [](const Stall&) { return false; });
}

/// The samples of a dig, as columns.
struct History {
  std::vector<ForceSample> samples;
};

void bind_history(py::module_& module) {
  py::class_<History>(module, "History", "Forces in the middle of each step of a dig.")
      .def_property_readonly(
          "phase",
          [](const History& h) {
            return texts(h.samples, [](const ForceSample& s) { return name(s.phase); });
          },
          "Of each step.")
      .def_property_readonly(
          "travelled",
          [](const History& h) {
            return array_of(h.samples, [](const ForceSample& s) { return s.travelled; });
          },
          "By the tip, shape (N,) [m].")
      .def_property_readonly(
          "joints",
          [](const History& h) {
            return array_of_rows(h.samples, [](const ForceSample& s) { return s.joints; });
          },
          "Boom, arm, bucket, shape (N, 3) [rad].")
      .def_property_readonly(
          "soil",
          [](const History& h) {
            return array_of_rows(h.samples, [](const ForceSample& s) { return s.soil; });
          },
          "Force of the soil on the bucket (x, z), shape (N, 2) [N].")
      .def_property_readonly(
          "torque",
          [](const History& h) {
            return array_of_rows(h.samples, [](const ForceSample& s) { return s.torque; });
          },
          "Of boom, arm, bucket, shape (N, 3) [N m].")
      .def_property_readonly(
          "bucket_fill",
          [](const History& h) {
            return array_of(h.samples, [](const ForceSample& s) { return s.bucket_fill; });
          },
          "Loose soil in the bucket, shape (N,) [m^3].")
      .def("__len__", [](const History& h) { return h.samples.size(); });
}

void bind_dig(py::module_& module) {
  py::class_<DigOptions>(module, "DigOptions", "Settings of SoilSimulator.dig().")
      .def(py::init([](bool history, std::optional<Eigen::Vector2d> dump_at) {
             DigOptions options;
             options.history = history;
             options.dump_at = dump_at;
             return options;
           }),
           py::kw_only(), arg("history") = false, arg("dump_at") = py::none())
      .def_readonly("history", &DigOptions::history, "Record the forces.")
      .def_readonly("dump_at", &DigOptions::dump_at,
                    "Heap the payload at (x, y) [m]; None: keep it.")
      .def_readonly("settle", &DigOptions::settle, "Let the ground come to rest.")
      .def_readonly("give_up_below", &DigOptions::give_up_below,
                    "A simulator may end a dig that cannot reach this efficiency [kg/J].");
  py::class_<DigResult>(module, "DigResult", "What a dig lifts, costs and leaves behind.")
      .def(py::init([](double mass, double volume, const EnergyLedger& energy,
                       const std::optional<Stall>& stall) {
             DigResult result;
             result.payload_mass = mass;
             result.payload_volume = volume;
             result.energy = energy;
             result.stall = stall;
             return result;
           }),
           py::kw_only(), arg("payload_mass") = 0.0, arg("payload_volume") = 0.0,
           py::arg_v("energy", EnergyLedger{}, "EnergyLedger()"), arg("stall") = py::none())
      .def_readwrite("patch", &DigResult::patch, "All cells that changed, afterwards.")
      .def_readwrite("payload_mass", &DigResult::payload_mass, "Moist [kg].")
      .def_readwrite("payload_volume", &DigResult::payload_volume, "Loose [m^3].")
      .def_readwrite("energy", &DigResult::energy, "[J]")
      .def_readwrite("soil", &DigResult::soil, "[m^3]")
      .def_readwrite("peak_force", &DigResult::peak_force, "Of the soil on the bucket [N].")
      .def_property_readonly(
          "stall", [](const DigResult& r) { return r.stall; },
          "None: the machine finished the path.")
      .def_readonly("given_up", &DigResult::given_up, "Ended early: DigOptions.give_up_below.")
      .def_property_readonly(
          "history", [](const DigResult& r) { return History{r.history}; },
          "Forces of each step; empty unless requested.")
      .def_readwrite("torques", &DigResult::torques,
                     "Of the joints, half-way from each pose of the path to the next [N m].")
      .def("after", &DigResult::after, arg("before"), "The whole terrain afterwards.")
      .def_property_readonly("efficiency", &DigResult::efficiency,
                             "The paper's f, payload mass / energy [kg/J].");
}

void bind_simulators(py::module_& module) {
  py::class_<SoilSimulator, SimulatorInPython>(
      module, "SoilSimulator",
      "A simulation of one dig. A simulator of your own is a subclass that defines\n"
      "dig(self, terrain, path, options) -> DigResult and, where it is given as a class,\n"
      "__init__(self, machine, soil, density_percent). It returns the same for the same\n"
      "arguments, conserves solids and leaves unknown cells unknown.")
      .def(py::init<>())
      .def(
          "dig",
          [](const SoilSimulator& simulator, const Terrain& terrain, const DigPath& path,
             const std::optional<DigOptions>& options) {
            if (is_in_python(simulator)) refuse_missing_dig();  // called as super().dig()
            return call(
                [&] { return simulator.dig(terrain, path, options.value_or(DigOptions{})); });
          },
          arg("terrain"), arg("path"), arg("options") = py::none(), "Digs along the path.")
      .def(
          "identity",
          [](const SoilSimulator& simulator) {
            return is_in_python(simulator) ? std::string() : simulator.identity();
          },
          "All that determines a dig besides its arguments, as text.");
  py::class_<HeightMapSimulator, SoilSimulator>(
      module, "HeightMapSimulator", py::is_final(),
      "The built-in simulator. A simulator of your own that changes its digs has one as a member.")
      .def(py::init<const Machine&, const SoilKind&, double>(), arg("machine"), arg("soil"),
           arg("density_percent"))
      .def_property_readonly("bank", &HeightMapSimulator::bank, "Of the undisturbed soil.")
      .def_property_readonly("loose", &HeightMapSimulator::loose, "Of dug soil.");
  module.def(
      "simulators",
      [] { return texts(simulator_kinds(), [](const SimulatorKind& k) { return k.word; }); },
      "Words of the built-in simulators; the first is the default.");
}

// ---- scenes -------------------------------------------------------------------------------------

/// DigScene of Python.
struct SceneInPython : DigScene {
  std::shared_ptr<const Machine> machine;
};

SceneInPython simulated(const Machine& machine, const SoilKind& soil, double density,
                        const std::optional<Terrain>& terrain,
                        const std::optional<DigParameters>& path, std::optional<double> start_x,
                        const Eigen::Vector2d& dump_at, const py::object& simulator,
                        double cell_size, bool planned) {
  const auto own = std::make_shared<Call>();
  SceneOptions options;
  options.path = path.value_or(options.path);
  options.start_x = start_x;
  options.dump_at = dump_at;
  options.history = true;
  options.simulator = simulator_kind(simulator, own);
  if (planned) options.rules = rules_for_planned_path();
  DigScene scene = own->run([&] {
    if (terrain) return run_scene(machine, soil, density, *terrain, options);
    require_simulated_cell(cell_size);
    const Terrain level = undisturbed(flat_ground(scene_extent(machine, dump_at), cell_size));
    return run_scene(machine, soil, density, level, options);
  });
  return {std::move(scene), std::make_shared<const Machine>(machine)};
}

std::pair<Array, Array> scans_of(const SceneInPython& scene, std::uint64_t seed,
                                 const std::optional<std::string>& sensor, int frames) {
  DepthCamera camera;
  if (sensor) camera = with_errors_of(sensor_of_word(*sensor), camera);
  camera.frames = frames;
  const SceneScans scans = call([&] { return scan_scene(scene, camera, seed); });
  const auto rows = [](const std::vector<Eigen::Vector3d>& points) {
    return array_of_rows(points, [](const Eigen::Vector3d& point) { return point; });
  };
  return {rows(scans.before), rows(scans.after)};
}

void bind_scene(py::module_& module) {
  py::class_<HeightMapVolumes>(module, "HeightMapVolumes",
                               "Volumes of a dig, cell by cell of its height maps [m^3].")
      .def_readonly("excavated", &HeightMapVolumes::excavated, "Ground that fell [m^3].")
      .def_readonly("spilled", &HeightMapVolumes::spilled, "That rose away from the heap [m^3].")
      .def_readonly("dumped", &HeightMapVolumes::dumped, "That rose at the heap [m^3].")
      .def_readonly("bulking_factor", &HeightMapVolumes::bulking_factor,
                    "(spilled + dumped) / excavated [-].");
  py::class_<SceneInPython>(module, "DigScene", "One dig with the ground before and after it.")
      .def_readonly("soil", &DigScene::soil, "Its name.")
      .def_readonly("density_percent", &DigScene::density_percent, "[%]")
      .def_readonly("path", &DigScene::path, "That was dug.")
      .def_readonly("before", &DigScene::before, "The ground before.")
      .def_readonly("after", &DigScene::after, "The ground with the heap.")
      .def_readonly("dig", &DigScene::dig, "With a stall, if there was one.")
      .def_readonly("volumes", &DigScene::volumes, "Of the two grounds.")
      .def_readonly("bulking_factor_true", &DigScene::bulking_factor_true,
                    "By the balance of dry mass [-].")
      .def_readonly("duration", &DigScene::duration, "Of penetrate, drag and scoop [s].")
      .def_readonly("warnings", &DigScene::warnings)
      .def(
          "to_json",
          [](const SceneInPython& scene, const std::optional<Machine>& machine) {
            return to_json(machine.value_or(*scene.machine), scene);
          },
          arg("machine") = py::none(),
          "The text that simulate-dig prints with --json, but for its options; machine: else\n"
          "that dug.")
      .def(
          "plot",
          [](const SceneInPython& scene, const std::string& what, const std::optional<File>& file) {
            const DigImage image = dig_image_of(what);
            return plotted(file, [&](ImageFormat format) {
              return dig_image(*scene.machine, scene, image, format);
            });
          },
          arg("what") = "section", arg("file") = py::none(),
          "A Picture.\n\n"
          "what: 'section', 'forces', 'torques', 'power' or 'cylinders'; file: also written to,\n"
          ".svg, .png or .pdf.")
      .def(
          "report",
          [](const SceneInPython& scene, const File& file) {
            write_bytes(file, call([&] { return report_page(*scene.machine, scene); }));
          },
          arg("file"), "Writes the page of simulate-dig --report.");
  module.def(
      "simulate_dig", &simulated, arg("machine"), arg("soil"), arg("density_percent"),
      arg("terrain") = py::none(), py::kw_only(), arg("path") = py::none(),
      arg("start_x") = py::none(), arg("dump_at") = default_dump_point(),
      arg("simulator") = py::none(), arg("cell_size") = 0.05, arg("planned") = false,
      "Digs once and dumps the payload, as simulate-dig does.\n\n"
      "terrain: must hold path and heap, else level on cells of cell_size [m]; path:\n"
      "DigParameters, else paper_fixed_path(); start_x: where the tip meets the ground [m];\n"
      "dump_at: centre of the heap (x, y) [m]; simulator: word or class; planned: path and\n"
      "start are those of a plan.");
  module.def(
      "scan_scene", &scans_of, arg("scene"), arg("seed") = 1, arg("sensor") = py::none(),
      arg("frames") = 1,
      "Points of simulated depth cameras before and after the dig, two arrays of shape\n"
      "(N, 3) in the site frame [m]; sensor: 'd435i', whose errors they have, else white noise\n"
      "and dropouts; frames: averaged.");
}

DensityCalibration calibrated(const Machine& machine, const SoilKind& soil,
                              const std::vector<double>& densities,
                              const std::optional<DigParameters>& path, int draws,
                              std::optional<double> cell_size, const py::object& simulator,
                              unsigned threads) {
  const auto own = std::make_shared<Call>();
  CalibrationOptions options;
  options.densities_percent = densities;
  options.path = path;
  options.draws = draws;
  options.cell_size = cell_size;
  options.simulator = simulator_kind(simulator, own);
  options.threads = threads_with(simulator, threads);
  return own->run([&] { return calibrate_density(machine, soil, options); });
}

}  // namespace

void bind_simulation(py::module_& module) {
  bind_terrain(module);
  bind_ledgers(module);
  bind_history(module);
  bind_dig(module);
  bind_simulators(module);
  bind_scene(module);
  module.def("calibrate_density", &calibrated, arg("machine"), arg("soil"), py::kw_only(),
             arg("densities_percent") = std::vector<double>{}, arg("path") = py::none(),
             arg("draws") = CalibrationOptions{}.draws, arg("cell_size") = py::none(),
             arg("simulator") = py::none(), arg("threads") = 0,
             "A density law from simulated digs, as calibrate-density makes it.\n\n"
             "densities_percent: of the digs, else 0, 5 .. 100; path: that the law is for, else\n"
             "the paper's with the scatter of digs along others; draws: digs in drawn soils;\n"
             "cell_size [m]: else as the machine needs it; threads: 0 is one per core.");
}

}  // namespace excavplan::python
