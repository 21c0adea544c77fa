// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <excavplan/machine/dig_path.hpp>

#include "drawing/drawing.hpp"

namespace excavplan {

/// Okabe and Ito's colours, distinct for colour-blind readers too.
namespace colours {
constexpr const char* black = "#000000";
constexpr const char* orange = "#e69f00";
constexpr const char* sky = "#56b4e9";
constexpr const char* green = "#009e73";
constexpr const char* blue = "#0072b2";
constexpr const char* vermilion = "#d55e00";
constexpr const char* purple = "#cc79a7";
constexpr const char* grey = "#777777";
}  // namespace colours

/// Line of the tip in a phase: a colour and dashes of its own, for print without colour too.
Style phase_style(DigPhase phase);

/// Grey of a phase, for strips beside curves.
const char* phase_grey(DigPhase phase);

/// Colour of a value from -1 to 1: red, white, blue, distinct for colour-blind readers too
/// (ColorBrewer's RdBu, C. Brewer).
std::string diverging_colour(double value);

/// Colour of a value from 0 to 1, dark to light, of even steps to the eye (viridis, S. van der Walt
/// and N. Smith).
std::string sequential_colour(double value);

/// Upper bounds of bands in steps of 1, 2, 5, 10, ... from `least` on, as many as lie below
/// `largest`, but one at least.
std::vector<double> colour_bands(double least, double largest);

/// Colour of a value: white below the first bound, then one of diverging_colour() for each band, so
/// that centimetres show beside decimetres.
std::string band_colour(double value, const std::vector<double>& bands);

/// Colour of the band so many bands above 0, or below if negative, of `count` on either side.
std::string colour_of_band(int band, std::size_t count);

/// Colours of the values of a map: of bands on either side of 0, or even from low to high.
struct ColourScale {
  std::vector<double> bands = {};  ///< empty: sequential_colour()
  double low = 0.0;
  double high = 1.0;
  std::string colour(double value) const;
};

}  // namespace excavplan
