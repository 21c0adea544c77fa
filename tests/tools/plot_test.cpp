// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "drawing/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/non_finite.hpp"
#include "base/plan_geometry.hpp"
#include "drawing/render.hpp"
#include "figures/change_figure.hpp"
#include "figures/dig_figures.hpp"
#include "figures/machine_outline.hpp"
#include "support/svg_layout.hpp"

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

Figure figure_of(const Panel& panel) {
  Figure figure;
  figure.rows = {{panel}};
  return figure;
}

std::string svg_of(const Panel& panel, const SheetSize& size = {}) {
  return to_svg(lay_out(figure_of(panel), size));
}

struct Ends {
  Eigen::Vector2d first, last;
};

/// Of the first line of a colour [pt].
Ends ends_of(const std::string& svg, const std::string& colour) {
  const auto end = svg.find("\" fill=\"none\" stroke=\"" + colour);
  const auto start = svg.rfind("d=\"M", end) + 4;
  const auto point = [&](std::size_t at) {
    return Eigen::Vector2d(std::stod(svg.substr(at)), std::stod(svg.substr(svg.find(' ', at))));
  };
  return {point(start), point(svg.rfind('L', end) + 1)};
}

Eigen::Vector2d way_of(const std::string& svg, const std::string& colour) {
  const Ends ends = ends_of(svg, colour);
  return ends.last - ends.first;
}

TEST(Panel, EqualAspectShowsAllOfTheViewOnSheetsOfAnyShape) {
  for (const Eigen::Vector2d& size : {Eigen::Vector2d(100.0, 10.0), Eigen::Vector2d(10.0, 100.0)}) {
    Panel panel("", "x", "y");
    panel.equal_aspect();
    panel.view({0.0, 0.0, size.x(), size.y()});
    panel.line({{0.0, 0.0}, {size.x(), size.y()}}, {"#123456"});
    for (const Eigen::Vector2d& sheet :
         {Eigen::Vector2d(170.0, 60.0), Eigen::Vector2d(60.0, 170.0)}) {  // [mm]
      const Ends ends = ends_of(svg_of(panel, {sheet.x(), sheet.y()}), "#123456");
      const Eigen::Array2d page = sheet.array() * 72.0 / 25.4;
      for (const Eigen::Vector2d& end : {ends.first, ends.last}) {
        EXPECT_TRUE((end.array() >= 0.0).all() && (end.array() <= page).all()) << end.transpose();
      }
      const Eigen::Vector2d way = ends.last - ends.first;
      EXPECT_NEAR(-way.y() / way.x(), size.y() / size.x(), 0.05 * size.y() / size.x());
    }
  }
}

TEST(Panel, EqualAspectShowsAMetreEquallyLong) {
  Panel panel("", "x", "y");
  panel.equal_aspect();
  panel.view({0.0, 0.0, 100.0, 10.0});
  panel.line({{0.0, 0.0}, {100.0, 10.0}}, {"#123456"});
  for (const double width : {40.0, 85.0, 170.0, 500.0}) {
    const Eigen::Vector2d way = way_of(svg_of(panel, {width, {}}), "#123456");
    EXPECT_NEAR(way.x() / -way.y(), 10.0, 0.2) << width;
  }
}

TEST(Panel, MirroredXGrowsToTheLeft) {
  Panel panel("", "y", "x");
  panel.mirror_x();
  panel.view({-8.0, 0.0, -2.0, 1.0});
  const std::string svg = svg_of(panel);
  const auto x_of = [&](const std::string& text) {
    const auto at = svg.rfind("<text x=\"", svg.find(">" + text + "</text>"));
    return std::stod(svg.substr(at + 9));
  };
  EXPECT_GT(x_of("3"), x_of("7"));
}

TEST(Panel, StatesHowMuchLongerAMetreIsUpwards) {
  Panel panel("hole", "x [m]", "z [m]");
  panel.view({0.0, 0.0, 10.0, 1.0});
  panel.shape(0.5);
  panel.state_exaggeration();
  const Figure figure = {"f", {{panel}}};
  const auto shows = [&](const SheetSize& size, const char* text) {
    return to_svg(lay_out(figure, size)).find(text) != std::string::npos;
  };
  EXPECT_TRUE(shows({}, ">hole, heights × 5.0</text>"));  // 0.5 of the width for a tenth of x
  EXPECT_FALSE(shows({170.0, 45.0}, "heights × 5.0"));    // lower axes
}

TEST(Panel, LowAxesHaveTwoNumbers) {
  Panel panel("", "x", "y");
  panel.view({0.0, -64.0, 1.0, 75.0});
  panel.shape(0.1);
  panel.least_height(20.0);
  const std::string svg = to_svg(lay_out({"f", {{panel}}}, {85.0, {}}));
  for (const char* number : {">−50</text>", ">0</text>", ">50</text>"}) {
    EXPECT_NE(svg.find(number), std::string::npos) << number;
  }
}

TEST(LayOut, SizesAreThoseAskedFor) {
  Panel panel("", "x", "y");
  panel.line({{0.0, 0.0}, {1.0, 1.0}}, {});
  const Drawing wide = lay_out(figure_of(panel));
  EXPECT_NEAR(wide.width / points_per_mm, 170.0, 1e-9);
  const Drawing low = lay_out(figure_of(panel), {85.0, 60.0});
  EXPECT_NEAR(low.width / points_per_mm, 85.0, 1e-9);
  EXPECT_NEAR(low.height / points_per_mm, 60.0, 1e-9);
  EXPECT_NE(to_svg(low).find("width=\"85mm\" height=\"60mm\""), std::string::npos);
}

TEST(LayOut, PanelsStackOnANarrowSheetAndAreLeftOutOnALowOne) {
  Figure figure;
  figure.rows.emplace_back();
  for (const char* title : {"first", "second", "third"}) {
    Panel panel(title, "x [m]", "y [m]");
    panel.line({{0.0, 0.0}, {1.0, 1.0}}, {}, title);
    figure.rows.front().push_back(panel);
  }
  EXPECT_LT(lay_out(figure, {170.0, {}}).height, 0.6 * lay_out(figure, {85.0, {}}).height);
  const std::string low = to_svg(lay_out(figure, {85.0, 60.0}));
  EXPECT_EQ(count(low, ">first</text>"), 2U);  // title and legend
  EXPECT_EQ(count(low, ">third</text>"), 0U);
}

TEST(LayOut, TheLowestPanelThatIsLeftHasTheAxisAndTheDrawingSaysWhatIsNot) {
  Figure figure;
  for (const char* name : {"boom", "arm", "bucket"}) {
    Panel panel("", "time", name);
    panel.line({{0.0, 0.0}, {1.0, 1.0}}, {}, name);
    if (figure.rows.size() < 2) panel.hide_x();
    figure.rows.push_back({panel});
  }
  const Drawing all = lay_out(figure, {85.0, 120.0});
  EXPECT_TRUE(all.left_out.empty());
  const Drawing low = lay_out(figure, {85.0, 45.0});
  ASSERT_FALSE(low.left_out.empty());
  EXPECT_EQ(low.left_out.front(), "the panel 'bucket'");
  EXPECT_EQ(count(to_svg(low), ">time</text>"), 1U);
  const double needed = low.needed_height / points_per_mm;
  EXPECT_TRUE(lay_out(figure, {85.0, std::ceil(needed)}).left_out.empty());
  EXPECT_FALSE(lay_out(figure, {85.0, std::floor(needed)}).left_out.empty());
}

TEST(LayOut, TheTableIsBelowAll) {
  Panel panel("", "x", "y");
  panel.line({{0.0, 0.0}, {1.0, 1.0}}, {});
  Figure figure = figure_of(panel);
  figure.title = "Dig";
  const double alone = lay_out(figure).height;
  EXPECT_EQ(count(to_svg(lay_out(figure)), ">Dig</text>"), 0U);
  figure.table = {"payload 800 kg", "", "energy 40 kJ"};
  EXPECT_GT(lay_out(figure).height, alone + 30.0);
  const std::string svg = to_svg(lay_out(figure));
  EXPECT_EQ(count(svg, ">Dig</text>"), 1U);
  EXPECT_EQ(count(svg, ">energy 40 kJ</text>"), 1U);
}

TEST(Panel, UnknownPointsInterruptALine) {
  Panel panel("", "x", "y");
  panel.line({{0.0, 0.0}, {1.0, 1.0}, {2.0, nan}, {3.0, 1.0}, {4.0, 0.0}}, {"#123456"});
  const std::string svg = svg_of(panel);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  const auto end = svg.find("\" fill=\"none\" stroke=\"#123456\"");
  ASSERT_NE(end, std::string::npos);
  const auto start = svg.rfind("d=\"", end);
  EXPECT_EQ(count(svg.substr(start, end - start), "M"), 2U);
}

TEST(Panel, LongLinesKeepTheirSpikesInSmallFiles) {
  Points line;
  for (int i = 0; i < 200000; ++i) line.emplace_back(i, i == 123457 ? 9.0 : std::sin(i));
  Panel panel("", "x", "y");
  panel.view({0.0, -1.0, 200000.0, 9.0});
  panel.line(line, {"#123456"});
  const std::string svg = svg_of(panel);
  EXPECT_LT(svg.size(), 300000U);
  const auto end = svg.find("\" fill=\"none\" stroke=\"#123456\"");
  const auto start = svg.rfind("d=\"M", end) + 4;
  double highest = 1e9;  // y runs down the page
  for (auto at = start; at < end; at = svg.find('L', at + 1) + 1) {
    highest = std::min(highest, std::stod(svg.substr(svg.find(' ', at), 20)));
    if (svg.find('L', at + 1) > end) break;
  }
  EXPECT_LT(highest, 10.0);
}

TEST(Panel, TextIsEscapedAndLegendsAreGivenOnce) {
  Panel panel("a < b & \"c\"", "x", "y");
  panel.line({{0.0, 0.0}, {1.0, 1.0}}, {}, "k > 1");
  panel.line({{0.0, 1.0}, {1.0, 1.0}}, {}, "k > 1");
  Figure figure = figure_of(panel);
  figure.note = "d < 5 %";
  const std::string svg = to_svg(lay_out(figure));
  EXPECT_EQ(count(svg, ">a &lt; b &amp; &quot;c&quot;</text>"), 1U);
  EXPECT_EQ(count(svg, ">k &gt; 1</text>"), 1U);
  EXPECT_EQ(count(svg, ">d &lt; 5 %</text>"), 1U);
}

TEST(Panel, LabelsCoverNeitherOneAnotherNorLines) {
  Panel panel("", "x", "y");
  panel.view({0.0, 0.0, 10.0, 5.0});
  panel.line({{0.0, 2.5}, {10.0, 2.5}}, {"#123456"});
  for (int i = 0; i < 5; ++i) panel.label({5.0, 2.5}, "label " + std::to_string(i));
  const std::string svg = svg_of(panel);
  const auto start = svg.rfind("d=\"M", svg.find("stroke=\"#123456")) + 4;
  const double line = std::stod(svg.substr(svg.find(' ', start)));
  std::vector<test::PlacedText> labels;
  for (const test::PlacedText& text : test::texts_of(svg)) {
    if (text.text.rfind("label", 0) != 0) continue;
    EXPECT_TRUE(text.box.bottom() < line || text.box.top > line) << text.text;
    for (const auto& other : labels) EXPECT_FALSE(test::overlap(text.box, other.box)) << text.text;
    labels.push_back(text);
  }
  EXPECT_EQ(labels.size(), 5U);
  EXPECT_EQ(count(svg, "<circle"), 5U);  // each is tied to its point
}

TEST(Panel, RemarksAndWordsOfManyGroupsFindRoom) {
  Panel panel("", "x", "y");
  std::vector<Panel::Tick> names;
  for (int i = 0; i < 12; ++i) {
    names.emplace_back(i, "name " + std::to_string(i));
    panel.remark({i - 0.0, 1.0}, 1.0, "+42 %");
  }
  panel.x_ticks(names);
  panel.skip_x_ticks();
  panel.view({-0.5, 0.0, 11.5, 2.0});
  for (const double width : {40.0, 60.0, 85.0, 170.0}) {
    const std::string svg = svg_of(panel, {width, {}});
    test::expect_legible(svg, "at " + std::to_string(width));
    EXPECT_EQ(count(svg, "…"), 0U) << width;
  }
  EXPECT_EQ(count(svg_of(panel), ">name "), 12U);
  EXPECT_LT(count(svg_of(panel, {60.0, {}}), ">name "), 12U);
}

Grid grid_of(const HeightMap& map) {
  return {map.origin, Eigen::Vector2d::Constant(map.cell_size), map.z};
}

TEST(Map, DrawsRunsOfCellsAndLeavesUnknownOnesOut) {
  HeightMap map = flat_ground({0.0, 0.0, 0.4, 0.1}, 0.1);
  map.z << 0.5, 0.5, std::numeric_limits<double>::quiet_NaN(), -0.5;
  Panel panel("", "x", "y");
  panel.map(grid_of(map), {{0.5}});
  Figure figure = figure_of(panel);
  figure.colour_bar = ColourBar{{{0.5}}, "change [m]"};
  const Drawing drawing = lay_out(figure);
  double rise = 0.0, fall = 0.0;
  for (const DrawnItem& item : drawing.items) {
    const auto* cells = std::get_if<DrawnCells>(&item);
    if (cells == nullptr || cells->boxes.size() != 1 || cells->boxes[0].top > 0.6 * drawing.height)
      continue;
    if (cells->colour == "#053061") rise = cells->boxes[0].width;
    if (cells->colour == "#67001f") fall = cells->boxes[0].width;
  }
  EXPECT_GT(fall, 0.0);
  EXPECT_NEAR(rise, 2.0 * fall, 1e-6);
  EXPECT_NE(to_svg(drawing).find(">not seen</text>"), std::string::npos);
}

TEST(Map, LargeMapsStaySmallFiles) {
  HeightMap map = flat_ground({0.0, 0.0, 200.0, 150.0}, 0.1);
  for (Eigen::Index i = 0; i < map.z.size(); ++i) map.z(i) = std::sin(static_cast<double>(i));
  Panel panel("", "x", "y");
  panel.map(grid_of(map), {colour_bands(0.1, 1.0)});
  EXPECT_LT(svg_of(panel).size(), 6000000U);
}

// Large maps are averaged in blocks, which the last row and column need not fill.
TEST(Map, LargeMapsShowTheLastRowAndColumnToo) {
  const std::vector<double> bands = {0.1};
  const auto shows_change_at = [&](Eigen::Index size, Eigen::Index row, Eigen::Index col) {
    HeightMap map{{0.0, 0.0}, 0.1, Eigen::ArrayXXd::Zero(size, size)};
    map.z(row, col) = 100.0;
    Panel panel("", "x", "y");
    panel.map(grid_of(map), {bands});
    return count(svg_of(panel), "fill=\"" + band_colour(1.0, bands)) == 1U;
  };
  for (const Eigen::Index size : {801, 802, 803}) {
    EXPECT_TRUE(shows_change_at(size, size / 2, size / 2)) << size;
    EXPECT_TRUE(shows_change_at(size, size - 1, size / 2)) << size;
    EXPECT_TRUE(shows_change_at(size, size / 2, size - 1)) << size;
  }
}

TEST(Colours, OfASequenceRunFromDarkToLight) {
  EXPECT_EQ(sequential_colour(0.0), "#440154");
  EXPECT_EQ(sequential_colour(1.0), "#fde725");
  EXPECT_EQ(sequential_colour(7.0), sequential_colour(1.0));
}

TEST(Images, StartWithTheirMagicAndAreTheSameBytesAgain) {
  Panel panel("", "x [m]", "y [m]");
  panel.line({{0.0, 0.0}, {1.0, 1.0}}, {}, "a line");
  const Drawing drawing = lay_out(figure_of(panel), {85.0, 60.0});
  for (const auto& [file, magic] :
       {std::pair("a.SVG", "<svg"), {"a.png", "\x89PNG"}, {"a.pdf", "%PDF-"}}) {
    const std::string image = image_of(drawing, file);
    EXPECT_EQ(image.substr(0, std::string(magic).size()), magic);
    EXPECT_EQ(image, image_of(drawing, file)) << file;
  }
  EXPECT_EQ(image_of(drawing, "a.pdf").find("CreationDate"), std::string::npos);
}

TEST(Images, OfPngHave300DotsPerInch) {
  Panel panel("", "x [m]", "y [m]");
  const std::string png = image_of(lay_out(figure_of(panel), {85.0, 60.0}), "a.png");
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = 256 * value + static_cast<unsigned char>(png[at + i]);
    return value;
  };
  EXPECT_EQ(number(16), 1004);  // 85 mm
  EXPECT_EQ(number(20), 709);   // 60 mm
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

/// With its table.
std::string change_svg(const ChangeSheet& sheet) {
  Figure figure = height_change_figure(sheet);
  figure.table = change_table(sheet);
  return to_svg(lay_out(figure));
}

/// The place of a text on the page [pt].
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
  const std::string svg = change_svg(survey.sheet);
  EXPECT_NE(svg.find(">hole 0.180 m³</text>"), std::string::npos);
  EXPECT_NE(svg.find(">heap 0.256 m³</text>"), std::string::npos);
  EXPECT_NE(svg.find(">bulking factor 0.59</text>"), std::string::npos);
  EXPECT_EQ(svg, change_svg(survey.sheet));
}

TEST(HeightChangeFigure, LabelOfSpillDoesNotLieOnTheHole) {
  const std::string svg = change_svg(Survey().sheet);
  EXPECT_GT((place_of(svg, "spill 0.0100 m³") - place_of(svg, "hole 0.180 m³")).norm(), 15.0);
}

TEST(HeightChangeFigure, OutlinesAreClosedLinesSoThatTheirDashesShow) {
  const std::string svg = change_svg(Survey().sheet);
  const auto end = svg.find("\" fill=\"none\" stroke=\"#009e73\"");
  const auto start = svg.rfind("d=\"", end);
  const std::string path = svg.substr(start, end - start);
  EXPECT_EQ(count(path, "M"), 1U);
  EXPECT_GT(count(path, "L"), 20U);  // around 10 x 2 cells
  EXPECT_NE(svg.substr(end, 200).find("stroke-dasharray"), std::string::npos);
}

TEST(HeightChangeFigure, ShowsSectionsThroughHoleAndHeap) {
  const Survey survey;
  const std::string svg = change_svg(survey.sheet);
  EXPECT_NE(svg.find(">hole, section at y = 1.25 m, heights × "), std::string::npos);
  EXPECT_NE(svg.find(">heap, section at "), std::string::npos);
  for (const char* legend : {"ground before", "ground after", "95 % band of a cell", "section"}) {
    EXPECT_EQ(count(svg, ">" + std::string(legend) + "</text>"), 1U) << legend;
  }
  ChangeSheet without = survey.sheet;
  without.before.clear();
  EXPECT_EQ(change_svg(without).find("section"), std::string::npos);
  EXPECT_NE(svg.find(">noise of a cell 10.0 mm</text>"), std::string::npos);
}

TEST(HeightChangeFigure, BandIsThatOfTheNoise) {
  Survey survey;
  const auto width = [&] {
    const std::string svg = change_svg(survey.sheet);
    const auto end = svg.find("Z\" fill=\"#d55e00\"");
    const auto start = svg.rfind('M', end);
    const std::string path = svg.substr(start + 1, end - start - 1);
    const auto y = [&](std::size_t at) { return std::stod(path.substr(path.find(' ', at) + 1)); };
    return y(path.rfind('L')) - y(0);  // from the first point below to the first one above
  };
  const double narrow = width();
  survey.sheet.change.areas[0].noise_sd = 0.02;
  EXPECT_GT(narrow, 3.0);
  EXPECT_NEAR(width(), 2.0 * narrow, 0.3 * narrow);  // the axis holds the wider band too
}

TEST(HeightChangeFigure, ListsWhatWasLeftOut) {
  EXPECT_NE(change_svg(Survey().sheet).find("−0.0324 m³ around x 5.8, y 2 m"), std::string::npos);
}

/// Whether a number stands at an axis.
bool shows(const std::string& svg, const std::string& number) {
  return svg.find(">" + number + "</text>") != std::string::npos ||
         svg.find(">" + number + ".0</text>") != std::string::npos;
}

// The rut begins at x = 5.6 m, the hole and its heap end at 3 m.
TEST(HeightChangeFigure, WhatWasLeftOutFarAwayIsOutOfView) {
  ChangeSheet sheet = Survey().sheet;
  sheet.before.clear();  // no sections
  const std::string svg = change_svg(sheet);
  EXPECT_TRUE(shows(svg, "2"));
  for (const char* beyond : {"4", "5"}) EXPECT_FALSE(shows(svg, beyond)) << beyond;
}

TEST(HeightChangeFigure, WhereNothingWasCountedAllIsInView) {
  Survey survey;
  survey.sheet.change.zones.clear();
  survey.sheet.change.areas[0].zone.setConstant(-1);
  survey.sheet.before.clear();
  survey.add(ZoneKind::other, {5.6, 0.2, 5.9, 3.8}, -0.03);
  const std::string svg = change_svg(survey.sheet);
  for (const char* x : {"0", "3", "6"}) EXPECT_TRUE(shows(svg, x)) << x;
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
  survey.sheet.warnings = {{WarningCode::other_change, std::string(200, 'x') + " left out"}};
  const std::string svg = change_svg(survey.sheet);
  EXPECT_NE(svg.find(">other_change:</text>"), std::string::npos) << svg;
  EXPECT_NE(svg.find("left out, open"), std::string::npos);
  EXPECT_NE(svg.find("a second heap 2 m off (of this dig: 35 %)"), std::string::npos);
  EXPECT_NE(svg.find("noise of the cells"), std::string::npos);
  EXPECT_EQ(svg.find("steep faces"), std::string::npos);  // there are none
}

class SectionFigure : public testing::Test {
 protected:
  Figure figure() const {
    const GroundProfile after = with_after ? level : GroundProfile();
    return section_figure({machine, path, dig, level, after, "Dig"});
  }

  const GroundProfile level = [](double) { return 0.0; };
  const Machine machine = load_machine(EXCAVPLAN_DATA_SOURCE "/machines/zx120.json");
  const DigPath path =
      std::get<DigPath>(make_dig_path_anywhere(machine, paper_fixed_path(), level));
  DigResult dig;
  bool with_after = true;
};

TEST_F(SectionFigure, ShowsEveryPhaseAndTheStart) {
  const std::string svg = to_svg(lay_out(figure()));
  for (const char* part : {"tip, penetrate", "tip, drag", "tip, scoop", "tip, lift",
                           ">start, x = ", "ground before", "ground after"}) {
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(svg, to_svg(lay_out(figure())));
  with_after = false;
  EXPECT_EQ(to_svg(lay_out(figure())).find("ground after"), std::string::npos);
}

TEST_F(SectionFigure, ShowsTheWholeMachine) {
  const MachineOutline outline = machine_outline(machine, path.poses.front().joints);
  const Rectangle view = figure().rows.front().front().shown();
  for (const Points* part : {&outline.tracks, &outline.house, &outline.cab, &outline.boom}) {
    for (const Eigen::Vector2d& point : *part) EXPECT_TRUE(view.contains(point.x(), point.y()));
  }
}

TEST_F(SectionFigure, OfASteepPathShowsTheBottomOfThePit) {
  const DigPath steep = std::get<DigPath>(make_dig_path_anywhere(machine, {1.2, 0.7, 0.3}, level));
  const Figure drawn = section_figure({machine, steep, dig, level, level, "Dig"});
  const Rectangle view = drawn.rows.front().back().shown();
  for (const DigPose& pose : steep.poses) {
    if (pose.phase == DigPhase::lift) break;
    EXPECT_TRUE(view.contains(pose.bucket.x, pose.bucket.z)) << pose.bucket.z;
  }
}

TEST_F(SectionFigure, SaysWhyADigEndedAndWhatWasNotDug) {
  EXPECT_EQ(to_svg(lay_out(figure())).find("path not dug"), std::string::npos);
  dig.history.resize(3);
  dig.stall = Stall{};
  dig.stall->cause = Stall::Cause::front_lifts;
  const std::string svg = to_svg(lay_out(figure()));
  EXPECT_NE(svg.find(">the front of the machine lifts<"), std::string::npos);
  EXPECT_NE(svg.find(">path not dug<"), std::string::npos);
  EXPECT_EQ(svg.find("tip, drag"), std::string::npos);
  dig.stall->cause = Stall::Cause::torque;
  dig.stall->joint = Joint::arm;
  EXPECT_NE(to_svg(lay_out(figure())).find(">the arm stalls<"), std::string::npos);
}

TEST_F(SectionFigure, TheLinkEndsOnTheBucket) {
  const MachineOutline outline = machine_outline(machine, path.poses.back().joints);
  ASSERT_GE(outline.bracket.size(), 4U);
  EXPECT_NEAR((outline.bracket[1] - outline.cylinders.back()[1]).norm(), 0.0, 1e-9);
  EXPECT_EQ(outline.bracket.back(), outline.bucket.back());
}

double area_of(const Points& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    sum += 0.5 * (p.x() * q.y() - q.x() * p.y());
  }
  return std::abs(sum);
}

TEST_F(SectionFigure, TheCylinderOfTheBucketEndsOnTheArm) {
  for (const DigPose& pose : path.poses) {
    const MachineOutline outline = machine_outline(machine, pose.joints);
    EXPECT_TRUE(is_inside(outline.arm, outline.cylinders[2].front()));
  }
}

TEST_F(SectionFigure, SoilInTheBucketHasItsVolume) {
  const JointAngles joints = path.poses.back().joints;
  EXPECT_TRUE(soil_in_bucket(machine, joints, 0.0).empty());
  for (const double volume : {0.02, 0.1, 0.2, 0.3}) {
    const double area = area_of(soil_in_bucket(machine, joints, volume));
    EXPECT_NEAR(area * machine.bucket.width_inside, volume, 1e-3) << volume;
  }
  EXPECT_GT(area_of(soil_in_bucket(machine, joints, 0.42)),
            area_of(soil_in_bucket(machine, joints, 0.33)));
}

TEST_F(SectionFigure, CylindersAreAsLongAsTheMachineSays) {
  const JointAngles joints = path.poses.front().joints;
  const MachineOutline outline = machine_outline(machine, joints);
  const auto states = cylinder_states(*machine.cylinders, joints);
  ASSERT_GE(outline.cylinders.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR((outline.cylinders[i][1] - outline.cylinders[i][0]).norm(), states[i].length, 1e-6);
  }
}

}  // namespace
}  // namespace excavplan::tools
