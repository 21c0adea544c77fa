// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "clouds/cloud_units.hpp"

#include <algorithm>
#include <cmath>

#include "base/angles.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

/// The unit that brings a quantity, of this power of a length, nearest to the usual.
const CloudUnit& nearest_unit(double quantity, int power, double unit, double usual) {
  const auto miss = [&](const CloudUnit& other) {
    return std::abs(std::log(quantity * std::pow(other.length / unit, power) / usual));
  };
  const std::vector<CloudUnit>& all = cloud_units();
  return *std::min_element(all.begin(), all.end(), [&](const CloudUnit& a, const CloudUnit& b) {
    return miss(a) < miss(b);
  });
}

std::string size_of(const Rectangle& r, double scale) {
  return readable(scale * (r.x_max - r.x_min)) + " x " + readable(scale * (r.y_max - r.y_min)) +
         " m";
}

/// What an extent is on the Earth if it is one of degrees, by a sphere; empty where it is none of a
/// site away from where they begin.
std::string as_degrees(const Rectangle& r) {
  constexpr double degree = 111195.0;  // of a great circle of radius 6371 km [m]
  constexpr double widest = 0.02;      // ours: 2 km [deg]
  constexpr double nearest = 0.1;      // ours: from 0 N 0 E [deg]
  const bool is_on_earth = std::abs(r.x_max) <= 180.0 && std::abs(r.y_max) <= 90.0;
  const double width = std::max(r.x_max - r.x_min, r.y_max - r.y_min);
  const bool is_far = std::max(std::abs(r.x_min), std::abs(r.y_min)) > nearest;
  if (!is_on_earth || !is_far || !(width > 0.0 && width < widest)) return "";
  const double east = degree * std::cos(r.y_min * pi / 180.0);
  return readable(east * (r.x_max - r.x_min), 2) + " x " +
         readable(degree * (r.y_max - r.y_min), 2) + " m";
}

}  // namespace

const std::vector<CloudUnit>& cloud_units() {
  static const std::vector<CloudUnit> units = {
      {"cm", 0.01}, {"ft", 0.3048}, {"in", 0.0254}, {"m", 1.0}, {"mm", 0.001}};
  return units;
}

const CloudUnit& likely_unit(double volume, double unit, double usual) {
  return nearest_unit(volume, 3, unit, usual);
}

std::optional<Warning> doubt_of_volume(double volume, const std::string& what, double unit) {
  constexpr double most = 1000.0;  // [m^3]; ours: five times the largest dragline's bucket, 168 m^3
  constexpr double usual = 1.0;    // [m^3], ours
  constexpr double least = 0.001;  // [m^3], ours: a tenth of the smallest excavator's bucket
  if (!(volume > most || (volume > 0.0 && volume < least))) return std::nullopt;
  const CloudUnit& likely = likely_unit(volume, unit, usual);
  std::string message = what + " of " + readable(volume) + " m^3 is none of a bucket";
  if (likely.length == unit) {
    message += ": check `unit`, and the depth unit of a camera";
  } else {
    message += "; with coordinates in " + likely.word + " it would be " +
               readable(volume * std::pow(likely.length / unit, 3)) +
               " m^3: give the unit of the clouds by `unit`, probably `unit` " + likely.word;
  }
  return Warning{WarningCode::units, message};
}

std::optional<Warning> doubt_of_extent(const Rectangle& extent, double density, double unit) {
  constexpr double least = 0.3;          // ours: narrower than any bucket [m]
  constexpr double wide = 100.0;         // ours [m]
  constexpr double least_density = 1.0;  // ours: surveys from the air have more [1/m^2]
  constexpr double usual = 10.0;         // ours: what a machine reaches [m]
  const double width = std::max(extent.x_max - extent.x_min, extent.y_max - extent.y_min);
  const bool is_thin = width > wide && density < least_density;
  if (!(width <= least || is_thin)) return std::nullopt;
  std::string message = "the points spread over " + size_of(extent, 1.0);
  if (is_thin) message += ", with " + readable(density, 2) + " of them per m^2";
  if (const std::string ground = as_degrees(extent); unit == 1.0 && !ground.empty()) {
    return Warning{WarningCode::units, message +
                                           "; as degrees of longitude and latitude it would "
                                           "be " +
                                           ground + ": project them to metres"};
  }
  const CloudUnit& likely = nearest_unit(width, 1, unit, usual);
  if (width > 0.0 && likely.length != unit) {
    message += "; with coordinates in " + likely.word + " it would be " +
               size_of(extent, likely.length / unit);
  }
  return Warning{WarningCode::units, message + ": is `unit` that of the coordinates?"};
}

}  // namespace excavplan
