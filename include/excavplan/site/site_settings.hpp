// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <excavplan/machine/machine.hpp>
#include <excavplan/soil/density_law.hpp>
#include <excavplan/soil/soil.hpp>

namespace excavplan {

/// Cells of a site; ours: 112 m square at 5 cm, in a file of 240 MB.
inline constexpr double most_site_cells = 5e6;

/// What holds for all digs of a site.
struct SiteSettings {
  SoilKind soil;    ///< of the bank
  Machine machine;  ///< that digs there
  DensityLaw law;   ///< by which bulking tells density
  /// Edge of the cells, which never changes [m]; unset: that of the site, or usual_cell().
  std::optional<double> cell_size;
  std::string frame = {};  ///< name of the site's frame; empty: not told
};

}  // namespace excavplan
