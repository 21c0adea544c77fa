// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/tool.hpp"
#include "plan_site/job_commands.hpp"

namespace excavplan::tools {
namespace {

const About about = {
    "plan-site",
    "plans a whole job, from a design and a scan to finished ground, step by step. COMMAND is new "
    "(begins a job in FOLDER), next (the step to do now, the same until it is done), done (what "
    "became of it), scan (takes in a scan that no step asked for), show (how far the job is, with "
    "--report a page of it), undo (takes the last done or scan back) or estimate (digs, time, fuel "
    "truckloads and cost before the first bucket, of the job in FOLDER, a plain site, or a trench "
    "in "
    "words). FOLDER holds all that the job knows.",
    {{"plan-site new job --trench 15x1x0.5 --from 3,0 --heading 0 --scan scan.tif --soil loam "
      "--windrow 2,1.5,18,1.5,18,5,2,5",
      "a trench from 3 m before the machine, its soil to the left"},
     {"plan-site next job --json", "the next dig, move or scan, with the file of its trajectory"},
     {"plan-site done job --step 7 --payload-mass 540 --energy-kj 160 --scan after.tif",
      "it was done, and this is the ground now"},
     {"plan-site show job --report job.html", "a page of all that was done"},
     {"plan-site show job --serve 8080", "the same in a browser, while the job goes on"},
     {"plan-site estimate --trench 15x1x0.5m --soil clay --density 50",
      "what a trench is going to take, in level ground"},
     {"plan-site estimate --trench 15x1x0.5m --soil loam --fuel-price 1.6 --hour-price 90 "
      "--truckload-price 75 --report trench.html",
      "its cost too, on a page to print"}},
    true,
    false,
    "10 next: the job is finished; 11 next: it is stuck, or nothing is safe"};

void declare(Arguments& arguments, JobInputs& inputs) {
  std::string words;
  for (const JobCommand& each : job_commands()) {
    words += (words.empty() ? "" : "|") + std::string(each.word);
  }
  declare(arguments, inputs, words);
}

Outcome work(const JobInputs& inputs, Console& console) {
  if (inputs.folder.empty() && inputs.command != "estimate") {
    usage_error("FOLDER is missing: folder of the job");
  }
  for (const JobCommand& each : job_commands()) {
    if (inputs.command == each.word) return each.work(inputs, console);
  }
  return {};
}

}  // namespace
}  // namespace excavplan::tools

int main(int argc, char** argv) {
  using namespace excavplan::tools;
  const auto bind = static_cast<void (*)(Arguments&, JobInputs&)>(declare);
  return tool_main(argc, argv, about, bind, work);
}
