// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/optimisation/search_settings.hpp>

namespace excavplan {

const char* name(StopReason reason) {
  switch (reason) {
    case StopReason::generations:
      return "generations";
    case StopReason::evaluations:
      return "evaluations";
    case StopReason::stall:
      return "stall";
    case StopReason::seconds:
      return "seconds";
    case StopReason::target:
      return "target";
    case StopReason::cancelled:
      return "cancelled";
  }
  return "";
}

}  // namespace excavplan
