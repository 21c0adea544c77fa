// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <excavplan/base/error.hpp>
#include <excavplan/design/cut_and_fill.hpp>
#include <excavplan/design/design_file.hpp>
#include <excavplan/design/job_design.hpp>

#include "fuzz/file_readers.hpp"
#include "fuzz/fuzz_target.hpp"

namespace excavplan::test {
namespace {

void say(Said& said, const std::string& name, const Measured& volume) {
  require_that(std::isfinite(volume.value) && volume.sd >= 0.0, name + " is not finite");
  said.add(name, volume.value).add(name + " sd", volume.sd);
}

/// And what is to be dug for it in level ground.
std::string read_any_design(const std::string& path) {
  static const HeightMap ground = flat_ground({-2.0, -4.0, 20.0, 8.0}, 0.25);
  const DesignSurface design = read_design(path);
  Said said;
  try {
    const CutAndFill volumes = cut_and_fill(design, ground);
    say(said, "cut", volumes.cut);
    say(said, "fill", volumes.fill);
  } catch (const Error& error) {  // names the design
    throw Error(error.kind(), path + ": " + error.what());
  }
  return said.add("name", design.name).text();
}

std::string read_site(const std::string& path) {
  const JobDesign job = read_plain_site(path);
  require_job(job);
  return Said().add("name", job.name).add("tolerance", job.tolerance).text();
}

}  // namespace

std::vector<FileReader> design_readers() {
  return {{"design", read_any_design}, {"plain_site", read_site}};
}

}  // namespace excavplan::test
