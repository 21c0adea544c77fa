// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "estimate_density/site_inputs.hpp"

namespace excavplan::tools {

void declare_site(Arguments& arguments, SiteEstimateInputs& inputs) {
  declare_site_folder(arguments, inputs.at,
                      "remember ground and density in this folder, which is made if it is not "
                      "there: BEFORE is then not needed after the first scan; alone: show what "
                      "it holds");
  const Arguments::Use used = {[&inputs] { return inputs.is_used(); }, "it is of --site"};
  arguments.only_if(used, [&] {
    arguments.file("dug", inputs.dug,
                   "the dig between the scans: a result of plan-path or simulate-dig --json, "
                   "for its path, start, foretold work and stall");
    arguments.option("dump-at", inputs.dump_at,
                     "where --dug emptied the bucket, in the machine's frame: soil elsewhere is no "
                     "heap of it (default: as a result of simulate-dig tells)");
    arguments.flag("no-dig", inputs.no_dig, "nothing was dug: the scan shows the ground alone");
    arguments.flag("stalled", inputs.stalled, "the dig was given up: the ground is strong");
    arguments.flag("no-update", inputs.no_update, "leave the site as it is");
    arguments.flag("undo", inputs.undo, "take the last update of the site back; without scans");
    arguments.option(
        "time", inputs.time, Quantity::time,
        "when AFTER was scanned, since 1970-01-01 UTC (default: as recorded, else now)");
  });
  arguments.exclude("undo", {"no-update", "dug", "dump-at", "no-dig", "stalled", "time"});
  arguments.exclude("no-dig", {"dug", "dump-at", "stalled"});
}

}  // namespace excavplan::tools
