// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/quantity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <excavplan/base/error.hpp>
#include <excavplan/scans/scan_pose.hpp>

#include "base/angles.hpp"
#include "base/read_double.hpp"

namespace excavplan::tools {
namespace {

struct QuantityInfo {
  Quantity quantity;
  const char* placeholder;
  const char* unit;
  const char* kind;
  const char* examples;
};
constexpr std::array<QuantityInfo, 11> quantities = {{
    {Quantity::length, "LENGTH", "m", "a length", "0.05, 5cm or 50mm"},
    {Quantity::angle, "ANGLE", "rad", "an angle", "0.785 or 45deg"},
    {Quantity::area, "AREA", "m^2", "an area", "0.03 or 300cm2"},
    {Quantity::volume, "VOLUME", "m^3", "a volume", "0.4 or 400L"},
    {Quantity::mass, "MASS", "kg", "a mass", "800 or 0.8t"},
    {Quantity::time, "TIME", "s", "a time", "90, 90s or 1.5min"},
    {Quantity::frequency, "FREQUENCY", "Hz", "a frequency", "100 or 100Hz"},
    {Quantity::energy, "ENERGY", "J", "an energy", "80000 or 80kJ"},
    {Quantity::density, "DENSITY", "kg/m^3", "a density", "1500 or 1.5t/m3"},
    {Quantity::percent, "PERCENT", "%", "a percentage", "40 or 40%"},
    {Quantity::ratio, "NUMBER", "-", "a number without a unit", "1.2"},
}};

struct Unit {
  const char* text;
  Quantity quantity;
  double factor;
};
constexpr std::array<Unit, 28> units = {{
    {"m", Quantity::length, 1.0},         {"cm", Quantity::length, 0.01},
    {"mm", Quantity::length, 0.001},      {"rad", Quantity::angle, 1.0},
    {"deg", Quantity::angle, pi / 180.0}, {"m2", Quantity::area, 1.0},
    {"m^2", Quantity::area, 1.0},         {"cm2", Quantity::area, 1e-4},
    {"m3", Quantity::volume, 1.0},        {"m^3", Quantity::volume, 1.0},
    {"L", Quantity::volume, 0.001},       {"l", Quantity::volume, 0.001},
    {"kg", Quantity::mass, 1.0},          {"t", Quantity::mass, 1000.0},
    {"s", Quantity::time, 1.0},           {"ms", Quantity::time, 0.001},
    {"min", Quantity::time, 60.0},        {"h", Quantity::time, 3600.0},
    {"J", Quantity::energy, 1.0},         {"kJ", Quantity::energy, 1e3},
    {"MJ", Quantity::energy, 1e6},        {"kg/m3", Quantity::density, 1.0},
    {"kg/m^3", Quantity::density, 1.0},   {"t/m3", Quantity::density, 1e3},
    {"t/m^3", Quantity::density, 1e3},    {"g/cm3", Quantity::density, 1e3},
    {"%", Quantity::percent, 1.0},        {"Hz", Quantity::frequency, 1.0},
}};

const QuantityInfo& info(Quantity quantity) {
  return *std::find_if(quantities.begin(), quantities.end(),
                       [&](const QuantityInfo& row) { return row.quantity == quantity; });
}

/// @throws Error (bad_input) unless there are `count` parts between commas
std::vector<std::string> parts_of(const std::string& what, const std::string& text,
                                  std::size_t count, const std::string& form) {
  std::vector<std::string> parts = split(text, ',');
  if (parts.size() != count || parts.back().empty()) {
    throw Error(ErrorKind::bad_input, what + ": '" + text + "' is not " + form);
  }
  return parts;
}

void append(std::string& list, const char* separator, const std::string& word) {
  list += (list.empty() ? "" : separator) + word;
}

}  // namespace

const char* placeholder(Quantity quantity) { return info(quantity).placeholder; }
const char* unit(Quantity quantity) { return info(quantity).unit; }

double parse_quantity(const std::string& what, const std::string& text, Quantity quantity) {
  const QuantityInfo& wanted = info(quantity);
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::bad_input, what + ": '" + text + "' " + why + ", expected " +
                                          wanted.kind + " such as " + wanted.examples);
  };
  const bool plus = text.rfind('+', 0) == 0 && text.rfind("+-", 0) != 0;
  const char* const begin = text.data() + (plus ? 1 : 0);
  const char* const end = text.data() + text.size();
  double value = 0.0;
  const auto [stop, error] = read_double(begin, end, value);
  if (error != std::errc{} || !std::isfinite(value)) refuse("is not a number");
  std::string suffix(stop, end);
  suffix.erase(0, suffix.find_first_not_of(' '));
  if (suffix.empty() && quantity == Quantity::angle && std::abs(value) > 2.0 * pi) {
    throw Error(ErrorKind::bad_input, what + ": '" + text +
                                          "' rad is more than a turn; degrees have their unit, "
                                          "as in 45deg");
  }
  if (suffix.empty()) return value;
  if (suffix[0] == ',') refuse("has a comma where decimals follow a point");
  const auto known =
      std::find_if(units.begin(), units.end(), [&](const Unit& row) { return suffix == row.text; });
  if (known == units.end()) {
    refuse("has the unknown unit '" + suffix + "'");
  } else if (known->quantity != quantity) {
    refuse(std::string("is ") + info(known->quantity).kind);
  }
  return value * known->factor;
}

Quantity quantity_of(const std::string& unit) {
  return std::find_if(quantities.begin(), quantities.end(),
                      [&](const QuantityInfo& row) { return unit == row.unit; })
      ->quantity;
}

DigPathForm dig_path_form() {
  DigPathForm form;
  for (const DigParameterInfo& row : dig_parameter_table()) {
    append(form.placeholder, ",", placeholder(quantity_of(row.unit)));
    append(form.units, ",", row.unit);
    append(form.names, ", ", row.text);
  }
  return form;
}

std::string dig_path_argument(const DigParameters& parameters) {
  std::string text;
  for (const DigParameterInfo& row : dig_parameter_table()) {
    const bool angle = quantity_of(row.unit) == Quantity::angle;
    const double value = parameters.*row.field * (angle ? 180.0 / pi : 1.0);
    append(text, ",", number_text(std::round(1e9 * value) / 1e9) + (angle ? "deg" : row.unit));
  }
  return text;
}

DigParameters parse_dig_path(const std::string& what, const std::string& text) {
  const auto& table = dig_parameter_table();
  const DigPathForm form = dig_path_form();
  const auto parts = parts_of(what, text, table.size(),
                              "a path " + form.placeholder + " (" + form.names + ") such as " +
                                  dig_path_argument(paper_fixed_path()));
  DigParameters parameters;
  for (std::size_t i = 0; i < table.size(); ++i) {
    parameters.*table[i].field = parse_quantity(what, parts[i], quantity_of(table[i].unit));
  }
  return parameters;
}

std::vector<double> parse_lengths(const std::string& what, const std::string& text,
                                  std::size_t count, const std::string& form) {
  std::vector<double> lengths;
  for (const std::string& part : parts_of(what, text, count, form)) {
    lengths.push_back(parse_quantity(what, part, Quantity::length));
  }
  return lengths;
}

Rectangle parse_rectangle(const std::string& what, const std::string& text) {
  const auto corner = parse_lengths(what, text, 4, "an area XMIN,YMIN,XMAX,YMAX such as 4,-1,7,1");
  if (corner[0] >= corner[2] || corner[1] >= corner[3]) {
    throw Error(ErrorKind::bad_input,
                what + ": '" + text + "' is empty: XMIN must be below XMAX, YMIN below YMAX");
  }
  return {corner[0], corner[1], corner[2], corner[3]};
}

Eigen::Vector2d parse_point(const std::string& what, const std::string& text) {
  const auto point = parse_lengths(what, text, 2, "a point X,Y such as 5,2.5");
  return {point[0], point[1]};
}

Eigen::Vector3d parse_place(const std::string& what, const std::string& text) {
  const auto parts = parts_of(what, text, 3, "a place X,Y,Z such as 5,2.5,3");
  return {parse_quantity(what, parts[0], Quantity::length),
          parse_quantity(what, parts[1], Quantity::length),
          parse_quantity(what, parts[2], Quantity::length)};
}

Eigen::Matrix4d parse_pose(const std::string& what, const std::string& text) {
  const auto parts = parts_of(what, text, 7, "a pose X,Y,Z,QX,QY,QZ,QW such as 1,0,2,0,0,0,1");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Quantity kind = i < 3 ? Quantity::length : Quantity::ratio;
    numbers.push_back(parse_quantity(what, parts[i], kind));
  }
  try {
    return pose_of_quaternion(Eigen::Vector3d(numbers.data()), Eigen::Vector4d(&numbers[3]));
  } catch (const Error& error) {
    throw Error(error.kind(), what + ": " + error.what());
  }
}

MachinePosture parse_posture(const std::string& what, const std::string& text) {
  const auto parts =
      parts_of(what, text, 4, "a posture SWING,BOOM,ARM,BUCKET such as 0,-20deg,70deg,40deg");
  const auto angle = [&](std::size_t i) { return parse_quantity(what, parts[i], Quantity::angle); };
  return {angle(0), {angle(1), angle(2), angle(3)}};
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

std::vector<double> parse_series(const std::string& what, const std::string& text,
                                 Quantity quantity) {
  std::vector<double> series;
  const auto number = [&](const std::string& word) { return parse_quantity(what, word, quantity); };
  const std::vector<std::string> range = split(text, ':');
  if (range.size() == 1) {
    for (const std::string& word : split(text, ',')) series.push_back(number(word));
    return series;
  }
  constexpr double most = 1e4;
  const double step = range.size() == 3 ? number(range[1]) : 0.0;
  const double steps = step > 0.0 ? (number(range[2]) - number(range[0])) / step : HUGE_VAL;
  if (!(steps < most)) {
    throw Error(ErrorKind::bad_input, what + ": '" + text +
                                          "' is not first:step:last with a step above 0 and at "
                                          "most 10000 of them");
  }
  for (int i = 0; i <= std::floor(steps + 1e-9); ++i) {
    const double value = number(range[0]) + i * step;
    series.push_back(std::abs(value) < 1e-9 * step ? 0.0 : value);
  }
  if (series.empty()) throw Error(ErrorKind::bad_input, what + ": '" + text + "' holds no number");
  return series;
}

std::vector<double> parse_densities(const std::string& what, const std::string& text) {
  std::vector<double> densities = parse_series(what, text, Quantity::percent);
  for (const double density : densities) {
    if (density >= 0.0 && density <= 100.0) continue;
    throw Error(ErrorKind::bad_input,
                what + ": " + number_text(density) + " % is outside 0 .. 100");
  }
  return densities;
}

}  // namespace excavplan::tools
