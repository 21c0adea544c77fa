// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/open_changes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <excavplan/change/bulking.hpp>

#include "base/text.hpp"
#include "ground/grid_cells.hpp"

namespace excavplan {
namespace {

// All ours.
constexpr double negligible_share = 0.0005;  // of the hole's volume
constexpr double least_stated = 0.03;        // weight of a reading
constexpr double least_single = 0.01;        // and of one that alone shows a change the other way
constexpr std::size_t most_readings = 6;
constexpr std::size_t most_single = 4;
constexpr double farthest = 0.025;       // weight that the covariance leaves out
constexpr double warned = 0.05;          // weight that a 95 % interval may leave out
constexpr double telling_share = 0.03;   // of k: readings that differ by more matter
constexpr double as_likely = 0.35;       // weight of readings that end trust
constexpr double deepest_press = 0.03;   // of the ground under a heap [m]
constexpr double press_share = 0.5;      // of the height seen there, at most
constexpr double pressed_weight = 0.04;  // that it gave way, without ruts that show soft ground
/// Pressure of a heap of half a metre (8 kPa) over that of tracks (some 40 kPa): sinkage in
/// proportion to pressure (Bekker 1969 with n = 1).
constexpr double pressed_to_rut = 0.2;

/// A combination against the one that is given.
struct Alternative {
  const Combination* combination;
  Eigen::Vector3d more;  ///< (hole, spill, heap) [m^3]
  double bulking;        ///< its k; 0 without a hole
};

class OpenChanges {
 public:
  OpenChanges(const std::vector<Area>& areas, const Attribution& attribution, VolumeChange& result)
      : areas_(areas),
        attribution_(attribution),
        result_(result),
        counted_(attribution.combinations.front().counted) {
    for (const Combination& one : attribution.combinations) {
      alternatives_.push_back(alternative(one));
    }
  }

  void state() {
    list();
    add_combinations();
    add_uncombined();
    add_stirred();
    add_pressed_by_ruts();
    state_readings();
    warn_of_readings();
    warn_of_stirred();
  }

 private:
  using Place = Change::Place;

  const std::vector<Change>& changes() const { return attribution_.changes; }
  bool is_negligible(const Change& change) const {
    return std::abs(change.volume) < negligible_share * result_.before.value;
  }

  Eigen::Vector3d role_of(const Change& change) const {
    if (change.volume < 0.0) return Eigen::Vector3d::UnitX();
    const Place& p = change.zones.front();
    const bool is_spill = areas_[p.area].kinds[p.zone] == ZoneKind::spill;
    return is_spill ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  }

  Alternative alternative(const Combination& one) const {
    Eigen::Vector3d more = Eigen::Vector3d::Zero();
    double loose = 0.0;
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      if (one.counted[i] == counted_[i]) continue;
      const double volume = std::abs(changes()[i].volume) * (counted_[i] ? -1.0 : 1.0);
      more += volume * role_of(changes()[i]);
      loose += counted_[i] ? -changes()[i].loose : changes()[i].loose;
    }
    const double before = result_.before.value + more(0) - loose;
    const double after = result_.after.value + more(1) + more(2) - loose;
    return {&one, more, before > 0.0 ? after / before : 0.0};
  }

  // ---- List and covariance --------------------------------------------------------------------

  void list() {
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      const Change& change = changes()[i];
      if ((counted_[i] && change.probability >= certain) || is_negligible(change)) continue;
      double variance = 0.0;
      for (const Place& p : change.zones) {
        const ZoneSum& zone = areas_[p.area].zones[p.zone];
        variance += zone.variance();
      }
      result_.attribution.push_back({change.kind,
                                     change.what,
                                     {change.volume, std::sqrt(variance)},
                                     counted_[i],
                                     change.probability});
    }
  }

  void add_combinations() {
    std::vector<Alternative> by_distance = alternatives_;
    const double given = alternatives_.front().bulking;
    std::stable_sort(by_distance.begin(), by_distance.end(),
                     [&](const Alternative& a, const Alternative& b) {
                       return std::abs(a.bulking - given) > std::abs(b.bulking - given);
                     });
    double left_out = farthest;
    for (const Alternative& one : by_distance) {
      const double weight = std::max(0.0, one.combination->weight - left_out);
      left_out = std::max(0.0, left_out - one.combination->weight);
      result_.errors.attribution += weight * one.more * one.more.transpose();
    }
  }

  /// What is open beyond those that are combined keeps the probability of its shape.
  void add_uncombined() {
    const std::vector<std::size_t> combined = combined_changes(changes());
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      const Change& change = changes()[i];
      if (!change.is_open() || is_negligible(change)) continue;
      if (std::find(combined.begin(), combined.end(), i) != combined.end()) continue;
      const Eigen::Vector3d volume = std::abs(change.volume) * role_of(change);
      const double open = counted_[i] ? 1.0 - change.probability : change.probability;
      result_.errors.attribution += open * volume * volume.transpose();
    }
  }

  /// Variance of counted zones that lie in stirred ground.
  void add_stirred() {
    for (const Area& area : areas_) {
      for (std::size_t z = 0; z < area.zones.size(); ++z) {
        const double variance = area.parts.stirred[z] * area.zones[z].area;
        Eigen::Matrix3d& covariance = result_.errors.attribution;
        if (area.kinds[z] == ZoneKind::dig) covariance(0, 0) += variance;
        if (area.kinds[z] == ZoneKind::spill) covariance(1, 1) += variance;
        if (area.kinds[z] == ZoneKind::dump) covariance(2, 2) += variance;
      }
    }
  }

  // ---- Ground under the heap ------------------------------------------------------------------

  /// What of the heap is hidden where the ground under it gave way by a depth [m^3]. The zone of
  /// the heap is wider than the heap, by what noise may hide of its foot.
  double hidden_by_press(double depth) const {
    constexpr double least = 0.01;  // ours: what counts as covered [m]
    double hidden = 0.0;
    for (const Area& area : areas_) {
      for_each_cell(area.ground.zone, [&](Cell at) {
        const int zone = area.ground.zone(at.row, at.col);
        if (zone < 0 || area.kinds[static_cast<std::size_t>(zone)] != ZoneKind::dump) return;
        const double d = area.ground.difference(at.row, at.col);
        if (d < std::max(least, area.ground.noise_sd)) return;
        hidden += std::min(depth, press_share * d) * area.grid.cell_size * area.grid.cell_size;
      });
    }
    return hidden;
  }

  /// Ruts show how soft the ground is.
  void add_pressed_by_ruts() {
    double volume = 0.0;
    double area = 0.0;
    for (const Change& change : changes()) {
      if (change.kind != ChangeKind::ruts) continue;
      volume -= change.volume;
      for (const Place& p : change.zones) area += areas_[p.area].zones[p.zone].area;
    }
    if (!(area > 0.0)) return;
    const double hidden = hidden_by_press(pressed_to_rut * volume / area);
    result_.errors.attribution(2, 2) += hidden * hidden;
  }

  /// Ground under the heap that gave way hides part of the heap: all of an even range.
  std::optional<AttributedChange> pressed_ground() const {
    const double most = hidden_by_press(deepest_press);
    if (!(most > 0.0)) return std::nullopt;
    return AttributedChange{ChangeKind::pressed,
                            "ground under the heap, if it gave way by up to " +
                                number_text(100.0 * deepest_press) + " cm: no scan shows it",
                            {0.5 * most, most / 3.0},
                            false,
                            pressed_weight};
  }

  // ---- Readings -------------------------------------------------------------------------------

  Reading reading_of(const Alternative& one, double sd) const {
    Reading reading{{}, "", one.combination->weight, {one.bulking, sd}};
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      if (one.combination->counted[i] == counted_[i]) continue;
      reading.kinds.push_back(changes()[i].kind);
      reading.what += (reading.what.empty() ? "" : ", ") +
                      std::string(counted_[i] ? "without " : "with ") + changes()[i].what;
    }
    if (reading.kinds.empty()) reading.what = "as counted";
    return reading;
  }

  /// The likeliest combinations, and of each change that would move k by more than the scans' error
  /// one that has it the other way.
  std::vector<Alternative> stated(double sd) const {
    std::vector<Alternative> readings;
    std::vector<bool> shown(counted_.size(), false);
    const auto add = [&](const Alternative& one) {
      if (!(one.bulking > 0.0)) return;  // no dig is like that
      readings.push_back(one);
      for (std::size_t i = 0; i < shown.size(); ++i) {
        shown[i] = shown[i] || one.combination->counted[i] != counted_[i];
      }
    };
    for (const Alternative& one : alternatives_) {
      if (one.combination->weight >= least_stated && readings.size() < most_readings) add(one);
    }
    const double given = alternatives_.front().bulking;
    for (const Alternative& one : alternatives_) {
      if (one.combination->weight < least_single) break;
      if (readings.size() == most_readings + most_single) break;
      bool is_new = false;
      for (std::size_t i = 0; i < shown.size(); ++i) {
        is_new = is_new || (!shown[i] && one.combination->counted[i] != counted_[i]);
      }
      if (is_new && std::abs(one.bulking - given) > sd) add(one);
    }
    return readings;
  }

  void state_readings() {
    if (!bulking_factor(result_)) return;
    const double sd = bulking_errors(result_).scans;
    for (const Alternative& one : stated(sd)) result_.readings.push_back(reading_of(one, sd));
    if (const auto pressed = pressed_ground()) {
      const double hole = result_.before.value;
      result_.attribution.push_back(*pressed);
      result_.readings.push_back({{ChangeKind::pressed},
                                  "with " + pressed->what,
                                  pressed->probability,
                                  {alternatives_.front().bulking + pressed->volume.value / hole,
                                   std::hypot(sd, pressed->volume.sd / hole)}});
    }
    double weight = 0.0;
    for (const Reading& reading : result_.readings) weight += reading.weight;
    for (Reading& reading : result_.readings) reading.weight /= weight;
  }

  // ---- Warnings -------------------------------------------------------------------------------

  void warn_of_readings() {
    if (result_.readings.empty()) return;
    const Reading& given = result_.readings.front();
    double other = 0.0;
    const Reading* likeliest = nullptr;
    for (const Reading& reading : result_.readings) {
      const double off = std::abs(reading.bulking.value - given.bulking.value);
      if (is_unseen(reading) || off < telling_share * given.bulking.value) continue;
      other += reading.weight;
      if (likeliest == nullptr) likeliest = &reading;
    }
    if (other < warned) return;
    result_.warnings.emplace_back(
        WarningCode::attribution_open,
        "the scene can be read in more than one way: the bulking factor is " +
            hundredths(given.bulking.value) + " as counted, and " +
            hundredths(likeliest->bulking.value) + " " + likeliest->what + " (weights " +
            hundredths(given.weight) + " and " + hundredths(likeliest->weight) +
            "): tell which changes belong to the dig with `dig_area` and `dump_area`",
        other > as_likely);
  }

  void warn_of_stirred() {
    const auto k = bulking_factor(result_);
    const bool found = std::any_of(changes().begin(), changes().end(), [](const Change& change) {
      return change.kind == ChangeKind::stirred;
    });
    if (!found || !k) return;
    const bool is_large = bulking_errors(result_).attribution > telling_share * k->value;
    result_.warnings.emplace_back(
        WarningCode::stirred_ground,
        "ground rose and fell in many small places: it was stirred, by tracks or a blade, and "
        "counts as noise; scan where nothing drove, or give `dig_area` and `dump_area`",
        is_large);
  }

  const std::vector<Area>& areas_;
  const Attribution& attribution_;
  VolumeChange& result_;
  const std::vector<bool>& counted_;
  std::vector<Alternative> alternatives_;  // as the combinations, the one that is given first
};

}  // namespace

void state_open_changes(const std::vector<Area>& areas, const Attribution& attribution,
                        VolumeChange& result) {
  if (!attribution.changes.empty()) OpenChanges(areas, attribution, result).state();
}

}  // namespace excavplan
