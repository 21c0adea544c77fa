// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include <excavplan/base/data_files.hpp>
#include <excavplan/change/bulking.hpp>
#include <excavplan/density/density_estimate.hpp>

#include "base/parallel.hpp"
#include "support/site_scenes.hpp"

/// @file
/// Surveys of scenes with what a site brings, whose volumes are known, from clouds in memory to the
/// density: one line of CSV for each survey, or a table with one line for each family.
///
///     site_surveys [--family NAME[,NAME]] [--seeds N] [--first-seed N] [--points N] [--summary]
///
/// --points is for one cloud. scripts/accuracy makes docs/generated/accuracy.md.

namespace excavplan::scenes {
namespace {

struct Settings {
  std::vector<std::string> families;
  std::uint64_t seeds = 8;
  std::uint64_t first_seed = 70001;
  std::size_t points = 300000;
  bool summary = false;
};

/// Why the answer of a survey holds; `none` where it does not.
enum class Held { none, interval, reading, untrusted };

/// What came of one survey; figures are NaN where there is none.
struct Record {
  std::string family;
  std::uint64_t seed = 0;
  Volumes truth;
  double k = nan;
  double sd = nan;
  double sd_scans = nan;
  std::array<double, 2> interval = {nan, nan};
  Volumes found{nan, nan, nan};
  double shift = nan;  ///< of k in its sd, by an offset of both scans
  bool trusted = false;
  bool has_reason = false;    ///< it is not, by a warning that is right in this family
  bool in_a_reading = false;  ///< of what the family brings
  bool refused = false;
  std::string codes;

  static constexpr double nan = std::numeric_limits<double>::quiet_NaN();

  double error() const { return 100.0 * (k / truth.bulking() - 1.0); }
  double z() const { return (k - truth.bulking()) / sd; }
  bool inside() const { return truth.bulking() >= interval[0] && truth.bulking() <= interval[1]; }
  /// Of the interval, as a share of k and as the sd of a normal distribution.
  double width() const { return (interval[1] - interval[0]) / (2.0 * 1.96); }
  /// Volumes in another unit are wrong even if their ratio is right.
  bool of_right_size() const {
    const double size = found.hole / truth.hole;
    return size > 0.67 && size < 1.5;
  }
  bool wrong() const { return trusted && (std::abs(z()) > 3.0 || !of_right_size()); }
  Held held() const {
    if (!refused && of_right_size() && inside()) return Held::interval;
    if (!refused && in_a_reading) return Held::reading;
    return !trusted && has_reason ? Held::untrusted : Held::none;
  }
};

double percent(double found, double truth) { return 100.0 * (found / truth - 1.0); }

/// Within 2 sd of a reading of what the family brings.
bool in_a_reading(const Family& family, const VolumeChange& change, double truth) {
  const auto is_cause = [&](ChangeKind kind) {
    return std::count(family.causes.begin(), family.causes.end(), kind) > 0;
  };
  return std::any_of(change.readings.begin(), change.readings.end(), [&](const Reading& reading) {
    return std::any_of(reading.kinds.begin(), reading.kinds.end(), is_cause) &&
           std::abs(reading.bulking.value - truth) <= 2.0 * reading.bulking.sd;
  });
}

bool is_reason(const Family& family, const std::string& code) {
  return std::count(family.reasons.begin(), family.reasons.end(), code) > 0;
}

void take(const Family& family, const DensityEstimate& estimate, Record& record) {
  const VolumeChange& change = estimate.change;
  record.refused = !estimate.bulking;
  record.found = {change.excavated.value, change.spilled.value, change.dumped.value};
  record.trusted = estimate.trustworthy;
  for (const Warning& warning : estimate.warnings) {
    record.codes += (record.codes.empty() ? "" : "+") + code_text(warning.code);
    record.has_reason = record.has_reason || is_reason(family, code_text(warning.code));
  }
  if (!estimate.bulking) return;
  record.k = estimate.bulking->value;
  record.sd = estimate.bulking->sd;
  record.sd_scans = bulking_errors(change).scans;
  if (const auto interval = bulking_interval(change)) record.interval = *interval;
  record.in_a_reading = in_a_reading(family, change, record.truth.bulking());
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
    take(family, estimate_density(scans_of(scene, seed), law, options), record);
    if (scene.offset_pair) {
      scene.frame_before = scene.frame_after = nullptr;
      const DensityEstimate unmoved = estimate_density(scans_of(scene, seed), law, options);
      if (unmoved.bulking) record.shift = std::abs(record.k - unmoved.bulking->value) / record.sd;
    }
  } catch (const Error& error) {
    record.refused = true;
    record.has_reason = is_reason(family, "refused");
    record.codes = std::string("refused: ") + error.what();
    std::replace(record.codes.begin(), record.codes.end(), ',', ';');
  }
  return record;
}

constexpr const char* header =
    "family,seed,k_true,k,k_sd,k_sd_scans,k_low,k_high,error_percent,z,trusted,has_reason,inside,"
    "in_a_reading,refused,held,wrong,hole_percent,spill_percent,heap_percent,shift,codes\n";

const char* name(Held held) {
  switch (held) {
    case Held::interval:
      return "interval";
    case Held::reading:
      return "reading";
    case Held::untrusted:
      return "untrusted";
    case Held::none:
      break;
  }
  return "none";
}

void print(const Record& r) {
  std::printf("%s,%llu,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f,%.3f,%.2f,%d,%d,%d,%d,%d,%s,%d,",
              r.family.c_str(), static_cast<unsigned long long>(r.seed), r.truth.bulking(), r.k,
              r.sd, r.sd_scans, r.interval[0], r.interval[1], r.error(), r.z(), r.trusted ? 1 : 0,
              r.has_reason ? 1 : 0, r.inside() ? 1 : 0, r.in_a_reading ? 1 : 0, r.refused ? 1 : 0,
              name(r.held()), r.wrong() ? 1 : 0);
  std::printf("%.3f,%.3f,%.3f,%.3f,%s\n", percent(r.found.hole, r.truth.hole),
              percent(r.found.spill, r.truth.spill), percent(r.found.heap, r.truth.heap), r.shift,
              r.codes.c_str());
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
  std::vector<double> widths;
  for (const Record& r : records) {
    if (r.refused) continue;
    sum += r.error();
    squares += r.error() * r.error();
    sds.push_back(100.0 * r.sd / r.truth.bulking());
    widths.push_back(100.0 * r.width() / r.truth.bulking());
    if (!(r.shift <= worst_shift)) worst_shift = std::fmax(r.shift, worst_shift);
  }
  const double answers = static_cast<double>(sds.size());
  const auto held_by = [&](Held how) {
    return share(records, [&](const Record& r) { return r.held() == how; });
  };
  std::printf("%-18s %4zu %7.2f %+7.2f %7.3f %7.3f", records.front().family.c_str(), records.size(),
              std::sqrt(squares / answers), sum / answers, median(sds), median(widths));
  std::printf(" %6.1f %6.1f %6.1f %6.1f %6.1f", 100.0 - held_by(Held::none),
              held_by(Held::interval), held_by(Held::reading), held_by(Held::untrusted),
              share(records, [](const Record& r) { return r.wrong(); }));
  std::printf(" %6.1f %6.1f",
              share(records, [](const Record& r) { return !r.refused && !r.trusted; }),
              share(records, [](const Record& r) { return r.refused; }));
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
    std::printf("%-18s %4s %7s %7s %7s %7s %6s %6s %6s %6s %6s %6s %6s\n", "family", "n", "rms k %",
                "bias %", "sd %", "width %", "held", "by int", "by rdg", "by unt", "wrong", "untr.",
                "refus.");
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
