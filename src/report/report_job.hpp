// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <excavplan/job/job_history.hpp>
#include <excavplan/machine/machine.hpp>

/// @file
/// What a report shows of a whole job.

namespace excavplan {

/// A block of the cells of a site, of which one of each square of `by` is drawn.
struct ReportedCells {
  Eigen::Index row = 0, col = 0, rows = 0, cols = 0, by = 1;

  bool operator==(const ReportedCells& other) const {
    return row == other.row && col == other.col && rows == other.rows && cols == other.cols &&
           by == other.by;
  }
};

struct ReportJob {
  JobHistory history;
  Machine machine;
};

/// For data/report/app: the ground where something is or happened, in codes of millimetres
/// (src/site/cell_codes.hpp), and of each step what it changed of it. More than 250000 cells are
/// coarsened.
nlohmann::ordered_json to_json(const ReportJob& job);

/// Steps one by one as to_json() of the whole job has them.
class StepCoder {
 public:
  /// @param history  of which the cells are drawn that it takes
  explicit StepCoder(const JobHistory& history);

  /// Whether to_json() of a history draws the same cells.
  bool fits(const JobHistory& history) const;
  /// Of the next step.
  nlohmann::ordered_json next(const JobEvent& event, const JobHistory::Ground& after);

 private:
  ReportedCells drawn_;
  Eigen::ArrayXXi heights_;  ///< after the last step [mm]
  Eigen::ArrayXXd seen_;     ///< likewise [s]
};

/// A row of HTML. @param number  of the step, from 1
std::string step_row(const JobEvent& event, std::size_t number);
/// One for each step.
std::string step_rows(const JobHistory& history);

}  // namespace excavplan
