// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <excavplan/maps/ground_maps.hpp>

#include "frame/arguments.hpp"

/// @file
/// The option --map of every tool that has ground to show. A tool has a list of its maps; the first
/// is the one that --map FILE writes.

namespace excavplan::tools {

struct Outcome;  // frame/tool.hpp

/// A map of a tool as the command line knows it.
struct MapName {
  std::string name;              ///< "change"
  std::string help;              ///< "height after less before"
  std::size_t layers = 1;        ///< 0: lines
  Arguments::Use possible = {};  ///< asked once all options are read; empty: always
};

/// before, after and change, and all of these layers.
std::vector<MapName> ground_map_names(std::size_t layers);

/// What the options say.
struct Maps {
  struct File {
    std::string map;  ///< its name
    std::string file;
  };
  std::vector<File> files;
};

void declare_maps(Arguments& arguments, Maps& maps, const std::vector<MapName>& names);

/// Writes what the options ask for; `contents` makes the maps if any is. Warns (map_not_written)
/// where a map is not there and its file is of an earlier run.
void write_maps(const Maps& maps, const std::function<std::vector<NamedMap>()>& contents,
                Outcome& outcome);

}  // namespace excavplan::tools
