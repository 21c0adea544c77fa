// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "shared/logged_dig.hpp"

#include <cmath>

namespace excavplan::tools {

void RunInputs::declare(Arguments& arguments, const std::string& its_prefix,
                        const std::string& whose) {
  prefix = its_prefix;
  arguments.option(prefix + "volume", volume, Quantity::volume, "soil in the bucket" + whose);
  arguments.option(prefix + "volume-sd", volume_sd, Quantity::volume,
                   "its standard deviation, if known");
  arguments.option(prefix + "mass", mass, Quantity::mass, "or its mass" + whose);
  arguments.option(prefix + "mass-sd", mass_sd, Quantity::mass, "its standard deviation, if known");
  arguments.file(prefix + "dump-before", dump_before,
                 "or volume from scans: cloud of the dump area before" + whose);
  arguments.file(prefix + "dump-after", dump_after, "cloud of the dump area after" + whose);
  arguments.option(prefix + "from", from, Quantity::time,
                   "time_s at which the dig starts" + whose + " (default: the log's first)");
  arguments.option(prefix + "to", to, Quantity::time,
                   "time_s at which it ends (default: the log's last)");
}

bool RunInputs::any() const {
  return volume || volume_sd || mass || mass_sd || dump_before || dump_after || from || to;
}

LoggedDig RunInputs::dig(const ScanFrames& frames) const {
  check();
  LoggedDig result;
  result.file = *log;
  result.from = from;
  result.to = to;
  result.prefix = option("");
  if (volume) {
    result.lifted = Payload{Lifted::volume, {*volume, volume_sd.value_or(std::nan(""))}};
  } else if (mass) {
    result.lifted = Payload{Lifted::mass, {*mass, mass_sd.value_or(std::nan(""))}};
  } else {
    ScanReport unread;
    result.lifted = placed_pair(*dump_before, *dump_after, frames, unread);
  }
  return result;
}

void RunInputs::check() const {
  const auto go_together = [&](bool broken, const std::string& name, const std::string& other) {
    if (broken) {
      usage_error(option(name) + " needs " + option(other) + ", which is missing");
    }
  };
  go_together(volume_sd && !volume, "volume-sd", "volume");
  go_together(mass_sd && !mass, "mass-sd", "mass");
  go_together(dump_before && !dump_after, "dump-before", "dump-after");
  go_together(dump_after && !dump_before, "dump-after", "dump-before");
  const int ways = int{volume.has_value()} + int{mass.has_value()} + int{dump_before.has_value()};
  if (ways != 1) {
    usage_error("payload of " + *log + ": give exactly one of " + option("volume") + ", " +
                option("mass") + ", or " + option("dump-before") + " with " + option("dump-after"));
  }
}

}  // namespace excavplan::tools
