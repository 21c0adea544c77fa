// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <excavplan/ground/bulking.hpp>

#include "measured_scene.hpp"

/// @file
/// How well volumes, bulking factor and density come out of scans of known digs, as a table in
/// Markdown; how often the 95 % interval of k holds the truth over random digs; and the same
/// scans as PLY files for other programs.
///
///     accuracy [--points N] [--seeds N] [--scenes N] [--only VARIANT] [--export DIR]

namespace excavplan::scenes {
namespace {

constexpr double points_per_bulking = 161.57;  ///< density per bulking factor, the paper's line

struct Settings {
  std::size_t points = 1000000;
  std::uint64_t seeds = 10;
  std::uint64_t scenes = 500;
  std::string only;
  std::string folder;
};

/// Errors of k in many surveys, and how often the interval held the truth.
struct Score {
  int surveys = 0;
  int covered = 0;
  int failed = 0;  // without a bulking factor
  double sum = 0.0;
  double squares = 0.0;
  double density_squares = 0.0;
  double stated_squares = 0.0;

  void add(const Survey& survey) {
    const auto k = bulking_factor(survey.measured());
    if (!k) {
      ++failed;
      return;
    }
    const double error = k->value - survey.dig.bulking;
    ++surveys;
    covered += std::abs(error) <= 1.96 * k->sd ? 1 : 0;
    sum += error / survey.dig.bulking;
    squares += std::pow(error / survey.dig.bulking, 2);
    density_squares += std::pow(error * points_per_bulking, 2);
    stated_squares += std::pow(k->sd / survey.dig.bulking, 2);
  }
  double bias() const { return 100.0 * sum / surveys; }
  double rms() const { return 100.0 * std::sqrt(squares / surveys); }
  double rms_density() const { return std::sqrt(density_squares / surveys); }
  double stated() const { return 100.0 * std::sqrt(stated_squares / surveys); }
  double coverage() const { return 100.0 * covered / surveys; }
};

/// Bars of rms error of k [%] at 1 M points.
double bar_of(const std::string& variant) {
  static const std::map<std::string, double> bars = {
      {"clean", 0.1}, {"noise", 0.1}, {"noise20", 0.3},    {"outliers", 0.3}, {"tilt", 0.3},
      {"rough", 0.3}, {"moved", 0.4}, {"correlated", 1.0}, {"unseen", 1.2},   {"all", 1.6}};
  return bars.at(variant);
}

void print_table(const Settings& settings, bool whole) {
  std::printf("\n%s, %.2f M points in all, %d seeds\n\n", whole ? "One scene" : "Two areas",
              static_cast<double>(settings.points) * 1e-6, static_cast<int>(settings.seeds));
  std::printf(
      "| scans | bias of k %% | rms k %% | bar %% | rms d points | stated sd %% | in 95 %% |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const Variant& variant : variants()) {
    if (!settings.only.empty() && settings.only != variant.name) continue;
    Score score;
    for (std::uint64_t seed = 1; seed <= settings.seeds; ++seed) {
      score.add({Dig{}, variant.errors, settings.points, seed, whole});
    }
    std::printf("| %s | %+.3f | %.3f | %.1f | %.2f | %.3f | %d of %d |\n", variant.name.c_str(),
                score.bias(), score.rms(), bar_of(variant.name), score.rms_density(),
                score.stated(), score.covered, score.surveys + score.failed);
    std::fflush(stdout);
  }
}

/// Random digs, each surveyed with the next kind of errors, every other one as a whole scene.
void print_coverage(const Settings& settings) {
  std::map<std::string, Score> by_variant;
  Score all;
  std::vector<Variant> kinds;
  for (const Variant& variant : variants()) {
    if ((variant.name == "clean" && settings.only != "clean") ||
        (!settings.only.empty() && settings.only != variant.name)) {
      continue;
    }
    kinds.push_back(variant);
  }
  for (std::uint64_t i = 0; i < settings.scenes; ++i) {
    const Variant& variant = kinds[i % kinds.size()];
    const Survey survey{random_dig(1000 + i), variant.errors, settings.points, 1000 + i,
                        (i / kinds.size()) % 2 == 1};
    by_variant[variant.name].add(survey);
    all.add(survey);
  }
  std::printf("\nRandom digs, %.2f M points in all\n\n",
              static_cast<double>(settings.points) * 1e-6);
  std::printf(
      "| scans | digs | bias of k %% | rms k %% | rms d points | stated sd %% | 95 %% interval "
      "holds |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  by_variant["all kinds"] = all;
  for (const auto& [name, score] : by_variant) {
    std::printf("| %s | %d | %+.3f | %.3f | %.2f | %.3f | %.1f %% |\n", name.c_str(),
                score.surveys + score.failed, score.bias(), score.rms(), score.rms_density(),
                score.stated(), score.coverage());
  }
}

void export_scans(const Settings& settings) {
  for (const Variant& variant : variants()) {
    const std::string folder = settings.folder + "/" + variant.name;
    std::filesystem::create_directories(folder);
    const Survey survey{Dig{}, variant.errors, settings.points, 1, false};
    const auto write = [&](const char* name, Part part, bool after) {
      write_cloud(folder + "/" + name + ".ply", survey.cloud(part, after), CloudFormat::ply_binary);
    };
    write("dig_before", Part::dig, false);
    write("dig_after", Part::dig, true);
    write("dump_before", Part::dump, false);
    write("dump_after", Part::dump, true);
  }
  const Dig dig;
  std::printf("truth: pit %.6f, ridge %.6f, heap %.6f m^3, k %.4f\n", dig.pit_volume(),
              dig.ridge_volume(), dig.heap_volume(), dig.bulking);
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
  using namespace excavplan::scenes;
  try {
    const Settings settings = read(count, words);
    if (!settings.folder.empty()) {
      export_scans(settings);
      return EXIT_SUCCESS;
    }
    if (settings.seeds > 0) {
      print_table(settings, false);
      print_table(settings, true);
    }
    if (settings.scenes > 0) print_coverage(settings);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "accuracy: %s\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
