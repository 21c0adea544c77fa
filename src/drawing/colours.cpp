// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "drawing/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace excavplan {
namespace {

using Rgb = std::array<int, 3>;

/// Between colours at even distances, `value` from 0 to 1.
template <std::size_t Count>
std::string between(const std::array<Rgb, Count>& anchors, double value) {
  const double place = std::clamp(value, 0.0, 1.0) * static_cast<double>(Count - 1);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), Count - 2);
  const double share = place - static_cast<double>(below);
  std::string colour = "#";
  for (std::size_t i = 0; i < 3; ++i) {
    const double mixed = (1.0 - share) * anchors[below][i] + share * anchors[below + 1][i];
    const auto byte = static_cast<unsigned>(std::lround(mixed));
    colour += "0123456789abcdef"[byte / 16];
    colour += "0123456789abcdef"[byte % 16];
  }
  return colour;
}

/// The band of a value, counted from 0 in the middle, with its sign.
int band_of(double value, const std::vector<double>& bands) {
  const auto beyond = std::upper_bound(bands.begin(), bands.end(), std::abs(value)) - bands.begin();
  return static_cast<int>(value < 0.0 ? -beyond : beyond);
}

}  // namespace

Style phase_style(DigPhase phase) {
  switch (phase) {
    case DigPhase::approach:
      return {colours::grey, 1.0, "none", 1.0, {1.0, 2.0}};
    case DigPhase::penetrate:
      return {colours::vermilion, 1.6};
    case DigPhase::drag:
      return {colours::blue, 1.6, "none", 1.0, {5.0, 1.5}};
    case DigPhase::scoop:
      return {colours::green, 1.6, "none", 1.0, {1.6, 1.4}};
    case DigPhase::swing:
    case DigPhase::dump:
    case DigPhase::back:
      return {colours::grey, 1.2};
    case DigPhase::lift:
      return {colours::purple, 1.2, "none", 1.0, {5.0, 1.5, 1.2, 1.5}};
  }
  return {};
}

const char* phase_grey(DigPhase phase) {
  switch (phase) {
    case DigPhase::penetrate:
      return "#4d4d4d";
    case DigPhase::drag:
      return "#999999";
    case DigPhase::scoop:
      return "#d0d0d0";
    case DigPhase::approach:
    case DigPhase::lift:
    case DigPhase::swing:
    case DigPhase::dump:
    case DigPhase::back:
      break;
  }
  return "#f0f0f0";
}

std::string diverging_colour(double value) {
  constexpr std::array<Rgb, 11> anchors = {{{0x67, 0x00, 0x1f},
                                            {0xb2, 0x18, 0x2b},
                                            {0xd6, 0x60, 0x4d},
                                            {0xf4, 0xa5, 0x82},
                                            {0xfd, 0xdb, 0xc7},
                                            {0xf7, 0xf7, 0xf7},
                                            {0xd1, 0xe5, 0xf0},
                                            {0x92, 0xc5, 0xde},
                                            {0x43, 0x93, 0xc3},
                                            {0x21, 0x66, 0xac},
                                            {0x05, 0x30, 0x61}}};
  return between(anchors, (value + 1.0) / 2.0);
}

std::string sequential_colour(double value) {
  constexpr std::array<Rgb, 11> anchors = {{{0x44, 0x01, 0x54},
                                            {0x48, 0x24, 0x75},
                                            {0x41, 0x44, 0x87},
                                            {0x35, 0x5f, 0x8d},
                                            {0x2a, 0x78, 0x8e},
                                            {0x21, 0x91, 0x8c},
                                            {0x22, 0xa8, 0x84},
                                            {0x44, 0xbf, 0x70},
                                            {0x7a, 0xd1, 0x51},
                                            {0xbd, 0xdf, 0x26},
                                            {0xfd, 0xe7, 0x25}}};
  return between(anchors, value);
}

std::vector<double> colour_bands(double least, double largest) {
  std::vector<double> bands;
  for (double decade = 1e-3; decade < 1e3; decade *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double bound = factor * decade;
      if (bound < least * (1.0 - 1e-9)) continue;
      if (bound >= largest && !bands.empty()) return bands;
      bands.push_back(bound);
    }
  }
  return bands;
}

std::string colour_of_band(int band, std::size_t count) {
  return diverging_colour(static_cast<double>(band) / static_cast<double>(count));
}

std::string band_colour(double value, const std::vector<double>& bands) {
  return colour_of_band(band_of(value, bands), bands.size());
}

std::string ColourScale::colour(double value) const {
  if (!bands.empty()) return band_colour(value, bands);
  constexpr double steps = 40.0;  // few enough for runs of equal colour
  return sequential_colour(std::round(steps * (value - low) / (high - low)) / steps);
}

}  // namespace excavplan
