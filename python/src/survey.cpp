// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/data_files.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/clouds/cloud.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/paper/paper_change.hpp>
#include <excavplan/report/report_pages.hpp>
#include <excavplan/results/result_json.hpp>
#include <excavplan/scans/scan_pose.hpp>
#include <excavplan/scans/scan_terrain.hpp>

#include "arrays.hpp"
#include "calls.hpp"
#include "paths.hpp"
#include "pictures.hpp"
#include "rooms.hpp"
#include "scans.hpp"
#include "texts.hpp"
#include "words.hpp"

namespace excavplan::python {
namespace {

using py::arg;

// ---- clouds and scans ---------------------------------------------------------------------------

Cloud made_cloud(const ArrayLike& points, const std::optional<Eigen::Vector3d>& sensor_origin) {
  Cloud cloud;
  cloud.points = points_of("the points of a cloud", points);
  cloud.width = cloud.points.size();
  cloud.sensor_origin = sensor_origin;
  return cloud;
}

/// Whether it is a sequence of files or clouds, not of numbers.
bool is_several(const py::object& source) {
  if (PySequence_Check(source.ptr()) == 0 || PyObject_CheckBuffer(source.ptr()) != 0 ||
      is_file(source) || py::len(source) == 0) {
    return false;
  }
  const py::object first = source[py::int_(0)];
  return is_file(first) || py::isinstance<Cloud>(first);
}

void add_source(const py::object& source, Scan& scan) {
  if (is_file(source)) {
    scan.files.push_back(file_of(source).path);
  } else if (py::isinstance<Cloud>(source)) {
    scan.clouds.push_back(std::make_shared<Cloud>(source.cast<Cloud>()));
  } else {
    scan.clouds.push_back(std::make_shared<Cloud>(made_cloud(ArrayLike(source), std::nullopt)));
  }
}

Scan made_scan(const py::object& source, const std::optional<ArrayLike>& site_from_scan,
               const std::optional<Rectangle>& area, double unit,
               const std::optional<Eigen::Vector3d>& sensor_origin, bool z_is_up,
               const std::string& name) {
  Scan scan;
  if (is_several(source)) {
    for (const py::handle each : source) add_source(py::reinterpret_borrow<py::object>(each), scan);
  } else {
    add_source(source, scan);
  }
  if (site_from_scan) scan.site_from_scan = transform_of("site_from_scan", *site_from_scan);
  scan.area = area;
  scan.unit = unit;
  scan.sensor_origin = sensor_origin;
  scan.z_is_up = z_is_up;
  scan.name = name;
  return scan;
}

}  // namespace

Scan scan_of(const py::object& source, const char* name) {
  if (py::isinstance<Scan>(source)) return source.cast<Scan>();
  const bool named = is_file(source);
  return made_scan(source, std::nullopt, std::nullopt, 1.0, std::nullopt, false, named ? "" : name);
}

namespace {

Array points_in(const Cloud& cloud) {
  return array_of_rows(cloud.points, [](const Eigen::Vector3d& point) { return point; });
}

void bind_clouds(py::module_& module) {
  py::class_<Cloud> bound(module, "Cloud", "Points of a scan [m].");
  bind_numbers(bound, "The points, shape (N, 3) [m].", &points_in);
  bound
      .def(py::init(&made_cloud), arg("points"), arg("sensor_origin") = py::none(),
           "points: shape (N, 3) [m], copied; sensor_origin: where the sensor stood, in the frame\n"
           "of the points [m].")
      .def_property_readonly("points", &points_in,
                             "In the order of the file, shape (N, 3) [m]; not all need be finite.")
      .def_readonly("width", &Cloud::width, "Of an organised cloud, else the number of points.")
      .def_readonly("height", &Cloud::height, "1 unless organised.")
      .def_readonly("sensor_origin", &Cloud::sensor_origin, "Where the sensor stood [m], if known.")
      .def_readonly("left_out", &Cloud::left_out, "Further points of its file that do not count.")
      .def(
          "transformed",
          [](Cloud cloud, const ArrayLike& site_from_scan) {
            transform(cloud, transform_of("site_from_scan", site_from_scan));
            return cloud;
          },
          arg("site_from_scan"), "The cloud moved by a matrix of shape (4, 4).")
      .def("__len__", [](const Cloud& cloud) { return cloud.points.size(); });
  py::class_<CloudSummary>(module, "CloudSummary", "What is in a cloud.")
      .def_readonly("points", &CloudSummary::points)
      .def_readonly("finite_points", &CloudSummary::finite_points)
      .def_readonly("centroid", &CloudSummary::centroid, "Of the finite points [m].")
      .def_readonly("min", &CloudSummary::min, "[m]")
      .def_readonly("max", &CloudSummary::max, "[m]")
      .def_readonly("extent", &CloudSummary::extent, "In plan; None without finite points.")
      .def_readonly("density", &CloudSummary::density, "Points per m^2 of occupied ground.")
      .def_readonly("frame_guess", &CloudSummary::frame_guess)
      .def(
          "to_json", [](const CloudSummary& summary) { return to_json(summary); },
          "The text that inspect-cloud prints with --json, but for its options.");
  module.def(
      "read_cloud", [](const File& file) { return call([&] { return read_cloud(file.path); }); },
      arg("file"),
      "Reads PCD, PLY, LAS, GeoTIFF, ESRI ASCII grids, OBJ or XYZ, told by the content.");
  module.def(
      "write_cloud",
      [](const File& file, const Cloud& cloud) {
        write_cloud(file.path, cloud, cloud_format_of_name(file.path));
      },
      arg("file"), arg("cloud"), "Writes .pcd or .ply (binary), .xyz, .txt or .asc.");
  module.def(
      "read_frame", [](const File& file) { return array(read_frame(file.path)); }, arg("file"),
      "What transforms a scan into the site frame, shape (4, 4).");
  module.def(
      "summarise", [](const Cloud& cloud) { return summarise(cloud); }, arg("cloud"),
      "Number, extent and frame of the points.");
  module.def(
      "rasterise",
      [](const Cloud& cloud, const std::optional<Rectangle>& extent, double cell_size,
         double outlier_distance) {
        RasterOptions options;
        options.cell_size = cell_size;
        options.outlier_distance = outlier_distance;
        return call(
            [&] { return rasterise(cloud, extent ? *extent : plan_extent(cloud), options); });
      },
      arg("cloud"), arg("extent") = py::none(), py::kw_only(),
      arg("cell_size") = RasterOptions{}.cell_size,
      arg("outlier_distance") = RasterOptions{}.outlier_distance,
      "A height map of the points that are no outliers; extent: else that of the cloud.");
}

void bind_scans(py::module_& module) {
  py::class_<Scan>(module, "Scan", "What was seen at one time of one piece of ground.")
      .def(
          py::init(&made_scan), arg("source"), py::kw_only(), arg("site_from_scan") = py::none(),
          arg("area") = py::none(), arg("unit") = 1.0, arg("sensor_origin") = py::none(),
          arg("z_is_up") = false, arg("name") = "",
          "source: a file, a Cloud, points of shape (N, 3), or a sequence of files or clouds;\n"
          "site_from_scan: a rigid motion, shape (4, 4), in metres; area: points outside of it\n"
          "are left out; unit: length of a unit of the coordinates [m]; sensor_origin: in frame\n"
          "and unit of the source; z_is_up: no frame of a camera is suspected; name: for messages.")
      .def_property_readonly("files",
                             [](const Scan& scan) {
                               std::vector<File> files;
                               for (const std::string& path : scan.files) files.push_back({path});
                               return files;
                             })
      .def_readonly("name", &Scan::name)
      .def_property_readonly(
          "site_from_scan", [](const Scan& scan) { return array(scan.site_from_scan); },
          "Shape (4, 4).");
  module.def(
      "level_on_ground",
      [](const Cloud& cloud) {
        return array(call([&] { return level_on_ground(cloud); }).site_from_scan);
      },
      arg("cloud"),
      "Levels a scan in the frame of its sensor by the ground plane: site_from_scan, shape\n"
      "(4, 4), with the origin on the ground below the sensor.");
  py::class_<ScannedTerrain>(module, "ScannedTerrain", "Ground to dig on as a scan shows it.")
      .def_readonly("terrain", &ScannedTerrain::terrain, "Unknown where the scan does not see.")
      .def_readonly("warnings", &ScannedTerrain::warnings);
  module.def(
      "terrain_from_scan",
      [](const py::object& scan, const Rectangle& extent, double cell_size) {
        const Scan source = scan_of(scan, "the scan");
        return call([&] { return terrain_from_scan(source, extent, cell_size); });
      },
      arg("scan"), arg("extent"), arg("cell_size") = 0.05,
      "The ground of `extent` (planning_extent()) on cells of cell_size [m], in the site\n"
      "frame; scan: a Scan, or what one is made from.");
  module.def(
      "swing_terrain_from_scan",
      [](const py::object& scan, const Machine& machine) {
        const Scan source = scan_of(scan, "the scan");
        return call([&] { return swing_terrain_from_scan(source, machine); });
      },
      arg("scan"), arg("machine"),
      "The ground of swing_extent(), which plan_motion() keeps clear of: known between points\n"
      "at most 0.25 m apart, and not between points more than 0.5 m apart; with obstacles.");
  module.def(
      "standing_ground_from_scan",
      [](const py::object& scan, const Machine& machine) {
        const Scan source = scan_of(scan, "the scan");
        return call([&] { return standing_ground_from_scan(source, machine); });
      },
      arg("scan"), arg("machine"),
      "The ground that the machine stands on, to 6 m about its tracks, for plan_dig().");
  module.def("with_surroundings", &with_surroundings, arg("present"), arg("earlier"),
             "The present ground, and where it is unknown an earlier one, both of\n"
             "swing_terrain_from_scan(). Warning surroundings_differ if one is in a wrong frame.");
}

// ---- estimate -----------------------------------------------------------------------------------

void bind_parts(py::module_& module) {
  py::class_<Fallback>(module, "Fallback", "Soil that fell back into a cut whose path is known.")
      .def_readonly("cut", &Fallback::cut, "Ground before that the bucket swept [m^3].")
      .def_readonly("in_pit", &Fallback::in_pit, "Soil on the swept floor afterwards [m^3].")
      .def_readonly("fraction", &Fallback::fraction, "in_pit over cut [-].")
      .def_readonly("seen_share", &Fallback::seen_share, "Of the swept ground, in both maps [-].");
  py::class_<BlockReport>(module, "BlockReport", "Evidence of blocks of hard soil.")
      .def_readonly("score", &BlockReport::score, "0: loose soil, 1: blocks.")
      .def_readonly("blocks", &BlockReport::blocks, "The density cannot be trusted.")
      .def_readonly("block_size", &BlockReport::block_size, "Mean edge [m], if it shows.")
      .def_readonly("voids", &BlockReport::voids, "Between the blocks [m^3].")
      .def_readonly("reasons", &BlockReport::reasons);
  py::class_<PayloadDensity>(module, "PayloadDensity", "The density by the mass of the payload.")
      .def_readonly("mass", &PayloadDensity::mass, "Moist, of one dump [kg].")
      .def_readonly("dug_mass", &PayloadDensity::dug_mass, "With the spill [kg].")
      .def_readonly("bulk_density", &PayloadDensity::bulk_density, "Moist, in place [kg/m^3].")
      .def_readonly("density_percent", &PayloadDensity::density_percent, "[%]")
      .def_readonly("law_density_percent", &PayloadDensity::law_density_percent, "By the law [%].")
      .def_readonly("disagreement", &PayloadDensity::disagreement, "In standard deviations.");
  py::class_<SoilAnswer>(module, "SoilAnswer", "The density if the soil is of one kind.")
      .def_readonly("name", &SoilAnswer::name, "Of the kind.")
      .def_readonly("weight", &SoilAnswer::weight, "Its probability.")
      .def_readonly("density", &SoilAnswer::density, "In this soil.")
      .def_readonly("payload", &SoilAnswer::payload, "If the payload was weighed.");
  py::class_<PriorDensity>(module, "PriorDensity", "The density that earlier digs gave.")
      .def(py::init(&prior_of), arg("density"), arg("drift_sd_percent") = usual_drift_percent,
           "Of an earlier result; drift_sd_percent: of the ground from that dig to this [points].")
      .def_readonly("raw_percent", &PriorDensity::raw_percent, "[%]")
      .def_readonly("independent_sd_percent", &PriorDensity::independent_sd_percent, "[points]")
      .def_readonly("shared_sd_percent", &PriorDensity::shared_sd_percent, "Of the law [points].")
      .def_readonly("drift_sd_percent", &PriorDensity::drift_sd_percent, "[points]");
  py::class_<SuccessiveDensity>(module, "SuccessiveDensity",
                                "The density of this dig and of those before it.")
      .def_readonly("prior", &SuccessiveDensity::prior, "That was combined.")
      .def_readonly("this_dig", &SuccessiveDensity::this_dig, "Without it.")
      .def_readonly("density", &SuccessiveDensity::density, "Of both.")
      .def_readonly("weight", &SuccessiveDensity::weight, "Of the prior in it [-].")
      .def_readonly("disagreement", &SuccessiveDensity::disagreement, "In standard deviations.");
}

Picture plot_of_estimate(const DensityEstimate& estimate, const std::string& what,
                         const std::optional<File>& file) {
  const bool is_change = of_word<bool>("the plot", what, {{"change", true}, {"density", false}});
  return plotted(file, [&](ImageFormat format) {
    return is_change ? change_image(estimate, format) : density_image(estimate, format);
  });
}

void bind_estimate(py::module_& module) {
  using E = DensityEstimate;
  py::class_<E>(module, "DensityEstimate",
                "Volumes, bulking factor and density by the scans of one dig. Without dumped soil\n"
                "in the scans, volumes and a warning alone.")
      .def_readonly("change", &E::change, "Volumes, zones and height change.")
      .def_readonly("before", &E::before, "The ground before, of each area of the change.")
      .def_readonly("bulking", &E::bulking, "k as the scans give it [-].")
      .def_readonly("fallback", &E::fallback, "If the path that was dug is known.")
      .def_readonly("blocks", &E::blocks, "Voids between blocks of hard soil.")
      .def_readonly("corrected", &E::corrected, "k corrected for fallback and voids, if any [-].")
      .def_readonly("density", &E::density, "Relative density with its error.")
      .def_readonly("soils", &E::soils, "In each soil that it may be.")
      .def_readonly("any_soil", &E::any_soil, "In any of them.")
      .def_readonly("payload", &E::payload, "If the payload was weighed.")
      .def_readonly("successive", &E::successive, "If earlier digs gave a density to trust.")
      .def_readonly("density_without_fallback", &E::density_without_fallback, "[%]")
      .def_readonly("law", &E::law, "That was used.")
      .def_readonly("trustworthy", &E::trustworthy, "False: see the warnings.")
      .def_readonly("warnings", &E::warnings, "Of volumes, density and blocks.")
      .def_readonly("cell_size", &E::cell_size, "Of the height maps [m].")
      .def_property_readonly(
          "correction",
          [](const E& estimate) -> std::optional<Array> {
            if (!estimate.registration) return std::nullopt;
            return array(estimate.registration->correction);
          },
          "Takes points of the scan after to the frame of that before, shape (4, 4); None if they\n"
          "were not registered.")
      .def("ground_density", &E::ground_density,
           "The density for plan_dig(); None if there is none.")
      .def(
          "to_json", [](const E& estimate) { return to_json(estimate); },
          "The text that estimate-density prints with --json, but for its options.")
      .def("plot", &plot_of_estimate, arg("what") = "change", arg("file") = py::none(),
           "A Picture.\n\n"
           "what: 'change' of the ground, or 'density' with the law; file: also written to, .svg,\n"
           ".png or .pdf.")
      .def(
          "report",
          [](const E& estimate, const File& file) {
            write_bytes(file, call([&] { return report_page(estimate); }));
          },
          arg("file"), "Writes the page of estimate-density --report.");
}

/// A kind, its name or file, "unknown" or nothing.
using Soil = std::optional<std::variant<SoilKind, File>>;

/// Sets what is known of the soil. @return the law to use, by the rules of estimate-density
DensityLaw law_for(const Soil& soil, const std::optional<DensityLaw>& given, const Machine& machine,
                   SoilKnowledge& known) {
  const File* const named = soil ? std::get_if<File>(&*soil) : nullptr;
  known.possible = shipped_soil_laws();
  known.unknown = named != nullptr && named->path == "unknown";
  if (known.unknown && given) {
    throw Error(ErrorKind::bad_input, "soil 'unknown' takes the laws of all shipped soils, no law");
  }
  if (named != nullptr && !known.unknown) {
    known.kind = load_soil(shipped_or_file("soils", named->path));
  } else if (soil && named == nullptr) {
    known.kind = std::get<SoilKind>(*soil);
  }
  if (given) {
    if (known.kind && !given->soil.empty() && given->soil != known.kind->name) {
      throw Error(ErrorKind::bad_input,
                  "the law is for " + given->soil + ", the soil is " + known.kind->name);
    }
    for (const SoilLaw& each : known.possible) {
      if (!known.kind && each.soil.name == given->soil) known.kind = each.soil;
    }
    return *given;
  }
  known.assumed = !soil;
  if (!known.kind) known.kind = load_soil(find_data_file("soils/loam.json"));
  return call([&] { return usual_law(machine, *known.kind, known.possible); });
}

DensityEstimate estimated(const py::object& before, const py::object& after, const Soil& soil,
                          const std::optional<DensityLaw>& law,
                          const std::optional<std::pair<py::object, py::object>>& dump,
                          const std::string& method, const std::optional<double>& cell_size,
                          bool registered, const std::optional<Rectangle>& dig_area,
                          const std::optional<Rectangle>& dump_area,
                          const std::optional<Machine>& machine,
                          const std::optional<DigParameters>& dug_path,
                          const std::optional<double>& dug_start,
                          const std::optional<Measured>& payload_mass,
                          const std::optional<Measured>& water_content,
                          const std::optional<PriorDensity>& prior, unsigned threads) {
  DigScans scans{scan_of(before, "the scan before"), scan_of(after, "the scan after"), {}};
  if (dump) {
    scans.dump = ScanPair{scan_of(dump->first, "the scan of the dump area before"),
                          scan_of(dump->second, "the scan of the dump area after")};
  }
  const Machine digger = machine ? *machine : load_machine(find_data_file("machines/zx120.json"));
  DensityOptions options;
  options.method = of_word<VolumeMethod>(
      "the method", method, {{"surface", VolumeMethod::surface}, {"paper", VolumeMethod::paper}});
#ifdef EXCAVPLAN_PAPER
  options.paper = paper_change();
#endif
  options.cell_size = cell_size;
  options.registered = registered;
  options.change.dig_area = dig_area;
  options.change.dump_area = dump_area;
  if (dug_start && !dug_path) throw Error(ErrorKind::bad_input, "dug_start needs dug_path");
  if (dug_path) options.dug_path = DugPath{digger, *dug_path, dug_start};
  options.payload_mass = payload_mass;
  options.soil.water_content = water_content;
  options.prior = prior;
  options.threads = threads;
  const DensityLaw used = law_for(soil, law, digger, options.soil);
  return call([&] { return estimate_density(scans, used, options); });
}

}  // namespace

void bind_survey(py::module_& module) {
  bind_clouds(module);
  bind_scans(module);
  bind_parts(module);
  bind_estimate(module);
  module.def(
      "estimate_density", &estimated, arg("before"), arg("after"), py::kw_only(),
      arg("soil") = py::none(), arg("law") = py::none(), arg("dump") = py::none(),
      arg("method") = "surface", arg("cell_size") = py::none(), arg("registered") = true,
      arg("dig_area") = py::none(), arg("dump_area") = py::none(), arg("machine") = py::none(),
      arg("dug_path") = py::none(), arg("dug_start") = py::none(), arg("payload_mass") = py::none(),
      arg("water_content") = py::none(), arg("prior") = py::none(), arg("threads") = 0,
      "The relative density of the ground before a dig, as estimate-density finds it.\n\n"
      "before, after: each a Scan, a file, a Cloud or points of shape (N, 3) [m]; soil: SoilKind,\n"
      "name, file or 'unknown', else loam is assumed with a warning; law: DensityLaw, else that "
      "of\n"
      "the soil; dump: (before, after) of the dump area, before and after are then of the dig "
      "area\n"
      "alone; method: 'surface' or 'paper'; cell_size: of the height map [m], else by the points;\n"
      "registered: false if the sensor did not move; dig_area, dump_area: Rectangle; machine: "
      "that\n"
      "dug, else zx120; dug_path, dug_start: DigParameters and x of the start [m], which correct\n"
      "for soil that fell back; payload_mass: Measured, moist [kg]; water_content: Measured [-];\n"
      "prior: PriorDensity; threads: 0 is one per core.");
}

}  // namespace excavplan::python
