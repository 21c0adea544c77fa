// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "ground/attribution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <excavplan/ground/bulking.hpp>

#include "base/text.hpp"
#include "ground/error_field.hpp"
#include "ground/grid_cells.hpp"
#include "ground/robust.hpp"
#include "ground/zone_shape.hpp"

namespace excavplan {
namespace {

// ---- What the shapes and places of changes tell: all ours -------------------------------------

/// Probability that a change belongs to the dig, by what it looks like.
namespace prior {
constexpr double certain = 0.98;        // the main heap, spill beside the hole, a given area
constexpr double main_hole = 0.9;       // the largest: another may fit the soil better
constexpr double beside_main = 0.96;    // of the same kind as the hole or heap that it lies beside
constexpr double second = 0.85;         // a hole or a heap away from the largest
constexpr double along_swing = 0.9;     // clods between hole and heap
constexpr double low_edge = 0.9;        // ground that runs out, thinner and thinner
constexpr double steep_in_swing = 0.7;  // small, and steeper than loose soil
constexpr double anywhere = 0.5;        // small or low and in no place that tells
constexpr double doubtful = 0.3;        // what the error of its volume explains
constexpr double shallow_fall = 0.15;   // ground that sank by far less than the hole is deep
constexpr double no_soil = 0.03;        // ruts and their berms, things, outside a given area
}  // namespace prior

constexpr double highest_lone_track = 0.05;  // one deeper than this is no rut [m]
constexpr double highest_berm = 0.10;        // [m]
constexpr double lasting_track = 0.6;        // a tail that keeps this share of its depth is one
constexpr double berm_reach = 0.6;           // from a rut [m]
constexpr double berm_share = 0.6;           // of its cells that lie there
constexpr double upright = 1.3;              // slope that no loose soil has: 52 degrees
constexpr double least_upright = 0.12;       // height of a thing [m]
constexpr double largest_upright = 0.25;     // of the hole's volume
constexpr double small_share = 0.03;         // of the hole's volume: a clod, a blemish
constexpr double shallow = 0.03;             // what feet, tracks and settling do [m]
constexpr double shallow_share = 0.2;        // of the hole's height
constexpr double swing_bulge = 1.25;         // ellipse about hole and heap
constexpr double swing_room = 0.5;           // [m]
constexpr double negligible = 0.0005;        // of the hole's volume
constexpr std::size_t most_open = 10;        // changes that are combined
constexpr double least_stated = 0.03;        // weight of a reading
constexpr std::size_t most_readings = 6;
constexpr double left_out = 0.05;         // what a 95 % interval may leave out
constexpr double inside_interval = 0.27;  // variance share that takes a change in: 1 / 1.96^2
constexpr double telling = 0.03;          // of k: readings that differ by more matter
constexpr double as_likely = 0.35;        // weight of readings that end trust
constexpr double pressed_depth = 0.01;    // of the ground under a heap, if it gave way [m]
constexpr double pressed_weight = 0.04;   // that it did, without ruts that show soft ground
/// Pressure of a heap of half a metre (8 kPa) over that of tracks (some 40 kPa): sinkage in
/// proportion to pressure (Bekker 1969 with n = 1).
constexpr double pressed_to_rut = 0.2;

/// Likelihood of a bulking factor in any soil: even from 1.02 to 1.65 (docs/methods.md#bulking).
double likelihood_of_bulking(double k) {
  constexpr double least = 1.02, least_sd = 0.04, most = 1.65, most_sd = 0.08, never = 1e-3;
  const double off = k < least ? (least - k) / least_sd : k > most ? (k - most) / most_sd : 0.0;
  return never + (1.0 - never) * std::exp(-0.5 * off * off);
}

std::string hundredths(double value) { return number_text(std::round(value * 100.0) / 100.0); }

/// Mean |D| of the far half of a tail over that of its near half, by distance from its parent.
double lasting_of(const Area& area, std::size_t tail, const std::vector<Cell>& cells) {
  const Eigen::ArrayXXd away = distance_to(area.ground.zone == area.parts.parent[tail]);
  std::vector<double> distances;
  for (const Cell at : cells) distances.push_back(away(at.row, at.col));
  std::vector<double> sorted = distances;
  const double middle = median(sorted);
  std::array<double, 2> sums = {0.0, 0.0};
  std::array<double, 2> counts = {0.0, 0.0};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t half = distances[i] > middle ? 1 : 0;
    sums[half] += std::abs(area.ground.difference(cells[i].row, cells[i].col));
    counts[half] += 1.0;
  }
  return counts[1] > 0.0 && sums[0] > 0.0 ? sums[1] / counts[1] / (sums[0] / counts[0]) : 1.0;
}

/// The zones of an area as the attribution sees them.
struct Look {
  std::vector<Cell> cells;
  ZoneShape shape;
  double lasting = 1.0;  ///< lasting_of() a tail
};

std::vector<Look> looks_of(const Area& area) {
  std::vector<Look> looks;
  for (std::vector<Cell>& cells : cells_of(area.ground)) {
    const std::size_t i = looks.size();
    Look look{std::move(cells), {}};
    look.shape = shape_of(area.ground.difference, look.cells, area.grid.cell_size);
    if (area.parts.part[i] == Part::tail && !look.cells.empty()) {
      look.lasting = lasting_of(area, i, look.cells);
    }
    looks.push_back(std::move(look));
  }
  return looks;
}

/// Finds the changes of a scene.
class ChangeReader {
 public:
  ChangeReader(std::vector<Area>& areas, const ChangeOptions& options)
      : areas_(areas), options_(options) {
    for (const Area& area : areas) looks_.push_back(looks_of(area));
    hole_ = largest(0, -1.0);
    if (hole_) mark_beside();
    heap_ = largest(areas.size() - 1, 1.0);
    if (heap_) beside_heap_ = near(*heap_);
  }

  std::vector<Change> read() {
    if (!hole_ && areas_.size() == 1) return {};
    find_ruts();
    for (std::size_t a = 0; a < areas_.size(); ++a) {
      for (std::size_t z = 0; z < areas_[a].zones.size(); ++z) {
        if (areas_[a].zones[z].area > 0.0 && areas_[a].zones[z].volume != 0.0) add({a, z});
      }
    }
    return std::move(changes_);
  }

 private:
  using Place = Change::Place;

  const ZoneSum& zone(Place p) const { return areas_[p.area].zones[p.zone]; }
  const ZoneShape& shape(Place p) const { return looks_[p.area][p.zone].shape; }
  Part part(Place p) const { return areas_[p.area].parts.part[p.zone]; }
  bool is(Place p, const std::optional<Place>& other) const {
    return other && p.area == other->area && p.zone == other->zone;
  }
  double hole_volume() const { return hole_ ? -zone(*hole_).volume : 0.0; }

  const std::optional<Rectangle>& given(double sign) const {
    return sign < 0.0 ? options_.dig_area : options_.dump_area;
  }
  double sign_of(Place p) const { return zone(p).volume < 0.0 ? -1.0 : 1.0; }
  bool in_given(Place p, double sign) const {
    return !given(sign) || given(sign)->contains(zone(p).centre.x(), zone(p).centre.y());
  }

  /// Lies in an area that was given for what it is.
  bool is_told(Place p) const { return given(sign_of(p)) && in_given(p, sign_of(p)); }

  /// The largest zone of a sign; of those that rose, one away from the hole.
  std::optional<Place> largest(std::size_t area, double sign) const {
    std::optional<Place> found;
    for (std::size_t z = 0; z < areas_[area].zones.size(); ++z) {
      const Place p{area, z};
      const bool is_candidate = sign * zone(p).volume > 0.0 && in_given(p, sign) &&
                                (sign < 0.0 || areas_.size() > 1 || given(sign) || !beside(p));
      if (is_candidate && (!found || sign * zone(p).volume > sign * zone(*found).volume)) found = p;
    }
    return found;
  }

  std::vector<bool> near(Place p) const {
    std::vector<bool> one(areas_[p.area].zones.size(), false);
    one[p.zone] = true;
    return zones_near(areas_[p.area].ground.zone, one,
                      options_.spill_distance / areas_[p.area].grid.cell_size);
  }
  /// Marks what lies beside the hole, and beside other falls that may be holes too.
  void mark_beside() {
    beside_ = near(*hole_);
    beside_others_.assign(beside_.size(), false);
    for (std::size_t z = 0; z < beside_.size(); ++z) {
      if (!(-areas_[0].zones[z].volume > small_share * hole_volume())) continue;
      const std::vector<bool> around = near({0, z});
      for (std::size_t i = 0; i < around.size(); ++i) {
        beside_others_[i] = beside_others_[i] || around[i];
      }
    }
  }
  bool beside(Place p) const { return p.area == 0 && !beside_.empty() && beside_[p.zone]; }

  // ---- Tracks ---------------------------------------------------------------------------------

  bool looks_like_track(Place p) const {
    if (is(p, hole_) || is(p, heap_) || part(p) == Part::churn || is_told(p)) return false;
    return shape(p).is_track_wide() && looks_[p.area][p.zone].lasting > lasting_track &&
           (has_twin(p) || (shape(p).is_strip() && shape(p).height < highest_lone_track));
  }

  bool has_twin(Place p) const {
    for (std::size_t z = 0; z < looks_[p.area].size(); ++z) {
      const Place other{p.area, z};
      if (z != p.zone && part(other) != Part::churn && zone(other).volume * zone(p).volume > 0.0 &&
          !is(other, hole_) && !is(other, heap_) && shape(p).is_twin_of(shape(other))) {
        return true;
      }
    }
    return false;
  }

  void find_ruts() {
    for (std::size_t a = 0; a < areas_.size(); ++a) {
      is_rut_.emplace_back(areas_[a].zones.size(), false);
      Mask ruts = Mask::Constant(areas_[a].ground.zone.rows(), areas_[a].ground.zone.cols(), false);
      for (std::size_t z = 0; z < areas_[a].zones.size(); ++z) {
        const Place p{a, z};
        is_rut_[a][z] =
            zone(p).volume < 0.0 && looks_like_track(p) && shape(p).height < 0.5 * hole_height();
        if (is_rut_[a][z]) ruts = ruts || areas_[a].ground.zone == static_cast<int>(z);
      }
      away_from_ruts_.push_back(distance_to(ruts) * areas_[a].grid.cell_size);
    }
  }
  double hole_height() const { return hole_ ? shape(*hole_).height : 0.0; }

  bool lies_along_ruts(Place p) const {
    double cells = 0.0;
    double near = 0.0;
    for (const Cell at : looks_[p.area][p.zone].cells) {
      cells += 1.0;
      near += away_from_ruts_[p.area](at.row, at.col) < berm_reach ? 1.0 : 0.0;
    }
    return near > berm_share * cells;
  }

  bool is_berm(Place p) const {
    const ZoneShape& s = shape(p);
    if (s.height > highest_berm || is(p, heap_)) return false;
    if (part(p) == Part::tail && looks_like_track(p) && !beside(p)) return true;
    return lies_along_ruts(p) && (s.is_strip() || part(p) == Part::tail);
  }

  // ---- What a change looks like ---------------------------------------------------------------

  struct Meaning {
    std::string what;
    double prior;
    bool is_group;  ///< all that look like this are one change
  };

  Meaning meaning_of(Place p) const {
    const bool fell = zone(p).volume < 0.0;
    if (part(p) == Part::churn) return {"stirred ground", prior::no_soil, true};
    if (!in_given(p, fell ? -1.0 : 1.0) && (fell || !beside(p))) {
      return {"ground outside the given area", prior::no_soil, true};
    }
    if (is_told(p) && !is(p, hole_) && !is(p, heap_)) return told(fell);
    if (is_within_error(p)) return {"changes within their error", prior::doubtful, true};
    return fell ? meaning_of_fall(p) : meaning_of_rise(p);
  }

  static Meaning told(bool fell) {
    return {fell ? "a hole in the given area" : "a heap in the given area", prior::certain, false};
  }

  /// Not known to have changed at all: filled where it was not seen, or at a step in both scans.
  bool is_within_error(Place p) const {
    constexpr double established = 2.0;  // sd; ours
    const ZoneErrors& errors = areas_[p.area].errors;
    const auto i = static_cast<Eigen::Index>(p.zone);
    const double variance = zone(p).noise + zone(p).holes + zone(p).faces +
                            errors.correlated(i, i) + errors.datum(i, i);
    return !is(p, hole_) && !is(p, heap_) &&
           std::abs(zone(p).volume) < established * std::sqrt(variance);
  }

  /// Of a tail that is no track: soil thins out, something else beside it does not.
  double edge_prior(Place p) const {
    return looks_[p.area][p.zone].lasting > lasting_track ? prior::low_edge : prior::certain;
  }

  Meaning meaning_of_fall(Place p) const {
    if (areas_.size() > 1 && p.area == 1) {
      return {"ground that fell in the dump area", prior::no_soil, true};
    }
    if (is(p, hole_)) return {"the hole", given(-1.0) ? prior::certain : prior::main_hole, false};
    if (is_rut_[p.area][p.zone]) return {"ruts", prior::no_soil, true};
    if (part(p) == Part::tail) return {"the low edge of a hole", edge_prior(p), false};
    if (beside(p)) return {"a hole beside the largest", prior::beside_main, false};
    const bool is_shallow = shape(p).height < std::min(shallow, shallow_share * hole_height());
    if (is_shallow) return {"ground that fell a little", prior::shallow_fall, false};
    if (-zone(p).volume < small_share * hole_volume()) {
      return {"a small hole", prior::anywhere, false};
    }
    return {"a second hole", prior::second, false};
  }

  Meaning meaning_of_rise(Place p) const {
    if (is(p, heap_)) return {"the heap", prior::certain, false};
    if (is_berm(p)) return {"berms of tracks", prior::no_soil, true};
    const bool is_small = zone(p).volume < small_share * hole_volume();
    const bool is_thing = shape(p).steepest > upright && shape(p).height > least_upright &&
                          zone(p).volume < largest_upright * hole_volume();
    if (is_thing && !beside(p)) return meaning_of_thing(p);
    if (beside(p)) return {"spill beside the hole", prior::certain, true};
    if (part(p) == Part::tail) return {"the low edge of a heap", edge_prior(p), false};
    if (heap_ && p.area == heap_->area && beside_heap_[p.zone]) {
      return {"soil beside the heap", prior::beside_main, false};
    }
    if (p.area == 0 && !beside_others_.empty() && beside_others_[p.zone]) {
      return {"spill beside another hole", prior::beside_main, true};
    }
    if (is_small && in_swing(p)) return {"clods along the swing", prior::along_swing, true};
    if (is_small) return {"small rises", prior::anywhere, true};
    if (areas_.size() > 1 && p.area == 0) {
      return {"a rise in the dig area", prior::anywhere, false};
    }
    return {"a second heap", prior::second, false};
  }

  /// A few clods that fell together are as steep as a thing.
  Meaning meaning_of_thing(Place p) const {
    const bool could_be_clods = zone(p).volume < 2.0 * small_share * hole_volume() && in_swing(p);
    if (could_be_clods) return {"clods together, or a thing,", prior::steep_in_swing, false};
    return {"a thing that is no soil", prior::no_soil, false};
  }

  /// Between the hole and the heap, as the bucket goes.
  bool in_swing(Place p) const {
    if (areas_.size() > 1) return true;
    if (!hole_ || !heap_) return false;
    const Eigen::Vector2d at = zone(p).centre;
    const Eigen::Vector2d from = zone(*hole_).centre;
    const Eigen::Vector2d to = zone(*heap_).centre;
    return (at - from).norm() + (at - to).norm() < swing_bulge * (from - to).norm() + swing_room;
  }

  void add(Place p) {
    Meaning meaning = meaning_of(p);
    const double volume = zone(p).volume;
    if (meaning.is_group) {
      for (Change& change : changes_) {
        if (change.what != meaning.what || (change.volume > 0.0) != (volume > 0.0)) continue;
        change.zones.push_back(p);
        change.volume += volume;
        return;
      }
    } else if (meaning.prior < prior::certain && !is(p, hole_)) {
      meaning.what += " around (" + hundredths(zone(p).centre.x()) + ", " +
                      hundredths(zone(p).centre.y()) + ") m";
    }
    changes_.push_back({meaning.what, {p}, volume, meaning.prior, meaning.prior});
  }

  std::vector<Area>& areas_;
  const ChangeOptions& options_;
  std::vector<std::vector<Look>> looks_;
  std::optional<Change::Place> hole_;
  std::optional<Change::Place> heap_;
  std::vector<bool> beside_;
  std::vector<bool> beside_others_;
  std::vector<bool> beside_heap_;
  std::vector<std::vector<bool>> is_rut_;
  std::vector<Eigen::ArrayXXd> away_from_ruts_;  // of each area [m]
  std::vector<Change> changes_;
};

// ---- The balance of the soil ------------------------------------------------------------------

/// Indices of the changes that are open, largest first.
std::vector<std::size_t> open_changes(const std::vector<Change>& changes) {
  double hole = 0.0;
  for (const Change& change : changes) hole = std::max(hole, -change.volume);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const Change& change = changes[i];
    if (change.prior >= prior::certain || change.prior <= prior::no_soil) continue;
    if (std::abs(change.volume) > negligible * hole) open.push_back(i);
  }
  std::stable_sort(open.begin(), open.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(changes[a].volume) > std::abs(changes[b].volume);
  });
  if (open.size() > most_open) open.resize(most_open);
  return open;
}

/// How well the soil of some changes balances; 0 without a hole that could be the dig.
double likelihood_of(const std::vector<Change>& changes, const std::vector<bool>& counted) {
  constexpr double least_hole = 0.3;  // of the largest fall; ours
  double before = 0.0;
  double after = 0.0;
  double largest = 0.0;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (changes[i].prior >= 0.5) largest = std::max(largest, -changes[i].volume);
    if (counted[i]) (changes[i].volume < 0.0 ? before : after) += std::abs(changes[i].volume);
  }
  if (largest == 0.0) return 1.0;
  return before > least_hole * largest ? likelihood_of_bulking(after / before) : 0.0;
}

/// All combinations of what is open, each as likely as its shapes, places and bulking factor.
std::vector<Combination> combinations_of(const std::vector<Change>& changes) {
  const std::vector<std::size_t> open = open_changes(changes);
  Combination base;
  for (const Change& change : changes) base.counted.push_back(change.prior >= 0.5);
  std::vector<Combination> all;
  double sum = 0.0;
  for (std::size_t set = 0; set < std::size_t{1} << open.size(); ++set) {
    Combination one = base;
    one.weight = 1.0;
    for (std::size_t bit = 0; bit < open.size(); ++bit) {
      const bool counted = (set >> bit & 1U) != 0;
      const double p = changes[open[bit]].prior;
      one.counted[open[bit]] = counted;
      one.weight *= counted ? p : 1.0 - p;
    }
    one.weight *= likelihood_of(changes, one.counted);
    sum += one.weight;
    if (one.weight > 0.0) all.push_back(std::move(one));
  }
  if (all.empty()) {
    base.weight = sum = 1.0;
    all.push_back(base);
  }
  for (Combination& one : all) one.weight /= sum;
  std::stable_sort(all.begin(), all.end(),
                   [](const Combination& a, const Combination& b) { return a.weight > b.weight; });
  return all;
}

void weigh_changes(Attribution& attribution) {
  for (const std::size_t i : open_changes(attribution.changes)) {
    double& probability = attribution.changes[i].probability;
    probability = 0.0;
    for (const Combination& one : attribution.combinations) {
      probability += one.counted[i] ? one.weight : 0.0;
    }
  }
}

// ---- Kinds of the zones -----------------------------------------------------------------------

using Chosen = std::vector<bool>;

Chosen zones_of_kind(const Area& area, ZoneKind kind) {
  Chosen chosen(area.zones.size());
  for (std::size_t z = 0; z < chosen.size(); ++z) chosen[z] = area.kinds[z] == kind;
  return chosen;
}

double volume_of_kind(const Area& area, ZoneKind kind) {
  double volume = 0.0;
  for (std::size_t z = 0; z < area.zones.size(); ++z) {
    if (area.kinds[z] == kind) volume += area.zones[z].volume;
  }
  return volume;
}

/// Where nothing rose away from the hole, but the largest rise beside it could hold the dug soil,
/// that is the heap.
void find_heap_beside(Area& area) {
  if (volume_of_kind(area, ZoneKind::dump) > 0.0) return;
  std::size_t largest = area.zones.size();
  for (std::size_t z = 0; z < area.zones.size(); ++z) {
    if (area.kinds[z] != ZoneKind::spill) continue;
    if (largest == area.zones.size() || area.zones[z].volume > area.zones[largest].volume) {
      largest = z;
    }
  }
  if (largest == area.zones.size()) return;
  const double hole = -volume_of_kind(area, ZoneKind::dig);
  if (area.zones[largest].volume >= least_after_share * hole) area.kinds[largest] = ZoneKind::dump;
}

void set_kinds(std::vector<Area>& areas, const Attribution& attribution,
               const ChangeOptions& options) {
  if (attribution.combinations.empty()) return;
  const std::vector<bool>& counted = attribution.combinations.front().counted;
  const auto for_each_counted = [&](auto visit) {
    for (std::size_t i = 0; i < counted.size(); ++i) {
      if (!counted[i]) continue;
      for (const Change::Place& p : attribution.changes[i].zones) visit(areas[p.area], p.zone);
    }
  };
  for_each_counted([&](Area& area, std::size_t z) {
    if (area.zones[z].volume < 0.0) area.kinds[z] = ZoneKind::dig;
  });
  const Chosen beside = zones_near(areas[0].ground.zone, zones_of_kind(areas[0], ZoneKind::dig),
                                   options.spill_distance / areas[0].grid.cell_size);
  for_each_counted([&](Area& area, std::size_t z) {
    if (area.zones[z].volume < 0.0) return;
    const Eigen::Vector2d& at = area.zones[z].centre;
    const bool is_dumped = &area != areas.data() || !beside[z] ||
                           (options.dump_area && options.dump_area->contains(at.x(), at.y()));
    area.kinds[z] = is_dumped ? ZoneKind::dump : ZoneKind::spill;
  });
  if (areas.size() == 1 && !options.dump_area) find_heap_beside(areas[0]);
}

// ---- What is open -----------------------------------------------------------------------------

/// Bulking factor of a combination, from the volumes of the result.
double bulking_of(const Attribution& attribution, const Combination& one,
                  const VolumeChange& result) {
  double before = result.before.value;
  double after = result.after.value;
  const std::vector<bool>& given = attribution.combinations.front().counted;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (one.counted[i] == given[i]) continue;
    const double volume = attribution.changes[i].volume * (given[i] ? -1.0 : 1.0);
    (attribution.changes[i].volume < 0.0 ? before : after) +=
        attribution.changes[i].volume < 0.0 ? -volume : volume;
  }
  return before > 0.0 ? after / before : 0.0;
}

std::string text_of(const Attribution& attribution, const Combination& one) {
  const std::vector<bool>& given = attribution.combinations.front().counted;
  std::string text;
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (one.counted[i] == given[i]) continue;
    text += (text.empty() ? "" : ", ") + std::string(given[i] ? "without " : "with ") +
            attribution.changes[i].what;
  }
  return text.empty() ? "as counted" : text;
}

Eigen::Vector3d role_of(const std::vector<Area>& areas, const Change& change) {
  if (change.volume < 0.0) return Eigen::Vector3d::UnitX();
  const Change::Place& p = change.zones.front();
  const bool is_spill = areas[p.area].kinds[p.zone] == ZoneKind::spill;
  return is_spill ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
}

void list_changes(const std::vector<Area>& areas, const Attribution& attribution,
                  VolumeChange& result) {
  const std::vector<bool>& given = attribution.combinations.front().counted;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const Change& change = attribution.changes[i];
    const bool is_certain = given[i] && change.prior >= prior::certain;
    if (is_certain || std::abs(change.volume) < negligible * result.before.value) continue;
    if (given[i] && change.probability >= prior::certain) continue;
    double variance = 0.0;
    for (const Change::Place& p : change.zones) {
      const ZoneSum& zone = areas[p.area].zones[p.zone];
      variance += zone.noise + zone.holes + zone.faces;
    }
    result.attribution.push_back(
        {change.what, {change.volume, std::sqrt(variance)}, given[i], change.probability});
    const double open = given[i] ? 1.0 - change.probability : change.probability;
    if (open < left_out) continue;
    const Eigen::Vector3d volume = std::abs(change.volume) * role_of(areas, change);
    result.errors.attribution += std::max(open, inside_interval) * volume * volume.transpose();
  }
}

/// Variance of counted zones that lie in stirred ground.
void add_stirred(const std::vector<Area>& areas, VolumeChange& result) {
  for (const Area& area : areas) {
    for (std::size_t z = 0; z < area.zones.size(); ++z) {
      const double variance = area.parts.stirred[z] * area.zones[z].area;
      if (area.kinds[z] == ZoneKind::dig) result.errors.attribution(0, 0) += variance;
      if (area.kinds[z] == ZoneKind::spill) result.errors.attribution(1, 1) += variance;
      if (area.kinds[z] == ZoneKind::dump) result.errors.attribution(2, 2) += variance;
    }
  }
}

/// Ground that the heap covers [m^2]; its zone is wider by what noise may hide of its foot.
double covered_by_heap(const std::vector<Area>& areas) {
  constexpr double least = 0.01;  // ours: what counts as covered [m]
  double covered = 0.0;
  for (const Area& area : areas) {
    for_each_cell(area.ground.zone, [&](Cell at) {
      const int zone = area.ground.zone(at.row, at.col);
      if (zone < 0 || area.kinds[static_cast<std::size_t>(zone)] != ZoneKind::dump) return;
      if (area.ground.difference(at.row, at.col) < std::max(least, area.ground.noise_sd)) return;
      covered += area.grid.cell_size * area.grid.cell_size;
    });
  }
  return covered;
}

/// Ground under the heap that gave way hides part of the heap.
std::optional<AttributedChange> pressed_ground(const std::vector<Area>& areas,
                                               const Attribution& attribution,
                                               VolumeChange& result) {
  const double heap = covered_by_heap(areas);
  if (!(heap > 0.0)) return std::nullopt;
  double rut_volume = 0.0;
  double rut_area = 0.0;
  for (const Change& change : attribution.changes) {
    if (change.what != "ruts") continue;
    for (const Change::Place& p : change.zones) {
      rut_volume -= areas[p.area].zones[p.zone].volume;
      rut_area += areas[p.area].zones[p.zone].area;
    }
  }
  const double shown = rut_area > 0.0 ? pressed_to_rut * rut_volume / rut_area : 0.0;
  result.errors.attribution(2, 2) += std::pow(shown * heap, 2);
  return AttributedChange{"ground under the heap, if it gave way by " +
                              number_text(100.0 * pressed_depth) + " cm: no scan shows it",
                          {pressed_depth * heap, 0.5 * pressed_depth * heap},
                          false,
                          pressed_weight};
}

void state_readings(const Attribution& attribution, const std::optional<AttributedChange>& pressed,
                    VolumeChange& result) {
  const auto k = bulking_factor(result);
  if (!k) return;
  const double sd = bulking_errors(result).scans;
  double weight = 0.0;
  for (const Combination& one : attribution.combinations) {
    if (one.weight < least_stated || result.readings.size() == most_readings) break;
    const double factor = bulking_of(attribution, one, result);
    result.readings.push_back({text_of(attribution, one), one.weight, {factor, sd}});
    weight += one.weight;
  }
  if (pressed) {
    const double deeper = pressed->volume.value / result.before.value;
    result.readings.push_back(
        {"with " + pressed->what, pressed->probability, {k->value + deeper, sd}});
    weight += pressed->probability;
  }
  for (Reading& reading : result.readings) reading.weight /= weight;
}

void warn_of_readings(VolumeChange& result) {
  if (result.readings.size() < 2) return;
  const Reading& given = result.readings.front();
  double other = 0.0;
  const Reading* likeliest = nullptr;
  for (const Reading& reading : result.readings) {
    if (std::abs(reading.bulking.value - given.bulking.value) < telling * given.bulking.value) {
      continue;
    }
    if (reading.weight < left_out) continue;
    other += reading.weight;
    if (likeliest == nullptr) likeliest = &reading;
  }
  if (likeliest == nullptr) return;
  result.warnings.push_back(
      {"attribution_open",
       "the scene can be read in more than one way: the bulking factor is " +
           hundredths(given.bulking.value) + " as counted, and " +
           hundredths(likeliest->bulking.value) + " " + likeliest->what + " (weights " +
           hundredths(given.weight) + " and " + hundredths(likeliest->weight) +
           "): tell which changes belong to the dig with --dig-area and --dump-area",
       other > as_likely});
}

void warn_of_stirred(const Attribution& attribution, VolumeChange& result) {
  const bool found = std::any_of(attribution.changes.begin(), attribution.changes.end(),
                                 [](const Change& c) { return c.what == "stirred ground"; });
  const auto k = bulking_factor(result);
  if (!found || !k) return;
  const bool is_large = bulking_errors(result).attribution > telling * k->value;
  result.warnings.push_back(
      {"stirred_ground",
       "ground rose and fell in many small places: it was stirred, by tracks or a blade, and "
       "counts as noise; scan where nothing drove, or give --dig-area and --dump-area",
       is_large});
}

}  // namespace

Attribution attribute(std::vector<Area>& areas, const ChangeOptions& options) {
  Attribution attribution;
  attribution.changes = ChangeReader(areas, options).read();
  attribution.combinations = combinations_of(attribution.changes);
  weigh_changes(attribution);
  set_kinds(areas, attribution, options);
  return attribution;
}

void state_open_changes(const std::vector<Area>& areas, const Attribution& attribution,
                        VolumeChange& result) {
  if (attribution.changes.empty()) return;
  list_changes(areas, attribution, result);
  add_stirred(areas, result);
  const auto pressed = pressed_ground(areas, attribution, result);
  if (pressed) result.attribution.push_back(*pressed);
  state_readings(attribution, pressed, result);
  warn_of_readings(result);
  warn_of_stirred(attribution, result);
}

}  // namespace excavplan
