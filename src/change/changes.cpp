// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "change/changes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/text.hpp"
#include "change/zone_looks.hpp"

namespace excavplan {
namespace {

// ---- What the shapes and places of changes tell: all ours -------------------------------------

/// Probability that a change belongs to the dig, by what it looks like.
namespace prior {
constexpr double main_hole = 0.96;     // the largest: another may fit the soil better
constexpr double beside_main = 0.96;   // of the same kind as the hole or heap that it lies beside
constexpr double deep_hole = 0.97;     // as deep as the largest: machines dig so
constexpr double large_spill = 0.9;    // or a berm
constexpr double second = 0.85;        // a hole or a heap away from the largest
constexpr double along_swing = 0.9;    // clods between hole and heap
constexpr double low_edge = 0.8;       // low ground beside a hole or heap that keeps its height
constexpr double anywhere = 0.5;       // small or low and in no place that tells
constexpr double doubtful = 0.3;       // what the error of its volume explains
constexpr double stray = 0.1;          // likewise, and away from the hole
constexpr double lone_track = 0.25;    // or a scrape that is as narrow and as shallow
constexpr double shallow_fall = 0.15;  // ground that sank by far less than the hole is deep
constexpr double pair_of_tracks = 0.04;
constexpr double thing = 0.04;           // steep, with a level top
constexpr double thing_in_swing = 0.25;  // small: clods that fell together look alike
constexpr double stirred = 0.04;         // by tracks or a blade
}  // namespace prior

constexpr double lasting_edge = 0.6;      // a tail that keeps this share of its depth is no edge
constexpr double highest_berm = 0.10;     // [m]
constexpr double upright = 1.3;           // slope that no loose soil has: 52 degrees
constexpr double least_upright = 0.12;    // height of a thing [m]
constexpr double largest_upright = 0.25;  // of the hole's volume
constexpr double round_top = 0.75;        // fullness of half a ball, once cells have blurred it
constexpr double level_top = 0.85;        // fullness of a box of 0.3 m, likewise
constexpr double small_share = 0.03;      // of the hole's volume: a clod, a blemish
constexpr double shallow = 0.03;          // what feet, tracks and settling do [m]
constexpr double shallow_share = 0.2;     // of the hole's height
constexpr double deep_share = 0.5;        // likewise
constexpr double largest_spill = 0.15;    // of the hole's volume: more is seldom lost beside it
constexpr double most_at_rim = 0.25;      // of the hole's volume
constexpr double established = 2.0;       // sd: a change is there
constexpr double hardly_there = 1.0;      // sd: nothing tells that it is
constexpr double least_reach = 10.0;      // of a dig, from the edge of its hole [m]
constexpr double reach_in_holes = 3.0;    // likewise, in lengths of the hole
constexpr double swing_bulge = 1.25;      // ellipse about hole and heap
constexpr double swing_room = 0.5;        // [m]

/// Finds the changes of a scene.
class ChangeReader {
 public:
  ChangeReader(const std::vector<Area>& areas, const ChangeOptions& options)
      : areas_(areas), options_(options) {
    for (const Area& area : areas) looks_.push_back(looks_of(area));
    hole_ = largest(0, -1.0);
    if (hole_) mark_beside();
    heap_ = largest(areas.size() - 1, 1.0);
    if (heap_) beside_heap_ = near(*heap_);
  }

  std::vector<Change> read() {
    const bool is_told_heap = heap_ && options_.dump_area;
    if (!hole_ && areas_.size() == 1 && !is_told_heap) return {};
    for (std::size_t a = 0; a < areas_.size(); ++a) {
      tracks_.push_back(find_tracks(areas_[a], looks_[a], possible_tracks(a), hole_height()));
    }
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
  const ZoneLook& look(Place p) const { return looks_[p.area][p.zone]; }
  const ZoneShape& shape(Place p) const { return look(p).shape; }
  Part part(Place p) const { return areas_[p.area].parts.part[p.zone]; }
  bool is(Place p, const std::optional<Place>& other) const {
    return other && p.area == other->area && p.zone == other->zone;
  }
  bool is_main(Place p) const { return is(p, hole_) || is(p, heap_); }
  double hole_volume() const { return hole_ ? -zone(*hole_).volume : 0.0; }
  double hole_height() const { return hole_ ? shape(*hole_).height : 0.0; }
  bool is_small(Place p) const { return std::abs(zone(p).volume) < small_share * hole_volume(); }

  const std::optional<Rectangle>& given(double sign) const {
    return sign < 0.0 ? options_.dig_area : options_.dump_area;
  }
  bool in_given(Place p, double sign) const {
    const auto is_in = [&](const std::optional<Rectangle>& area) {
      return !area || area->contains(zone(p).centre.x(), zone(p).centre.y());
    };
    return is_in(given(sign)) && (sign < 0.0 || is_in(options_.heap_near));
  }
  /// Lies in an area that was given for what it is.
  bool is_told(Place p) const {
    const double sign = zone(p).volume < 0.0 ? -1.0 : 1.0;
    return given(sign) && in_given(p, sign);
  }

  /// The largest zone of a sign that is more than its error, or of all; of those that rose, one
  /// away from the hole, or where the bucket was emptied.
  std::optional<Place> largest(std::size_t area, double sign) const {
    std::optional<Place> found;
    bool is_found_sure = false;
    for (std::size_t z = 0; z < areas_[area].zones.size(); ++z) {
      const Place p{area, z};
      const double volume = sign * zone(p).volume;
      const bool is_where_told = given(sign) || options_.heap_near;
      const bool is_candidate = volume > 0.0 && in_given(p, sign) &&
                                (sign < 0.0 || areas_.size() > 1 || is_where_told || !beside(p));
      if (!is_candidate) continue;
      const bool is_sure = significance(p) > established;
      const bool is_larger = !found || volume > sign * zone(*found).volume;
      if (is_sure == is_found_sure ? !is_larger : is_found_sure) continue;
      found = p;
      is_found_sure = is_sure;
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
      if (!(areas_[0].zones[z].volume < 0.0) || is_small({0, z}) || is_at_rim({0, z})) continue;
      const std::vector<bool> around = near({0, z});
      for (std::size_t i = 0; i < around.size(); ++i) {
        beside_others_[i] = beside_others_[i] || around[i];
      }
    }
  }
  bool beside(Place p) const { return p.area == 0 && !beside_.empty() && beside_[p.zone]; }

  std::vector<bool> possible_tracks(std::size_t area) const {
    std::vector<bool> may_be;
    for (std::size_t z = 0; z < areas_[area].zones.size(); ++z) {
      const Place p{area, z};
      may_be.push_back(!is_main(p) && part(p) != Part::churn && !is_told(p));
    }
    return may_be;
  }
  bool is_track(Place p) const { return tracks_[p.area].is_track[p.zone]; }

  bool is_berm(Place p) const {
    const std::vector<bool>& ruts = tracks_[p.area].is_rut;
    if (std::find(ruts.begin(), ruts.end(), true) == ruts.end()) return false;
    if (shape(p).height > highest_berm || is(p, heap_)) return false;
    if (part(p) == Part::tail && is_track(p) && !beside(p)) return true;
    return tracks_[p.area].lies_along(look(p)) && (shape(p).is_strip() || part(p) == Part::tail);
  }

  /// Small and at the edge of the survey, where few points make a change that is none.
  bool is_at_rim(Place p) const {
    return zone(p).is_cut && !beside(p) && part(p) != Part::tail &&
           std::abs(zone(p).volume) < most_at_rim * hole_volume();
  }

  // ---- What a change looks like ---------------------------------------------------------------

  struct Meaning {
    ChangeKind kind;
    std::string what;
    double prior;
    bool is_group;  ///< all that look like this are one change
  };

  Meaning meaning_of(Place p) const {
    const bool fell = zone(p).volume < 0.0;
    if (part(p) == Part::churn) {
      return {ChangeKind::stirred, "stirred ground", prior::stirred, true};
    }
    if (is_out_of_reach(p)) {
      return {ChangeKind::outside_area, "ground far from the hole", excluded, true};
    }
    if (is_excluded(p)) {
      return {ChangeKind::outside_area, "ground outside the given area", excluded, true};
    }
    if (is_told(p) && !is_main(p)) {
      return {ChangeKind::in_area, fell ? "a hole in the given area" : "a heap in the given area",
              certain, false};
    }
    if (const double sds = evidence(p); sds < established && !is_main(p)) {
      if (sds < hardly_there) return {ChangeKind::within_error, "noise", excluded, true};
      const bool is_near = p.area == 0 && beside(p);
      return {ChangeKind::within_error,
              is_near ? "changes within their error beside the hole" : "changes within their error",
              is_near ? prior::doubtful : prior::stray, true};
    }
    return fell ? meaning_of_fall(p) : meaning_of_rise(p);
  }

  /// Farther away than soil is carried in a dig: a scan may show a whole site.
  bool is_out_of_reach(Place p) const {
    if (!hole_ || p.area != hole_->area || is_told(p)) return false;
    const Rectangle& hole = zone(*hole_).extent;
    const Rectangle& other = zone(p).extent;
    const double size = std::max(hole.x_max - hole.x_min, hole.y_max - hole.y_min);
    const double x = std::max({hole.x_min - other.x_max, other.x_min - hole.x_max, 0.0});
    const double y = std::max({hole.y_min - other.y_max, other.y_min - hole.y_max, 0.0});
    return std::hypot(x, y) > std::max(least_reach, reach_in_holes * size);
  }

  /// By an area that was given, as is a fall where only soil was dumped.
  bool is_excluded(Place p) const {
    const bool fell = zone(p).volume < 0.0;
    if (fell && areas_.size() > 1 && p.area == 1) return true;
    return !in_given(p, fell ? -1.0 : 1.0) && (fell || !beside(p));
  }

  /// Volume over its error.
  double significance(Place p) const {
    const ZoneErrors& errors = areas_[p.area].errors;
    const auto i = static_cast<Eigen::Index>(p.zone);
    const double variance = zone(p).variance() + errors.correlated(i, i) + errors.datum(i, i);
    return std::abs(zone(p).volume) / std::sqrt(variance);
  }

  /// The same of a zone that may not have changed at all: filled where it was not seen, which errs
  /// by more than normal errors do, or at a step in both scans.
  double evidence(Place p) const {
    constexpr double by_filling = 3.0;  // ours
    return significance(p) / (1.0 + by_filling * zone(p).unknown / zone(p).area);
  }

  /// Of a tail that is no track: soil thins out, something else beside it does not.
  double edge_prior(Place p) const {
    return look(p).lasting > lasting_edge ? prior::low_edge : certain;
  }

  Meaning meaning_of_track(Place p, ChangeKind kind, const std::string& what) const {
    const bool is_pair = tracks_[p.area].has_twin[p.zone];
    return {kind, is_pair ? what : "a lone strip like " + what,
            is_pair ? prior::pair_of_tracks : prior::lone_track, is_pair};
  }

  Meaning meaning_of_fall(Place p) const {
    if (is(p, hole_)) {
      return {ChangeKind::hole, "the hole", given(-1.0) ? certain : prior::main_hole, false};
    }
    if (tracks_[p.area].is_rut[p.zone]) return meaning_of_track(p, ChangeKind::ruts, "ruts");
    if (part(p) == Part::tail) {
      return {ChangeKind::edge, "the low edge of a hole", edge_prior(p), false};
    }
    if (is_at_rim(p)) {
      return {ChangeKind::settled, "falls at the rim of the survey", prior::doubtful, true};
    }
    if (shape(p).height < std::min(shallow, shallow_share * hole_height())) {
      return {ChangeKind::settled, "ground that fell a little",
              beside(p) ? prior::anywhere : prior::shallow_fall, false};
    }
    if (beside(p)) {
      return {ChangeKind::second_hole, "a hole beside the largest", prior::beside_main, false};
    }
    if (is_small(p)) return {ChangeKind::small_hole, "a small hole", prior::anywhere, false};
    const bool is_deep = shape(p).height > deep_share * hole_height();
    return {ChangeKind::second_hole, "a second hole", is_deep ? prior::deep_hole : prior::second,
            false};
  }

  Meaning meaning_of_rise(Place p) const {
    if (is(p, heap_)) return {ChangeKind::heap, "the heap", certain, false};
    if (is_berm(p)) return meaning_of_berm(p);
    if (areas_[p.area].ground.zone_is_layer[p.zone]) return meaning_of_layer(p);
    const bool is_upright = shape(p).steepest > upright && shape(p).height > least_upright &&
                            zone(p).volume < largest_upright * hole_volume();
    const Meaning soil = meaning_of_soil(p);
    return is_upright && !beside(p) ? meaning_of_upright(p, soil) : soil;
  }

  Meaning meaning_of_berm(Place p) const {
    const std::vector<bool>& twins = tracks_[p.area].has_twin;
    const bool of_pair = std::find(twins.begin(), twins.end(), true) != twins.end();
    return {ChangeKind::berms, "berms of tracks",
            of_pair ? prior::pair_of_tracks : prior::lone_track, true};
  }

  /// Hardly anything but soil lies so thin over so much ground.
  Meaning meaning_of_layer(Place p) const {
    if (beside(p)) return {ChangeKind::spill, "spill beside the hole", certain, true};
    const bool is_beside_heap = heap_ && p.area == heap_->area && beside_heap_[p.zone];
    if (is_beside_heap || in_swing(p)) {
      return {ChangeKind::clods, "soil strewn along the swing", prior::beside_main, true};
    }
    return {ChangeKind::small_rises, "soil strewn off the swing", prior::anywhere, true};
  }

  bool is_ridge(Place p) const {
    return beside(p) && zone(p).volume > small_share * hole_volume() && !is(p, heap_) &&
           !areas_[p.area].ground.zone_is_layer[p.zone];
  }
  bool is_one_of_ridges(Place p) const {
    std::size_t ridges = 0;
    for (std::size_t z = 0; z < areas_[p.area].zones.size(); ++z) {
      ridges += is_ridge({p.area, z}) ? 1 : 0;
    }
    return is_ridge(p) && ridges > 1;
  }

  /// Where the heap lies elsewhere, more than digs spill beside the hole may be a berm, and so may
  /// one of several ridges.
  Meaning meaning_of_spill(Place p) const {
    const bool may_be_berm = heap_ && !areas_[p.area].is_cut_told;
    const bool is_large = zone(p).volume > largest_spill * hole_volume();
    if (may_be_berm && (is_large || is_one_of_ridges(p))) {
      return {ChangeKind::spill, "a ridge beside the hole", prior::large_spill, false};
    }
    return {ChangeKind::spill, "spill beside the hole", certain, true};
  }

  Meaning meaning_of_soil(Place p) const {
    if (beside(p)) return meaning_of_spill(p);
    if (part(p) == Part::tail) {
      return {ChangeKind::edge, "the low edge of a heap", edge_prior(p), false};
    }
    if (is_at_rim(p)) {
      return {ChangeKind::small_rises, "rises at the rim of the survey", prior::doubtful, true};
    }
    if (heap_ && p.area == heap_->area && beside_heap_[p.zone]) {
      return {ChangeKind::second_heap, "soil beside the heap", prior::beside_main, false};
    }
    if (p.area == 0 && !beside_others_.empty() && beside_others_[p.zone]) {
      return {ChangeKind::spill, "spill beside another hole", prior::beside_main, true};
    }
    if (is_small(p) && in_swing(p)) {
      return {ChangeKind::clods, "clods along the swing", prior::along_swing, true};
    }
    if (is_small(p)) return {ChangeKind::small_rises, "small rises", prior::anywhere, true};
    if (areas_.size() > 1 && p.area == 0) {
      return {ChangeKind::second_heap, "a rise in the dig area", prior::anywhere, false};
    }
    return {ChangeKind::second_heap, "a second heap", prior::second, false};
  }

  /// Steeper than loose soil: with a level top a thing, with a round or pointed one as likely soil
  /// as others in its place.
  Meaning meaning_of_upright(Place p, const Meaning& soil) const {
    const double level =
        std::clamp((shape(p).fullness - round_top) / (level_top - round_top), 0.0, 1.0);
    const bool could_be_clods = zone(p).volume < 2.0 * small_share * hole_volume() && in_swing(p);
    const double thing = could_be_clods ? prior::thing_in_swing : prior::thing;
    const double probability = soil.prior + level * (thing - soil.prior);
    if (probability < prior::anywhere) {
      return {ChangeKind::thing, "a thing that is no soil", probability, false};
    }
    return {ChangeKind::lump, "a steep lump of soil, or a thing,", probability, false};
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
        change.loose += zone(p).loose;
        return;
      }
    } else if (meaning.prior < certain && !is(p, hole_)) {
      meaning.what += " around (" + hundredths(zone(p).centre.x()) + ", " +
                      hundredths(zone(p).centre.y()) + ") m";
    }
    changes_.push_back(
        {meaning.kind, meaning.what, {p}, volume, zone(p).loose, meaning.prior, meaning.prior});
  }

  const std::vector<Area>& areas_;
  const ChangeOptions& options_;
  std::vector<std::vector<ZoneLook>> looks_;
  std::optional<Place> hole_;
  std::optional<Place> heap_;
  std::vector<bool> beside_;
  std::vector<bool> beside_others_;
  std::vector<bool> beside_heap_;
  std::vector<Tracks> tracks_;  // of each area
  std::vector<Change> changes_;
};

}  // namespace

std::vector<Change> read_changes(const std::vector<Area>& areas, const ChangeOptions& options) {
  return ChangeReader(areas, options).read();
}

}  // namespace excavplan
