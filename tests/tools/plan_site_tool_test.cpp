// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <fstream>
#include <functional>
#include <map>
#include <string>

#include <excavplan/machine/trajectory.hpp>

#include "site/site_folder.hpp"
#include "support/http_client.hpp"
#include "support/plain_site_folder.hpp"
#include "support/report_page.hpp"
#include "support/tool_answers.hpp"

namespace excavplan::test {
namespace {

/// A trench of 2.5 m in level ground, as words on the command line and as a plain site.
class PlanSite : public BadInput {
 protected:
  std::string grid(const std::string& name, const std::function<double(double, double)>& height) {
    const double cell = 0.05;
    const int cols = 360, rows = 280;
    std::string text = "ncols 360\nnrows 280\nxllcorner -8\nyllcorner -7\ncellsize 0.05\n";
    for (int row = rows - 1; row >= 0; --row) {
      for (int col = 0; col < cols; ++col) {
        text += std::to_string(height(-8.0 + cell * (col + 0.5), -7.0 + cell * (row + 0.5))) + ' ';
      }
      text += '\n';
    }
    return folder.write(name, text);
  }

  std::string job() const { return folder.file("job"); }
  Words order() const {
    return {"new",    job(), "--trench", "2.5x1x0.4", "--from",    "2,0",   "--heading", "0",
            "--scan", level, "--soil",   "loam",      "--windrow", windrow, "--time",    "1000"};
  }
  json next() { return answer("plan-site", {"next", job()}); }
  json done(const json& step, const Words& more = {}) {
    return answer("plan-site",
                  Words{"done", job(), "--step", std::to_string(step["step"].get<int>())} + more);
  }

  const std::string windrow = "-1,1.5,7,1.5,7,5.5,-1,5.5";
  const std::string level = grid("scan0.asc", [](double, double) { return 0.0; });
};

/// Each file of a folder by its name.
std::map<std::string, std::string> files_in(const std::string& path) {
  std::map<std::string, std::string> files;
  for (const auto& each : fs::directory_iterator(path)) {
    files[each.path().filename().string()] = content_of(each.path().string());
  }
  return files;
}

TEST_F(PlanSite, OrderStepAndReport) {
  const json begun = answer("plan-site", order());
  EXPECT_NEAR(number(begun, "/progress/design_m3"), 1.0, 0.06);
  fs::remove(level);
  const json move = next();
  EXPECT_EQ(move["what"], "move");
  EXPECT_TRUE(move["path"].is_null());
  EXPECT_EQ(done(move, {"--base", "-0.6,0,0"})["taken"], true);

  const json dig = next();
  EXPECT_EQ(dig, next());
  EXPECT_EQ(dig["what"], "dig");
  EXPECT_NEAR(number(dig, "/base/x_m"), -0.6, 1e-12);
  expect_keys(dig, "number",
              path_keys + Words{"step", "base/x_m", "base/y_m", "base/z_m", "base/heading_rad",
                                "base/roll_rad", "base/pitch_rad", "path/lane_m", "path/grade_rad",
                                "dump/x_m", "dump/y_m", "dump/z_m", "predicted/payload_kg",
                                "predicted/energy_kj", "predicted/time_s"});
  expect_keys(dig, "array",
              {"predicted/payload_kg_interval", "predicted/energy_kj_interval", "warnings"});
  expect_keys(dig, "boolean", {"path/floor", "trustworthy"});
  const std::string motion = content_of(dig["trajectory"].get<std::string>());
  EXPECT_EQ(motion.rfind("time_s,phase,boom_rad,arm_rad,bucket_rad,tip_x_m,tip_z_m", 0), 0U);
  EXPECT_TRUE(contains(motion, ",dump,"));

  const std::string record = content_of(job() + "/job.json");
  EXPECT_EQ(done(move)["taken"], false);
  EXPECT_EQ(content_of(job() + "/job.json"), record);
  const std::string dug = grid("scan1.asc", [](double x, double y) {
    return x > 3.2 && x < 4.4 && y > 0.0 && y < 0.5 ? -0.3 : 0.0;
  });
  const json after =
      done(dig, {"--payload-mass", "400", "--energy-kj", "140", "--scan", dug, "--time", "1200"});
  EXPECT_EQ(after["scan_taken"], true);
  EXPECT_LT(number(after, "/progress/left_m3"), number(begun, "/progress/left_m3") - 0.1);
  EXPECT_EQ(after["progress"]["digs"], 1);
  const std::string page = folder.file("job.html");
  const json shown = answer("plan-site", {"show", job(), "--report", page});
  EXPECT_EQ(shown["progress"], after["progress"]);
  const json drawn = drawn_on(content_of(page));
  ASSERT_EQ(drawn["events"].size(), 2U);
  const json& event = drawn["events"][1];
  EXPECT_EQ(event["payload_kg"], 400.0);
  EXPECT_EQ(event["energy_j"], 140e3);
  EXPECT_EQ(event["foretold_kg"], dig["predicted"]["payload_kg"]);
  EXPECT_EQ(event["scanned"], true);
  EXPECT_EQ(event["left_m3"], shown["progress"]["left_m3"]);
  EXPECT_EQ(drawn["design_m3"], shown["progress"]["design_m3"]);
  EXPECT_EQ(answer("plan-site", {"undo", job()})["step"], dig["step"]);
  EXPECT_EQ(content_of(job() + "/job.json"), record);
}

TEST_F(PlanSite, WhatOnlyLooksLeavesTheFolderAsItIs) {
  answer("plan-site", order());
  done(next(), {"--base", "-0.6,0,0"});
  const json after = done(next());
  EXPECT_EQ(after["progress"]["digs"], 1);
  fs::remove(job() + "/site.lock");
  const auto files = files_in(job());
  fs::permissions(job(), fs::perms::owner_read | fs::perms::owner_exec);  // but for root
  const json shown = answer("plan-site", {"show", job(), "--report", folder.file("job.html")});
  EXPECT_EQ(shown["progress"], after["progress"]);
  const json rest = answer("plan-site", {"estimate", job(), "--density", "40"});
  EXPECT_LT(number(rest, "/design_m3"), 0.95);
  fs::permissions(job(), fs::perms::owner_all);
  EXPECT_EQ(files_in(job()), files);
}

TEST_F(PlanSite, AScanWithoutAStepAndAJobThatEnds) {
  answer("plan-site", order());
  const json move = next();
  done(move, {"--base", "-0.6,0,0"});
  const std::string finished = grid("finished.asc", [](double x, double y) {
    return x > 2.0 && x < 4.5 && y > -0.5 && y < 0.5 ? -0.4 : 0.0;
  });
  const json seen = answer("plan-site", {"scan", job(), "--scan", finished, "--time", "1300"});
  EXPECT_EQ(seen["scan_taken"], true);
  EXPECT_LT(number(seen, "/progress/rms_m"), 0.01);
  json step;
  for (int i = 0; i < 4; ++i) {
    const ProgramResult result = run_program("plan-site", {"next", job(), "--json"});
    step = json::parse(result.out);
    if (step["what"] == "stop") {
      EXPECT_EQ(result.code, 10);
      EXPECT_EQ(step["reason"], "finished");
      return;
    }
    ASSERT_EQ(step["what"], "move") << step;
    done(step);
  }
  ADD_FAILURE() << step;
}

TEST_F(PlanSite, AStepThatWasNotGivenIsNotDone) {
  answer("plan-site", order());
  const std::string record = content_of(job() + "/job.json");
  EXPECT_EQ(done({{"step", 1}})["taken"], false);
  EXPECT_EQ(content_of(job() + "/job.json"), record);
}

TEST_F(PlanSite, WhatAFolderHoldsOfAJobIsNoOutput) {
  answer("plan-site", order());
  const auto before = files_in(job());
  for (const char* const file : {"job.json", "job-first-ground.tif", "order-design.ply"})
    refused(2, "name the same file", "plan-site", {"show", job(), "--report", job() + '/' + file});
  EXPECT_EQ(files_in(job()), before);
  EXPECT_EQ(run_program("plan-site", {"show", job(), "--report", job() + "/page.html"}).code, 0);
}

TEST_F(PlanSite, OneProcessOrdersAtATime) {
  const SiteFolder other(job(), true, "order.lock");
  const ProgramResult result = run_program("plan-site", order());
  EXPECT_EQ(result.code, 3);
  EXPECT_TRUE(contains(result.err, "is in use by process")) << result.err;
  EXPECT_FALSE(fs::exists(job() + "/order.json"));
}

TEST_F(PlanSite, AnOrderThatCannotBeDoneAsAskedForIsDoubted) {
  Words deep = order();
  *(std::find(deep.begin(), deep.end(), "--trench") + 1) = "2.5x1x7";
  deep.push_back("--density");
  deep.push_back("0.4");
  const json begun = answer("plan-site", deep);
  EXPECT_EQ(begun["trustworthy"], false);
  const std::string warnings = begun["warnings"].dump();
  EXPECT_TRUE(contains(warnings, "design_out_of_reach")) << warnings;
  EXPECT_TRUE(contains(warnings, "density_as_fraction")) << warnings;
}

TEST_F(PlanSite, APlainSiteSaysAll) {
  json site = PlainSiteFolder().site;
  site["design"]["length_m"] = 2.5;
  site["design"].erase("floor_z_at_middle_m");  // its depth counts from the scan
  site["tolerance_m"] = 0.02;
  site["start_pose"]["x"] = -0.6;
  site["soil"]["e_max"] = 1.4;
  const std::string file = folder.write("site.json", site.dump());
  const json begun = answer("plan-site", {"new", job(), "--site", file});
  EXPECT_NEAR(number(begun, "/progress/design_m3"), 1.0, 0.06);
  const json kept = json::parse(content_of(job() + "/order.json"));
  EXPECT_EQ(kept["tolerance_m"], 0.02);
  EXPECT_EQ(kept["kept"]["soil"]["void_ratio_max"], 1.4);
  site["start_pose"]["x"] = "there";
  refused(3, "start_pose", "plan-site",
          {"new", folder.file("other"), "--site", folder.write("bad.json", site.dump())});
  refused(2, "--site excludes --soil", "plan-site",
          {"new", folder.file("other"), "--site", file, "--soil", "clay"});
}

TEST_F(PlanSite, AWallThatMayFailIsTold) {
  Words upright = order();
  upright[3] = "2.5x1x1.5";
  upright[11] = "sand";
  const json begun = answer("plan-site", upright);
  EXPECT_EQ(begun["trustworthy"], false);
  EXPECT_TRUE(warns(begun, "unstable_wall")) << begun["warnings"];
  const Words words = {"estimate", "--trench", "15x1x1.5m", "--soil", "sand"};
  EXPECT_TRUE(warns(answer("plan-site", words), "unstable_wall"));
  EXPECT_FALSE(warns(answer("plan-site", words + Words{"--batter", "1.8"}), "unstable_wall"));
}

TEST_F(PlanSite, AnEstimateOfWordsOfASiteAndOfAJob) {
  const json words = answer(
      "plan-site", {"estimate", "--trench", "2.5x1x0.4m", "--soil", "loam", "--density", "40"});
  EXPECT_NEAR(number(words, "/design_m3"), 1.0, 1e-6);
  EXPECT_EQ(words["density_sd_percent"], 10.0);
  const Words figures = {"digs", "time_min", "fuel_l", "truckloads", "swollen_m3", "mass_kg"};
  expect_keys(words, "number", figures + Words{"reference_kj_per_design_m3", "reference_digs"});
  for (const std::string& key : figures) {
    const json& interval = words[key + "_interval"];
    EXPECT_LE(interval[0], words[key]) << key;
    EXPECT_LE(words[key], interval[1]) << key;
    EXPECT_EQ(words["spread_percent"][key].size(), 6U);
  }
  EXPECT_NEAR(number(words, "/swollen_m3"), number(words, "/bulking_factor"), 1e-9);
  EXPECT_EQ(words["trustworthy"], false);  // a short trench was never played

  answer("plan-site", order());
  const json begun = answer("plan-site", {"estimate", job(), "--density", "40"});
  EXPECT_NEAR(number(begun, "/design_m3"), 1.0, 0.06);
  EXPECT_NEAR(number(begun, "/digs"), number(words, "/digs"), 2.0);
  EXPECT_GT(number(begun, "/spread_percent/digs/volume"), 0.5);
  const json guessed = answer("plan-site", {"estimate", job()});
  EXPECT_EQ(guessed["density_sd_percent"], 25.0);
  EXPECT_GT(number(guessed, "/spread_percent/digs/density"),
            number(begun, "/spread_percent/digs/density"));
  const Words scanned = {"estimate", "--trench", "2.5x1x0.4", "--from",    "2,0", "--heading",
                         "0",        "--scan",   level,       "--density", "40",  "--truck-mass",
                         "500"};
  const json seen = answer("plan-site", scanned);
  EXPECT_NEAR(number(seen, "/design_m3"), number(begun, "/design_m3"), 0.06);
  EXPECT_GE(number(seen, "/truckloads"), 3.0);

  const ProgramResult strict =
      run_program("plan-site", {"estimate", "--trench", "15x1x3", "--strict"});
  EXPECT_EQ(strict.code, 4);
  EXPECT_TRUE(contains(strict.out, "density 50 ± 25 %")) << strict.out;
  EXPECT_TRUE(contains(strict.out, "NOT TRUSTWORTHY: its mean depth is 3.00 m")) << strict.out;
}

TEST_F(PlanSite, AnEstimateWithPricesHasACostAndAPageToPrint) {
  const std::string page = folder.file("trench.html");
  const Words words = {"estimate", "--trench", "10x0.7x1.2m", "--soil", "clay"};
  EXPECT_FALSE(answer("plan-site", words).contains("cost"));
  const json priced =
      answer("plan-site", words + Words{"--fuel-price", "2", "--hour-price", "60",
                                        "--truckload-price", "100", "--report", page});
  const json& parts = priced["cost_parts"];
  EXPECT_NEAR(number(parts, "/fuel"), 2.0 * number(priced, "/fuel_l"), 1e-9);
  EXPECT_NEAR(number(parts, "/machine"), number(priced, "/time_min"), 1e-9);
  EXPECT_NEAR(number(parts, "/truckloads"), 100.0 * number(priced, "/truckloads"), 1e-9);
  EXPECT_NEAR(number(priced, "/cost"),
              number(parts, "/fuel") + number(parts, "/machine") + number(parts, "/truckloads"),
              1e-9);
  EXPECT_LT(number(priced["cost_interval"], "/0"), number(priced, "/cost"));
  EXPECT_GT(number(priced["cost_interval"], "/1"), number(priced, "/cost"));
  const std::string text = content_of(page);
  EXPECT_TRUE(contains(text, "<h1>Trench 10x0.7x1.2m in clay, zx120: estimate</h1>"));
  EXPECT_TRUE(contains(text, "Not trustworthy: its mean depth is 1.20 m"));
  EXPECT_TRUE(contains(text, "<dt>Cost</dt>"));
  EXPECT_TRUE(contains(text, "95 % interval"));
  EXPECT_LT(text.size(), 100000U) << "a page without ground needs no program to draw it";
}

TEST_F(PlanSite, AnEstimateNamesWhatIsWrong) {
  const auto refuse = [&](const Words& words, const std::string& reason, int code = 2) {
    refused(code, reason, "plan-site", Words{"estimate"} + words);
  };
  refuse({}, "the design is missing: give FOLDER, --site, --trench or --design");
  refuse({"--trench", "10x1x1", "--fuel-price", "-1"}, "--fuel-price: -1 must be at least 0");
  refuse({"--trench", "10x0.7"}, "--trench: design: the size of a trench is '10x0.7', must be");
  refuse({"--trench", "10x1x500"}, "--trench: design: depth [m] is 500");
  refuse({"--trench", "10x1x1", "--soil", "mud"}, "--soil: 'mud' is neither a file nor one of");
  refuse({"--trench", "10x1x1", "--density", "150"}, "--density [%] is 150, must be in 0 .. 100");
  refuse({"--trench", "10x1x1", "--truck-mass", "0"}, "--truck-mass [kg] is 0");
  refuse({"--trench", "10x1x1", "--fuel-model", "coal"}, "'coal' is neither a file nor one of");
  refuse({job()}, "holds no job: it has no order.json", 3);
  refuse({job(), "--trench", "10x1x1"}, "FOLDER excludes --site, --trench");
  refused(2, "FOLDER is missing", "plan-site", {"next"});
}

/// plan-site show --serve as a process of its own.
class Served {
 public:
  explicit Served(const Words& words) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
    child_ = started("plan-site", words, [&] {
      ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
      ::dup2(ends[1], STDERR_FILENO);
    });
    ::close(ends[1]);
    std::string text;
    for (char letter = 0; letter != '\n' && ::read(ends[0], &letter, 1) == 1;) text += letter;
    ::close(ends[0]);
    const std::size_t url = text.find("http://");
    said = text;
    if (url != std::string::npos) at = parts_of(text.substr(url, text.size() - url - 1));
  }
  ~Served() { end(SIGKILL); }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  /// @return its exit code
  int end(int signal) {
    if (child_ == 0) return -1;
    ::kill(child_, signal);
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = 0;
    return exit_code(status);
  }
  std::string request(const std::string& path) const {
    return "GET " + path + at.query + " HTTP/1.1\r\nHost: " + at.host + "\r\n\r\n";
  }

  std::string said;  ///< its first line
  ServedUrl at;

 private:
  pid_t child_ = 0;
};

TEST_F(PlanSite, IsServedWhileItGoesOn) {
  answer("plan-site", order());
  Served served({"show", job(), "--serve", "0"});
  if (contains(served.said, "without Boost.Beast")) GTEST_SKIP() << served.said;
  ASSERT_NE(served.at.port, 0) << served.said;
  HttpClient page(served.at.port), events(served.at.port);
  page.send(served.request("/?"));
  const std::string html = page.all();
  const json drawn = drawn_on(html);
  EXPECT_TRUE(drawn["events"].empty());
  const std::string stream = drawn["stream"].get<std::string>();
  EXPECT_EQ(stream.rfind("events?", 0), 0U);
  EXPECT_TRUE(contains(html, "connect-src 'self'"));
  events.send(served.request("/" + stream + "&steps=0&"));
  events.until("event: state\n");

  const json move = next();  // the server holds no lock
  const std::string planned = events.until("Next: step 1, move.");
  EXPECT_TRUE(contains(planned, "Next: step 1, move."));
  done(move, {"--base", "-0.6,0,0"});
  const std::string& come = events.until("id: 0.1\n");
  events.until("\"row\":\"<tr data-step=");
  const std::size_t data = come.find("data: ", come.find("event: step"));
  const json step = json::parse(come.substr(data + 6, come.find('\n', data) - data - 6));
  EXPECT_EQ(step["event"]["what"], "move");
  EXPECT_EQ(step["event"]["base"][0], -0.6);
  answer("plan-site", {"undo", job()});
  EXPECT_TRUE(contains(events.until("event: reload"), "event: reload"));
  EXPECT_EQ(served.end(SIGTERM), 0);
  Served interrupted({"show", job(), "--serve", "localhost:0"});
  EXPECT_EQ(interrupted.end(SIGINT), 0);
}

TEST_F(PlanSite, ServesNothingThatIsNotAJob) {
  refused(2, "--serve: 'here' is not PORT or ADDRESS:PORT", "plan-site",
          {"show", job(), "--serve", "here"});
  refused(3, "holds no job: it has no order.json", "plan-site", {"show", job(), "--serve", "0"});
  refused(2, "--serve excludes --report", "plan-site",
          {"show", job(), "--serve", "0", "--report", folder.file("page.html")});
}

TEST_F(PlanSite, WrongInputsNameKeyAndValue) {
  const auto with = [&](const std::string& option, const std::string& value) {
    Words words = order();
    const auto at = std::find(words.begin(), words.end(), option);
    if (at == words.end()) return words + Words{option, value};
    *(at + 1) = value;
    return words;
  };
  const auto refuse = [&](const std::string& option, const std::string& value,
                          const std::string& reason, int code = 2) {
    refused(code, reason, "plan-site", with(option, value));
  };
  refuse("--trench", "4x1", "--trench: design: the size of a trench is '4x1'");
  refuse("--trench", "4x1x200", "depth [m]");
  refuse("--from", "200,0", "no ground is known along it");
  refuse("--heading", "north", "--heading: 'north'");
  refuse("--heading", "90", "--heading: '90' rad is more than a turn");
  refuse("--windrow", "1,2,3,4", "--windrow: '1,2,3,4': its polygon has 2 corners");
  refuse("--truck", "1,2,3,4,5,6:2", "--truck: truck '1,2,3,4,5,6:2': must be POLYGON:HEIGHT:KG");
  refuse("--keep-out", "1,2,3,4,5,9:deep", "--keep-out: depth of a keep-out [m] is 'deep'");
  refuse("--tolerance", "0", "tolerance [m]");
  refuse("--density", "140", "density [%]");
  refuse("--base", "1,2", "--base: '1,2' is not X,Y,HEADING");
  refuse("--base", "1,2,90", "--base: '90' rad is more than a turn");
  refuse("--base", "1e300,0,0", "start of the machine [m] is 1e+300");
  refuse("--soil", "peat", "peat");
  refuse("--scan", folder.file("none.asc"), "none.asc", 3);
  const std::string cell = folder.file("cell.asc");
  std::ofstream(cell) << "ncols 1\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 0.1\n0\n";
  refuse("--scan", cell, "--scan: " + cell + ": the points spread over 0.00 x 0.00 m", 3);
  refuse("--design", letter, "--design excludes --trench");
  refused(2, "COMMAND: 'nxt' is not one of new|next|done|scan|show|undo|estimate", "plan-site",
          {"nxt", job()});
  refused(3, "holds no job: it has no order.json", "plan-site", {"next", job()});
  answer("plan-site", order());
  refused(2, "holds a job already", "plan-site", order());
  refused(2, "--step is missing", "plan-site", {"done", job()});
  refused(2, "--scan is missing", "plan-site", {"scan", job()});
  refused(2, "no step to take back", "plan-site", {"undo", job()});
  const ProgramResult ignored = run_program("plan-site", {"show", job(), "--payload-mass", "5"});
  EXPECT_EQ(ignored.code, 0);
  EXPECT_TRUE(contains(ignored.err, "without effect: --payload-mass")) << ignored.err;
  std::ofstream(job() + "/job.json", std::ios::app) << "x";
  EXPECT_EQ(run_program("plan-site", {"next", job()}).code, 3);
}

}  // namespace
}  // namespace excavplan::test
