// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <excavplan/ground/ground_state.hpp>
#include <excavplan/job/job_history.hpp>

#include "job/job_record.hpp"

/// @file
/// The history of a job and its file, job-log.jsonl. Private to the project.

namespace excavplan {

/// An event a line, written before the record of the job that it led to. So after a kill the log
/// may be ahead of the record, never behind it: what is ahead is cut off, and comes again.
class JobLog {
 public:
  /// @param start  of the job, without events
  JobLog(const std::string& folder, JobHistory start);

  /// Begins the file anew.
  void begin();
  /// Reads it, as far as the record goes. A job without a log begins one.
  /// @throws Error (bad_file) naming file, line, key, value and rule
  void resume(const JobRecord& record);
  /// Reads what another process wrote since, and changes nothing.
  /// @return false if what was read before does not hold any more: to be begun anew
  /// @throws Error (bad_file) as resume()
  bool follow(const JobRecord& record);
  /// @param record  after the event
  void append(JobEvent event, const JobHistory::Ground& after, const JobRecord& record);
  /// Takes back what is ahead of the record.
  void cut(const JobRecord& record);

  const JobHistory& history() const { return recorder_.history(); }

 private:
  /// How far a record had come, and where the log ended then.
  struct Mark {
    long long last_step = 0;
    int scans = 0;
    std::uint64_t end = 0;
    bool is_within(const JobRecord& record) const {
      return last_step <= record.last_step && scans <= record.progress.scans;
    }
  };
  struct LoggedEvent {
    JobEvent event;
    Mark mark;
  };
  LoggedEvent read_line(const std::string& name, const std::string& line, std::uint64_t end) const;
  void add(LoggedEvent logged);
  void read_begin(const std::string& name, const std::string& line);

  std::string path_;
  JobHistory start_;
  JobRecorder recorder_;
  std::uint64_t begun_ = 0;  ///< where the first event stands
  std::vector<Mark> marks_;  ///< of each event
  /// That follow() read last, by which it sees that nothing else was written there.
  struct {
    std::uint64_t from = 0;
    std::string text;
  } last_line_;
};

/// A history to begin with.
/// @param target  height of the design on the cells of the ground
JobHistory history_start(const JobDesign& design, const HeightMap& target, const GroundState& first,
                         double design_volume);

/// With the time that it took since an earlier one, where both times are told.
JobEvent timed(JobEvent event, const JobHistory& earlier);

}  // namespace excavplan
