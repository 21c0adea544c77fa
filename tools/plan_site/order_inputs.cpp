// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/order_inputs.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <excavplan/base/data_files.hpp>
#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/design/design_file.hpp>
#include <excavplan/kit/kit_files.hpp>
#include <excavplan/simulation/dig_ground.hpp>
#include <excavplan/trial/hidden_site.hpp>

#include "base/text.hpp"
#include "inputs/named_kinds.hpp"
#include "inputs/site_folder.hpp"
#include "inputs/unit_inputs.hpp"
#include "scans/scan_checks.hpp"
#include "scans/scan_reading.hpp"

namespace excavplan::tools {
namespace {

constexpr double before_design = 1.5;  // of the tracks, where no base is told; ours [m]

/// An error of a value then names its option.
template <typename Work>
auto of_option(const std::string& option, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.kind(), option + ": " + error.what());
  }
}

void name_kinds(const OrderInputs& inputs, SiteSettings& site) {
  site.machine = of_option("--machine", [&] { return machine_named(inputs.machine); });
  site.soil = of_option("--soil", [&] { return soil_named(inputs.soil); });
}

bool is_raster(const std::string& file) {
  const std::string ending = small_letters(std::filesystem::path(file).extension().string());
  return ending == ".asc" || ending == ".tif" || ending == ".tiff";
}

/// The ground as a scan shows it.
Surface surface_of(const Scan& scan, const Machine& machine) {
  const ScanOutline seen = outline(scan);
  if (!seen.extent) {
    throw Error(ErrorKind::bad_file, "--scan: " + name_of(scan) + " holds no finite point");
  }
  if (const auto doubt = check_outline(seen, scan)) {
    throw Error(ErrorKind::bad_file, "--scan: " + doubt->message);
  }
  RasterOptions options;
  options.cell_size = std::max(usual_cell(machine), survey_cell({seen}));
  return of_option("--scan", [&] { return survey_surface(scan, *seen.extent, options); });
}

/// All of a trench but its place.
DesignWords size_of(const OrderInputs& inputs) {
  DesignWords words = of_option("--trench", [&] { return trench_of_size(*inputs.trench); });
  words.grade = inputs.grade;
  words.batter = inputs.batter;
  return words;
}

DesignWords words_of(const OrderInputs& inputs) {
  DesignWords words = size_of(inputs);
  if (!inputs.from) usage_error("--from is missing: where the trench begins");
  if (!inputs.heading) usage_error("--heading is missing: where the trench goes from there");
  words.from = parse_point("--from", *inputs.from);
  words.heading = *inputs.heading;
  return words;
}

/// Where the machine stands when the job begins: as told, or before the trench.
BasePose start_of(const OrderInputs& inputs, const Machine& machine) {
  if (inputs.base) return parse_base(*inputs.base);
  if (inputs.design) {
    usage_error(
        "--base is missing: where the machine stands, and in which heading it works, from the far "
        "end of the design backwards");
  }
  const DesignWords words = words_of(inputs);
  const double away = machine.track_front + before_design;
  return {words.from.x() - away * std::cos(words.heading),
          words.from.y() - away * std::sin(words.heading), 0.0, words.heading};
}

DesignSurface design_of(const OrderInputs& inputs, const Surface& ground) {
  DesignSurface design;
  if (inputs.trench) {
    design = design_of_words(words_of(inputs), ground.height);
  } else if (inputs.design) {
    DesignFileOptions options;
    options.surface = inputs.surface.value_or("");
    design = read_design(*inputs.design, options);
  } else {
    usage_error("the design is missing: give --trench, --design or --site");
  }
  (void)cut_and_fill(design, ground);  // tells a design that does not lie on the scan
  return design;
}

JobDesign job_of(const OrderInputs& inputs, const Machine& machine) {
  JobDesign job;
  job.tolerance = inputs.tolerance;
  job.start = start_of(inputs, machine);
  for (const auto& [texts, kind] : {std::pair(&inputs.windrows, DumpArea::Kind::windrow),
                                    std::pair(&inputs.heaps, DumpArea::Kind::heap)}) {
    const char* const option = kind == DumpArea::Kind::heap ? "--heap" : "--windrow";
    for (const std::string& text : *texts) {
      job.dump_areas.push_back({kind, of_option(option, [&] { return polygon_of_text(text); })});
    }
  }
  for (const std::string& text : inputs.keep_out) {
    job.keep_out.push_back(of_option("--keep-out", [&] { return keep_out_of_text(text); }));
  }
  if (inputs.truck) {
    job.truck = of_option("--truck", [&] { return truck_of_text(*inputs.truck); });
  }
  if (job.dump_areas.empty() && !job.truck) {
    usage_error("soil has no place to go: give --windrow, --heap or --truck");
  }
  return job;
}

Order finished(Order order, const std::string& machine_word) {
  SiteSettings& site = order.settings.site;
  order.files.machine = machine_path(machine_word);
  order.files.law = law_path(machine_word, site.machine, site.soil.name);
  site.law = law_in(order.files.law, site.soil);
  return order;
}

Order order_of_site(const OrderInputs& inputs, const SiteScanInputs& scan) {
  const SiteBrief brief = read_site_brief(*inputs.site);
  Order order;
  order.settings = settings_of(brief, machine_named(brief.machine), {});  // finished() sets the law
  order.settings.density_percent = inputs.density.value_or(brief.density.percent);
  order.first.scan = first_scan(brief.job);
  order.first.time = time_of(scan.time, {});
  return finished(std::move(order), brief.machine);
}

}  // namespace

void declare_scan(Arguments& arguments, SiteScanInputs& inputs) {
  arguments.text("scan", "FILE", inputs.scan,
                 std::string("scan of the ground in the site's frame: a cloud, a grid (.asc, "
                             ".tif), or one ") +
                     recording_form);
  arguments.text("frame", "FRAME", inputs.frames.both,
                 std::string("transforms the scan into the site's frame: ") + frame_forms);
  declare_unit(arguments, "unit", inputs.frames.unit, "unit of the coordinates in the scan");
  declare_recorded(arguments, inputs.frames.recorded);
  arguments.option("time", inputs.time, Quantity::time,
                   "when it was scanned, since 1970-01-01 UTC (default: as recorded, else now)");
}

TimedScan scan_of(const SiteScanInputs& inputs) {
  if (!inputs.scan) usage_error("--scan is missing: the ground as it is now");
  TimedScan taken;
  taken.scan = placed_scan(*inputs.scan, inputs.frames, taken.report);
  if (is_raster(*inputs.scan)) taken.scan.z_is_up = true;
  taken.time = time_of(inputs.time, taken.report);
  return taken;
}

void declare_order(Arguments& arguments, OrderInputs& inputs) {
  arguments.file("site", inputs.site,
                 "description of a plain site, which says all but what is given here");
  arguments.file("design", inputs.design,
                 "surface that the ground is to have: LandXML, DXF, PLY, OBJ, STL, .asc or .tif");
  arguments.text("surface", "NAME", inputs.surface, "which of several in that file");
  arguments.text("trench", "LxWxD", inputs.trench,
                 "instead of a file: length, width of the floor, and depth in its middle below the "
                 "mean of the ground along it, such as 15x1x0.5 [m]");
  arguments.text("from", "X,Y", inputs.from, "middle of its end at the machine [m]");
  arguments.option("heading", inputs.heading, Quantity::angle, "of the trench from there");
  arguments.option("grade", inputs.grade, Quantity::ratio, "of its floor, > 0 rises along it");
  arguments.option("batter", inputs.batter, Quantity::ratio,
                   "of its walls, horizontal per vertical; 0: upright");
  arguments.soil(inputs.soil);
  arguments.machine(inputs.machine);
  arguments.texts("windrow", "X1,Y1,X2,Y2,...", inputs.windrows,
                  "polygon in which soil is laid; may be given several times [m]");
  arguments.texts("heap", "X1,Y1,X2,Y2,...", inputs.heaps, "the same of a heap [m]");
  arguments.text("truck", "X1,Y1,...:HEIGHT:KG", inputs.truck,
                 "bed of a truck, its upper edge over the ground, and the mass of a load [m,m,kg]");
  arguments.texts("keep-out", "X1,Y1,...[:DEPTH]", inputs.keep_out,
                  "polygon that is not touched, with a depth from there on down; may be given "
                  "several times [m]");
  arguments.option("tolerance", inputs.tolerance, Quantity::length,
                   "of the finished ground, to either side");
  for (const char* alone : {"design", "trench"}) arguments.exclude("site", {alone});
  arguments.exclude("site", {"from", "heading", "grade", "batter", "soil", "machine", "windrow",
                             "heap", "truck", "keep-out", "tolerance", "surface"});
  arguments.exclude("design", {"trench", "from", "heading", "grade", "batter"});
}

Order order_of(const OrderInputs& inputs, const SiteScanInputs& scan) {
  if (inputs.site) {
    if (scan.scan) usage_error("--site excludes --scan: the site names its first scan");
    return order_of_site(inputs, scan);
  }
  Order order;
  SiteSettings& site = order.settings.site;
  name_kinds(inputs, site);
  order.settings.density_percent = inputs.density.value_or(order.settings.density_percent);
  order.settings.design = job_of(inputs, site.machine);
  order.first = scan_of(scan);
  const Surface ground = surface_of(order.first.scan, site.machine);
  order.settings.surface = design_of(inputs, ground);
  return finished(std::move(order), inputs.machine);
}

GroundErrors errors_of_scan() {
  GroundErrors errors;
  errors.height_sd = 0.01;
  return errors;
}

PlannedCut cut_of(const OrderInputs& inputs, const SiteScanInputs& scan) {
  PlannedCut cut;
  CutOptions options;
  options.errors = errors_of_scan();
  const auto against = [&](const DesignSurface& design, const Surface& ground) {
    cut.shape = shape_of(design, cut_and_fill(design, ground, options));
  };
  if (inputs.site) {
    const Order order = order_of(inputs, scan);
    cut.site = order.settings.site;
    cut.density = read_site_brief(*inputs.site).density;
    cut.truck = order.settings.design.truck;
    against(order.settings.surface, surface_of(order.first.scan, cut.site.machine));
    return cut;
  }
  if (!inputs.trench && !inputs.design) {
    usage_error("the design is missing: give FOLDER, --site, --trench or --design");
  }
  name_kinds(inputs, cut.site);
  if (inputs.truck) {
    cut.truck = of_option("--truck", [&] { return truck_of_text(*inputs.truck); });
  }
  if (inputs.trench && !scan.scan) {
    cut.words = size_of(inputs);
    cut.shape = of_option("--trench", [&] { return shape_on_level_ground(*cut.words); });
    return cut;
  }
  const Surface ground = surface_of(scan_of(scan).scan, cut.site.machine);
  against(design_of(inputs, ground), ground);
  return cut;
}

}  // namespace excavplan::tools
