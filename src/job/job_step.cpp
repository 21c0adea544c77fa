// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/job/job_step.hpp>

namespace excavplan {

const char* name(JobAction action) {
  switch (action) {
    case JobAction::dig:
      return "dig";
    case JobAction::finish:
      return "finish";
    case JobAction::move:
      return "move";
    case JobAction::scan:
      return "scan";
    case JobAction::wait:
      return "wait";
    case JobAction::stop:
      return "stop";
  }
  return "unknown action";
}

bool digs(JobAction action) { return action == JobAction::dig || action == JobAction::finish; }

}  // namespace excavplan
