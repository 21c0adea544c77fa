// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/planning/standing_ground.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/angles.hpp"
#include "base/random.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "ground/grid_cells.hpp"
#include "ground/map_check.hpp"
#include "ground/plane_fit.hpp"

namespace excavplan {
namespace {

using Eigen::Index;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Ours:
constexpr double ring = 1.0;             // about the tracks, of the plane [m]
constexpr double off_height = 0.2;       // of the plane, from z = 0 [m]
constexpr double off_level = pi / 60.0;  // of the plane: 3 degrees [rad]
constexpr double on_plane = 0.1;         // of ground as rough as a site's [m]
constexpr int planes_tried = 300;        // of three cells; a plane of half of all is found
constexpr double fewest_cells = 30;      // of a plane
constexpr double least_seen = 0.5;       // of one side of the ring
constexpr double least_drop = 0.45;      // 0.5 m less what cells at an edge are off [m]
constexpr double least_area = 0.1;       // that counts as a drop or as soil [m^2]
constexpr double before_own_cut = 0.4;   // DigPathOptions::track_margin less 0.1 m of crumbling [m]
constexpr double beside_own_cut = 0.5;   // that falls in on either side of the bucket [m]
constexpr double under_a_quarter = -0.3;  // of the ground: a track's end would hang in the air [m]

/// In the order round the tracks; a corner lies between two of them.
enum class Side { ahead, left, behind, right };
constexpr std::array side_names = {"ahead", "left", "behind", "right"};

/// The tracks of a machine, seen from above.
class Tracks {
 public:
  explicit Tracks(const Machine& machine)
      : front_(std::max(0.0, machine.track_front)), half_(0.5 * machine.undercarriage_width()) {}

  double length() const { return 2.0 * front_; }  // [m]

  /// 0 under the machine [m].
  double distance(double x, double y) const { return (Vector2d(x, y) - nearest(x, y)).norm(); }

  Vector2d nearest(double x, double y) const {
    return {std::clamp(x, -front_, front_), std::clamp(y, -half_, half_)};
  }

  bool is_on(Side side, double x, double y) const {
    switch (side) {
      case Side::ahead:
        return x > front_ && std::abs(y) <= half_;
      case Side::left:
        return y > half_ && std::abs(x) <= front_;
      case Side::behind:
        return x < -front_ && std::abs(y) <= half_;
      case Side::right:
        return y < -half_ && std::abs(x) <= front_;
    }
    return false;
  }

  /// Ends of the side.
  std::array<Vector2d, 2> ends(Side side) const {
    const std::array<Vector2d, 4> corners = {
        {{front_, -half_}, {front_, half_}, {-front_, half_}, {-front_, -half_}}};
    const auto i = static_cast<std::size_t>(side);
    return {corners[i], corners[(i + 1) % 4]};
  }

 private:
  double front_, half_;
};

/// The plane that the most points lie on, and the sum that tells so.
struct Candidate {
  GroundPlane plane;
  double misfit = std::numeric_limits<double>::infinity();
};

/// Least squares of the points near a plane.
GroundPlane refined(const GroundPlane& about, const std::vector<Vector3d>& points) {
  PlaneFit near;
  for (const Vector3d& p : points) {
    if (std::abs(p.z() - about.at(p.x(), p.y())) <= on_plane) near.add(p.x(), p.y(), p.z());
  }
  return near.count() < 3.0 || !(near.reciprocal_condition() > 1e-9) ? about : near.plane();
}

/// By sample consensus (Fischler and Bolles 1981, with the bounded squares of Torr and Zisserman
/// 2000): a part of the points, however far off the plane, has no say in it.
GroundPlane plane_of_most(const std::vector<Vector3d>& points) {
  Random random(1);
  Candidate best;
  for (int i = 0; i < planes_tried; ++i) {
    PlaneFit three;
    for (int corner = 0; corner < 3; ++corner) {
      const Vector3d& p = points[random.index(points.size())];
      three.add(p.x(), p.y(), p.z());
    }
    if (!(three.reciprocal_condition() > 1e-6)) continue;
    Candidate tried{three.plane(), 0.0};
    for (const Vector3d& p : points) {
      const double off = p.z() - tried.plane.at(p.x(), p.y());
      tried.misfit += std::min(off * off, on_plane * on_plane);
    }
    if (tried.misfit < best.misfit) best = tried;
  }
  for (int round = 0; round < 4; ++round) best.plane = refined(best.plane, points);
  return best.plane;
}

std::string degrees(double angle) { return readable(angle * 180.0 / pi, 2) + " degrees"; }

std::string place(const Vector2d& at) {
  return "x = " + readable(at.x(), 2) + " m, y = " + readable(at.y(), 2) + " m";
}

/// Looks at one map.
class Judgement {
 public:
  Judgement(const Machine& machine, const HeightMap& ground)
      : machine_(machine), ground_(ground), tracks_(machine) {}

  StandingGround run() {
    look_at_ring();
    if (static_cast<double>(points_.size()) >= fewest_cells) judge_plane();
    judge_support();
    judge_under();
    judge_drops();
    name_unseen();
    return std::move(found_);
  }

 private:
  template <typename Visit>
  void each_cell(Visit visit) const {
    for (Index col = 0; col < ground_.z.cols(); ++col) {
      for (Index row = 0; row < ground_.z.rows(); ++row) {
        visit(ground_.x(col), ground_.y(row), ground_.z(row, col));
      }
    }
  }

  double cell() const { return ground_.cell_size; }
  double area() const { return cell() * cell(); }

  void warn(WarningCode code, const std::string& what) { found_.warnings.emplace_back(code, what); }

  /// The sides of which enough is seen, and their cells.
  void look_at_ring() {
    std::array<double, 4> known{};
    double all = 0.0;
    each_cell([&](double x, double y, double z) {
      const double away = tracks_.distance(x, y);
      if (!(away > 0.0 && away <= ring) || std::isnan(z)) return;
      all += 1.0;
      points_.emplace_back(x, y, z);
      for (std::size_t i = 0; i < 4; ++i) {
        if (tracks_.is_on(static_cast<Side>(i), x, y)) known[i] += 1.0;
      }
    });
    const double length = tracks_.length(), width = machine_.undercarriage_width();
    for (std::size_t i = 0; i < 4; ++i) {
      const double whole = ring * (i % 2 == 0 ? width : length);
      seen_[i] = known[i] * area() >= least_seen * whole;
    }
    const double whole = ring * (2.0 * (length + width) + pi * ring);
    found_.seen = std::min(1.0, all * area() / whole);
  }

  bool sees(Side side) const { return seen_[static_cast<std::size_t>(side)]; }

  /// The slope of a plane is known along a side that is seen, and between two that face each other.
  void judge_plane() {
    const bool across = sees(Side::left) && sees(Side::right);
    const bool along = sees(Side::ahead) && sees(Side::behind);
    const bool x_is_known = along || sees(Side::left) || sees(Side::right);
    const bool y_is_known = across || sees(Side::ahead) || sees(Side::behind);
    if (!x_is_known && !y_is_known) return;
    const GroundPlane plane = plane_of_most(points_);
    Vector2d middle = Vector2d::Zero();
    double ends = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!seen_[i]) continue;
      for (const Vector2d& end : tracks_.ends(static_cast<Side>(i))) {
        middle += end;
        ends += 1.0;
      }
    }
    middle /= ends;
    found_.height = plane.at(middle.x(), middle.y());
    if (x_is_known) found_.rise_ahead = std::atan(plane.gradient().x());
    if (y_is_known) found_.rise_left = std::atan(plane.gradient().y());
    judge_height(*found_.height, middle);
    judge_tilt();
  }

  void judge_height(double height, const Vector2d& middle) {
    if (std::abs(height) <= off_height) return;
    const bool above = height > 0.0;
    warn(above ? WarningCode::ground_above_tracks : WarningCode::ground_below_tracks,
         "the ground about the tracks lies " + readable(std::abs(height), 2) + " m " +
             (above ? "above" : "below") + " the plane that they stand on, z = 0, at " +
             place(middle) + ": are the heights of the terrain those of the site frame?");
  }

  void judge_tilt() {
    const double ahead = std::tan(found_.rise_ahead.value_or(0.0));
    const double left = std::tan(found_.rise_left.value_or(0.0));
    const double tilt = std::atan(std::hypot(ahead, left));
    if (tilt <= off_level) return;
    const auto part = [](double rise, const char* up, const char* down) {
      return degrees(std::abs(rise)) + (rise > 0.0 ? up : down);
    };
    std::string parts;
    if (found_.rise_ahead) parts = part(*found_.rise_ahead, " up ahead", " down ahead");
    if (found_.rise_left) {
      parts += (parts.empty() ? "" : ", ") + part(*found_.rise_left, " up left", " down left");
    }
    warn(WarningCode::ground_tilted, "the ground about the tracks is " + degrees(tilt) +
                                         " off the plane of the machine (" + parts +
                                         "): state how it stands, or level the scan");
  }

  /// Every quarter of the tracks needs ground below it.
  void judge_support() {
    std::array<std::vector<double>, 4> quarters;
    each_cell([&](double x, double y, double z) {
      if (std::isnan(z) || tracks_.distance(x, y) > off_height) return;
      quarters[(x < 0.0 ? 2U : 0U) + (y < 0.0 ? 1U : 0U)].push_back(z);
    });
    if (has(WarningCode::ground_below_tracks)) return;
    static constexpr std::array names = {"front left", "front right", "rear left", "rear right"};
    for (std::size_t i = 0; i < 4; ++i) {
      if (static_cast<double>(quarters[i].size()) < fewest_cells) continue;
      const double height = median(quarters[i]);
      if (height >= under_a_quarter) continue;
      warn(WarningCode::ground_below_tracks, std::string("the ground under the ") + names[i] +
                                                 " of the tracks lies " + readable(-height, 2) +
                                                 " m below them");
      return;
    }
  }

  void judge_under() {
    double highest = 0.0, covered = 0.0;
    Vector2d at = Vector2d::Zero();
    each_cell([&](double x, double y, double z) {
      if (!(z > off_height) || tracks_.distance(x, y) > 0.0) return;
      covered += area();
      if (z > highest) {
        highest = z;
        at = {x, y};
      }
    });
    if (covered < least_area || has(WarningCode::ground_above_tracks)) return;
    warn(WarningCode::soil_under_tracks,
         readable(covered, 2) +
             " m2 of the ground where the machine stands rise above its tracks, "
             "the highest by " +
             readable(highest, 2) + " m at " + place(at) +
             ": soil under them, or the machine itself in the scan?");
  }

  bool has(WarningCode code) const {
    return std::any_of(found_.warnings.begin(), found_.warnings.end(),
                       [code](const Warning& each) { return each.code == code; });
  }

  double height_of(const Vector2d& at) const {
    const auto place = cell_at(ground_, at.x(), at.y());
    return place ? ground_.z(place->row, place->col) : 0.0;
  }

  /// Where a drop may begin, on the way to the tracks: its edge hides at most as much ground behind
  /// it as it is deep.
  Vector2d nearest_edge(const Vector2d& far, double depth) const {
    const Vector2d way = tracks_.nearest(far.x(), far.y()) - far;
    const double distance = way.norm();
    Vector2d edge = far;
    for (double back = cell(); back < std::min(distance, depth); back += cell()) {
      const Vector2d at = far + back / distance * way;
      if (!std::isnan(height_of(at))) break;
      edge = at;
    }
    return edge;
  }

  /// Straight ahead, with its end near the tracks as far from them as the machine digs.
  bool is_own_cut(Vector2d edge) const {
    if (std::abs(edge.y()) > 0.5 * machine_.bucket.width_outside + beside_own_cut) return false;
    const double nearest = machine_.track_front + before_own_cut;
    while (edge.x() >= nearest && !(height_of(edge) > -least_drop)) edge.x() -= cell();
    return edge.x() >= nearest;
  }

  void judge_drops() {
    if (has(WarningCode::ground_below_tracks)) return;
    double area_of_drop = 0.0, depth = 0.0;
    double nearest = std::numeric_limits<double>::infinity();
    Vector2d at = Vector2d::Zero();
    each_cell([&](double x, double y, double z) {
      if (!(-z >= least_drop)) return;
      const Vector2d edge = nearest_edge({x, y}, -z);
      const double away = tracks_.distance(edge.x(), edge.y());
      if (away > -z || is_own_cut(edge)) return;
      area_of_drop += area();
      depth = std::max(depth, -z);
      if (away < nearest) {
        nearest = away;
        at = edge;
      }
    });
    if (area_of_drop < least_area) return;
    warn(WarningCode::drop_at_tracks,
         "the ground drops by " + readable(depth, 2) + " m " +
             (nearest > 0.0 ? readable(nearest, 2) + " m from the tracks" : "under the tracks") +
             ", first at " + place(at) + ": nearer than it is deep, its edge may give way");
  }

  void name_unseen() {
    std::string sides;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!seen_[i]) sides += (sides.empty() ? "" : ", ") + std::string(side_names[i]);
    }
    if (sides.empty()) return;
    warn(WarningCode::ground_at_tracks_unseen,
         "the scan shows " + readable(100.0 * found_.seen, 2) +
             " % of the ground within a metre of the tracks, too little of it " + sides +
             ": height, slope and drops there are not known");
  }

  const Machine& machine_;
  const HeightMap& ground_;
  Tracks tracks_;
  std::vector<Vector3d> points_;  ///< of the ring
  std::array<bool, 4> seen_{};    ///< by Side
  StandingGround found_;
};

}  // namespace

StandingGround standing_ground(const Machine& machine, const HeightMap& ground) {
  require_machine(machine);
  require_grid(ground, "ground that the machine stands on");
  return Judgement(machine, ground).run();
}

HeightMap known_from_both(const HeightMap& present, const HeightMap& earlier) {
  HeightMap both = present;
  for (Index col = 0; col < both.z.cols(); ++col) {
    for (Index row = 0; row < both.z.rows(); ++row) {
      double& z = both.z(row, col);
      if (std::isnan(z)) z = height_at(earlier, both.x(col), both.y(row));
    }
  }
  return both;
}

}  // namespace excavplan
