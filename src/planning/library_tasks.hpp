// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <excavplan/planning/library_search.hpp>

/// @file
/// The tasks that libraries are built by: what they ask, how they are done, what they answer.
/// Private to the library.

namespace excavplan {

/// All that decides the answer to a task besides the task.
struct LibraryJob {
  LibraryGrid grid;
  LibrarySearch search;
};

/// Where an entry stands.
struct LibraryPlace {
  std::size_t machine = 0;  ///< in the grid
  std::size_t soil = 0;     ///< in the grid
  double slope = 0.0;       ///< [rad]
  double density_percent = 0.0;
};

struct LibraryTask {
  LibraryPlace place;
  /// To be dug as they are, at their start or, where it cannot be driven, at that of a search. If
  /// any are given nothing is searched.
  std::vector<PlannedDig> digs = {};
  std::vector<DigParameters> starts = {};  ///< to be polished; none: searched from nothing
  double expected = 0.0;  ///< what ranks lower is followed by a search from nothing
  /// Rank of the dig there is; 0: none. Else the start is polished if it comes near
  /// that, and nothing else is tried.
  double known = 0.0;
};

struct LibraryAnswer {
  bool feasible = false;
  PlannedDig dig = {};  ///< if feasible
  double rank = 0.0;    ///< of the dig; 0 if not feasible
  int evaluations = 0;
  std::vector<double> measured = {};  ///< worths of LibraryTask::digs, 0: cannot be dug
};

std::string to_text(const LibraryTask& task);

/// Does a task. @return the answer; empty if stopped
std::string do_task(const LibraryJob& job, const std::string& text,
                    const std::function<bool(int digs, double best)>& progress);

/// @param name  of the text, for messages
/// @throws Error (bad_file) if the text is damaged or the answer for another place or search
LibraryAnswer read_answer(const LibraryJob& job, const LibraryPlace& place, const std::string& name,
                          const std::string& text);

/// The densities whose digs the search for this one starts from, nearest first; none: it is
/// searched from nothing. Those that divide by ten form chains from 0, 50 and 100 % outwards, each
/// other starts from the two of them around it.
std::vector<double> parent_densities(double density_percent, const LibrarySearch& search);

/// The search for a place.
/// @param parents  by density, in the order of parent_densities(); those without a dig left out
LibraryTask first_search(const LibraryJob& job, const LibraryPlace& place,
                         const std::vector<std::pair<double, PlannedDig>>& parents);

/// How the digs are searched, for people.
std::string describe(const LibrarySearch& search);

inline constexpr const char* entry_file_end = ".entry.json";

/// Name of the file of an entry: readable, and different for all that decides what is found.
std::string entry_file_name(const LibraryJob& job, const LibraryPlace& place);

}  // namespace excavplan
