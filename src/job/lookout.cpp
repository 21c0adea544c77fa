// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "job/lookout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "base/angles.hpp"
#include "base/parallel.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Numbers of our own choice.
constexpr int headings = 8;
constexpr double place_step = 0.5;         // of places to stand [m]
constexpr double same_place = 1.0;         // [m]
constexpr double farthest_look = 5.0;      // from the design along, from what is hidden across [m]
constexpr std::size_t most_cells = 200;    // that are looked for from each place
constexpr double least_revealed = 0.0005;  // of the design, to be worth a scan
constexpr std::size_t most_looks = 3;      // that are planned at once
constexpr double way_price = 0.0003;       // of the design, for a metre of the way [1/m]

class Lookout {
 public:
  explicit Lookout(const LookTask& task) : task_(task), surface_(task.ground.surface()) {
    std::vector<Vector3d> unseen;
    for_each_cell(task.map.target.z, [&](Cell at) {
      if (std::isnan(task.map.target.z(at.row, at.col))) return;
      ++all_;
      const double z = surface_.z(at.row, at.col);
      if (!std::isnan(task.seen(at.row, at.col)) || std::isnan(z)) return;
      const Vector3d place(surface_.x(at.col), surface_.y(at.row), z);
      if (!is_dug_next(place)) unseen.push_back(place);
    });
    const std::size_t step = 1 + unseen.size() / most_cells;
    for (std::size_t i = 0; i < unseen.size(); i += step) hidden_.push_back(unseen[i]);
    weight_ = all_ > 0 ? static_cast<double>(step) / all_ : 0.0;
  }

  /// Each of a few looks reveals most of what those before it do not; they are made in the order
  /// of the shortest way.
  std::optional<JobStation> best() const {
    const std::vector<JobStation> places = candidates();
    std::vector<JobStation> looks;
    std::vector<Vector3d> left = hidden_;
    while (share(left) > task_.may_stay && looks.size() < std::min(task_.most, most_looks)) {
      const auto place = most_revealing(places, left);
      if (!place) break;
      looks.push_back(*place);
      const BasePose base = base_of(*place);
      left.erase(std::remove_if(left.begin(), left.end(),
                                [&](const Vector3d& at) { return sees_from(base, at); }),
                 left.end());
    }
    if (looks.empty()) return std::nullopt;
    return first_of_shortest_way(looks);
  }

 private:
  /// All along the design: what lies at the foot of one end is seen from beyond the other.
  std::vector<JobStation> candidates() const {
    Eigen::AlignedBox2d box;
    for (const Vector3d& at : hidden_) box.extend(task_.frame.of(at.head<2>()));
    std::vector<JobStation> places;
    if (box.isEmpty()) return places;
    box.min().x() = task_.frame.near;
    box.max().x() = task_.frame.far;
    const auto steps = [&](int axis) {
      return static_cast<int>((box.sizes()[axis] + 2.0 * farthest_look) / place_step);
    };
    const Vector2d first = box.min() - Vector2d(farthest_look, farthest_look);
    for (int i = 0; i <= steps(0); ++i) {
      for (int k = 0; k <= steps(1); ++k) {
        for (int h = 0; h < headings; ++h) {
          places.push_back({first.x() + i * place_step,
                            first.y() + k * place_step,
                            {},
                            wrapped(2.0 * pi * h / headings)});
        }
      }
    }
    return places;
  }

  bool is_dug_next(const Vector3d& at) const {
    if (!task_.next) return false;
    const JobStation& next = *task_.next;
    const JobFrame line = line_of(task_.frame, next);
    const WorkRange range = work_range(line, task_.settings.site.machine, next.along, next.is_wide);
    return line.of(at.head<2>()).x() <= next.along + range.far;
  }

  double share(const std::vector<Vector3d>& cells) const {
    return weight_ * static_cast<double>(cells.size());
  }

  std::optional<JobStation> most_revealing(const std::vector<JobStation>& places,
                                           const std::vector<Vector3d>& hidden) const {
    std::vector<double> revealed(places.size());
    parallel_for(places.size(), 0,
                 [&](std::size_t i) { revealed[i] = share_seen(places[i], hidden); });
    std::optional<JobStation> best;
    double worth = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (revealed[i] < least_revealed) continue;
      const double value = revealed[i] - way_price * way_over({places[i]});
      if (best && !(value > worth)) continue;
      best = places[i];
      worth = value;
    }
    return best;
  }

  JobStation first_of_shortest_way(const std::vector<JobStation>& looks) const {
    std::vector<std::size_t> order(looks.size());
    std::iota(order.begin(), order.end(), 0);
    JobStation first = looks.front();
    double shortest = std::numeric_limits<double>::infinity();
    do {
      std::vector<JobStation> way(looks.size());
      std::transform(order.begin(), order.end(), way.begin(),
                     [&](std::size_t i) { return looks[i]; });
      const double length = way_over(way);
      if (!(length < shortest)) continue;
      shortest = length;
      first = way.front();
    } while (std::next_permutation(order.begin(), order.end()));
    return first;
  }

  /// From where the machine is, and on to the next place to dig from, if there is one [m].
  double way_over(const std::vector<JobStation>& places) const {
    Vector2d from(task_.base.x, task_.base.y);
    double length = 0.0;
    const auto go = [&](const JobStation& place) {
      const Vector2d to = line_of(task_.frame, place).place(place.along, place.beside);
      length += (to - std::exchange(from, to)).norm();
    };
    std::for_each(places.begin(), places.end(), go);
    if (task_.next) go(*task_.next);
    return length;
  }

  /// What was not seen from there will not be from beside it, whatever the map says.
  bool is_here(const JobStation& place) const {
    const Vector2d at = task_.frame.place(place.along, place.beside);
    return (at - Vector2d(task_.base.x, task_.base.y)).norm() < same_place;
  }

  /// Of the cells of the design.
  double share_seen(const JobStation& place, const std::vector<Vector3d>& hidden) const {
    if (is_here(place) || !can_stand(task_.frame, place, task_.settings.site.machine, task_.map))
      return 0.0;
    const BasePose base = base_of(place);
    const auto seen = std::count_if(hidden.begin(), hidden.end(),
                                    [&](const Vector3d& at) { return sees_from(base, at); });
    return weight_ * static_cast<double>(seen);
  }
  BasePose base_of(const JobStation& place) const {
    return base_at(task_.frame, place, task_.ground, task_.settings.site.machine);
  }
  bool sees_from(const BasePose& base, const Vector3d& at) const {
    return std::any_of(task_.looks.begin(), task_.looks.end(),
                       [&](const SensorLook& look) { return sees(look, base, surface_, at); });
  }

  const LookTask& task_;
  HeightMap surface_;
  std::vector<Vector3d> hidden_;
  int all_ = 0;
  double weight_ = 0.0;  ///< of one of `hidden_`, as a share of the design
};

}  // namespace

std::optional<JobStation> best_lookout(const LookTask& task) { return Lookout(task).best(); }

}  // namespace excavplan
