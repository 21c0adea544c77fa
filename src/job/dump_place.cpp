// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/dump_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/angles.hpp"
#include "base/plan_geometry.hpp"
#include "base/text.hpp"
#include "simulation/across_tracks.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Numbers of our own choice.
constexpr double nearest = 0.5;           // of the pin, share of boom and arm
constexpr double farthest = 0.9;          // likewise
constexpr double farthest_across = 0.99;  // likewise over a design that the machine stands beside
constexpr double room_price = 0.6;        // of a metre nearer than is wanted, as a swing [rad/m]
constexpr double later_soil = 1.6;        // half of the width of what is laid then [m]
constexpr double radius_step = 0.4;       // [m]
constexpr double turn_step = 0.05;        // [rad]
constexpr double most_turn = 2.6;         // [rad]
constexpr double drop = 0.3;              // from the open bucket to the heap [m]
constexpr double height_price = 0.15;     // of a metre, as a swing [rad/m]
constexpr double edge_of_cut = 0.6;       // soil keeps so far from the design [m]
constexpr double off_keep_out = 0.3;  // likewise from keep-outs, as heaps run and no dump is exact
constexpr double outside_price = 10.0;  // of a bucket beside the dump areas, as a swing [rad]
constexpr double inside_bed = 0.5;      // of a truck's border, so that the load falls in [m]
constexpr double spare_reach = 0.1;     // of what the joints allow [m]
constexpr double most_outside = 0.8;    // share of a bucket beside the dump areas
constexpr double area_run = 1.0;        // of soil into an area from beside it [m]
constexpr double farthest_off = 4.0;    // of soil from areas that are full [m]
constexpr double heap_step = 0.15;      // between the places of a heap that are looked at [m]
constexpr double farthest_run = 3.0;    // of soil from where it falls [m]
constexpr double edge_step = 0.1;       // of an obstacle's outline [m]
constexpr int halvings = 7;             // of the range in which the top of a heap lies

bool is_cut(const JobMap& map, Cell at) { return !std::isnan(map.target.z(at.row, at.col)); }

double volume_of(const JobSettings& settings, const DumpRules& rules) {
  return rules.load * heaped_capacity(settings.site.machine);
}

/// Height of the cone of a load of soil.
double heap_height(const JobSettings& settings, const DumpRules& rules) {
  const double repose = std::tan(settings.site.soil.angle_of_repose);
  const double volume = volume_of(settings, rules);
  return std::cbrt(3.0 * volume * repose * repose / pi);
}

/// A heap of this radius lies in the dump areas, and runs neither into the cut nor to what no soil
/// may touch.
bool fits(const JobMap& map, const Vector2d& place, double radius) {
  const double cell = map.target.cell_size;
  const double around = radius + std::max(edge_of_cut, off_keep_out);
  for (double x = -around; x <= around; x += cell) {
    for (double y = -around; y <= around; y += cell) {
      const double distance = std::hypot(x, y);
      if (distance > around) continue;
      const auto at = cell_at(map.target, place.x() + x, place.y() + y);
      if (distance <= radius && (!at || !map.dump(at->row, at->col))) return false;
      if (!at) continue;
      if (distance <= radius + off_keep_out && map.untouched(at->row, at->col)) return false;
      if (distance <= radius + edge_of_cut && is_cut(map, *at)) return false;
    }
  }
  return true;
}

/// How far from the swing axis the pin of the bucket comes at a height over the ground [m].
double pin_reach(const Machine& machine, double height) {
  const double boom = machine.boom_length, arm = machine.arm_length;
  const double bent = machine.limits[static_cast<std::size_t>(Joint::arm)].lower;
  const double up = height - machine.boom_pin.y();
  const double left = boom * boom + arm * arm + 2.0 * boom * arm * std::cos(bent) - up * up;
  return left > 0.0 ? machine.boom_pin.x() + std::sqrt(left) - spare_reach : 0.0;
}

/// Points of an outline, of sides that reach far those near a place alone.
template <typename Visit>
void for_each_on(const SitePolygon& polygon, const Vector2d& near, double reach, Visit visit) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d way = polygon[(i + 1) % polygon.size()] - polygon[i];
    const double steps = std::max(1.0, std::ceil(way.norm() / edge_step));
    const double step = std::max(way.norm(), 1e-12) / steps;
    const double beside = (near - polygon[i]).dot(way) / (step * step * steps);
    const double last = std::min(steps - 1.0, std::floor(beside + reach / step) + 1.0);
    for (double k = std::max(0.0, std::ceil(beside - reach / step) - 1.0); k <= last; ++k)
      visit(Vector2d(polygon[i] + k / steps * way));
  }
}

/// Visits the places within reach, with the way to the left that the machine swings to them [rad].
template <typename Visit>
void for_each_place(const JobSettings& settings, const BasePose& base, const DumpRules& rules,
                    Visit visit) {
  const Machine& machine = settings.site.machine;
  const double reach = machine.boom_length + machine.arm_length;
  std::vector<double> turns;
  for (double turn = -most_turn; turn <= most_turn; turn += turn_step) {
    const double swing = turn - rules.tracks;
    if (swing < machine.swing->lower || swing > machine.swing->upper) continue;
    if (turns_clear(settings, base, turn)) turns.push_back(turn);
  }
  const bool across = is_across(rules.tracks);
  const double most = (across ? farthest_across : farthest) * reach - rules.spare_reach;
  const double step = across ? 0.5 * radius_step : radius_step;
  const int more = static_cast<int>((most - nearest * reach) / step);
  for (int i = 0; i <= more; ++i) {
    const double radius = across ? most - i * step : nearest * reach + i * step;
    for (const double turn : turns) {
      const double heading = base.heading + turn;
      const Vector2d off(std::cos(heading), std::sin(heading));
      visit(Vector2d(Vector2d(base.x, base.y) + radius * off), turn);
    }
  }
}

/// The price of a place that leaves less room for later soil than another one, as a swing [rad].
double price_of_room(const DumpRules& rules, const BasePose& base, const Vector2d& place) {
  const Vector2d off = PlanFrame({base.x, base.y}, base.heading).of(place);
  if (is_across(rules.tracks)) return -room_price * off.norm();
  return room_price * std::max(0.0, rules.off_line - std::abs(off.y()));
}

std::optional<DumpPlace> in_truck(const JobSettings& settings, const Terrain& ground,
                                  const BasePose& base, const DumpRules& rules) {
  const JobTruck& truck = *settings.design.truck;
  const Machine& machine = settings.site.machine;
  std::optional<DumpPlace> best;
  for_each_place(settings, base, rules, [&](const Vector2d& place, double turn) {
    if (best && std::abs(turn) >= std::abs(best->swing)) return;
    if (!is_well_in(truck.bed, place, inside_bed)) return;
    const auto at = cell_at(ground.bank, place.x(), place.y());
    const double z = at ? ground.bank.z(at->row, at->col) : base.z;
    const double pin =
        (std::isnan(z) ? base.z : z) + truck.bed_height + machine.bucket_length + drop;
    const double away = std::hypot(place.x() - base.x, place.y() - base.y);
    if (away > pin_reach(machine, pin - base.z)) return;
    best = DumpPlace{{place.x(), place.y(), pin}, turn, pin - base.z, true};
  });
  return best;
}

/// A bucket of soil as it comes to lie: a cone on what lies there already.
struct Heap {
  double top = 0.0;        ///< [m]
  double outside = 0.0;    ///< share of it beside the dump areas [-]
  bool is_allowed = true;  ///< it runs neither into the cut nor to what no soil may touch
};

/// Lays soil on the ground of a site.
class HeapLayer {
 public:
  HeapLayer(const JobSettings& settings, const JobMap& map, const Terrain& ground,
            const DumpRules& rules)
      : map_(map),
        ground_(ground),
        repose_(std::tan(settings.site.soil.angle_of_repose)),
        volume_(volume_of(settings, rules)),
        cone_(heap_height(settings, rules)) {}

  Heap lay(const Vector2d& place) {
    look_about(place);
    const auto at = cell_at(map_.target, place.x(), place.y());
    double low = surface_of(ground_, *at);
    double high = low + cone_;
    for (int i = 0; i < halvings; ++i) {
      const double top = 0.5 * (low + high);
      (volume(top) < volume_ ? low : high) = top;
    }
    return described(high);
  }

 private:
  /// Ground about the place of a heap.
  struct Spot {
    Cell at;
    double away;     ///< from the place [m]
    double surface;  ///< [m]
    bool may_hold;   ///< soil of the heap
  };

  void look_about(const Vector2d& place) {
    constexpr double radius = farthest_run + edge_of_cut;
    spots_.clear();
    for (double x = -radius; x <= radius; x += heap_step) {
      for (double y = -radius; y <= radius; y += heap_step) {
        const auto at = cell_at(map_.target, place.x() + x, place.y() + y);
        if (!at || std::isnan(surface_of(ground_, *at))) continue;
        const double reach = std::max(std::abs(x), std::abs(y));
        spots_.push_back({*at, std::hypot(x, y), surface(*at), reach <= farthest_run});
      }
    }
  }

  /// Soil that runs does not know how deep it is behind the edge of the cut.
  double surface(Cell at) const {
    const double now = surface_of(ground_, at);
    return is_cut(map_, at) ? std::fmax(now, map_.before(at.row, at.col)) : now;
  }

  double volume(double top) const {
    double sum = 0.0;
    for (const Spot& spot : spots_) {
      if (spot.may_hold) sum += std::max(0.0, top - repose_ * spot.away - spot.surface);
    }
    return heap_step * heap_step * sum;
  }

  Heap described(double top) const {
    Heap heap;
    heap.top = top;
    double all = 0.0;
    for (const Spot& spot : spots_) {
      const Cell at = spot.at;
      const auto reaches = [&](double margin) {
        return top - repose_ * std::max(0.0, spot.away - margin) > spot.surface;
      };
      const bool is_untouched = map_.untouched(at.row, at.col);
      if ((is_cut(map_, at) && reaches(edge_of_cut)) || (is_untouched && reaches(off_keep_out)))
        heap.is_allowed = false;
      const double height = std::max(0.0, top - repose_ * spot.away - spot.surface);
      all += height;
      if (!map_.dump(at.row, at.col)) heap.outside += height;
    }
    heap.outside = all > 0.0 ? heap.outside / all : 1.0;
    return heap;
  }

  const JobMap& map_;
  const Terrain& ground_;
  double repose_;
  double volume_;
  double cone_;  ///< height of the load on level ground [m]
  std::vector<Spot> spots_;
};

bool is_near_area(const JobMap& map, const Vector2d& place, double near) {
  constexpr int ways = 16;
  for (int i = 0; i <= ways; ++i) {
    const double angle = 2.0 * pi * i / ways, away = i < ways ? near : 0.0;
    const auto at =
        cell_at(map.target, place.x() + away * std::cos(angle), place.y() + away * std::sin(angle));
    if (at && map.dump(at->row, at->col)) return true;
  }
  return false;
}

/// Where the least of a bucket comes to lie beside the areas; beyond most_outside and area_run only
/// if that is allowed and there is no other place.
std::optional<DumpPlace> least_outside(const JobSettings& settings, const JobMap& map,
                                       const Terrain& ground, const BasePose& base,
                                       const DumpRules& rules) {
  const Machine& machine = settings.site.machine;
  HeapLayer layer(settings, map, ground, rules);
  std::optional<DumpPlace> best;
  double least = std::numeric_limits<double>::infinity();
  for_each_place(settings, base, rules, [&](const Vector2d& place, double turn) {
    const bool has_room = best && !best->overflows;
    const auto at = cell_at(map.target, place.x(), place.y());
    if ((has_room && !is_across(rules.tracks) && std::abs(turn) >= least) || !at ||
        std::isnan(ground.bank.z(at->row, at->col)))
      return;
    if (is_cut(map, *at)) return;
    const bool runs_in = is_near_area(map, place, area_run);
    const bool may_be_off = rules.may_overflow && !has_room;
    if (!runs_in && !(may_be_off && is_near_area(map, place, farthest_off))) return;
    const Heap heap = layer.lay(place);
    const double pin = heap.top + drop + machine.bucket_length;
    const double away = std::hypot(place.x() - base.x, place.y() - base.y);
    const double cost = outside_price * heap.outside + std::abs(turn) +
                        height_price * std::max(0.0, heap.top - base.z) +
                        price_of_room(rules, base, place);
    if (!heap.is_allowed || away > pin_reach(machine, pin - base.z)) return;
    const bool overflows = heap.outside > most_outside || !runs_in;
    if (overflows && !may_be_off) return;
    const bool is_first_with_room = !overflows && !has_room;
    if (cost >= least && !is_first_with_room) return;
    least = cost;
    best = DumpPlace{{place.x(), place.y(), pin},
                     turn,
                     std::max(0.0, pin - base.z),
                     false,
                     heap.outside,
                     overflows};
  });
  return best;
}

}  // namespace

double beyond_later_soil(const Machine& machine, double beside) {
  return farthest_across * (machine.boom_length + machine.arm_length) - beside + later_soil;
}

std::vector<Warning> dump_warnings(const DumpPlace& dump) {
  if (!(dump.outside > 0.5)) return {};
  return {{WarningCode::dump_areas_full,
           "the places for soil are full, or out of reach: " + readable(100.0 * dump.outside, 2) +
               " % of this bucket comes to lie beside them"}};
}

bool turns_clear(const JobSettings& settings, const BasePose& base, double swing) {
  const Machine& machine = settings.site.machine;
  const double reach = machine.tail_swing_radius() + off_tail;
  const double half_width = 0.5 * machine.undercarriage_width() + off_tail;
  const PlanFrame frame(Vector2d(base.x, base.y), base.heading);
  bool clear = true;
  for (const JobObstacle& obstacle : settings.design.obstacles) {
    for_each_on(obstacle.polygon, {base.x, base.y}, reach, [&](const Vector2d& place) {
      const Vector2d at = frame.of(place);
      const double away = at.norm();
      if (away >= reach) return;
      // From where the tail is as the machine looks ahead, in the sense of the swing.
      const double turned = wrapped(std::atan2(at.y(), at.x()) - pi);
      const double margin = std::asin(half_width / std::max(away, half_width));
      for (const double around : {-2.0 * pi, 0.0, 2.0 * pi}) {
        clear &= turned + around < std::min(0.0, swing) - margin ||
                 turned + around > std::max(0.0, swing) + margin;
      }
    });
  }
  return clear;
}

std::optional<DumpPlace> dump_place(const JobSettings& settings, const JobMap& map,
                                    const Terrain& ground, const BasePose& base,
                                    const DumpRules& rules) {
  if (settings.design.truck) return in_truck(settings, ground, base, rules);
  const Machine& machine = settings.site.machine;
  const double repose = std::tan(settings.site.soil.angle_of_repose);
  const double cone = heap_height(settings, rules);
  std::optional<DumpPlace> best;
  double least = std::numeric_limits<double>::infinity();
  for_each_place(settings, base, rules, [&](const Vector2d& place, double turn) {
    const auto at = cell_at(map.target, place.x(), place.y());
    if (!at || !map.dump(at->row, at->col)) return;
    const double surface = surface_of(ground, *at);
    if (std::isnan(surface)) return;
    const double risen =
        std::fmax(ground.loose(at->row, at->col), surface - map.before(at->row, at->col));
    const double cost = std::abs(turn) + height_price * std::max(0.0, surface - base.z) +
                        price_of_room(rules, base, place);
    if (cost >= least || !fits(map, place, (risen + cone) / repose)) return;
    const double pin = surface + cone + drop + machine.bucket_length;
    if (std::hypot(place.x() - base.x, place.y() - base.y) > pin_reach(machine, pin - base.z))
      return;
    least = cost;
    best = DumpPlace{{place.x(), place.y(), pin}, turn, std::max(0.0, pin - base.z), false};
  });
  if (best) return best;
  return least_outside(settings, map, ground, base, rules);
}

}  // namespace excavplan
