// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include <excavplan/base/data_files.hpp>
#include <excavplan/sensing/scene.hpp>
#include <excavplan/simulation/dig_ground.hpp>

#include "figures/study_figure.hpp"
#include "results/dig_timing.hpp"
#include "support/svg_figure.hpp"
#include "support/svg_layout.hpp"

namespace excavplan::test {
namespace {

/// A figure of a tool, and texts that it shows.
struct Drawn {
  std::string name;
  Words texts;
};

/// A run of a tool that can draw all of its figures.
struct Job {
  std::string tool;
  Words words;
  std::vector<Drawn> figures;  ///< the first is the main one
};

const Words run_pair = {shipped("recordings/fixed.csv"),
                        shipped("recordings/planned.csv"),
                        "--volume",
                        "0.391",
                        "--volume-sd",
                        "0.01",
                        "--second-volume",
                        "0.398",
                        "--second-volume-sd",
                        "0.01"};

const std::vector<Drawn> of_dig = {
    {"section", {"x from the swing axis [m]", "z [m]", "ground before", "soil in the bucket"}},
    {"forces", {"force [kN]", "soil in bucket [kg]", "time since the dig began [s]"}},
    {"torques", {"boom [kN m]", "arm [kN m]", "bucket [kN m]", "limit of the boom 400 kN m"}},
    {"power", {"power [kW]", "energy [kJ]"}},
    {"cylinders", {"boom [MPa]", "pressure", "penetrate"}}};

std::vector<Job> jobs() {
  std::vector<Drawn> of_plan = of_dig;
  of_plan.push_back({"search", {"digs evaluated", "[kg/kJ]", "best so far", "best [kg/kJ]"}});
  of_plan.push_back({"landscape",
                     {"penetration angle [deg]", "penetration length [m]", "drag length [m]",
                      "cannot be dug", "planned dig", "at drag length", "at penetration angle"}});
  return {{"simulate-dig", {"--density", "40"}, of_dig},
          {"plan-path", {"--density", "40", "--search", "--evaluations", "60"}, of_plan},
          {"estimate-density",
           {shipped("quickstart/before.pcd"), shipped("quickstart/after.pcd")},
           {{"change", {"x [m]", "y [m]", "z [m]", "height after − before [cm]", "not seen"}},
            {"density",
             {"relative density [%]", "probability density [1/%]", "bulking factor k [-]"}}}},
          {"calibrate-density",
           {"--draws", "0"},
           {{"law", {"relative density [%]", "bulking factor k [-]", "(used)"}}}},
          {"run-experiment",
           {},
           {{"paths", {"x from the swing axis [m]", "tip, fixed path", "tip, planned path"}},
            {"efficiency", {"[kg/kJ]", "soft", "medium", "hard"}},
            {"regression",
             {"relative density [%]", "paper: d = 161.6 k − 152.9", "closed form",
              "The void ratios of loam were derived from the paper's line."}}}},
          {"measure-efficiency",
           run_pair,
           {{"efficiency",
             {"efficiency [m³/mL]", "95 % interval",
              "± is one standard deviation. Gain of the second run"}},
            {"fuel", {"fuel flow [mL/s]", "time [s]", "idling"}}}}};
}

class Figures : public testing::TestWithParam<std::size_t> {
 protected:
  /// Draws all figures of the job. @return what the tool answers
  json draw(const std::string& ending, const Words& more = {}) {
    Words words = job.words + more;
    for (const Drawn& figure : job.figures) {
      words.insert(words.end(), {"--plot", figure.name + "=" + file(figure.name + ending)});
    }
    return answer(job.tool, words);
  }
  std::string file(const std::string& name) const { return folder.file(name); }

  const Job job = jobs()[GetParam()];
  const TemporaryFolder folder;
};

INSTANTIATE_TEST_SUITE_P(OfEveryTool, Figures, testing::Range<std::size_t>(0, 6),
                         [](const auto& of) {
                           std::string name = jobs()[of.param].tool;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

TEST_P(Figures, AreImagesOfEveryFormat) {
  for (const auto& [ending, magic] :
       {std::pair(".png", "\x89PNG"), {".pdf", "%PDF-"}, {".SVG", "<svg"}}) {
    draw(ending);
    for (const Drawn& figure : job.figures) {
      EXPECT_EQ(content_of(file(figure.name + ending)).rfind(magic, 0), 0U) << figure.name;
    }
  }
}

TEST_P(Figures, NameTheirAxesWithUnitsAndCanBeRead) {
  const Words sizes = {"170mm", "85mm", "40mm", "300mm", "85mm,60mm"};
  for (const std::string& size : sizes) {
    draw(".svg", {"--plot-size", size});
    for (const Drawn& figure : job.figures) {
      const std::string svg = content_of(file(figure.name + ".svg"));
      expect_legible(svg, job.tool + " " + figure.name + " at " + size);
      if (size == "170mm") expect_figure(file(figure.name + ".svg"), figure.texts);
    }
  }
}

TEST_P(Figures, TheFirstIsTheMainOneAndATableComesBelow) {
  answer(job.tool, job.words + Words{"--plot", file("main.svg")});
  answer(job.tool, job.words + Words{"--plot", job.figures[0].name + "=" + file("named.svg")});
  EXPECT_EQ(content_of(file("main.svg")), content_of(file("named.svg")));
  answer(job.tool, job.words + Words{"--plot", file("table.svg"), "--plot-table"});
  EXPECT_GT(texts_of(content_of(file("table.svg"))).size(),
            texts_of(content_of(file("main.svg"))).size());
  expect_legible(content_of(file("table.svg")), job.tool + " with table");
}

class FigureValues : public BadInput {};

std::size_t circles(const std::string& svg, const std::string& style) {
  std::size_t count = 0;
  for (auto at = svg.find("<circle"); at != std::string::npos; at = svg.find("<circle", at + 1)) {
    if (contains(svg.substr(at, svg.find("/>", at) - at), style)) ++count;
  }
  return count;
}

TEST_F(FigureValues, ARegressionShowsEveryDig) {
  const std::string file = folder.file("regression.svg");
  const json found = answer("run-experiment", {"--plot", "regression=" + file});
  EXPECT_EQ(circles(content_of(file), "fill=\"#ffffff\" stroke=\"#0072b2\""),
            found["regression"]["samples"].size() + 1);  // and the legend
}

/// Heights of the bars of a colour, in the order of the figure [pt].
std::vector<double> bars(const std::string& svg, const std::string& colour) {
  std::vector<double> heights;
  const std::string style = "Z\" fill=\"" + colour + '"';
  for (auto at = svg.find(style); at != std::string::npos; at = svg.find(style, at + 1)) {
    const std::string path = svg.substr(svg.rfind("d=\"M", at) + 4, at);
    const double bottom = std::stod(path.substr(path.find(' ')));
    const std::string last = svg.substr(svg.rfind('L', at) + 1, 40);
    heights.push_back(bottom - std::stod(last.substr(last.find(' '))));
  }
  return heights;
}

TEST_F(FigureValues, BarsAreAsHighAsTheEfficiencies) {
  const std::string file = folder.file("efficiency.svg");
  const json found = answer("run-experiment", {"--plot", "efficiency=" + file});
  const std::vector<double> planned = bars(content_of(file), "#0072b2");
  const std::vector<double> fixed = bars(content_of(file), "#c9c9c9");
  const json& conditions = found["conditions"];
  ASSERT_GE(planned.size(), conditions.size());
  ASSERT_GE(fixed.size(), conditions.size());
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const double ratio = number(conditions[i], "/planned/efficiency_kg_per_kj") /
                         number(conditions[i], "/fixed/efficiency_kg_per_kj");
    EXPECT_NEAR(planned[i] / fixed[i], ratio, 0.01 * ratio) << i;
  }
}

TEST_F(FigureValues, ConditionsThatFailAndDugGroundAreNamed) {
  const std::string file = folder.file("efficiency.svg");
  const json found =
      answer("run-experiment", {"--densities", "5,90,100", "--path", "60deg,0.5m,2m", "--second",
                                "left", "--plot", "efficiency=" + file, "--plot-size", "85mm"});
  ASSERT_TRUE(warns(found, "condition_failed"));
  const std::string svg = content_of(file);
  EXPECT_TRUE(contains(svg, ">no dig</text>"));
  EXPECT_TRUE(contains(svg, "No dig in 100 %"));
  EXPECT_TRUE(contains(svg, "planned path on the"));
  EXPECT_TRUE(contains(svg, ">90</text>"));
}

TEST_F(FigureValues, ManyDensitiesCanBeReadOnAColumn) {
  const Words digs = {"--densities", "5:10:95", "--plot-size"};
  for (const char* size : {"40mm", "85mm", "170mm"}) {
    const Words plots = {"--plot", "efficiency=" + folder.file("e.svg"), "--plot",
                         "paths=" + folder.file("p.svg")};
    answer("run-experiment", digs + Words{size} + plots);
    expect_legible(content_of(folder.file("e.svg")), std::string("ten densities at ") + size);
    EXPECT_TRUE(contains(content_of(folder.file("p.svg")), "6 of 10 conditions"));
  }
}

TEST_F(FigureValues, ASearchInUncertainSoilSaysWhatItsAxisCounts) {
  const std::string file = folder.file("search.svg");
  answer("plan-path", {"--density", "40", "--density-sd", "8", "--search", "--evaluations", "30",
                       "--plot", "search=" + file});
  EXPECT_TRUE(contains(content_of(file), ">paths evaluated</text>"));
  EXPECT_TRUE(contains(content_of(file), "digs were simulated"));
}

TEST_F(FigureValues, WhatALowSheetLeavesOutIsWarnedAbout) {
  const std::string file = folder.file("torques.svg");
  const Words dig = {"--density", "40", "--plot", "torques=" + file, "--plot-size"};
  const json low = answer("simulate-dig", dig + Words{"85mm,60mm"});
  EXPECT_TRUE(warns(low, "plot_left_out"));
  EXPECT_TRUE(contains(low["warnings"].dump(), "the panel 'bucket [kN m]'"));
  EXPECT_TRUE(contains(content_of(file), "time since the dig began [s]"));
  EXPECT_FALSE(warns(answer("simulate-dig", dig + Words{"85mm,90mm"}), "plot_left_out"));
}

TEST_F(FigureValues, PhasesHaveColoursThatNoCurveHas) {
  const std::string file = folder.file("forces.svg");
  answer("simulate-dig", {"--density", "40", "--plot", "forces=" + file});
  const std::string svg = content_of(file);
  for (const char* curve : {"#0072b2", "#d55e00", "#009e73"}) {
    EXPECT_FALSE(contains(svg, "fill=\"" + std::string(curve))) << curve;
  }
  for (const char* phase : {"penetrate", "drag", "scoop"}) {
    EXPECT_TRUE(contains(svg, ">" + std::string(phase) + "</text>")) << phase;
  }
}

TEST_F(FigureValues, ASearchShowsEveryDigThatWasNotAStall) {
  const std::string file = folder.file("search.svg");
  const json found = answer("plan-path", {"--density", "40", "--search", "--evaluations", "60",
                                          "--plot", "search=" + file});
  const std::size_t shown = circles(content_of(file), "#56b4e9");
  EXPECT_LE(shown, static_cast<std::size_t>(number(found, "/evaluations")) + 1);
  EXPECT_GT(shown, static_cast<std::size_t>(0.5 * number(found, "/evaluations")));
}

TEST_F(FigureValues, AFigureWithoutWhatItNeedsIsRefusedBeforeTheWork) {
  refused(2, "--plot: no figure 'landscape': nothing is searched", "plan-path",
          {"--density", "40", "--plot", "landscape=" + folder.file("l.svg")});
  refused(2, "--plot: no figure 'study': there is no --study", "run-experiment",
          {"--plot", "study=" + folder.file("s.svg")});
  refused(2, "--plot: no figure 'fuel': it is of RUN.csv", "measure-efficiency",
          {"--runs", folder.file("a"), "--against", folder.file("b"), "--plot",
           "fuel=" + folder.file("e.svg")});
  refused(2, "--plot: no figure 'sets': it is of --runs", "measure-efficiency",
          run_pair + Words{"--plot", "sets=" + folder.file("e.svg")});
  auto machine = json::parse(content_of(shipped("machines/zx120.json")));
  machine.erase("cylinders");
  machine.erase("hydraulics");
  refused(2, "no figure 'cylinders': the file of the machine states no cylinders", "simulate-dig",
          {"--density", "40", "--machine", folder.write("m.json", machine.dump()), "--plot",
           "cylinders=" + folder.file("c.svg")});
}

TEST_F(FigureValues, WithoutFontsOnlySvgIsDrawn) {
  ::setenv("FONTCONFIG_FILE", folder.write("fonts.conf", "<fontconfig></fontconfig>").c_str(), 1);
  for (const char* name : {"f.png", "f.pdf"}) {
    refused(2, "--plot: no font is installed", "simulate-dig",
            {"--density", "40", "--plot", folder.file(name)});
  }
  answer("simulate-dig", {"--density", "40", "--plot", folder.file("f.svg")});
  ::unsetenv("FONTCONFIG_FILE");
}

TEST(DigTiming, BeginsWhereTheDigDoesNotWhereItsApproachDoes) {
  const Machine machine = load_machine(shipped_or_file("machines", "zx120"));
  const SoilKind loam = load_soil(shipped_or_file("soils", "loam"));
  SceneOptions options;
  options.history = true;
  const Terrain ground =
      undisturbed(flat_ground(scene_extent(machine, default_dump_point()), 0.05));
  const DigScene scene = run_scene(machine, loam, 40.0, ground, options);
  DigPath with_approach = scene.path;
  with_approach.approach =
      std::get<std::vector<DigPose>>(way_down(machine, scene.path, boom_plane_profile(ground)));
  ASSERT_FALSE(with_approach.approach.empty());
  const auto steps = timed_steps(machine, scene.path, scene.dig);
  const auto same = timed_steps(machine, with_approach, scene.dig);
  ASSERT_EQ(steps.size(), same.size());
  for (std::size_t i = 0; i < steps.size(); ++i) EXPECT_EQ(steps[i].time, same[i].time) << i;
  EXPECT_NEAR(steps.back().time + 0.5 * steps.back().duration, scene.duration, 0.02);
}

TEST(StudyFigure, HasARowForEachConditionAndTheGains) {
  std::vector<StudyResult> results(3);
  const char* const levels[] = {"-5 deg", "0 deg", "+5 deg"};
  for (std::size_t i = 0; i < 3; ++i) {
    results[i].condition.factor = "slope";
    results[i].condition.level = levels[i];
    results[i].rms = 4.0;
    const double gain = 10.0 + 5.0 * static_cast<double>(i);
    results[i].energy.gain = {gain, {gain - 3.0, gain + 3.0}, 30};
    results[i].equal.gain = {std::nan(""), {}, 0};
    results[i].cycle.gain = {gain + 1.0, {gain - 1.0, gain + 2.0}, 30};
  }
  for (const double width : {40.0, 85.0, 170.0}) {
    const std::string svg = to_svg(lay_out(study_figure(results), {width, {}}));
    expect_legible(svg, "study");
    EXPECT_TRUE(contains(svg, "slope, +5 deg"));
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(circles(svg, "r=\"1.3\" fill=\"#0072b2\""), 3U) << width;
  }
}

TEST(StudyFigure, SaysWhyARowIsEmptyAndCutsNoWord) {
  std::vector<StudyResult> results(4);
  for (StudyResult& result : results) {
    result.condition = {};
    result.condition.factor = "second dig";
    result.condition.level = "on the ground that the first one left";
    result.compared = 30;
    for (const auto goal : {&StudyResult::energy, &StudyResult::equal, &StudyResult::cycle}) {
      (result.*goal).gain = {std::nan(""), {}, 0};
    }
  }
  results[0].energy.gain = {40.0, {30.0, 50.0}, 30};
  results[1].held_down = 30;
  results[2].compared = 0;
  for (const double width : {85.0, 170.0}) {
    const std::string svg = to_svg(lay_out(study_figure(results), {width, {}}));
    expect_legible(svg, "study");
    EXPECT_TRUE(contains(svg, ">machine lifts or drags<")) << width;
    EXPECT_TRUE(contains(svg, ">density alone<"));
    EXPECT_TRUE(contains(svg, ">no run with both digs<"));
    EXPECT_FALSE(contains(svg, "…")) << width;
    EXPECT_TRUE(contains(svg, "first one left<"));
  }
}

}  // namespace
}  // namespace excavplan::test
