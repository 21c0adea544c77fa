// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "shared/figures.hpp"

namespace excavplan::tools {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Colours, RedFallsBlueRisesWhiteStays) {
  EXPECT_EQ(diverging_colour(-1.0), "#67001f");
  EXPECT_EQ(diverging_colour(0.0), "#f7f7f7");
  EXPECT_EQ(diverging_colour(1.0), "#053061");
  EXPECT_EQ(diverging_colour(-9.0), diverging_colour(-1.0));
}

TEST(ColourBands, StepByOneTwoFiveUpToTheLargest) {
  const std::vector<double> bands = colour_bands(0.01, 0.41);
  const std::vector<double> expected = {0.01, 0.02, 0.05, 0.1, 0.2};
  ASSERT_EQ(bands.size(), expected.size());
  for (std::size_t i = 0; i < bands.size(); ++i) EXPECT_NEAR(bands[i], expected[i], 1e-12);
  EXPECT_NEAR(colour_bands(0.013, 10.0).front(), 0.02, 1e-12);
  EXPECT_EQ(colour_bands(0.01, 0.0).size(), 1U);
  EXPECT_EQ(colour_bands(0.01, std::numeric_limits<double>::quiet_NaN()).empty(), false);
}

TEST(ColourBands, ShowCentimetresBesideDecimetres) {
  const std::vector<double> bands = colour_bands(0.01, 0.41);
  EXPECT_EQ(band_colour(0.009, bands), diverging_colour(0.0));
  EXPECT_EQ(band_colour(-0.03, bands), diverging_colour(-0.4));
  EXPECT_EQ(band_colour(-0.06, bands), diverging_colour(-0.6));
  EXPECT_EQ(band_colour(0.4, bands), diverging_colour(1.0));
  EXPECT_EQ(band_colour(9.0, bands), diverging_colour(1.0));
}

// 100 m in x over 720 px is the widest that fits: 7.2 px a metre, and 10 m in y make 90 px (the
// least height of 1 : 8), so that the line rises by 10 m * 7.2 px.
TEST(Panel, EqualAspectShowsAMetreEquallyLong) {
  Panel panel("", "x", "y");
  panel.view({0.0, 0.0, 100.0, 10.0});
  panel.line({{0.0, 0.0}, {100.0, 10.0}}, {});
  const std::string svg = to_svg({"", {panel}, {}, {}});
  EXPECT_NE(svg.find("M76 121L796 49\""), std::string::npos) << svg;
}

/// The heights of the axes of all panels, in the order of the page [px].
std::vector<double> heights_of_axes(const std::string& svg) {
  std::vector<double> heights;
  const std::string border = "\" fill=\"none\" stroke=\"#444444\"/>";
  for (auto at = svg.find(border); at != std::string::npos; at = svg.find(border, at + 1)) {
    heights.push_back(std::stod(svg.substr(svg.rfind("height=\"", at) + 8)));
  }
  return heights;
}

TEST(Panel, ATallViewIsNoHigherThanItsRowAndHalfAsHighInTheSecondOne) {
  const auto panel = [](const Rectangle& view, bool equal) {
    Panel made("", "x", "y");
    made.view(view);
    made.equal_aspect(equal);
    return made;
  };
  const Rectangle tall = {0.0, 0.0, 10.0, 40.0};
  const std::vector<double> heights =
      heights_of_axes(to_svg({"", {panel(tall, true)}, {}, {}, {panel(tall, true)}}));
  const std::vector<double> rows =
      heights_of_axes(to_svg({"", {panel(tall, false)}, {}, {}, {panel(tall, false)}}));
  ASSERT_EQ(heights.size(), 2U);
  ASSERT_EQ(rows.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(heights[i], rows[i], 0.01);
  EXPECT_LT(heights[1], 0.6 * heights[0]);
}

TEST(Panel, UnknownPointsInterruptALine) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Panel panel("", "x", "y");
  panel.line({{0.0, 0.0}, {1.0, 1.0}, {2.0, nan}, {3.0, 1.0}, {4.0, 0.0}}, {"#123456"});
  const std::string svg = to_svg({"", {panel}, {}, {}});
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  const auto end = svg.find("\" stroke-linejoin=\"round\" fill=\"none\" stroke=\"#123456\"");
  ASSERT_NE(end, std::string::npos);
  const auto start = svg.rfind("d=\"", end);
  EXPECT_EQ(count(svg.substr(start, end - start), "M"), 2U);
}

TEST(Panel, TextIsEscapedAndLegendsAreGivenOnce) {
  Panel panel("a < b & \"c\"", "x", "y");
  panel.line({{0.0, 0.0}, {1.0, 1.0}}, {}, "k > 1");
  panel.line({{0.0, 1.0}, {1.0, 1.0}}, {}, "k > 1");
  const std::string svg = to_svg({"", {panel}, {}, {"d < 5 %"}});
  EXPECT_EQ(count(svg, ">a &lt; b &amp; &quot;c&quot;</text>"), 1U);
  EXPECT_EQ(count(svg, ">k &gt; 1</text>"), 1U);
  EXPECT_EQ(count(svg, ">d &lt; 5 %</text>"), 1U);
}

TEST(Panel, LabelsDoNotCoverOneAnother) {
  Panel panel("", "x", "y");
  panel.view({0.0, 0.0, 10.0, 5.0});
  for (int i = 0; i < 5; ++i) panel.label({5.0, 2.5}, "label " + std::to_string(i));
  const std::string svg = to_svg({"", {panel}, {}, {}});
  std::set<double> rows;
  for (auto at = svg.find(">label "); at != std::string::npos; at = svg.find(">label ", at + 1)) {
    rows.insert(std::stod(svg.substr(svg.rfind("y=\"", at) + 3)));
  }
  ASSERT_EQ(rows.size(), 5U);
  for (auto row = rows.begin(), next = std::next(row); next != rows.end(); ++row, ++next) {
    EXPECT_GE(*next - *row, 17.9);
  }
}

TEST(HeatMap, DrawsRunsOfCellsAndLeavesUnknownOnesOut) {
  HeightMap map = flat_ground({0.0, 0.0, 0.4, 0.1}, 0.1);
  map.z << 0.5, 0.5, std::numeric_limits<double>::quiet_NaN(), -0.5;
  Panel panel("", "x", "y");
  panel.heat_map(map, {0.5});
  const std::string svg = to_svg({"", {panel}, ColourBar{{0.5}, "change [m]"}, {}});
  EXPECT_NE(svg.find("<path fill=\"#053061\" d=\"M0 0h2v1h-2z\"/>"), std::string::npos);
  EXPECT_NE(svg.find("<path fill=\"#67001f\" d=\"M3 0h1v1h-1z\"/>"), std::string::npos);
  EXPECT_EQ(count(svg, "v1h-"), 2U);
  EXPECT_NE(svg.find(">not seen</text>"), std::string::npos);
}

TEST(HeatMap, LargeMapsStaySmallFiles) {
  HeightMap map = flat_ground({0.0, 0.0, 200.0, 150.0}, 0.1);
  for (Eigen::Index i = 0; i < map.z.size(); ++i) map.z(i) = std::sin(static_cast<double>(i));
  Panel panel("", "x", "y");
  panel.heat_map(map, colour_bands(0.1, 1.0));
  EXPECT_LT(to_svg({"", {panel}, {}, {}}).size(), 4000000U);
}

// Large maps are averaged in blocks, which the last row and column need not fill.
TEST(HeatMap, LargeMapsShowTheLastRowAndColumnToo) {
  const std::vector<double> bands = {0.1};
  const auto shows_change_at = [&](Eigen::Index size, Eigen::Index row, Eigen::Index col) {
    HeightMap map{{0.0, 0.0}, 0.1, Eigen::ArrayXXd::Zero(size, size)};
    map.z(row, col) = 100.0;
    Panel panel("", "x", "y");
    panel.heat_map(map, bands);
    return count(to_svg({"", {panel}, {}, {}}), "fill=\"" + band_colour(1.0, bands)) == 1U;
  };
  for (const Eigen::Index size : {801, 802, 803}) {
    EXPECT_TRUE(shows_change_at(size, size / 2, size / 2)) << size;
    EXPECT_TRUE(shows_change_at(size, size - 1, size / 2)) << size;
    EXPECT_TRUE(shows_change_at(size, size / 2, size - 1)) << size;
  }
}

/// Level ground of 6 x 4 m with a hole, a spill beside it, a heap and a rut that was left out.
struct Survey {
  ChangeSheet sheet;

  Survey() {
    AreaChange area;
    area.difference = flat_ground({0.0, 0.0, 6.0, 4.0}, 0.1);
    area.zone = Eigen::ArrayXXi::Constant(40, 60, -1);
    area.noise_sd = 0.01;
    sheet.change.areas = {area};
    add(ZoneKind::dig, {2.0, 1.0, 3.0, 1.6}, -0.3);
    add(ZoneKind::spill, {2.0, 0.8, 3.0, 1.0}, 0.05);
    add(ZoneKind::dump, {2.2, 2.6, 3.0, 3.4}, 0.4);
    add(ZoneKind::other, {5.6, 0.2, 5.9, 3.8}, -0.03);
    sheet.before = {flat_ground({0.0, 0.0, 6.0, 4.0}, 0.1, 10.0)};
  }

  void add(ZoneKind kind, const Rectangle& where, double height) {
    AreaChange& area = sheet.change.areas[0];
    ChangeZone zone;
    zone.kind = kind;
    zone.extent = where;
    for (Eigen::Index col = 0; col < 60; ++col) {
      for (Eigen::Index row = 0; row < 40; ++row) {
        if (!where.contains(area.difference.x(col), area.difference.y(row))) continue;
        area.difference.z(row, col) = height;
        area.zone(row, col) = static_cast<int>(sheet.change.zones.size());
        zone.volume.value += 0.01 * height;
      }
    }
    sheet.change.zones.push_back(zone);
  }
};

/// The place of a text on the page [px].
Eigen::Vector2d place_of(const std::string& svg, const std::string& text) {
  const auto at = svg.rfind("<text", svg.find(">" + text));
  if (at == std::string::npos) return {-1.0, -1.0};
  const auto number = [&](const char* name) {
    return std::stod(svg.substr(svg.find(name, at) + std::string(name).size()));
  };
  return {number("x=\""), number("y=\"")};
}

TEST(HeightChangeFigure, NamesEachZoneWithItsVolume) {
  Survey survey;
  survey.sheet.lines = {"bulking factor 0.59"};
  const std::string svg = height_change_figure(survey.sheet);
  EXPECT_NE(svg.find(">hole 0.180 m³</text>"), std::string::npos);
  EXPECT_NE(svg.find(">heap 0.256 m³</text>"), std::string::npos);
  EXPECT_NE(svg.find(">bulking factor 0.59</text>"), std::string::npos);
  EXPECT_EQ(svg, height_change_figure(survey.sheet));
}

TEST(HeightChangeFigure, LabelOfSpillDoesNotLieOnTheHole) {
  const std::string svg = height_change_figure(Survey().sheet);
  EXPECT_GT(place_of(svg, "spill 0.0100 m³").y(), place_of(svg, "hole 0.180 m³").y() + 30.0);
}

TEST(HeightChangeFigure, ShowsSectionsThroughHoleAndHeap) {
  const Survey survey;
  const std::string svg = height_change_figure(survey.sheet);
  EXPECT_NE(svg.find(">section through the hole, y = 1.25 m</text>"), std::string::npos);
  EXPECT_NE(svg.find(">section through the heap, "), std::string::npos);
  for (const char* legend : {"ground before", "ground after", "95 % band of a cell", "section"}) {
    EXPECT_EQ(count(svg, ">" + std::string(legend) + "</text>"), 1U) << legend;
  }
  ChangeSheet without = survey.sheet;
  without.before.clear();
  EXPECT_EQ(height_change_figure(without).find("section"), std::string::npos);
  EXPECT_NE(svg.find(">noise of a cell 10.0 mm</text>"), std::string::npos);
}

TEST(HeightChangeFigure, BandIsThatOfTheNoise) {
  Survey survey;
  const auto width = [&] {
    const std::string svg = height_change_figure(survey.sheet);
    const auto end = svg.find("Z\" stroke-linejoin=\"round\" fill=\"#d55e00\"");
    const auto start = svg.rfind("M", end);
    const std::string path = svg.substr(start + 1, end - start - 1);
    const auto y = [&](std::size_t at) { return std::stod(path.substr(path.find(' ', at) + 1)); };
    return y(path.rfind('L')) - y(0);  // from the first point below to the first one above
  };
  const double narrow = width();
  survey.sheet.change.areas[0].noise_sd = 0.02;
  EXPECT_GT(narrow, 5.0);
  EXPECT_NEAR(width(), 2.0 * narrow, 0.3 * narrow);  // the axis holds the wider band too
}

TEST(HeightChangeFigure, ZoomsToWhatWasCounted) {
  const std::string svg = height_change_figure(Survey().sheet);
  EXPECT_EQ(svg.find("text-anchor=\"middle\">0.5</text>"), std::string::npos);  // x of the map
  EXPECT_NE(svg.find("−0.0324 m³ around x 5.8, y 2 m"), std::string::npos);
}

/// Whether a number stands below the axis of x.
bool shows_x(const std::string& svg, const std::string& number) {
  return svg.find("text-anchor=\"middle\">" + number) != std::string::npos;
}

// The rut begins at x = 5.6 m, the hole and its heap end at 3 m.
TEST(HeightChangeFigure, WhatWasLeftOutFarAwayIsOutOfView) {
  ChangeSheet sheet = Survey().sheet;
  sheet.before.clear();  // no sections
  const std::string svg = height_change_figure(sheet);
  EXPECT_TRUE(shows_x(svg, "2"));
  for (const char* beyond : {"4", "5"}) EXPECT_FALSE(shows_x(svg, beyond)) << beyond;
}

TEST(HeightChangeFigure, WhereNothingWasCountedAllIsInView) {
  Survey survey;
  survey.sheet.change.zones.clear();
  survey.sheet.change.areas[0].zone.setConstant(-1);
  survey.sheet.before.clear();
  survey.add(ZoneKind::other, {5.6, 0.2, 5.9, 3.8}, -0.03);
  const std::string svg = height_change_figure(survey.sheet);
  for (const char* x : {"0", "3", "6"}) EXPECT_TRUE(shows_x(svg, x)) << x;
}

TEST(HeightChangeFigure, ListsWarningsOpenChangesAndErrors) {
  Survey survey;
  VolumeChange& change = survey.sheet.change;
  change.before = change.excavated = {0.18, 0.002};
  change.dumped = {0.256, 0.003};
  change.after = {0.266, 0.003};
  change.spilled = {0.01, 0.001};
  change.errors.noise = Eigen::Vector3d(4e-6, 1e-6, 9e-6).asDiagonal();
  change.attribution = {
      {ChangeKind::second_heap, "a second heap 2 m off", {0.031, 0.001}, false, 0.35}};
  survey.sheet.warnings = {{"other_change", std::string(200, 'x') + " left out"}};
  const std::string svg = height_change_figure(survey.sheet);
  EXPECT_NE(svg.find(">other_change:</text>"), std::string::npos);
  EXPECT_NE(svg.find("left out, open"), std::string::npos);
  EXPECT_NE(svg.find("a second heap 2 m off (of this dig: 35 %)"), std::string::npos);
  EXPECT_NE(svg.find("noise of the cells"), std::string::npos);
  EXPECT_EQ(svg.find("steep faces"), std::string::npos);  // there are none
}

TEST(DigFigure, ShowsEveryPhaseAndTheStart) {
  const Machine machine = load_machine(EXCAVPLAN_DATA_SOURCE "/machines/zx120.json");
  const auto level = [](double) { return 0.0; };
  const auto dig = make_dig_path_anywhere(machine, paper_fixed_path(), level);
  const auto* path = std::get_if<DigPath>(&dig);
  ASSERT_TRUE(path);
  const std::string svg = dig_figure(machine, *path, {level, {}}, "Dig", {"payload 800 kg"});
  for (const char* part : {"tip, penetrate", "tip, drag", "tip, scoop", "tip, lift",
                           ">start, x = ", "ground before", "payload 800 kg"}) {
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(svg.find("ground after"), std::string::npos);
  EXPECT_EQ(svg, dig_figure(machine, *path, {level, {}}, "Dig", {"payload 800 kg"}));
}

}  // namespace
}  // namespace excavplan::tools
