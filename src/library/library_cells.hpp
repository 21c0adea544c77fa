// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <excavplan/library/library_build.hpp>
#include <excavplan/library/path_library.hpp>

#include "base/json.hpp"
#include "base/text.hpp"

/// @file
/// The cells a library is made of: what decides one, how it is computed, how it is kept in a file.

namespace excavplan {

/// One density on one slope for one machine in one soil.
struct LibraryCell {
  const Machine* machine = nullptr;
  const SoilKind* soil = nullptr;
  double slope = 0.0;
  double density_percent = 0.0;
};

/// What a cell came to.
struct CellOutcome {
  std::optional<PathLibraryEntry> entry;  ///< nothing: no dig is feasible
  int evaluations = 0;
};

/// The densities whose digs the search of this one starts from, nearest first; none: it is searched
/// from nothing. They depend on the density alone, so that a cell is the same in every library:
/// those that divide by ten form chains from 0, 50 and 100 % outwards, each other starts from the
/// two of them around it.
std::vector<double> parent_densities(double density_percent, const LibrarySearch& search);

/// Everything that decides the outcome of a cell, in words.
std::string identity(const LibraryCell& cell, const LibrarySearch& search);

/// A name as every file system takes it.
std::string file_name_part(const std::string& name);

/// Name of a cell's file: readable, and different for cells of different identity.
std::string cell_file_name(const LibraryCell& cell, const LibrarySearch& search);

/// How the digs are searched, in words.
std::string describe(const LibrarySearch& search);

/// @param parents  outcomes of the cell's parent_densities()
/// @param progress  its evaluations are those of all searches for the cell together
/// @return nothing if `progress` stopped it
/// @throws Error (bad_input) if the search is out of range
std::optional<CellOutcome> compute_cell(const LibraryCell& cell, const LibrarySearch& search,
                                        const std::vector<CellOutcome>& parents,
                                        const std::function<bool(const SearchProgress&)>& progress);

/// The cell searched once more, from the digs of neighbours alone, nearest first.
///
/// @return nothing if `progress` stopped it
std::optional<CellOutcome> look_again(const LibraryCell& cell, const LibrarySearch& search,
                                      const std::vector<CellOutcome>& neighbours,
                                      const std::function<bool(const SearchProgress&)>& progress);

/// The text of a cell's file.
std::string cell_text(const LibraryCell& cell, const LibrarySearch& search,
                      const CellOutcome& outcome);
/// @param name  of the file, for messages
/// @throws Error (bad_file) if the text is damaged or of another cell
CellOutcome read_cell(const std::string& name, const std::string& text, const LibraryCell& cell,
                      const LibrarySearch& search);

nlohmann::ordered_json library_entry_json(const PathLibraryEntry& entry);
PathLibraryEntry read_library_entry(JsonObject object);

}  // namespace excavplan
