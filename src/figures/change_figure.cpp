// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "figures/change_figure.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <excavplan/change/bulking.hpp>

#include "base/statistics.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

struct ZoneStyle {
  const char* name;
  Style outline;
};

ZoneStyle style_of(ZoneKind kind) {
  switch (kind) {
    case ZoneKind::dig:
      return {"hole", {colours::black, 1.1}};
    case ZoneKind::spill:
      return {"spill", {colours::green, 1.1, "none", 1.0, {2.0, 1.0}}};
    case ZoneKind::dump:
      return {"heap", {colours::orange, 1.1}};
    case ZoneKind::other:
      break;
  }
  return {"left out", {colours::purple, 1.1, "none", 1.0, {1.0, 1.0}}};
}

/// A multiple of a step.
std::string rounded(double value, double step) {
  const auto per_unit = std::round(1.0 / step);
  return number_text(std::round(value * per_unit) / per_unit + 0.0);  // no minus zero
}

std::string volume_text(const Measured& volume) {
  const double sd = std::isfinite(volume.sd) ? volume.sd : 0.0;
  return readable(std::abs(volume.value), sd) + " m³";
}

// ---- The map ----------------------------------------------------------------------------------

/// Whether a cell is on the map and in a zone.
bool in_zone(const AreaChange& area, int zone, Eigen::Index row, Eigen::Index col) {
  return row >= 0 && row < area.zone.rows() && col >= 0 && col < area.zone.cols() &&
         area.zone(row, col) == zone;
}

/// A cell, or a corner between cells: its row and column.
using Place = std::pair<Eigen::Index, Eigen::Index>;

/// Borders between the cells of one zone and all others, from corner to corner with the zone on the
/// left.
std::multimap<Place, Place> borders(const AreaChange& area, int zone) {
  std::multimap<Place, Place> found;
  for (Eigen::Index row = 0; row < area.zone.rows(); ++row) {
    for (Eigen::Index col = 0; col < area.zone.cols(); ++col) {
      if (!in_zone(area, zone, row, col)) continue;
      const Place a(row, col), b(row, col + 1), c(row + 1, col + 1), d(row + 1, col);
      if (!in_zone(area, zone, row - 1, col)) found.emplace(a, b);
      if (!in_zone(area, zone, row, col + 1)) found.emplace(b, c);
      if (!in_zone(area, zone, row + 1, col)) found.emplace(c, d);
      if (!in_zone(area, zone, row, col - 1)) found.emplace(d, a);
    }
  }
  return found;
}

/// The borders of a zone as closed lines, so that dashes run along them.
std::vector<Points> outlines(const AreaChange& area, int zone) {
  const HeightMap& map = area.difference;
  const auto point = [&](const Place& corner) -> Eigen::Vector2d {
    return map.origin + map.cell_size * Eigen::Vector2d(static_cast<double>(corner.second),
                                                        static_cast<double>(corner.first));
  };
  std::multimap<Place, Place> left = borders(area, zone);
  std::vector<Points> lines;
  while (!left.empty()) {
    auto border = left.begin();
    Points line = {point(border->first)};
    while (border != left.end()) {
      const Place end = border->second;
      line.push_back(point(end));
      left.erase(border);
      border = left.find(end);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

/// The middle of a zone: its mean weighted by the change, or the cell of it that is nearest to
/// that.
Eigen::Vector2d middle_of(const AreaChange& area, int zone) {
  const HeightMap& map = area.difference;
  Eigen::Vector3d sum(0.0, 0.0, 1e-12);
  std::vector<Eigen::Vector2d> cells;
  for (Eigen::Index col = 0; col < area.zone.cols(); ++col) {
    for (Eigen::Index row = 0; row < area.zone.rows(); ++row) {
      if (area.zone(row, col) != zone) continue;
      const double z = map.z(row, col);
      cells.emplace_back(map.x(col), map.y(row));
      if (std::isfinite(z)) {
        sum += std::abs(z) * Eigen::Vector3d(cells.back().x(), cells.back().y(), 1.0);
      }
    }
  }
  const Eigen::Vector2d mean = sum.head<2>() / sum.z();
  return *std::min_element(cells.begin(), cells.end(), [&](const auto& a, const auto& b) {
    return (a - mean).squaredNorm() < (b - mean).squaredNorm();
  });
}

bool is_largest_of_its_kind(const ChangeZone& zone, const VolumeChange& change) {
  return std::none_of(change.zones.begin(), change.zones.end(), [&](const ChangeZone& other) {
    return other.kind == zone.kind && std::abs(other.volume.value) > std::abs(zone.volume.value);
  });
}

/// How an area lies on the page: as x and y, or, if it is longer in y, turned to the left with x
/// upwards.
struct Turn {
  bool is_turned = false;

  Eigen::Vector2d operator()(const Eigen::Vector2d& at) const {
    return is_turned ? Eigen::Vector2d(-at.y(), at.x()) : at;
  }
  Points operator()(Points points) const {
    for (Eigen::Vector2d& point : points) point = (*this)(point);
    return points;
  }
  Rectangle operator()(const Rectangle& r) const {
    return is_turned ? Rectangle{-r.y_max, r.x_min, -r.y_min, r.x_max} : r;
  }
  Grid operator()(const HeightMap& map) const {
    const Eigen::Vector2d cell = Eigen::Vector2d::Constant(map.cell_size);
    if (!is_turned) return {map.origin, cell, map.z};
    const Rectangle all = (*this)(map.extent());
    return {{all.x_min, all.y_min}, cell, map.z.transpose().rowwise().reverse()};
  }
  Panel panel(const std::string& title) const {
    Panel panel(title, is_turned ? "y [m]" : "x [m]", is_turned ? "x [m]" : "y [m]");
    if (is_turned) panel.mirror_x();
    panel.equal_aspect();
    return panel;
  }
};

/// The cell that is deepest inside a zone; of several the one nearest to its middle.
Eigen::Vector2d inside_of(const AreaChange& area, int zone) {
  std::vector<Place> cells;
  for (Eigen::Index row = 0; row < area.zone.rows(); ++row) {
    for (Eigen::Index col = 0; col < area.zone.cols(); ++col) {
      if (area.zone(row, col) == zone) cells.emplace_back(row, col);
    }
  }
  for (std::set<Place> layer(cells.begin(), cells.end());;) {  // peeled until nothing is left
    std::set<Place> inner;
    for (const auto& [row, col] : layer) {
      const bool is_inner = layer.count({row - 1, col}) && layer.count({row + 1, col}) &&
                            layer.count({row, col - 1}) && layer.count({row, col + 1});
      if (is_inner) inner.emplace(row, col);
    }
    if (inner.empty()) break;
    cells.assign(inner.begin(), inner.end());
    layer = std::move(inner);
  }
  const Eigen::Vector2d middle = middle_of(area, zone);
  const auto distance = [&](const Place& cell) {
    return (Eigen::Vector2d(area.difference.x(cell.second), area.difference.y(cell.first)) - middle)
        .norm();
  };
  const auto [row, col] =
      *std::min_element(cells.begin(), cells.end(),
                        [&](const Place& a, const Place& b) { return distance(a) < distance(b); });
  return {area.difference.x(col), area.difference.y(row)};
}

/// Names a zone with its volume; the largest of several spills with that of all spill.
void label_zone(Panel& panel, const VolumeChange& change, const AreaChange& area, int index,
                const Turn& turn) {
  const ChangeZone& zone = change.zones[static_cast<std::size_t>(index)];
  if (zone.kind == ZoneKind::spill && !is_largest_of_its_kind(zone, change)) return;
  const Measured& volume = zone.kind == ZoneKind::spill ? change.spilled : zone.volume;
  panel.label(turn(inside_of(area, index)),
              std::string(style_of(zone.kind).name) + ' ' + volume_text(volume));
}

Rectangle joined(const Rectangle& a, const Rectangle& b) {
  return {std::min(a.x_min, b.x_min), std::min(a.y_min, b.y_min), std::max(a.x_max, b.x_max),
          std::max(a.y_max, b.y_max)};
}

Rectangle grown(const Rectangle& r, double by) {
  return {r.x_min - by, r.y_min - by, r.x_max + by, r.y_max + by};
}

/// The part of an area that its zones take up, with room around it. What was left out is in view
/// if it lies near what was counted; everything is where nothing was counted.
Rectangle view_of(const VolumeChange& change, const AreaChange& area) {
  std::optional<Rectangle> view;
  const auto in_area = [&](std::size_t i) { return (area.zone == static_cast<int>(i)).any(); };
  for (std::size_t i = 0; i < change.zones.size(); ++i) {
    const ChangeZone& zone = change.zones[i];
    if (zone.kind == ZoneKind::other || !in_area(i)) continue;
    view = view ? joined(*view, zone.extent) : zone.extent;
  }
  const Rectangle all = area.difference.extent();
  if (!view) return all;
  const double size = std::max(view->x_max - view->x_min, view->y_max - view->y_min);
  const Rectangle near = grown(*view, 0.25 * size);
  for (std::size_t i = 0; i < change.zones.size(); ++i) {
    const Rectangle& r = change.zones[i].extent;
    const Eigen::Vector2d middle((r.x_min + r.x_max) / 2.0, (r.y_min + r.y_max) / 2.0);
    if (in_area(i) && near.contains(middle.x(), middle.y())) view = joined(*view, r);
  }
  const Rectangle room = grown(*view, std::max(0.15, 0.08 * size));
  return {std::max(room.x_min, all.x_min), std::max(room.y_min, all.y_min),
          std::min(room.x_max, all.x_max), std::min(room.y_max, all.y_max)};
}

/// From the noise of a cell, at least 1 cm, up to the largest change inside the zones;
/// without zones up to the 99th percentile of all cells.
std::vector<double> bands_of(const VolumeChange& change) {
  double largest = 0.0;
  double noise = 0.0;
  std::vector<double> all;
  for (const AreaChange& area : change.areas) {
    noise = std::max(noise, area.noise_sd);
    for (Eigen::Index i = 0; i < area.difference.z.size(); ++i) {
      const double value = std::abs(area.difference.z(i));
      if (!std::isfinite(value)) continue;
      all.push_back(value);
      if (area.zone(i) >= 0) largest = std::max(largest, value);
    }
  }
  if (largest == 0.0) largest = quantile(std::move(all), 0.99);
  return colour_bands(std::max(0.01, noise), largest);
}

// ---- Sections ---------------------------------------------------------------------------------

/// A row or a column of cells through a zone.
struct Section {
  bool along_x = true;
  Eigen::Index line = 0;             ///< the row or column
  Eigen::Index first = 0, last = 0;  ///< its cells, last included
  std::string name;                  ///< "hole"
};

/// Through the middle of a zone along its longer side, with a quarter of it on both sides.
Section section_of(const AreaChange& area, const ChangeZone& zone, int index) {
  const HeightMap& map = area.difference;
  const Eigen::Vector2d cell = (middle_of(area, index) - map.origin) / map.cell_size;
  const Rectangle& r = zone.extent;
  const bool along_x = r.x_max - r.x_min >= r.y_max - r.y_min;
  const double low = (along_x ? r.x_min - map.origin.x() : r.y_min - map.origin.y());
  const double high = (along_x ? r.x_max - map.origin.x() : r.y_max - map.origin.y());
  const double room = std::max(0.3, 0.25 * (high - low));
  const Eigen::Index cells = along_x ? map.z.cols() : map.z.rows();
  const auto at = [&](double place) {
    const auto i = static_cast<Eigen::Index>(std::floor(place / map.cell_size));
    return std::clamp<Eigen::Index>(i, 0, cells - 1);
  };
  return {along_x, static_cast<Eigen::Index>(along_x ? cell.y() : cell.x()), at(low - room),
          at(high + room), style_of(zone.kind).name};
}

/// Ground before and after along a section: points (place, before), (place, after).
struct Profiles {
  Points before;
  Points after;
};

Profiles profiles_of(const Section& section, const HeightMap& before, const HeightMap& difference) {
  Profiles profiles;
  for (Eigen::Index i = section.first; i <= section.last; ++i) {
    const Eigen::Index row = section.along_x ? section.line : i;
    const Eigen::Index col = section.along_x ? i : section.line;
    const double place = section.along_x ? before.x(i) : before.y(i);
    profiles.before.emplace_back(place, before.z(row, col));
    profiles.after.emplace_back(place, before.z(row, col) + difference.z(row, col));
  }
  return profiles;
}

/// Soil between two profiles within a factor of the band's half-width, one polygon for each stretch
/// that was seen.
void draw_band(Panel& panel, const Points& line, double half_width) {
  Points above;
  Points below;
  const auto close = [&] {
    above.insert(above.end(), below.rbegin(), below.rend());
    if (above.size() > 2) {
      panel.polygon(above, {"none", 0.0, colours::vermilion, 0.3}, "95 % band of a cell");
    }
    above.clear();
    below.clear();
  };
  for (const Eigen::Vector2d& point : line) {
    if (!point.allFinite()) {
      close();
      continue;
    }
    above.emplace_back(point.x(), point.y() + half_width);
    below.emplace_back(point.x(), point.y() - half_width);
  }
  close();
}

Panel section_panel(const Section& section, const HeightMap& before, const AreaChange& area) {
  const Profiles profiles = profiles_of(section, before, area.difference);
  const double line = section.along_x ? before.y(section.line) : before.x(section.line);
  const std::string title = section.name + ", section at " + (section.along_x ? "y = " : "x = ") +
                            rounded(line, 0.01) + " m";
  Panel panel(title, section.along_x ? "x [m]" : "y [m]", "z [m]");
  panel.shape(0.42);
  panel.state_exaggeration();
  draw_band(panel, profiles.after, 1.96 * area.noise_sd);
  panel.line(profiles.before, {colours::grey, 1.0, "none", 1.0, {3.0, 1.5}}, "ground before");
  panel.line(profiles.after, {colours::vermilion, 1.2}, "ground after");
  return panel;
}

/// Where a section lies on the map.
void draw_place(Panel& map, const Section& section, const HeightMap& on, const Turn& turn) {
  const auto end = [&](Eigen::Index i) -> Eigen::Vector2d {
    return section.along_x ? Eigen::Vector2d(on.x(i), on.y(section.line))
                           : Eigen::Vector2d(on.x(section.line), on.y(i));
  };
  map.strokes(turn(Points{end(section.first), end(section.last)}),
              {"#222222", 0.8, "none", 1.0, {1.0, 2.0}}, "section");
}

// ---- The table --------------------------------------------------------------------------------

std::string signed_volume(const Measured& volume) {
  return (volume.value < 0.0 ? "−" : "+") + volume_text(volume);
}

void add_open_changes(const VolumeChange& change, std::vector<std::string>& notes) {
  for (const bool counted : {true, false}) {
    std::vector<std::string> lines;
    for (const AttributedChange& open : change.attribution) {
      if (open.counted != counted) continue;
      lines.push_back(signed_volume(open.volume) + "  " + open.what +
                      " (of this dig: " + rounded(100.0 * open.probability, 1.0) + " %)");
    }
    if (lines.empty()) continue;
    notes.insert(notes.end(), {"", counted ? "counted, might not be ours" : "left out, open"});
    notes.insert(notes.end(), lines.begin(), lines.end());
  }
}

/// Zones of the kind `other` as a list, the largest first.
void add_left_out(const VolumeChange& change, std::vector<std::string>& notes) {
  std::vector<const ChangeZone*> zones;
  for (const ChangeZone& zone : change.zones) {
    if (zone.kind == ZoneKind::other) zones.push_back(&zone);
  }
  if (zones.empty()) return;
  std::stable_sort(zones.begin(), zones.end(), [](const auto* a, const auto* b) {
    return std::abs(a->volume.value) > std::abs(b->volume.value);
  });
  notes.insert(notes.end(), {"", "left out of all volumes"});
  constexpr std::size_t most = 5;
  for (std::size_t i = 0; i < std::min(most, zones.size()); ++i) {
    const Rectangle& r = zones[i]->extent;
    notes.push_back(signed_volume(zones[i]->volume) + " around x " +
                    rounded((r.x_min + r.x_max) / 2.0, 0.1) + ", y " +
                    rounded((r.y_min + r.y_max) / 2.0, 0.1) + " m");
  }
  if (zones.size() > most) {
    notes.push_back("and " + std::to_string(zones.size() - most) + " smaller ones");
  }
}

/// Standard deviation of k by source, the largest first.
void add_errors(const VolumeChange& change, std::vector<std::string>& notes) {
  const BulkingErrors errors = bulking_errors(change);
  std::vector<std::pair<double, const char*>> sources = {{errors.noise, "noise of the cells"},
                                                         {errors.correlated, "correlated error"},
                                                         {errors.datum, "motion between the scans"},
                                                         {errors.holes, "unseen ground"},
                                                         {errors.faces, "steep faces"},
                                                         {errors.thin, "thin soil"},
                                                         {errors.attribution, "open changes"}};
  std::stable_sort(sources.begin(), sources.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (!(sources.front().first > 0.0)) return;
  notes.insert(notes.end(), {"", "standard deviation of the bulking factor"});
  for (const auto& [sd, source] : sources) {
    if (sd > 0.0) notes.push_back(readable(sd) + "  " + source);
  }
}

const char* title_of(std::size_t area, std::size_t areas) {
  if (areas == 1) return "seen from above";
  return area == 0 ? "dig area, seen from above" : "dump area, seen from above";
}

}  // namespace

std::vector<std::string> change_table(const ChangeSheet& sheet) {
  std::vector<std::string> notes = sheet.lines;
  for (const AreaChange& area : sheet.change.areas) {
    notes.push_back("noise of a cell " + readable(1000.0 * area.noise_sd) + " mm");
  }
  add_open_changes(sheet.change, notes);
  add_left_out(sheet.change, notes);
  if (!sheet.warnings.empty()) notes.insert(notes.end(), {"", "warnings"});
  for (const Warning& warning : sheet.warnings) {
    notes.push_back(code_text(warning.code) + ": " + warning.message);
  }
  add_errors(sheet.change, notes);
  return notes;
}

Figure height_change_figure(const ChangeSheet& sheet) {
  const VolumeChange& change = sheet.change;
  const ColourScale scale = {bands_of(change)};
  Figure figure;
  figure.title = "Height change of the ground";
  figure.note = "± is one standard deviation.";
  figure.colour_bar = ColourBar{scale, "height after − before [cm]", 0.01};
  std::vector<Panel> maps;
  std::vector<Panel> sections;
  for (std::size_t i = 0; i < change.areas.size(); ++i) {
    const AreaChange& area = change.areas[i];
    const Rectangle view = view_of(change, area);
    const Turn turn = {view.y_max - view.y_min > 1.1 * (view.x_max - view.x_min)};
    Panel map = turn.panel(title_of(i, change.areas.size()));
    map.map(turn(area.difference), scale);
    map.view(turn(view));
    for (std::size_t j = 0; j < change.zones.size(); ++j) {
      const ChangeZone& zone = change.zones[j];
      const int index = static_cast<int>(j);
      if (!(area.zone == index).any()) continue;
      const ZoneStyle style = style_of(zone.kind);
      for (const Points& line : outlines(area, index)) {
        map.line(turn(line), style.outline, style.name);
      }
      if (zone.kind != ZoneKind::other) label_zone(map, change, area, index, turn);
      const bool cut = zone.kind == ZoneKind::dig || zone.kind == ZoneKind::dump;
      if (!cut || i >= sheet.before.size() || !is_largest_of_its_kind(zone, change)) continue;
      const Section section = section_of(area, zone, index);
      draw_place(map, section, area.difference, turn);
      const bool hole = zone.kind == ZoneKind::dig;
      sections.insert(hole ? sections.begin() : sections.end(),
                      section_panel(section, sheet.before[i], area));
    }
    maps.push_back(map);
  }
  figure.rows = {maps};
  if (!sections.empty()) figure.rows.push_back(sections);
  return figure;
}

}  // namespace excavplan
