// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "efficiency/bucket_content.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <excavplan/change/volume_change.hpp>

#include "base/text.hpp"
#include "ground/too_few_cells.hpp"
#include "scans/point_checks.hpp"
#include "scans/scan_checks.hpp"
#include "scans/scan_pairs.hpp"

namespace excavplan {
namespace {

constexpr double largest_factor = 3.0;  // ours; rock swells to 1.8

[[noreturn]] void refuse_content(const std::string& why) { throw Error(ErrorKind::bad_input, why); }

void check(bool holds, const std::string& what, double value, const char* rule) {
  if (!holds) refuse_content(what + ": " + number_text(value) + ", must be " + rule);
}

Measured stated(const Measured& amount, const std::string& name) {
  const auto [value, sd] = amount;
  check(value > 0.0 && std::isfinite(value), name, value, "above 0");
  check(!(sd < 0.0) && !(sd > value), name + "-sd", sd, "0 or more and at most the amount");
  return amount;
}

Measured product(const Measured& a, const Measured& b) {
  return {a.value * b.value, std::hypot(a.sd * b.value, b.sd * a.value)};
}

Measured ratio(const Measured& a, const Measured& b) {
  const double value = a.value / b.value;
  return {value, value * std::hypot(a.sd / a.value, b.sd / b.value)};
}

std::optional<Measured> factor_of(const LoggedDig& dig) {
  if (!dig.bulking_factor) return std::nullopt;
  const auto [value, sd] = *dig.bulking_factor;
  const std::string name = dig.prefix + "bulking-factor";
  check(value >= 1.0 && value <= largest_factor, name, value, "in 1 .. 3");
  check(sd >= 0.0 && sd <= value, name + ", its standard deviation", sd,
        "0 or more and at most the factor");
  return dig.bulking_factor;
}

Measured needed_factor(const LoggedDig& dig, const char* for_what) {
  if (const auto factor = factor_of(dig)) return *factor;
  refuse_content(dig.prefix + "bulking-factor is missing: " + for_what +
                 " is of undisturbed soil, the bucket holds loose soil");
}

// ---- Scans ------------------------------------------------------------------------------------

/// What two scans of one piece of ground show, and what is doubtful about it.
struct ScannedChange {
  VolumeChange change;
  std::vector<Warning> warnings;
  std::string names;
};

/// @param is_hole  of the dig area; else of the dump area
ScannedChange change_between(const ScanPair& scans, const LoggedDig& dig, bool is_hole) {
  const OutlinedPair seen = outlined(scans, dig.threads);
  ScannedChange result{{}, {}, seen.names()};
  const double cell = dig.cell_size.value_or(seen.cell_size());
  const std::vector<Warning> doubts = check_outlines(seen);
  const SurfacePair surfaces =
      with_doubts(doubts, [&] { return survey_pair(seen, cell, false, dig.threads).surfaces; });
  const HeightMapPair both{surfaces.before.height, surfaces.after.height};
  const HeightMapPair unchanged{both.before, both.before};
  const auto add = [&](const std::vector<Warning>& warnings) {
    const WarningCode expected = is_hole ? WarningCode::no_dumped_soil : WarningCode::no_hole_found;
    for (const Warning& warning : warnings) {
      if (warning.code == expected) continue;
      result.warnings.emplace_back(warning.code, result.names + ": " + warning.message,
                                   warning.ends_trust);
    }
  };
  try {
    result.change = is_hole ? measure_change(both, unchanged) : measure_change(unchanged, both);
    const VolumeChange& change = result.change;
    if (!((is_hole ? change.excavated : change.dumped).value > 0.0)) {
      throw Error(ErrorKind::bad_file, std::string("no ground ") + (is_hole ? "sank" : "rose") +
                                           " by more than the noise of the scans");
    }
    add(doubts);
    add(is_hole ? check_points({&surfaces, nullptr}, change)
                : check_points({nullptr, &surfaces}, change));
    if (!is_hole) add(check_volumes(change, scans.after.unit));
    add(change.warnings);
    return result;
  } catch (const TooFewCells& few) {
    throw few.of_scans(result.names);
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, result.names + ": " + error.what());
  }
}

LiftedSoil from_heap(const ScanPair& scans, const LoggedDig& dig) {
  ScannedChange heap = change_between(scans, dig, false);
  return {{Lifted::volume, heap.change.dumped}, {}, std::move(heap.warnings)};
}

LiftedSoil from_pit(const ScanPair& scans, const LoggedDig& dig) {
  const Measured factor = needed_factor(dig, "the hole");
  ScannedChange pit = change_between(scans, dig, true);
  const Measured loose = product(pit.change.excavated, factor);
  const Measured& spilled = pit.change.spilled;
  const Measured content{loose.value - spilled.value, std::hypot(loose.sd, spilled.sd)};
  if (!(content.value > 0.0)) {
    throw Error(ErrorKind::bad_file,
                pit.names + ": the hole of " + readable(pit.change.excavated.value) + " m3 is " +
                    readable(loose.value) + " m3 of loose soil, and " + readable(spilled.value) +
                    " m3 lie beside it: nothing was lifted");
  }
  return {{Lifted::volume, content}, {}, std::move(pit.warnings)};
}

/// Sum of what rose in the bucket and its error.
struct BucketRise {
  Measured volume;      ///< [m^3]
  double unseen = 0.0;  ///< share of the cells of the scan after that the one before does not show
};

/// The bucket has no part that stays level, so nothing is registered.
BucketRise rise_of(const SurfacePair& surfaces) {
  constexpr double least_rise = 0.02;     // of a cell with soil in it [m]; ours
  constexpr double scanner_bias = 0.005;  // between both scans, over the soil [m]; ours
  const Surface& empty = surfaces.before;
  const Surface& loaded = surfaces.after;
  const double cell_area = empty.height.cell_size * empty.height.cell_size;
  double sum = 0.0;
  double variance = 0.0;
  int cells = 0;
  int seen = 0;
  int seen_twice = 0;
  for (Eigen::Index i = 0; i < loaded.height.z.size(); ++i) {
    const double rise = loaded.height.z(i) - empty.height.z(i);
    seen += std::isfinite(loaded.height.z(i)) ? 1 : 0;
    seen_twice += std::isfinite(rise) ? 1 : 0;
    if (!(std::abs(rise) > least_rise)) continue;
    ++cells;
    sum += rise;
    const double noise = empty.variance(i) + loaded.variance(i);
    if (std::isfinite(noise)) variance += noise;
  }
  const double sd = std::hypot(std::sqrt(variance), scanner_bias * cells);
  return {{cell_area * sum, cell_area * sd}, 1.0 - static_cast<double>(seen_twice) / seen};
}

LiftedSoil from_bucket(const ScanPair& scans, const LoggedDig& dig) {
  constexpr double most_unseen = 0.1;  // ours
  const OutlinedPair seen = outlined(scans, dig.threads);
  const double cell = dig.cell_size.value_or(seen.cell_size());
  const BucketRise rise = rise_of(survey_pair(seen, cell, false, dig.threads).surfaces);
  if (!(rise.volume.value > 0.0)) {
    throw Error(ErrorKind::bad_file, seen.names() + ": the loaded bucket is " +
                                         readable(rise.volume.value) +
                                         " m3 fuller than the empty one, must be above 0");
  }
  LiftedSoil result{{Lifted::volume, rise.volume}, {}, {}};
  if (rise.unseen > most_unseen) {
    result.warnings.emplace_back(
        WarningCode::bucket_partly_unseen,
        seen.names() + ": the scan of the empty bucket does not show " +
            readable(100.0 * rise.unseen, 2) +
            " % of what that of the loaded one does; the soil there is not counted");
  }
  return result;
}

}  // namespace

LiftedSoil lifted_soil(const LoggedDig& dig) {
  LiftedSoil result;
  if (const auto* payload = std::get_if<Payload>(&dig.lifted)) {
    const bool is_mass = payload->kind == Lifted::mass;
    if (is_mass && dig.bulking_factor) {
      refuse_content(dig.prefix +
                     "bulking-factor turns volumes into each other; a mass needs none");
    }
    stated(payload->amount, dig.prefix + (is_mass ? "mass" : "volume"));
    result.payload = *payload;
  } else if (const auto* bank = std::get_if<BankVolume>(&dig.lifted)) {
    const Measured amount = stated(bank->amount, dig.prefix + "bank-volume");
    result.payload = {Lifted::volume, product(amount, needed_factor(dig, "the bank volume"))};
    result.bank_volume = amount;
    return result;
  } else if (const auto* heap = std::get_if<ScanPair>(&dig.lifted)) {
    result = from_heap(*heap, dig);
  } else if (const auto* pit = std::get_if<PitScans>(&dig.lifted)) {
    result = from_pit(pit->scans, dig);
  } else {
    result = from_bucket(std::get<BucketScans>(dig.lifted).scans, dig);
  }
  if (const auto factor = factor_of(dig)) {
    result.bank_volume = ratio(result.payload.amount, *factor);
  }
  return result;
}

}  // namespace excavplan
