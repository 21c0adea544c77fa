// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <excavplan/ground/bulking.hpp>
#include <excavplan/planning/fallback.hpp>
#include <excavplan/planning/planner.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/survey/cloud.hpp>

#ifdef EXCAVPLAN_SURVEY
#include <excavplan/survey/paper_method.hpp>
#endif

#include "figures.hpp"
#include "json_file.hpp"
#include "results.hpp"
#include "scans.hpp"
#include "tool.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "estimate-density",
    "estimates the relative density of soil from scans of the ground before and after one dig: "
    "volumes of hole, spill and heap, bulking factor, density, each with its standard deviation.",
    {{"estimate-density before.pcd after.pcd", "two scans that show dig and heap"},
     {"estimate-density dig0.ply dig1.ply --dump-before heap0.ply --dump-after heap1.ply",
      "separate scans of the dig area and of the dump area"},
     {"estimate-density before.pcd after.pcd --dug-path 45deg,0.35m,1.5m --dug-start 6.05",
      "the path is known: soil that fell back into the cut is taken into account"},
     {"estimate-density before.pcd after.pcd --json --plot change.svg",
      "figures for a program, a picture for you"}},
    true};

struct Inputs {
  std::string before;
  std::string after;
  std::optional<std::string> dump_before;
  std::optional<std::string> dump_after;
  ScanFrames frames;
  ChangeOptions change;
  std::string method = "surface";
  std::optional<double> cell;
  std::optional<DigParameters> dug_path;
  std::optional<double> dug_start;
  std::string machine = "zx120";
  std::string law = "default";
  std::optional<std::string> plot;
};

void declare(Arguments& arguments, Inputs& inputs) {
  arguments.positional("BEFORE", inputs.before, "cloud before the dig: PCD, PLY or XYZ");
  arguments.positional("AFTER", inputs.after, "cloud after it");
  arguments.file("dump-before", inputs.dump_before,
                 "cloud of the dump area before; BEFORE and AFTER then show the dig area only");
  arguments.file("dump-after", inputs.dump_after, "cloud of the dump area after");
  arguments.option("area", inputs.frames.area,
                   "leave out everything outside (default: what both see)");
  arguments.option("dig-area", inputs.change.dig_area, "where the hole is (default: found)");
  arguments.option("dump-area", inputs.change.dump_area, "where the heap is (default: found)");
  arguments.file("before-frame", inputs.frames.before,
                 "4 x 4 matrix that takes the clouds before into the site frame");
  arguments.file("after-frame", inputs.frames.after, "the same for the clouds after");
  arguments.choice("method", inputs.method, {"surface", "paper"},
                   "surface: signed change of one height map; paper: the pipeline as published");
  arguments.option("cell", inputs.cell, Quantity::length,
                   "cell of the height map, voxel of the paper's method (default: from the density "
                   "of the points, at least 0.05)");
  arguments.text("law", "NAME|FILE", inputs.law,
                 "density law: default (built-in simulator, ZX120 in loam), paper, or a law file");
  arguments.option(
      "dug-path", inputs.dug_path,
      "the path that was dug: finds the soil that fell back into the cut and frees the "
      "bulking factor of it; needs scans in the site frame");
  arguments.option("dug-start", inputs.dug_start, Quantity::length,
                   "x where that path met the ground");
  arguments.machine(inputs.machine);
  arguments.plot(inputs.plot, "the height change with its zones");
}

// ---- Clouds to volumes ------------------------------------------------------------------------

/// Errors of the change are about what the files show.
template <typename Measure>
VolumeChange measured(const std::string& files, const Measure& measure) {
  try {
    return measure();
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, files + ": " + error.what());
  }
}

struct Survey {
  ScanPair dig;
  std::optional<ScanPair> dump;
  double cell = 0.05;
};

Survey read_survey(const Inputs& inputs) {
  if (inputs.dump_before.has_value() != inputs.dump_after.has_value()) {
    throw Error(ErrorKind::bad_input, "--dump-before and --dump-after go together");
  }
  Survey survey;
  survey.dig = read_scans(inputs.before, inputs.after, inputs.frames);
  survey.cell = cell_for(survey.dig);
  if (inputs.dump_before) {
    survey.dump = read_scans(*inputs.dump_before, *inputs.dump_after, inputs.frames);
    survey.cell = std::max(survey.cell, cell_for(*survey.dump));
  }
  if (inputs.cell) survey.cell = *inputs.cell;
  return survey;
}

VolumeChange surface_change(const Inputs& inputs, const Survey& survey) {
  const SurfacePair dig = surfaces(survey.dig, survey.cell);
  const std::string files = survey.dig.files();
  if (!survey.dump) {
    return measured(files, [&] { return measure_change(dig.before, dig.after, inputs.change); });
  }
  const SurfacePair dump = surfaces(*survey.dump, survey.cell);
  return measured(files, [&] { return measure_change(dig, dump, inputs.change); });
}

void refuse_swapped(const VolumeChange& change, const Inputs& inputs) {
  for (const Warning& warning : change.warnings) {
    if (warning.code == "looks_swapped") {
      throw Error(ErrorKind::bad_file,
                  inputs.before + ", " + inputs.after + ": " + warning.message);
    }
  }
}

#ifdef EXCAVPLAN_SURVEY

/// Extent of the zones of some kinds, with room around it.
std::optional<Rectangle> extent_of(const VolumeChange& change,
                                   std::initializer_list<ZoneKind> kinds) {
  std::optional<Rectangle> extent;
  for (const ChangeZone& zone : change.zones) {
    if (std::find(kinds.begin(), kinds.end(), zone.kind) == kinds.end()) continue;
    const Rectangle& r = zone.extent;
    const Rectangle e = extent.value_or(r);
    extent = Rectangle{std::min(e.x_min, r.x_min), std::min(e.y_min, r.y_min),
                       std::max(e.x_max, r.x_max), std::max(e.y_max, r.y_max)};
  }
  if (!extent) return extent;
  constexpr double room = 0.3;  // [m], ours
  return Rectangle{extent->x_min - room, extent->y_min - room, extent->x_max + room,
                   extent->y_max + room};
}

/// Points inside, with the ground's median height at z = 0 as the method expects it.
Cloud levelled(const Cloud& cloud, const std::optional<Rectangle>& area, double ground) {
  Cloud result;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (!p.allFinite() || (area && !area->contains(p.x(), p.y()))) continue;
    result.points.emplace_back(p.x(), p.y(), p.z() - ground);
  }
  result.width = result.points.size();
  return result;
}

double median_height(const Cloud& cloud) {
  std::vector<double> z;
  for (const Eigen::Vector3d& p : cloud.points) {
    if (p.allFinite()) z.push_back(p.z());
  }
  const auto middle = z.begin() + static_cast<std::ptrdiff_t>(z.size() / 2);
  std::nth_element(z.begin(), middle, z.end());
  return *middle;
}

VolumeChange paper_change(const Inputs& inputs, const Survey& survey, const VolumeChange& surface) {
  PaperMethodOptions options;
  options.leaf = survey.cell;
  const ScanPair& heap = survey.dump ? *survey.dump : survey.dig;
  auto dig_area = inputs.change.dig_area;
  auto dump_area = inputs.change.dump_area;
  if (!survey.dump) {
    if (!dig_area) dig_area = extent_of(surface, {ZoneKind::dig, ZoneKind::spill});
    if (!dump_area) dump_area = extent_of(surface, {ZoneKind::dump});
  }
  const bool no_heap = !survey.dump && !dump_area;
  const double dig_ground = median_height(survey.dig.before);
  const double heap_ground = median_height(heap.before);
  const Cloud still = levelled(survey.dig.before, dig_area, dig_ground);  // nothing rises in it
  VolumeChange change = measured(inputs.before + ", " + inputs.after, [&] {
    return paper_volumes(still, levelled(survey.dig.after, dig_area, dig_ground),
                         no_heap ? still : levelled(heap.before, dump_area, heap_ground),
                         no_heap ? still : levelled(heap.after, dump_area, heap_ground), options);
  });
  for (const Warning& warning : surface.warnings) change.warnings.push_back(warning);
  return change;
}

#else

VolumeChange paper_change(const Inputs&, const Survey&, const VolumeChange&) {
  throw Error(ErrorKind::bad_input,
              "--method: paper needs PCL, and this program was built without it "
              "(EXCAVPLAN_SURVEY=OFF)");
}

#endif

// ---- Volumes to density -----------------------------------------------------------------------

DensityLaw law_named(const std::string& name) {
  return load_density_law(shipped_or_file("laws", name == "default" ? "zx120-loam" : name));
}

struct Estimate {
  std::optional<Measured> bulking;  ///< as the height maps give it
  std::optional<Fallback> fallback;
  std::optional<Measured> freed;  ///< bulking, freed of the fallback
  std::optional<DensityEstimate> density;
  double density_without_fallback = 0.0;  ///< were `bulking` free of it [%]
  bool trustworthy = true;
  std::vector<Warning> warnings;
};

/// k = f + (1 - f) k_measured with the errors of both.
Measured freed_of(const Measured& bulking, const Measured& fallback) {
  return {free_of_fallback(bulking.value, fallback.value),
          std::hypot((1.0 - fallback.value) * bulking.sd, (1.0 - bulking.value) * fallback.sd)};
}

Estimate estimate(const VolumeChange& change, const std::optional<Fallback>& fallback,
                  DensityLaw law) {
  Estimate result;
  result.warnings = change.warnings;
  result.bulking = bulking_factor(change);
  if (result.bulking) {
    result.fallback = fallback;
    result.density_without_fallback = density_of_bulking(law.freed_form, result.bulking->value);
    if (fallback) {
      result.freed = freed_of(*result.bulking, fallback->fraction);
      law.form = law.freed_form;
    }
    Measured k = result.freed.value_or(*result.bulking);
    const bool known_error = !std::isnan(k.sd);
    if (!known_error) {
      k.sd = 0.0;
      result.warnings.push_back(
          {"volume_error_unknown",
           "this method tells no error of its volumes: the interval of the density holds the "
           "scatter of the law only"});
    }
    result.density = estimate_density(law, k);
    result.trustworthy = known_error && result.density->trustworthy;
    for (const Warning& warning : result.density->warnings) result.warnings.push_back(warning);
  } else {
    result.trustworthy = false;
  }
  for (const Warning& warning : change.warnings) {
    if (warning.code == "zone_at_border" || warning.code == "zone_partly_unseen") {
      result.trustworthy = false;
    }
  }
  return result;
}

nlohmann::ordered_json estimate_json(const VolumeChange& change, const Estimate& result,
                                     const DensityLaw& law) {
  nlohmann::ordered_json json;
  json["volume"] = volumes_json(change);
  json["bulking_factor"] = nullptr;
  json["bulking_factor_sd"] = nullptr;
  json["density_percent"] = nullptr;
  json["density_raw_percent"] = nullptr;
  json["density_sd_percent"] = nullptr;
  json["density_interval_percent"] = nullptr;
  if (result.bulking) {
    json["bulking_factor"] = result.bulking->value;
    json["bulking_factor_sd"] = result.bulking->sd;
    json["density_percent"] = result.density->percent;
    json["density_raw_percent"] = result.density->raw_percent;
    json["density_sd_percent"] = result.density->sd_percent;
    json["density_interval_percent"] = result.density->interval_percent;
    json["density_without_fallback_percent"] = result.density_without_fallback;
  }
  json["fallback"] = nullptr;
  if (result.fallback) {
    json["fallback"] = {{"fraction", result.fallback->fraction.value},
                        {"fraction_sd", result.fallback->fraction.sd},
                        {"cut_m3", result.fallback->cut},
                        {"in_pit_m3", result.fallback->in_pit},
                        {"seen_share", result.fallback->seen_share},
                        {"bulking_factor_freed", result.freed->value},
                        {"bulking_factor_freed_sd", result.freed->sd}};
  }
  json["law"] = law.name;
  json["trustworthy"] = result.trustworthy;
  return json;
}

nlohmann::ordered_json zones_json(const VolumeChange& change) {
  auto list = nlohmann::ordered_json::array();
  for (const ChangeZone& zone : change.zones) {
    list.push_back(
        {{"kind", name(zone.kind)},
         {"volume_m3", zone.volume.value},
         {"volume_sd_m3", zone.volume.sd},
         {"area_m2", zone.area},
         {"unseen_share", zone.unknown_share},
         {"extent_m",
          {zone.extent.x_min, zone.extent.y_min, zone.extent.x_max, zone.extent.y_max}}});
  }
  return list;
}

std::vector<std::string> estimate_lines(const VolumeChange& change, const Estimate& result,
                                        const DensityLaw& law) {
  const auto volume = [](const Measured& v) { return readable(v.value, v.sd) + " m3"; };
  std::vector<std::string> lines = {"hole       " + volume(change.excavated),
                                    "spill      " + volume(change.spilled),
                                    "heap       " + volume(change.dumped)};
  if (!result.bulking) {
    lines.emplace_back("bulking    unknown, and so is the density");
    return lines;
  }
  const DensityEstimate& d = *result.density;
  lines.push_back("bulking    " + readable(result.bulking->value, result.bulking->sd));
  if (result.fallback) {
    lines.push_back(
        "fallback   " +
        readable(100.0 * result.fallback->fraction.value, 100.0 * result.fallback->fraction.sd) +
        " % of the cut; freed of it, bulking is " +
        readable(result.freed->value, result.freed->sd));
  }
  lines.push_back("density    " + readable(d.percent, d.sd_percent) + " %, 95 % interval " +
                  readable(d.interval_percent[0]) + " .. " + readable(d.interval_percent[1]) +
                  " %");
  lines.push_back("law        " + law.name + (result.trustworthy ? "" : " (NOT TRUSTWORTHY)"));
  const double bias = result.density_without_fallback - d.raw_percent;
  if (!result.fallback && std::abs(bias) > 0.05) {
    lines.push_back(
        "           holds for digs whose bucket spilled as in its calibration; had nothing "
        "fallen back, " +
        readable(std::clamp(result.density_without_fallback, 0.0, 100.0)) +
        " % (--dug-path finds out)");
  }
  return lines;
}

/// Mean height under the bucket, 15 cm to both sides of x: one cell's noise would move
/// the whole path.
GroundProfile ground_under(const HeightMap& map, double width) {
  return [&map, width](double x) {
    constexpr double reach = 0.15;  // [m], ours
    double sum = 0.0;
    int count = 0;
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
      if (std::abs(map.x(col) - x) > reach) continue;
      for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
        if (std::abs(map.y(row)) > 0.5 * width || std::isnan(map.z(row, col))) continue;
        sum += map.z(row, col);
        ++count;
      }
    }
    return count > 0 ? sum / count : std::nan("");
  };
}

/// What lies on the floor of the path that was dug, if it was given.
std::optional<Fallback> fallback_of(const Inputs& inputs, const Survey& survey,
                                    const VolumeChange& surface) {
  if (inputs.dug_path.has_value() != inputs.dug_start.has_value()) {
    throw Error(ErrorKind::bad_input, "--dug-path and --dug-start go together");
  }
  if (!inputs.dug_path) return std::nullopt;
  const Machine machine = machine_named(inputs.machine);
  SurfacePair dig = surfaces(survey.dig, survey.cell);
  dig.after.z -= surface.areas.front().datum;
  const auto path = make_dig_path(machine, *inputs.dug_path, *inputs.dug_start,
                                  ground_under(dig.before, machine.bucket.width_outside));
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input, "--dug-path: " + infeasible->message);
  }
  return measure_fallback(machine, std::get<DigPath>(path), dig.before, dig.after);
}

Outcome work(const Inputs& inputs) {
  const DensityLaw law = law_named(inputs.law);
  const Survey survey = read_survey(inputs);
  const VolumeChange surface = surface_change(inputs, survey);
  refuse_swapped(surface, inputs);
  const bool paper = inputs.method == "paper";
  const VolumeChange change = paper ? paper_change(inputs, survey, surface) : surface;
  const Estimate result = estimate(change, fallback_of(inputs, survey, surface), law);

  Outcome outcome;
  outcome.json = estimate_json(change, result, law);
  outcome.json["method"] = inputs.method;
  outcome.json["cell_m"] = survey.cell;
  outcome.json["zones"] = zones_json(surface);
  outcome.lines = estimate_lines(change, result, law);
  outcome.warnings = result.warnings;
  outcome.trustworthy = result.trustworthy;
  if (inputs.plot) write_file(*inputs.plot, height_change_figure(surface, outcome.lines));
  return outcome;
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
