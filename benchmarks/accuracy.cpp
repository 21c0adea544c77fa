// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/density/density_estimate.hpp>
#include <excavplan/sensing/depth_camera.hpp>

#include "base/parallel.hpp"
#include "support/block_heap.hpp"
#include "support/survey_scenes.hpp"

/// @file
/// Surveys of digs whose volumes are known, from the scans' files to the density as
/// estimate-density goes, with the paper's law: one line of CSV for each survey.
///
///     accuracy [--points N] [--seeds N] [--first-seed N] [--only KIND] [--export DIR]
///     accuracy --scenes N [--points N] [--first-seed N] [--only KIND]
///
/// --scenes takes another dig for every survey, of random size and density. --export keeps the
/// scans as DIR/<kind>/<layout>/<seed>/*.ply, for other programs. scripts/accuracy makes the tables
/// of docs/generated/accuracy.md.

namespace excavplan::scenes {
namespace {

/// What is surveyed, and how.
struct Kind {
  std::string name;
  ScanErrors errors;
  double camera_height = 0.0;  ///< above the ground [m]; 0: points spread evenly
  bool registered = true;      ///< else the sensor is known not to have moved
  bool blocks = false;         ///< the heap is one of blocks, another for every seed
  void (*shape)(Dig&) = [](Dig&) {};
};

std::vector<Kind> kinds() {
  std::vector<Kind> list;
  for (const Variant& variant : variants()) list.push_back({variant.name, variant.errors});
  list.push_back({"d435i-2m", {}, 2.0, false});
  list.push_back({"d435i-3m", {}, 3.0, false});
  list.push_back({"d435i-2m-registered", {}, 2.0});
  list.push_back({"d435i-3m-registered", {}, 3.0});

  ScanErrors errors = errors_of("noise");
  const auto shape = [&](const char* name, void (*change)(Dig&)) {
    list.push_back({name, errors, 0.0, true, false, change});
  };
  shape("flat-walls", [](Dig& dig) { dig.wall_angle = 45.0 * degree; });
  shape("shallow", [](Dig& dig) { dig.pit_depth = 0.15, dig.ridge_height = 0.08; });
  shape("windrow", [](Dig& dig) { dig.heap_crest = 1.6; });
  list.push_back({"blocks", errors, 0.0, true, true});
  errors.slope = 8.0 * degree;
  errors.roughness = 0.10;
  list.push_back({"uneven", errors});
  return list;
}

/// A heap of blocks with voids between them in the middle of the dump area.
/// @return the share of the heap that is solid
double heap_blocks(Dig& dig, std::uint64_t seed) {
  test::Heap heap = test::block_heap({}, seed);
  const Rectangle extent = heap.fine.extent();
  heap.fine.origin -=
      Eigen::Vector2d(0.5 * (extent.x_min + extent.x_max), 0.5 * (extent.y_min + extent.y_max));
  dig.bulking = (heap.envelope() + dig.ridge_volume()) / dig.pit_volume();
  const double solid = heap.solids / heap.envelope();
  dig.heap_shape = std::make_shared<HeightMap>(std::move(heap.fine));
  return solid;
}

struct Survey {
  Kind kind;
  Dig dig;
  std::uint64_t seed = 0;
  bool whole = false;
  std::size_t points = 0;  ///< in all clouds
  double density = 0.0;    ///< true [%]
  double voids = 0.0;      ///< between the blocks of the heap [m^3]
  const DensityLaw* law = nullptr;

  const char* layout() const { return whole ? "whole" : "areas"; }
};

/// The scene on cells of 1 cm, each the mean of nine heights, so that it holds the true volume.
HeightMap surface_of(const Dig& dig, Part part, bool after) {
  constexpr int fine = 3;
  HeightMap map = flat_ground(extent_of(part), 0.01);
  if (!after) return map;
  for (Eigen::Index col = 0; col < map.z.cols(); ++col) {
    for (Eigen::Index row = 0; row < map.z.rows(); ++row) {
      for (int i = 0; i < fine * fine; ++i) {
        const double dx = ((i % fine + 0.5) / fine - 0.5) * map.cell_size;
        const double dy = ((i / fine + 0.5) / fine - 0.5) * map.cell_size;
        map.z(row, col) += change_at(dig, part, map.x(col) + dx, map.y(row) + dy);
      }
      map.z(row, col) /= fine * fine;
    }
  }
  return map;
}

/// 848 x 480 pixels, 30 frames, half its height to the side of the dig, which fills the picture.
Points camera_scan(const Survey& survey, Part part, bool after) {
  DepthCamera camera;
  camera.width = 848;
  camera.height = 480;
  camera.frames = 30;
  camera.position = {0.0, -0.5 * survey.kind.camera_height, survey.kind.camera_height};
  camera.target = {0.0, -0.15, 0.0};
  const std::uint64_t scan = static_cast<std::uint64_t>(part) * 2 + (after ? 1 : 0);
  return scan_surface(surface_of(survey.dig, part, after),
                      with_errors_of(sensor_of_word("d435i"), camera), survey.seed * 8 + scan);
}

std::string write_scan(const std::string& folder, const Survey& survey, Part part, bool after) {
  static const char* const parts[] = {"dig", "dump", "whole"};
  Cloud cloud;
  cloud.points = survey.kind.camera_height > 0.0
                     ? camera_scan(survey, part, after)
                     : scan(survey.dig, part, survey.kind.errors,
                            survey.points / (survey.whole ? 2 : 4), survey.seed, after);
  cloud.width = cloud.points.size();
  std::string file = folder + "/" + parts[static_cast<std::size_t>(part)];
  file += after ? "_after.ply" : "_before.ply";
  write_cloud(file, cloud, CloudFormat{"ply"});
  return file;
}

ScanPair scans_of(const std::string& folder, const Survey& survey, Part part) {
  ScanPair pair;
  pair.before.files = {write_scan(folder, survey, part, false)};
  pair.after.files = {write_scan(folder, survey, part, true)};
  return pair;
}

std::string record_of(const Survey& survey, const DensityEstimate& found) {
  const Dig& dig = survey.dig;
  const VolumeChange& change = found.change;
  const Measured none{std::nan(""), std::nan("")};
  const Measured k = found.bulking.value_or(none);
  const Measured free = found.corrected.value_or(k);
  const RelativeDensity d = found.density.value_or(RelativeDensity{});
  const double k_free = dig.bulking - survey.voids / dig.pit_volume();
  char line[1024];
  std::snprintf(line, sizeof line,
                "%s,%s,%llu,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%.3f,%.3f,"
                "%.3f,%.3f,%d,%.6f\n",
                survey.kind.name.c_str(), survey.layout(),
                static_cast<unsigned long long>(survey.seed), dig.pit_volume(), dig.ridge_volume(),
                dig.heap_volume(), dig.bulking, k_free, change.excavated.value,
                change.spilled.value, change.dumped.value, k.value, k.sd, free.value, free.sd,
                survey.density, found.density ? d.raw_percent : std::nan(""), d.interval_percent[0],
                d.interval_percent[1], found.trustworthy ? 1 : 0, bulking_errors(change).scans);
  return line;
}

constexpr const char* header =
    "kind,layout,seed,hole_true,spill_true,heap_true,k_true,k_free_true,hole,spill,heap,k,k_sd,"
    "k_free,k_free_sd,d_true,d,d_low,d_high,trusted,k_sd_scans\n";

/// From nothing to a line, over files in the folder.
std::string measured(const std::string& folder, const Survey& survey) {
  std::filesystem::create_directories(folder);
  const ScanPair first = scans_of(folder, survey, survey.whole ? Part::whole : Part::dig);
  DigScans scans{first.before, first.after};
  if (!survey.whole) scans.dump = scans_of(folder, survey, Part::dump);
  DensityOptions options;
  options.registered = survey.kind.registered;
  return record_of(survey, estimate_density(scans, *survey.law, options));
}

struct Settings {
  std::size_t points = 1000000;
  std::uint64_t seeds = 10;
  std::uint64_t first_seed = 90001;
  std::uint64_t scenes = 0;
  std::string only;
  std::string folder;
};

/// Every layout and seed of a kind.
std::vector<Survey> repeated(const Kind& kind, const Settings& settings, const DensityLaw& law) {
  std::vector<Survey> surveys;
  for (const bool whole : {false, true}) {
    if (whole && kind.camera_height > 0.0) continue;
    for (std::uint64_t i = 0; i < settings.seeds; ++i) {
      Survey survey{kind, {}, settings.first_seed + i, whole, settings.points, 0.0, 0.0, &law};
      kind.shape(survey.dig);
      if (kind.blocks) {
        const double solid = heap_blocks(survey.dig, survey.seed);
        survey.voids = (1.0 - solid) * survey.dig.heap_volume();
      }
      survey.density = density_of_bulking(law.form, survey.dig.bulking);
      surveys.push_back(std::move(survey));
    }
  }
  return surveys;
}

/// Random digs in soil of random density whose bulking factor scatters about the law as its
/// calibration did; each with the next kind of errors, every other one as a whole scene.
std::vector<Survey> random_surveys(const std::vector<Kind>& all, const Settings& settings,
                                   const DensityLaw& law) {
  std::vector<Kind> surveyed;
  for (const Kind& kind : all) {
    const bool twice = kind.camera_height > 0.0 && kind.registered;
    if (!kind.blocks && !twice && kind.name != "clean") surveyed.push_back(kind);
  }
  const double scatter = std::get<DensityLine>(law.form).residual_sd;
  std::vector<Survey> surveys;
  for (std::uint64_t i = 0; i < settings.scenes; ++i) {
    const std::uint64_t seed = settings.first_seed + i;
    const Kind& kind = surveyed[i % surveyed.size()];
    const bool whole = (i / surveyed.size()) % 2 == 1 && kind.camera_height == 0.0;
    Survey survey{kind, random_dig(seed), seed, whole, settings.points, 0.0, 0.0, &law};
    kind.shape(survey.dig);
    Random random(seed, 8);
    survey.density = random.uniform(0.0, 100.0);
    survey.dig.bulking = bulking_of_density(law.form, survey.density + scatter * random.normal());
    surveys.push_back(std::move(survey));
  }
  return surveys;
}

void run(const std::vector<Survey>& surveys, const std::string& folder, bool keep) {
  std::vector<std::string> lines(surveys.size());
  parallel_for(surveys.size(), 0, [&](std::size_t i) {
    const Survey& survey = surveys[i];
    const std::string own =
        folder + "/" + survey.kind.name + "/" + survey.layout() + "/" + std::to_string(survey.seed);
    lines[i] = measured(own, survey);
    if (!keep) std::filesystem::remove_all(own);
  });
  for (const std::string& line : lines) std::fputs(line.c_str(), stdout);
  std::fflush(stdout);
}

void work(const Settings& settings) {
  std::vector<Kind> chosen;
  for (const Kind& kind : kinds()) {
    if (settings.only.empty() || settings.only == kind.name) chosen.push_back(kind);
  }
  if (chosen.empty()) throw Error(ErrorKind::bad_input, "--only: no kind " + settings.only);
  const DensityLaw law = load_density_law(find_data_file("laws/paper.json"));
  const bool keep = !settings.folder.empty();
  const std::string folder = keep ? settings.folder
                                  : std::filesystem::temp_directory_path().string() + "/accuracy-" +
                                        std::to_string(::getpid());
  std::fputs(header, stdout);
  if (settings.scenes > 0) {
    run(random_surveys(chosen, settings, law), folder, keep);
  } else {
    for (const Kind& kind : chosen) run(repeated(kind, settings, law), folder, keep);
  }
  if (!keep) std::filesystem::remove_all(folder);
}

Settings read(int count, char** words) {
  Settings settings;
  for (int i = 1; i < count; i += 2) {
    const std::string option = words[i];
    if (i + 1 == count) throw Error(ErrorKind::bad_input, option + " needs a value");
    const std::string value = words[i + 1];
    if (option == "--points") {
      settings.points = std::stoul(value);
    } else if (option == "--seeds") {
      settings.seeds = std::stoul(value);
    } else if (option == "--first-seed") {
      settings.first_seed = std::stoul(value);
    } else if (option == "--scenes") {
      settings.scenes = std::stoul(value);
    } else if (option == "--only") {
      settings.only = value;
    } else if (option == "--export") {
      settings.folder = value;
    } else {
      throw Error(ErrorKind::bad_input, option + " is no option of accuracy");
    }
  }
  return settings;
}

}  // namespace
}  // namespace excavplan::scenes

int main(int count, char** words) {
  try {
    excavplan::scenes::work(excavplan::scenes::read(count, words));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "accuracy: %s\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
