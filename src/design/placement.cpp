// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "design/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>

#include "base/check.hpp"
#include "base/statistics.hpp"
#include "base/text.hpp"
#include "design/pieces.hpp"

namespace excavplan {
namespace {

constexpr double farthest_off = 30.0;  // between ground and design [m]; ours
constexpr double well = 0.9;           // of a design on known ground; ours
constexpr double shortest = 0.5;       // design that could be meant [m]; ours

struct Factor {
  double value;
  const char* words;
};
constexpr std::array<Factor, 9> factors = {{{1.0, ""},
                                            {0.3048, "feet taken for metres"},
                                            {1.0 / 0.3048, "metres taken for feet"},
                                            {0.001, "millimetres taken for metres"},
                                            {1000.0, "metres taken for millimetres"},
                                            {0.01, "centimetres taken for metres"},
                                            {100.0, "metres taken for centimetres"},
                                            {0.0254, "inches taken for metres"},
                                            {1.0 / 0.0254, "metres taken for inches"}}};

/// Places of the design, each with the area that it stands for: heights at middles of faces.
struct Sample {
  Eigen::Vector3d place;
  double area;
};

std::vector<Sample> samples_of(const DesignSurface& design) {
  constexpr std::size_t most_faces = 50000;  // evenly over the file; ours
  std::size_t faces = 0, next = 0;
  for_each_face(design, HeightMap{}, [&faces](const Piece&) { ++faces; });
  const std::size_t step = 1 + faces / most_faces;
  std::vector<Sample> samples;
  for_each_face(design, HeightMap{}, [&](const Piece& face) {
    if (next++ % step != 0) return;
    const double area = sum_of(face).area;
    constexpr double towards_middle = 0.5;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < face.count; ++i) {
      middle += face.corners[i] / static_cast<double>(face.count);
    }
    for (std::size_t i = 0; i < face.count; ++i) {
      samples.push_back({middle + towards_middle * (face.corners[i] - middle),
                         area / static_cast<double>(face.count)});
    }
  });
  return samples;
}

struct Fit {
  double known_share = 0.0;
  double height = 0.0;  ///< median of the ground above the design [m]
};

Fit fit_of(const std::vector<Sample>& samples, const HeightMap& ground, bool swapped,
           double factor) {
  double known = 0.0, all = 0.0;
  std::vector<double> above;
  for (const Sample& sample : samples) {
    const Eigen::Vector3d place = factor * sample.place;
    const auto at =
        swapped ? cell_at(ground, place.y(), place.x()) : cell_at(ground, place.x(), place.y());
    all += sample.area;
    if (!at || std::isnan(ground.z(at->row, at->col))) continue;
    known += sample.area;
    above.push_back(ground.z(at->row, at->col) - place.z());
  }
  if (above.empty() || !(all > 0.0)) return {};
  return {known / all, median(above)};
}

std::string range_text(double low, double high) {
  return readable(low, 4) + " .. " + readable(high, 4);
}

/// What comes of a single mistake is told first.
std::string advice_for(const std::vector<Sample>& samples, double length, const HeightMap& ground) {
  constexpr std::array<std::pair<bool, bool>, 3> mistakes = {
      {{true, false}, {false, true}, {true, true}}};
  for (const auto& [swapped, scaled] : mistakes) {
    for (const Factor& factor : factors) {
      if ((factor.value != 1.0) != scaled || factor.value * length < shortest) continue;
      const Fit fit = fit_of(samples, ground, swapped, factor.value);
      if (fit.known_share < well || std::abs(fit.height) > farthest_off) continue;
      const std::string how = swapped
                                  ? std::string("x and y (easting and northing) are swapped") +
                                        (scaled ? std::string(" and they are ") : "") + factor.words
                                  : std::string("they are ") + factor.words;
      return ": it would with " + readable(100.0 * fit.known_share, 2) +
             " % of its area if its coordinates are " +
             (swapped ? "put right, as " : "scaled, as ") + how;
    }
  }
  return ": no swap of x and y and no usual unit makes it fit; are both in the same frame?";
}

}  // namespace

void require_placement(const DesignSurface& design, const HeightMap& ground, double least_share) {
  const Rectangle own = extent_of(design);
  const Rectangle map = ground.extent();
  const std::vector<Sample> samples = samples_of(design);
  const Fit fit = fit_of(samples, ground, false, 1.0);
  const std::string what = "design " + in_quotes(design.name);
  if (fit.known_share < least_share) {
    const double length = std::max(own.x_max - own.x_min, own.y_max - own.y_min);
    throw Error(ErrorKind::bad_file,
                what + ": only " + readable(100.0 * fit.known_share, 2) +
                    " % of it lies on known ground (x " + range_text(own.x_min, own.x_max) +
                    " m, y " + range_text(own.y_min, own.y_max) + " m; the scan x " +
                    range_text(map.x_min, map.x_max) + " m, y " + range_text(map.y_min, map.y_max) +
                    " m)" + advice_for(samples, length, ground));
  }
  if (std::abs(fit.height) <= farthest_off) return;
  throw Error(ErrorKind::bad_file,
              what + ": it lies " + readable(std::abs(fit.height), 3) + " m " +
                  (fit.height > 0.0 ? "below" : "above") +
                  " the ground, expected within 30 m: are heights in the same unit and datum?");
}

}  // namespace excavplan
