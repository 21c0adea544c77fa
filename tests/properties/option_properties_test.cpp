// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/quantity.hpp"

#include "support/cases.hpp"
#include "support/errors.hpp"

namespace excavplan::tools {
namespace {

using test::drawn_bytes;
using test::drawn_int;
using test::drawn_number;
using test::for_cases;

struct KnownUnit {
  const char* text;
  Quantity quantity;
  double in_si;
};
/// By the definitions of the SI and of its prefixes.
const KnownUnit known_units[] = {
    {"m", Quantity::length, 1.0},
    {"cm", Quantity::length, 1.0 / 100.0},
    {"mm", Quantity::length, 1e-3},
    {"rad", Quantity::angle, 1.0},
    {"deg", Quantity::angle, 0.017453292519943295},
    {"cm2", Quantity::area, 1e-4},
    {"m3", Quantity::volume, 1.0},
    {"L", Quantity::volume, 1e-3},
    {"kg", Quantity::mass, 1.0},
    {"t", Quantity::mass, 1000.0},
    {"s", Quantity::time, 1.0},
    {"ms", Quantity::time, 1e-3},
    {"min", Quantity::time, 60.0},
    {"h", Quantity::time, 3600.0},
    {"J", Quantity::energy, 1.0},
    {"kJ", Quantity::energy, 1e3},
    {"MJ", Quantity::energy, 1e6},
    {"kg/m3", Quantity::density, 1.0},
    {"g/cm3", Quantity::density, 1000.0},
    {"%", Quantity::percent, 1.0},
};

TEST(OptionProperties, NumbersWithUnitsAreTheirSiValue) {
  for_cases([](Random& random) {
    const double value = drawn_number(random);
    const KnownUnit& unit = known_units[random.index(std::size(known_units))];
    const std::string text = number_text(value);
    const bool is_turned = unit.quantity == Quantity::angle && std::abs(value) > 6.2831853;
    if (!is_turned) {
      EXPECT_EQ(parse_quantity("o", text, unit.quantity), value);
    }
    const std::string blank = random.uniform() < 0.5 ? " " : "";
    const double found = parse_quantity("o", text + blank + unit.text, unit.quantity);
    if (std::isfinite(value * unit.in_si)) {
      EXPECT_NEAR(found, value * unit.in_si, 1e-15 * std::abs(value * unit.in_si));
    }
    const KnownUnit& other = known_units[random.index(std::size(known_units))];
    if (other.quantity != unit.quantity) {
      EXPECT_THROW(parse_quantity("o", text + other.text, unit.quantity), Error);
    }
  });
}

TEST(OptionProperties, AnyTextIsANumberOrRefused) {
  for_cases([](Random& random) {
    const std::string text = drawn_bytes(random, 12);
    const auto quantity = static_cast<Quantity>(random.index(10));
    try {
      EXPECT_TRUE(std::isfinite(parse_quantity("o", text, quantity))) << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    }
  });
}

TEST(OptionProperties, SeriesGoFromTheFirstByTheStepToTheLast) {
  for_cases([](Random& random) {
    const int first = drawn_int(random, -50, 50);
    const int step = drawn_int(random, 1, 9);
    const int count = drawn_int(random, 0, 30);
    // in tenths, which are no binary fractions
    const auto tenths = [](int n) { return number_text(n / 10.0); };
    const int beyond = drawn_int(random, 0, step - 1);
    const std::string text =
        tenths(first) + ":" + tenths(step) + ":" + tenths(first + count * step + beyond);
    const auto series = parse_series("o", text, Quantity::percent);
    ASSERT_EQ(series.size(), static_cast<std::size_t>(count + 1)) << text;
    for (int i = 0; i <= count; ++i) {
      const int exact = first + i * step;
      EXPECT_NEAR(series[static_cast<std::size_t>(i)], exact / 10.0, 1e-12);
      if (exact == 0) {
        EXPECT_EQ(series[static_cast<std::size_t>(i)], 0.0);
      }
    }
  });
}

TEST(OptionProperties, ListsOfNumbersReadBack) {
  for_cases([](Random& random) {
    std::vector<double> numbers(1 + random.index(5));
    std::string text;
    for (double& number : numbers) {
      number = drawn_number(random);
      text += (text.empty() ? "" : ",") + number_text(number);
    }
    EXPECT_EQ(parse_series("o", text, Quantity::length), numbers);
    EXPECT_EQ(parse_lengths("o", text, numbers.size(), "form"), numbers);
    EXPECT_THROW(parse_lengths("o", text, numbers.size() + 1, "form"), Error);
    EXPECT_EQ(split(text, ',').size(), numbers.size());
  });
}

TEST(OptionProperties, PathsReadBackToANanometre) {
  for_cases([](Random& random) {
    DigParameters path;
    path.penetration_angle = random.uniform(0.01, 1.5);
    path.penetration_length = random.uniform(0.0, 2.0);
    path.drag_length = random.uniform(0.0, 5.0);
    const DigParameters read = parse_dig_path("o", dig_path_argument(path));
    EXPECT_LT((to_vector(read) - to_vector(path)).cwiseAbs().maxCoeff(), 1e-9);
  });
}

TEST(OptionProperties, AreasHaveAnExtent) {
  for_cases([](Random& random) {
    const double a = random.uniform(-9.0, 9.0), b = random.uniform(-9.0, 9.0);
    const double c = random.uniform(-9.0, 9.0), d = random.uniform(-9.0, 9.0);
    const std::string text =
        number_text(a) + "," + number_text(b) + "," + number_text(c) + "," + number_text(d);
    if (a < c && b < d) {
      const Rectangle area = parse_rectangle("o", text);
      EXPECT_TRUE(area.x_min == a && area.y_min == b && area.x_max == c && area.y_max == d);
    } else {
      EXPECT_THROW(parse_rectangle("o", text), Error);
    }
  });
}

}  // namespace
}  // namespace excavplan::tools
