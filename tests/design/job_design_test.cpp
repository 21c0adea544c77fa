// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/design/job_design.hpp>

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include <excavplan/clouds/raster_file.hpp>
#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/ground/ascii_grid.hpp>

#include "design_files.hpp"
#include "support/errors.hpp"

namespace excavplan::test {
namespace {

using std::string;

const string square = "[[0,0],[1,0],[1,1],[0,1]]";
string site(const string& more) {
  return R"({"format":"plain-site","version":1,"id":"T","tolerance_m":0.05,
"design":{"kind":"trench","length_m":15,"floor_width_m":1,"depth_m":0.5,"origin_m":[1,2],"heading_rad":0.5})" +
         more + "}";
}

TEST(PlainSite, AllThatAJobSaysIsRead) {
  const DesignFile file(
      "json",
      site(R"(,"keep_out":[{"kind":"cable","polygon":)" + square +
           R"(,"depth_m":0.8},{"polygon":)" + square +
           R"(}],"obstacles":[{"kind":"pole","polygon":)" + square +
           R"(,"height_m":6}],"dump_areas":[{"kind":"heap","polygon":)" + square +
           R"(}],"truck":{"bed_polygon":)" + square +
           R"(,"bed_height_m":2.4,"target_kg":4000},"start_pose":{"x":1,"y":2,"heading_rad":3})" +
           R"(,"sensor":{"noise_sd_at_1m_m":0.001,"pattern_sd_at_1m_m":0.002,"range_power":2})"));
  const JobDesign job = read_plain_site(file.path());
  require_job(job);
  EXPECT_EQ(job.tolerance, 0.05);
  ASSERT_EQ(job.keep_out.size(), 2u);
  EXPECT_EQ(job.keep_out[0].depth, 0.8);
  EXPECT_FALSE(job.keep_out[1].depth.has_value());
  EXPECT_EQ(job.obstacles.at(0).height, 6.0);
  EXPECT_EQ(job.dump_areas.at(0).kind, DumpArea::Kind::heap);
  EXPECT_EQ(job.truck->target_mass, 4000.0);
  EXPECT_EQ(job.start->heading, 3.0);
  ASSERT_TRUE(job.sensor.has_value());
  EXPECT_EQ(job.sensor->own, 0.001);
  EXPECT_EQ(job.sensor->shared, 0.002);
  EXPECT_EQ(job.sensor->range_power, 2.0);
  EXPECT_EQ(job.words->depth, 0.5);
}

TEST(PlainSite, ErrorsNameKeyAndRule) {
  const std::vector<std::pair<string, string>> cases = {
      {R"(,"keep_out":[{"polygon":[[0,0],[1,1]]}])", "keep_out[0].polygon: has 2 corners"},
      {R"(,"keep_out":[{"polygon":[[0,0],[1,1],[1,0],[0,1]]}])", "has no area"},
      {R"(,"keep_out":[{"polygon":[[0,0],[2,1],[2,0],[0,2]]}])", "has sides that cross"},
      {R"(,"keep_out":[{"polygon":[[0,0],[2,1],[2]]}])", "must be [x, y]"},
      {R"(,"keep_out":[{}])", "must be a list of corners"},
      {R"(,"dump_areas":[{"kind":"pond","polygon":[[0,0],[1,0],[1,1]]}])",
       "must be windrow or heap"},
      {R"(,"start_pose":{"x":1e10,"y":2,"heading_rad":3})", "start_pose.x"},
      {R"(,"start_pose":{"x":1,"y":2,"heading_rad":1e17})", "start_pose.heading_rad"},
      {R"(,"files":{"first_scan":"../scan.asc"})", "must be a file in the folder"}};
  for (const auto& [more, expected] : cases) {
    const DesignFile file("json", site(more));
    const string error = error_about([&] { read_plain_site(file.path()); }, file.path());
    EXPECT_NE(error.find(expected), string::npos) << error;
  }
}

TEST(PlainSite, ADepthBesideAFloorIsRead) {
  const auto with_depth = [](const string& depth) {
    return R"({"format":"plain-site","version":1,"design":{"kind":"trench","length_m":15,)"
           R"("floor_width_m":1,"origin_m":[1,2],"heading_rad":0.5,"floor_z_at_middle_m":-0.4,)"
           R"("depth_m":)" +
           depth + "}}";
  };
  const DesignFile file("json", with_depth("0.5"));
  const JobDesign job = read_plain_site(file.path());
  EXPECT_EQ(job.words->floor_z, -0.4);
  EXPECT_FALSE(job.words->depth.has_value());
  for (const auto& [depth, expected] : std::vector<std::pair<string, string>>{
           {R"("deep")", "design.depth_m: is \"deep\", expected a number"},
           {"null", "design.depth_m: is null, expected a number"},
           {"-0.5", "design.depth_m: is -0.5, must be in 0.01"}}) {
    const DesignFile bad("json", with_depth(depth));
    const string error = error_about([&] { read_plain_site(bad.path()); }, bad.path());
    EXPECT_NE(error.find(expected), string::npos) << error;
  }
}

TEST(PlainSite, AStartWhereNoMachineStandsIsRefused) {
  JobDesign job;
  job.dump_areas = {{DumpArea::Kind::heap, polygon_of_text("0,0,1,0,1,1")}};
  job.start = BasePose{1.0, 2.0, 0.0, 3.0};
  require_job(job);
  for (const double bad : {std::nan(""), 1e10, -1e300}) {
    for (double BasePose::*part : {&BasePose::x, &BasePose::y, &BasePose::heading}) {
      JobDesign other = job;
      (*other.start).*part = bad;
      EXPECT_NE(error_of([&] { require_job(other); }).find("start"), string::npos) << bad;
    }
  }
}

TEST(JobWords, PolygonsWithWhatFollows) {
  EXPECT_EQ(polygon_of_text("0,0,1,0,1,1").size(), 3u);
  EXPECT_EQ(keep_out_of_text("0,0,1,0,1,1:0.8").depth, 0.8);
  EXPECT_EQ(truck_of_text("0,0,1,0,1,1:2.4:4000").bed_height, 2.4);
  for (const char* text : {"0,0,1,0,1", "0,0,1,0", "0,0,x,0,1,1", ""}) {
    EXPECT_NE(error_of([&] { polygon_of_text(text); }).find("polygon"), string::npos) << text;
  }
  EXPECT_NE(error_of([&] { truck_of_text("0,0,1,0,1,1:2.4"); }).find("POLYGON:HEIGHT:KG"),
            string::npos);
  EXPECT_NE(error_of([] { require_job({}); }).find("soil has no place to go"), string::npos);
}

const string packed_sites = string(EXCAVPLAN_SHARED_DATA) + "/sites/sites.tar.gz";

/// The plain sites, unpacked while this lives.
class UnpackedSites {
 public:
  UnpackedSites() : path_(testing::TempDir() + "excavplan_sites_" + std::to_string(::getpid())) {
    std::filesystem::create_directories(path_);
    EXPECT_EQ(std::system(("tar xzf '" + packed_sites + "' -C '" + path_ + "'").c_str()), 0);
  }
  ~UnpackedSites() { std::filesystem::remove_all(path_); }
  UnpackedSites(const UnpackedSites&) = delete;
  UnpackedSites& operator=(const UnpackedSites&) = delete;
  const string& path() const { return path_; }

 private:
  string path_;
};

TEST(SharedSites, WordsTinAndRasterOfASiteCutTheSame) {
  if (!std::filesystem::exists(packed_sites)) GTEST_SKIP() << "no " << packed_sites;
  const UnpackedSites sites;
  for (const auto& folder : std::filesystem::directory_iterator(sites.path())) {
    if (!folder.is_directory()) continue;
    const string path = folder.path().string();
    const JobDesign job = read_plain_site(path + "/site.json");
    const HeightMap ground = read_ascii_grid(path + "/hidden/ground.asc");
    const double words = cut_and_fill(design_of_words(*job.words, ground), ground).cut.value;
    const double cells = cut_and_fill(read_design(path + "/design.asc"), ground).cut.value;
    DesignSurface tin = read_design(job.design_file);
    tin.cuts_only = true;
    EXPECT_NEAR(words / cells, 1.0, 0.01) << path;
    EXPECT_NEAR(cut_and_fill(tin, ground).cut.value / words, 1.0, 0.002) << path;
  }
}

}  // namespace
}  // namespace excavplan::test
