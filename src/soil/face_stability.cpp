// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/soil/face_stability.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "base/check.hpp"

namespace excavplan {
namespace {

using Eigen::Vector2d;

// Numbers of our own choice.
constexpr int slices = 24;
constexpr int most_rounds = 30;       // of Bishop's factor
constexpr double same_factor = 1e-6;  // between two of them
constexpr double least_bearing =
    0.2;  // cos a + sin a tan phi / F (Whitman and Bailey 1967, recalled)
constexpr double nearest_exit = 0.02;  // of a slip behind the edge, in heights
constexpr double farthest_exit = 3.0;  // likewise
constexpr int exits = 20;              // that are looked at between them
constexpr int bends = 12;              // of the slip at each
constexpr int refinements = 3;         // about the worst, each of a third of the steps
constexpr double steepest_slip = 1.5;  // [rad]
constexpr double deepest_entry = 0.8;  // of a slip below the toe [rad]
constexpr double flattest = 4.0;       // run over height
constexpr double batter_step = 0.05;   // likewise

/// A slip surface from the toe: where it ends, and by how much it bends up from its chord there.
struct Slip {
  Vector2d end;  ///< from the toe [m]
  double bend;   ///< half of its angle at the centre [rad]; 0: a plane
};

class FaceStability {
 public:
  FaceStability(const SoilState& soil, const SoilFace& face, double crack)
      : soil_(soil), face_(face), friction_(std::tan(soil.friction_angle)) {
    crack_ = std::min(0.5 * critical_height(soil), crack * face.height);
  }

  double least() const {
    double log_exit = std::log(nearest_exit * face_.height);
    double log_step = std::log(farthest_exit / nearest_exit) / (exits - 1);
    double worst = std::numeric_limits<double>::infinity();
    double at = log_exit, bend_at = 0.0;
    const auto look = [&](double log_x, double share) {
      const double factor = factor_of(slip(std::exp(log_x), share));
      if (!(factor < worst)) return;
      worst = factor;
      at = log_x;
      bend_at = share;
    };
    for (int i = 0; i < exits; ++i) {
      for (int k = 0; k < bends; ++k)
        look(log_exit + i * log_step, static_cast<double>(k) / (bends - 1));
    }
    double share_step = 1.0 / (bends - 1);
    for (int round = 0; round < refinements; ++round) {
      log_step /= 3.0;
      share_step /= 3.0;
      const double middle = at, middle_bend = bend_at;
      for (int i = -2; i <= 2; ++i) {
        for (int k = -2; k <= 2; ++k)
          look(middle + i * log_step, std::clamp(middle_bend + k * share_step, 0.0, 1.0));
      }
    }
    return worst;
  }

 private:
  /// @param share  of the most that it can bend
  Slip slip(double exit, double share) const {
    const Vector2d end(face_.run + exit, face_.height - crack_);
    const double chord = std::atan2(end.y(), end.x());
    return {end, share * std::max(0.0, std::min(steepest_slip - chord, chord + deepest_entry))};
  }

  /// Height of the ground over the toe.
  double ground(double x) const {
    return x < face_.run ? face_.height * x / face_.run : face_.height;
  }

  double load(double x) const {
    const double place = (x - face_.run) / face_.load_step;
    if (place < 0.0 || place >= static_cast<double>(face_.loads.size())) return 0.0;
    return face_.loads[static_cast<std::size_t>(place)];
  }

  struct Slice {
    double weight = 0.0;  ///< with its load [N/m]
    double sin = 0.0;     ///< of its base
    double cos = 1.0;
  };

  std::array<Slice, slices> cut(const Slip& slip) const {
    std::array<Slice, slices> all;
    const double chord = std::atan2(slip.end.y(), slip.end.x());
    const double width = slip.end.x() / slices;
    const double radius = slip.bend > 0.0 ? 0.5 * slip.end.norm() / std::sin(slip.bend) : 0.0;
    const double entry = chord - slip.bend;
    const Vector2d centre = radius * Vector2d(-std::sin(entry), std::cos(entry));
    for (int i = 0; i < slices; ++i) {
      Slice& slice = all[static_cast<std::size_t>(i)];
      const double x = (i + 0.5) * width;
      slice.sin = slip.bend > 0.0 ? (x - centre.x()) / radius : std::sin(chord);
      slice.cos = std::sqrt(std::max(0.0, 1.0 - slice.sin * slice.sin));
      const double base = slip.bend > 0.0 ? centre.y() - radius * slice.cos : x * std::tan(chord);
      const double height = std::max(0.0, ground(x) - base);
      slice.weight = width * (soil_.unit_weight * height + load(x));
    }
    return all;
  }

  double factor_of(const Slip& slip) const {
    constexpr double none = std::numeric_limits<double>::infinity();
    if (!(slip.end.x() > 0.0)) return none;
    const auto all = cut(slip);
    const double stuck = soil_.cohesion * slip.end.x() / slices;
    double driving = 0.0, resisting = 0.0;
    for (const Slice& each : all) {
      driving += each.weight * each.sin;
      resisting += stuck / std::max(least_bearing, each.cos) + each.weight * each.cos * friction_;
    }
    if (!(driving > 0.0)) return none;
    double factor = resisting / driving;  // Fellenius 1936
    for (int round = 0; round < most_rounds; ++round) {
      resisting = 0.0;
      for (const Slice& each : all) {
        const double bearing = each.cos + each.sin * friction_ / factor;
        if (bearing < least_bearing) return none;
        resisting += (stuck + each.weight * friction_) / bearing;
      }
      const double last = factor;
      factor = resisting / driving;
      if (!(factor > 0.0)) return 0.0;
      if (std::abs(factor - last) < same_factor * last) break;
    }
    return factor;
  }

  const SoilState& soil_;
  const SoilFace& face_;
  double friction_;
  double crack_;
};

void require_face(const SoilState& soil, const SoilFace& face) {
  constexpr double most = 1e6;
  require_in("face: height [m]", face.height, 1e-3, most);
  require_in("face: run [m]", face.run, 0.0, most);
  require_in("face: step of its loads [m]", face.load_step, 1e-3, most);
  for (const double load : face.loads) require_in("face: a load [Pa]", load, 0.0, 1e9);
  require_in("face: cohesion of the soil [Pa]", soil.cohesion, 0.0, 1e9);
  require_in("face: friction angle of the soil [rad]", soil.friction_angle, 0.0, 1.4);
  require_in("face: unit weight of the soil [N/m^3]", soil.unit_weight, 1.0, most);
}

}  // namespace

double factor_of_safety(const SoilState& soil, const SoilFace& face, double crack) {
  require_face(soil, face);
  require_in("face: depth of the crack over the height", crack, 0.0, 0.9);
  return FaceStability(soil, face, crack).least();
}

std::optional<double> standing_batter(const SoilState& soil, SoilFace face, double least_factor) {
  require_in("face: least factor of safety", least_factor, 0.0, 100.0);
  for (int i = 0; i * batter_step <= flattest; ++i) {
    face.run = i * batter_step * face.height;
    if (factor_of_safety(soil, face) >= least_factor) return i * batter_step;
  }
  return std::nullopt;
}

}  // namespace excavplan
