// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <excavplan/base/error.hpp>
#include <excavplan/calibration/calibration.hpp>
#include <excavplan/planning/plan_dig.hpp>
#include <excavplan/recording/recording.hpp>
#include <excavplan/results/stated_density.hpp>

#include "base/table.hpp"
#include "frame/quantity.hpp"
#include "frame/settings_file.hpp"
#include "fuzz/file_readers.hpp"
#include "plan_path/density_input.hpp"

namespace excavplan::test {
namespace {

std::string read_density_from(const std::string& path) {
  const tools::DensityInput input{{}, {}, path};
  const GroundDensity density = tools::density_of(input);
  DigPlan plan;
  plan.dig = PlannedDig{};
  const StatedDensity stated = stated_density(path);  // as --prior takes it
  return Said()
      .add("raw", stated.raw_percent)
      .add("independent", stated.independent_sd)
      .add("percent", density.percent)
      .add("sd", density.sd_percent)
      .add("soil", density.soil)
      .add("trustworthy", density.trustworthy)
      .add("warnings", static_cast<double>(tools::plan_warnings(plan, input, nullptr).size()))
      .text();
}

/// As calibrate-density does.
std::string read_samples(const std::string& path) {
  const Table table = Table::read(path);
  std::vector<BulkingSample> samples;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    samples.push_back({table.column("bulking_factor")[i], table.column("density_percent")[i]});
  }
  try {
    return to_json(calibrate_density(samples));
  } catch (const Error& error) {
    throw Error(ErrorKind::bad_file, path + ": " + error.what());
  }
}

/// A text of the command line, taken as each of what there is.
std::string read_option(const std::string& path) {
  using namespace tools;
  const std::string text = content_of_file(path);
  Said said;
  const auto attempt = [&](const char* name, const std::function<double()>& parse) {
    try {
      said.add(name, parse());
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::bad_input) throw;
    }
  };
  for (int quantity = 0; quantity <= static_cast<int>(Quantity::ratio); ++quantity) {
    const auto of = static_cast<Quantity>(quantity);
    attempt("quantity", [&] { return parse_quantity("--x", text, of); });
    attempt("series", [&] { return static_cast<double>(parse_series("--x", text, of).size()); });
  }
  attempt("path", [&] { return to_vector(parse_dig_path("--x", text)).sum(); });
  attempt("rectangle", [&] { return parse_rectangle("--x", text).x_max; });
  attempt("point", [&] { return parse_point("--x", text).sum(); });
  attempt("place", [&] { return parse_place("--x", text).sum(); });
  attempt("pose", [&] { return parse_pose("--x", text).sum(); });
  attempt("posture", [&] { return parse_posture("--x", text).swing; });
  attempt("recording", [&] {
    const auto query = parse_recording_spec(text);
    return query ? query->time.value_or(0.0) + query->span : -1.0;
  });
  return said.text();
}

/// As --config of a tool with an option of each form.
std::string read_settings(const std::string& path) {
  tools::Arguments arguments;
  bool flag = false;
  std::string word;
  std::vector<CameraPlace> places;
  arguments.flag("search", flag, "");
  arguments.text("soil", "NAME", word, "");
  arguments.option("camera", places, "");
  const tools::StatedSettings stated =
      tools::read_settings_file(path, "plan-path", arguments.entries());
  Said said;
  for (const auto& option : stated.options) {
    said.add("entry", static_cast<double>(option.entry));
    for (const std::string& text : option.texts) said.add("text", text);
  }
  return said.add("others", static_cast<double>(stated.left_out.size())).text();
}

}  // namespace

std::vector<FileReader> tool_readers() {
  return {{"density_from", read_density_from},
          {"samples", read_samples},
          {"option", read_option},
          {"settings", read_settings}};
}

}  // namespace excavplan::test
