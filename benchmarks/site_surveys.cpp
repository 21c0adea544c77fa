// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <excavplan/data_files.hpp>
#include <excavplan/ground/bulking.hpp>
#include <excavplan/survey/density_estimate.hpp>

#include "base/parallel.hpp"
#include "support/site_scenes.hpp"

/// @file
/// Surveys of scenes with what a site brings, whose volumes are known, from clouds in memory to the
/// density: one line of CSV for each survey, or a table with one line for each family.
///
///     site_surveys [--family NAME[,NAME]] [--seeds N] [--first-seed N] [--points N] [--summary]
///
/// --points is for one cloud. scripts/accuracy makes the table of docs/accuracy.md.

namespace excavplan::scenes {
namespace {

struct Settings {
  std::vector<std::string> families;
  std::uint64_t seeds = 8;
  std::uint64_t first_seed = 70001;
  std::size_t points = 300000;
  bool summary = false;
};

/// What came of one survey; figures are NaN where there is none.
struct Record {
  std::string family;
  std::uint64_t seed = 0;
  Volumes truth;
  double k = nan;
  double sd = nan;
  double sd_scans = nan;
  Volumes found{nan, nan, nan};
  double shift = nan;  ///< of k in its sd, by an offset of both scans
  bool trusted = false;
  bool in_a_reading = false;
  bool refused = false;
  std::string codes;

  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

  double error() const { return 100.0 * (k / truth.bulking() - 1.0); }
  double z() const { return (k - truth.bulking()) / sd; }
  bool inside() const { return std::abs(z()) <= 1.96; }
  /// Volumes in another unit are wrong even if their ratio is right.
  bool of_right_size() const {
    const double size = found.hole / truth.hole;
    return size > 0.67 && size < 1.5;
  }
  bool wrong() const { return trusted && (std::abs(z()) > 3.0 || !of_right_size()); }
  bool held() const {
    return refused || !trusted || (of_right_size() && (inside() || in_a_reading));
  }
};

double percent(double found, double truth) { return 100.0 * (found / truth - 1.0); }

/// Within 2 of a reading's own sd and half a per cent.
bool in_a_reading(const VolumeChange& change, double truth) {
  return std::any_of(change.readings.begin(), change.readings.end(), [&](const Reading& reading) {
    const Measured& k = reading.bulking;
    return std::abs(k.value - truth) <= 2.0 * k.sd + 0.005 * k.value;
  });
}

void take(const DensityEstimate& estimate, Record& record) {
  const VolumeChange& change = estimate.change;
  record.refused = !estimate.bulking;
  record.found = {change.excavated.value, change.spilled.value, change.dumped.value};
  record.trusted = estimate.trustworthy;
  for (const Warning& warning : estimate.warnings) {
    record.codes += (record.codes.empty() ? "" : "+") + warning.code;
  }
  if (!estimate.bulking) return;
  record.k = estimate.bulking->value;
  record.sd = estimate.bulking->sd;
  record.sd_scans = bulking_errors(change).scans;
  record.in_a_reading = in_a_reading(change, record.truth.bulking());
}

Record surveyed(const Family& family, std::uint64_t seed, const Settings& settings,
                const DensityLaw& law) {
  SiteScene scene = site_scene(family, seed, settings.points);
  Record record;
  record.family = family.name;
  record.seed = seed;
  record.truth = scene.truth;
  DensityOptions options;
  options.threads = 1;
  try {
    take(estimate_density(scans_of(scene, seed), law, options), record);
    if (scene.offset_pair) {
      scene.frame_before = scene.frame_after = nullptr;
      const DensityEstimate unmoved = estimate_density(scans_of(scene, seed), law, options);
      if (unmoved.bulking) record.shift = std::abs(record.k - unmoved.bulking->value) / record.sd;
    }
  } catch (const Error& error) {
    record.refused = true;
    record.codes = std::string("refused: ") + error.what();
    std::replace(record.codes.begin(), record.codes.end(), ',', ';');
  }
  return record;
}

constexpr const char* header =
    "family,seed,k_true,k,k_sd,k_sd_scans,error_percent,z,trusted,inside,in_a_reading,refused,"
    "held,wrong,hole_percent,spill_percent,heap_percent,shift,codes\n";

void print(const Record& r) {
  std::printf("%s,%llu,%.5f,%.5f,%.5f,%.5f,%.3f,%.2f,%d,%d,%d,%d,%d,%d,%.3f,%.3f,%.3f,%.3f,%s\n",
              r.family.c_str(), static_cast<unsigned long long>(r.seed), r.truth.bulking(), r.k,
              r.sd, r.sd_scans, r.error(), r.z(), r.trusted ? 1 : 0, r.inside() ? 1 : 0,
              r.in_a_reading ? 1 : 0, r.refused ? 1 : 0, r.held() ? 1 : 0, r.wrong() ? 1 : 0,
              percent(r.found.hole, r.truth.hole), percent(r.found.spill, r.truth.spill),
              percent(r.found.heap, r.truth.heap), r.shift, r.codes.c_str());
}

/// A share of the records [%].
template <typename Test>
double share(const std::vector<Record>& records, const Test& test) {
  const auto count = std::count_if(records.begin(), records.end(), test);
  return 100.0 * static_cast<double>(count) / static_cast<double>(records.size());
}

double median(std::vector<double> values) {
  if (values.empty()) return Record::nan;
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// One line of the table. Of offsets the worst shift is shown behind it.
void print_summary(const std::vector<Record>& records) {
  double sum = 0.0;
  double squares = 0.0;
  double worst_shift = Record::nan;
  std::vector<double> sds;
  for (const Record& r : records) {
    if (r.refused) continue;
    sum += r.error();
    squares += r.error() * r.error();
    sds.push_back(100.0 * r.sd / r.truth.bulking());
    if (!(r.shift <= worst_shift)) worst_shift = std::fmax(r.shift, worst_shift);
  }
  const double answers = static_cast<double>(sds.size());
  const auto wrong_alone = [](const Record& r) { return r.wrong() && !r.in_a_reading; };
  std::printf("%-22s %4zu %9.2f %+9.2f %6.1f %6.1f %6.1f %6.1f %6.1f %8.3f",
              records.front().family.c_str(), records.size(), std::sqrt(squares / answers),
              sum / answers, share(records, [](const Record& r) { return r.held(); }),
              share(records, [](const Record& r) { return r.wrong(); }),
              share(records, wrong_alone),
              share(records, [](const Record& r) { return !r.refused && !r.trusted; }),
              share(records, [](const Record& r) { return r.refused; }), median(sds));
  if (!std::isnan(worst_shift)) std::printf("  worst shift %.2f sd", worst_shift);
  std::printf("\n");
}

std::vector<Family> chosen(const Settings& settings) {
  if (settings.families.empty()) return families();
  std::vector<Family> some;
  for (const std::string& name : settings.families) {
    const auto found = std::find_if(families().begin(), families().end(),
                                    [&](const Family& family) { return family.name == name; });
    if (found == families().end()) throw Error(ErrorKind::bad_input, "no family " + name);
    some.push_back(*found);
  }
  return some;
}

void work(const Settings& settings) {
  const DensityLaw law = load_density_law(find_data_file("laws/paper.json"));
  if (settings.summary) {
    std::printf("%-22s %4s %9s %9s %6s %6s %6s %6s %6s %8s\n", "family", "n", "rms k %", "bias %",
                "held", "wrong", "alone", "untr.", "refus.", "sd %");
  } else {
    std::fputs(header, stdout);
  }
  for (const Family& family : chosen(settings)) {
    std::vector<Record> records(settings.seeds);
    parallel_for(settings.seeds, 0, [&](std::size_t i) {
      records[i] = surveyed(family, settings.first_seed + i, settings, law);
    });
    if (settings.summary) {
      print_summary(records);
    } else {
      for (const Record& record : records) print(record);
    }
    std::fflush(stdout);
  }
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    if (letter == ',') {
      parts.emplace_back();
    } else {
      parts.back() += letter;
    }
  }
  return parts;
}

Settings read(int count, char** words) {
  Settings settings;
  for (int i = 1; i < count; ++i) {
    const std::string option = words[i];
    if (option == "--summary") {
      settings.summary = true;
      continue;
    }
    if (++i == count) throw Error(ErrorKind::bad_input, option + " needs a value");
    const std::string value = words[i];
    if (option == "--family") {
      settings.families = split(value);
    } else if (option == "--seeds") {
      settings.seeds = std::stoul(value);
    } else if (option == "--first-seed") {
      settings.first_seed = std::stoul(value);
    } else if (option == "--points") {
      settings.points = std::stoul(value);
    } else {
      throw Error(ErrorKind::bad_input, option + " is no option of site_surveys");
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
    std::fprintf(stderr, "site_surveys: %s\n", e.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
