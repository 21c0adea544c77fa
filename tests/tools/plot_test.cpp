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

TEST(RoundUp, FindsTheNextRoundNumber) {
  EXPECT_DOUBLE_EQ(round_up(0.41), 0.5);
  EXPECT_DOUBLE_EQ(round_up(0.5), 0.5);
  EXPECT_DOUBLE_EQ(round_up(81.0), 100.0);
  EXPECT_EQ(round_up(0.0), 1.0);
  EXPECT_EQ(round_up(std::numeric_limits<double>::quiet_NaN()), 1.0);
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
  panel.heat_map(map, 0.5);
  const std::string svg = to_svg({"", {panel}, ColourBar{0.5, "change [m]"}, {}});
  EXPECT_NE(svg.find("<path fill=\"#053061\" d=\"M0 0h2v1h-2z\"/>"), std::string::npos);
  EXPECT_NE(svg.find("<path fill=\"#67001f\" d=\"M3 0h1v1h-1z\"/>"), std::string::npos);
  EXPECT_EQ(count(svg, "v1h-"), 2U);
  EXPECT_NE(svg.find(">not seen</text>"), std::string::npos);
}

TEST(HeatMap, LargeMapsStaySmallFiles) {
  HeightMap map = flat_ground({0.0, 0.0, 200.0, 150.0}, 0.1);
  for (Eigen::Index i = 0; i < map.z.size(); ++i) map.z(i) = std::sin(static_cast<double>(i));
  Panel panel("", "x", "y");
  panel.heat_map(map, 1.0);
  EXPECT_LT(to_svg({"", {panel}, {}, {}}).size(), 4000000U);
}

TEST(HeightChangeFigure, NamesEachZoneWithItsVolume) {
  VolumeChange change;
  AreaChange area;
  area.difference = flat_ground({0.0, 0.0, 1.0, 1.0}, 0.1);
  area.zone = Eigen::ArrayXXi::Constant(10, 10, -1);
  area.difference.z.block(2, 2, 3, 3) = -0.3;
  area.zone.block(2, 2, 3, 3) = 0;
  area.difference.z.block(7, 7, 2, 2) = 0.4;
  area.zone.block(7, 7, 2, 2) = 1;
  change.areas = {area};
  change.zones.resize(2);
  change.zones[0].kind = ZoneKind::dig;
  change.zones[0].volume.value = -0.027;
  change.zones[1].kind = ZoneKind::dump;
  change.zones[1].volume.value = 0.016;
  const std::string svg = height_change_figure(change, {"bulking factor 0.59"});
  EXPECT_NE(svg.find(">hole 0.0270 m³</text>"), std::string::npos);
  EXPECT_NE(svg.find(">heap 0.0160 m³</text>"), std::string::npos);
  EXPECT_NE(svg.find(">bulking factor 0.59</text>"), std::string::npos);
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
