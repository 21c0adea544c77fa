// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <excavplan/ground/blocks.hpp>
#include <excavplan/planning/planner.hpp>
#include <excavplan/simulation/fallback.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/survey/cloud.hpp>

#ifdef EXCAVPLAN_SURVEY
#include <excavplan/survey/paper_method.hpp>
#endif

#include "base/files.hpp"
#include "base/json.hpp"
#include "shared/estimate.hpp"
#include "shared/figures.hpp"
#include "shared/results.hpp"
#include "shared/scans.hpp"
#include "shared/survey_planning.hpp"
#include "shared/tool.hpp"

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
     {"estimate-density --plan-survey height=2.5,offset=1.2,target=5",
      "no scans yet: how well a D435i on a mast of 2.5 m will tell the density"},
     {"estimate-density before.pcd after.pcd --json --plot change.svg",
      "figures for a program, a picture for you"}},
    true};

struct Inputs {
  std::optional<std::string> before;
  std::optional<std::string> after;
  std::optional<std::string> dump_before;
  std::optional<std::string> dump_after;
  ScanFrames frames;
  ChangeOptions change;
  std::string method = "surface";
  bool compare = false;
  bool still = false;
  std::optional<std::string> plan_survey;
  std::optional<double> cell_size;
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
  arguments.flag("no-register", inputs.still,
                 "the sensor stood still between the scans: do not bring them onto each other");
  arguments.flag("compare-methods", inputs.compare, "show what both methods give");
  arguments.option("cell", inputs.cell_size, Quantity::length,
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
  arguments.text("plan-survey", "KEY=VALUE,..", inputs.plan_survey, survey_keys());
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
  SeenPair dig;
  std::optional<SeenPair> dump;
  double cell_size = 0.05;
};

Survey read_survey(const Inputs& inputs) {
  if (inputs.dump_before.has_value() != inputs.dump_after.has_value()) {
    throw Error(ErrorKind::bad_input, "--dump-before and --dump-after go together");
  }
  Survey survey;
  survey.dig = read_scans(*inputs.before, *inputs.after, inputs.frames);
  survey.cell_size = cell_for(survey.dig);
  if (inputs.dump_before) {
    survey.dump = read_scans(*inputs.dump_before, *inputs.dump_after, inputs.frames);
    survey.cell_size = std::max(survey.cell_size, cell_for(*survey.dump));
  }
  if (inputs.cell_size) survey.cell_size = *inputs.cell_size;
  return survey;
}

/// The surfaces of a survey.
struct Maps {
  RegisteredPair dig;
  std::optional<RegisteredPair> dump;

  std::vector<HeightMap> after() const {
    std::vector<HeightMap> maps = {dig.surfaces.after.height};
    if (dump) maps.push_back(dump->surfaces.after.height);
    return maps;
  }
};

Maps maps_of(const Survey& survey, bool align_them) {
  Maps maps;
  maps.dig = surveyed(survey.dig, survey.cell_size, align_them);
  if (survey.dump) maps.dump = surveyed(*survey.dump, survey.cell_size, align_them);
  return maps;
}

nlohmann::ordered_json registration_json(const RegisteredPair& pair) {
  const Alignment& alignment = pair.first;
  const auto numbers = [](const Motion& motion) {
    return nlohmann::ordered_json(std::vector<double>(motion.data(), motion.data() + 6));
  };
  nlohmann::ordered_json correction = nlohmann::ordered_json::array();
  for (const auto& row : pair.correction.rowwise()) {
    correction.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return {{"correction", correction},
          {"found", numbers(alignment.found)},
          {"found_sd", numbers(alignment.covariance.diagonal().cwiseMax(0.0).cwiseSqrt())},
          {"vertical_is_significant", alignment.vertical_is_significant},
          {"lateral_is_significant", alignment.lateral_is_significant},
          {"residual_sd_m", alignment.residual_sd},
          {"stable_share", alignment.stable_share}};
}

/// Null where the sensor stood still and said so.
nlohmann::ordered_json registration_json(const Maps& maps, bool registered) {
  if (!registered) return nullptr;
  nlohmann::ordered_json json = {{"dig", registration_json(maps.dig)}, {"dump", nullptr}};
  if (maps.dump) json["dump"] = registration_json(*maps.dump);
  return json;
}

VolumeChange surface_change(const Inputs& inputs, const Survey& survey, const Maps& maps) {
  return measured(survey.dig.files(), [&] {
    return maps.dump ? measure_change(maps.dig.surfaces, maps.dump->surfaces, inputs.change)
                     : measure_change(maps.dig.surfaces, inputs.change);
  });
}

void refuse_swapped(const VolumeChange& change, const Inputs& inputs) {
  for (const Warning& warning : change.warnings) {
    if (warning.code == "looks_swapped") {
      throw Error(ErrorKind::bad_file,
                  *inputs.before + ", " + *inputs.after + ": " + warning.message);
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
  options.leaf = survey.cell_size;
  auto dig_area = inputs.change.dig_area;
  auto dump_area = inputs.change.dump_area;
  if (!survey.dump) {
    if (!dig_area) dig_area = extent_of(surface, {ZoneKind::dig, ZoneKind::spill});
    if (!dump_area) dump_area = extent_of(surface, {ZoneKind::dump});
  }
  const bool no_heap = !survey.dump && !dump_area;
  const Cloud before = survey.dig.before.cloud();
  const Cloud after = survey.dig.after.cloud();
  std::optional<Cloud> dump_before, dump_after;
  if (survey.dump) {
    dump_before = survey.dump->before.cloud();
    dump_after = survey.dump->after.cloud();
  }
  const Cloud& heap_before = dump_before ? *dump_before : before;
  const Cloud& heap_after = dump_after ? *dump_after : after;
  const double dig_ground = median_height(before);
  const double heap_ground = dump_before ? median_height(*dump_before) : dig_ground;
  const Cloud still = levelled(before, dig_area, dig_ground);  // nothing rises in it
  VolumeChange change = measured(*inputs.before + ", " + *inputs.after, [&] {
    return paper_volumes(still, levelled(after, dig_area, dig_ground),
                         no_heap ? still : levelled(heap_before, dump_area, heap_ground),
                         no_heap ? still : levelled(heap_after, dump_area, heap_ground), options);
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
std::optional<Fallback> fallback_of(const Inputs& inputs, const Maps& maps,
                                    const VolumeChange& surface) {
  if (inputs.dug_path.has_value() != inputs.dug_start.has_value()) {
    throw Error(ErrorKind::bad_input, "--dug-path and --dug-start go together");
  }
  if (!inputs.dug_path) return std::nullopt;
  const Machine machine = machine_named(inputs.machine);
  const HeightMap& before = maps.dig.surfaces.before.height;
  HeightMap after = realigned(maps.dig.surfaces.after.height, maps.dig.surfaces.alignment);
  after.z -= surface.areas.front().datum;
  const auto path = make_dig_path(machine, *inputs.dug_path, *inputs.dug_start,
                                  ground_under(before, machine.bucket.width_outside));
  if (const auto* infeasible = std::get_if<Infeasible>(&path)) {
    throw Error(ErrorKind::bad_input, "--dug-path: " + infeasible->message);
  }
  return measure_fallback(machine, std::get<DigPath>(path), before, after);
}

/// Estimate and figures of one method as a program gets them.
struct Answer {
  VolumeChange change;
  Estimate estimate;
  nlohmann::ordered_json json;
  std::vector<std::string> lines;
};

Answer answer_of(const std::string& method, VolumeChange change, const Knowledge& knowledge,
                 const DensityLaw& law) {
  Answer answer;
  answer.estimate = estimate(change, knowledge, law);
  answer.json = estimate_json(change, answer.estimate, law);
  answer.json["method"] = method;
  answer.lines = estimate_lines(change, answer.estimate, law);
  answer.change = std::move(change);
  return answer;
}

std::vector<Warning> new_ones(const std::vector<Warning>& warnings,
                              const std::vector<Warning>& said) {
  std::vector<Warning> result;
  for (const Warning& warning : warnings) {
    const auto same = [&](const Warning& other) { return other.message == warning.message; };
    if (std::none_of(said.begin(), said.end(), same)) result.push_back(warning);
  }
  return result;
}

Outcome work_on_scans(const Inputs& inputs) {
  const DensityLaw law = law_named(inputs.law);
  const Survey survey = read_survey(inputs);
  const Maps maps = maps_of(survey, !inputs.still);
  const VolumeChange surface = surface_change(inputs, survey, maps);
  refuse_swapped(surface, inputs);
  Knowledge knowledge;
  knowledge.fallback = fallback_of(inputs, maps, surface);
  knowledge.blocks = assess_blocks(maps.after(), surface);

  const bool paper_counts = inputs.method == "paper";
  std::vector<Answer> answers;
  if (!paper_counts || inputs.compare) {
    answers.push_back(answer_of("surface", surface, knowledge, law));
  }
  if (paper_counts || inputs.compare) {
    answers.push_back(answer_of("paper", paper_change(inputs, survey, surface), knowledge, law));
  }
  Answer& counts = paper_counts ? answers.back() : answers.front();

  Outcome outcome;
  outcome.json = counts.json;
  outcome.json["cell_m"] = survey.cell_size;
  outcome.json["registration"] = registration_json(maps, !inputs.still);
  outcome.json["zones"] = zones_json(surface);
  outcome.lines = counts.lines;
  outcome.warnings = counts.estimate.warnings;
  outcome.trustworthy = counts.estimate.trustworthy;
  if (inputs.compare) {
    for (const Answer& answer : answers) {
      const std::string& method = answer.json["method"].get_ref<const std::string&>();
      outcome.json["methods"][method] = answer.json;
      if (&answer == &counts) continue;
      outcome.lines.push_back("method " + method + " gives");
      for (const std::string& line : answer.lines) outcome.lines.push_back("  " + line);
      for (const Warning& w : new_ones(answer.estimate.warnings, outcome.warnings)) {
        outcome.warnings.push_back({w.code, "method " + method + ": " + w.message});
      }
    }
  }
  if (inputs.plot) write_file(*inputs.plot, height_change_figure(surface, counts.lines));
  return outcome;
}

Outcome work(const Inputs& inputs) {
  if (inputs.plan_survey) {
    if (inputs.before || inputs.after) {
      throw Error(ErrorKind::bad_input, "--plan-survey takes no scans: it plans them");
    }
    return planned_survey(*inputs.plan_survey, law_named(inputs.law));
  }
  if (!inputs.before || !inputs.after) {
    throw Error(ErrorKind::bad_input,
                std::string(inputs.before ? "AFTER" : "BEFORE") +
                    " is missing: a cloud before the dig and one after it are needed");
  }
  return work_on_scans(inputs);
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  return tool_main(argc, argv, about, declare, work);
}
