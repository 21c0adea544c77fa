// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report_job.hpp"

#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "base/text.hpp"
#include "drawing/drawing.hpp"
#include "ground/grid_cells.hpp"
#include "ground/window.hpp"
#include "report/report_parts.hpp"
#include "site/cell_codes.hpp"

namespace excavplan {
namespace {

using Eigen::ArrayXXd;
using Eigen::ArrayXXi;
using Eigen::Index;
using Json = nlohmann::ordered_json;

// ---- The part of the ground that is drawn -----------------------------------------------------

// Ours [m].
constexpr double margin = 1.5;  // around all that is or happened
constexpr double room = 1.5;    // of a machine beside that

Eigen::AlignedBox2d place_of(const JobHistory& history) {
  Eigen::AlignedBox2d box;
  const HeightMap& grid = history.before;
  for_each_cell(history.target.z, [&](Cell at) {
    if (!std::isnan(history.target.z(at.row, at.col)))
      box.extend(Eigen::Vector2d(grid.x(at.col), grid.y(at.row)));
  });
  const auto add = [&](const SitePolygon& polygon) {
    for (const Eigen::Vector2d& corner : polygon) box.extend(corner);
  };
  for (const DumpArea& area : history.design.dump_areas) add(area.polygon);
  for (const JobObstacle& obstacle : history.design.obstacles) add(obstacle.polygon);
  if (history.design.truck) add(history.design.truck->bed);
  const auto add_machine = [&](const BasePose& base) {
    box.extend(Eigen::Vector2d(base.x - room, base.y - room));
    box.extend(Eigen::Vector2d(base.x + room, base.y + room));
  };
  if (history.design.start) add_machine(*history.design.start);
  for (const JobEvent& event : history.events) add_machine(event.base);
  const Rectangle all = grid.extent();
  if (box.isEmpty()) {
    return {Eigen::Vector2d(all.x_min, all.y_min), Eigen::Vector2d(all.x_max, all.y_max)};
  }
  return {box.min().array() - margin, box.max().array() + margin};
}

/// Those where something is or happened.
ReportedCells reported_cells(const JobHistory& history) {
  const HeightMap& grid = history.before;
  const Eigen::AlignedBox2d box = place_of(history);
  const auto within = [&](double place, double origin, Index most) {
    return std::clamp(static_cast<Index>(std::floor((place - origin) / grid.cell_size)), Index{0},
                      most - 1);
  };
  ReportedCells drawn;
  drawn.col = within(box.min().x(), grid.origin.x(), grid.z.cols());
  drawn.row = within(box.min().y(), grid.origin.y(), grid.z.rows());
  drawn.cols = within(box.max().x(), grid.origin.x(), grid.z.cols()) + 1 - drawn.col;
  drawn.rows = within(box.max().y(), grid.origin.y(), grid.z.rows()) + 1 - drawn.row;
  drawn.by = coarsening(drawn.rows, drawn.cols);
  return drawn;
}

HeightMap drawn_of(const ReportedCells& drawn, const HeightMap& map) {
  HeightMap part = map;
  part.origin += map.cell_size *
                 Eigen::Vector2d(static_cast<double>(drawn.col), static_cast<double>(drawn.row));
  part.z = map.z.block(drawn.row, drawn.col, drawn.rows, drawn.cols);
  return coarser(part, drawn.by);
}

ArrayXXd drawn_of(const ReportedCells& drawn, const ArrayXXd& layer) {
  return middle_cells(ArrayXXd(layer.block(drawn.row, drawn.col, drawn.rows, drawn.cols)),
                      drawn.by);
}

// ---- Layers -----------------------------------------------------------------------------------

std::string first_codes(const ArrayXXd& z) { return codes_of(steps_of(millimetres_of(z))); }

/// The smallest block of numbers that holds all that are not 0, as steps or as they are; null of
/// none.
Json block_json(const ArrayXXi& numbers, bool as_steps) {
  Eigen::AlignedBox<Index, 2> box;
  for_each_cell(numbers, [&](Cell at) {
    if (numbers(at.row, at.col) != 0) box.extend(Eigen::Matrix<Index, 2, 1>(at.row, at.col));
  });
  if (box.isEmpty()) return nullptr;
  const Index row = box.min().x(), col = box.min().y();
  const Index rows = box.max().x() - row + 1, cols = box.max().y() - col + 1;
  const ArrayXXi block = numbers.block(row, col, rows, cols);
  return {{"row", row},
          {"col", col},
          {"rows", rows},
          {"cols", cols},
          {"codes", codes_of(as_steps ? steps_of(block) : block)}};
}

/// 1: seen in a step that ended now; -1: not known any more when.
ArrayXXi news(const ArrayXXd& before, const ArrayXXd& after) {
  ArrayXXi numbers = ArrayXXi::Zero(after.rows(), after.cols());
  for_each_cell(after, [&](Cell at) {
    const double was = before(at.row, at.col), is = after(at.row, at.col);
    if (was == is || (std::isnan(was) && std::isnan(is))) return;
    numbers(at.row, at.col) = std::isnan(is) ? -1 : 1;
  });
  return numbers;
}

// ---- Steps ------------------------------------------------------------------------------------

Json base_json(const BasePose& base) {
  return {number(base.x), number(base.y), number(base.z), number(base.heading)};
}

Json polygon_json(const SitePolygon& polygon) {
  Json corners = Json::array();
  for (const Eigen::Vector2d& corner : polygon) {
    corners.push_back({number(corner.x()), number(corner.y())});
  }
  return corners;
}

Json event_json(const JobEvent& event) {
  Json json = {
      {"what", name(event.what)},      {"step", event.step},
      {"time_s", event.time},          {"energy_j", event.energy ? Json(*event.energy) : Json()},
      {"base", base_json(event.base)}, {"scanned", event.scanned},
      {"left_m3", event.left_volume}};
  if (!event.digs()) return json;
  json["stall"] = event.stalled;
  json["payload_kg"] = event.payload_mass ? Json(*event.payload_mass) : Json();
  if (!event.keeps_load) {
    json["dump"] = {number(event.dump.x()), number(event.dump.y()), number(event.dump.z())};
  }
  if (event.predicted.payload_mass > 0.0) {
    json["foretold_kg"] = event.predicted.payload_mass;
    json["foretold_interval_kg"] = event.predicted.payload_interval;
  }
  return json;
}

Json events_json(const JobHistory& history) {
  Json events = Json::array();
  StepCoder coder(history);
  history.play([&](std::size_t done, const JobHistory::Ground& ground) {
    if (done > 0) events.push_back(coder.next(history.events[done - 1], ground));
  });
  return events;
}

Json design_json(const JobDesign& design) {
  Json json = {{"tolerance_m", design.tolerance},
               {"start", base_json(design.start.value_or(BasePose{}))},
               {"dump_areas", Json::array()},
               {"keep_out", Json::array()},
               {"obstacles", Json::array()}};
  for (const DumpArea& area : design.dump_areas) {
    json["dump_areas"].push_back({{"kind", area.kind == DumpArea::Kind::heap ? "heap" : "windrow"},
                                  {"polygon", polygon_json(area.polygon)}});
  }
  for (const KeepOut& area : design.keep_out) {
    json["keep_out"].push_back({{"kind", area.kind}, {"polygon", polygon_json(area.polygon)}});
    if (area.depth) json["keep_out"].back()["depth_m"] = number(*area.depth);
  }
  for (const JobObstacle& each : design.obstacles) {
    json["obstacles"].push_back({{"kind", each.kind},
                                 {"polygon", polygon_json(each.polygon)},
                                 {"height_m", number(each.height)}});
  }
  if (design.truck) {
    json["truck"] = {{"polygon", polygon_json(design.truck->bed)},
                     {"height_m", number(design.truck->bed_height)}};
  }
  return json;
}

// ---- Table ------------------------------------------------------------------------------------

std::string cell(const std::string& text, const char* kind = "") {
  return std::string("<td") + (*kind != '\0' ? " class=\"" + std::string(kind) + '"' : "") + ">" +
         xml_escaped(safe_text(text, longest_text)) + "</td>";
}

std::string base_text(const BasePose& base) {
  constexpr double per_radian = 57.29577951308232;
  return decimals(base.x, 2) + ", " + decimals(base.y, 2) + ", " +
         decimals(base.heading * per_radian, 0) + "°";
}

std::string payload_text(const JobEvent& event) {
  if (!event.digs()) return "";
  const ForetoldStep& foretold = event.predicted;
  std::string text = event.payload_mass ? decimals(*event.payload_mass, 0) : "–";
  if (!(foretold.payload_mass > 0.0)) return text;
  return text + " (" + decimals(foretold.payload_mass, 0) + ": " +
         decimals(foretold.payload_interval[0], 0) + " .. " +
         decimals(foretold.payload_interval[1], 0) + ")";
}

std::string doubts_text(const JobEvent& event) {
  std::string text = event.stalled ? "stalled" : "";
  for (const Warning& each : event.warnings) {
    text += (text.empty() ? "" : "; ") + code_text(each.code) + ": " + each.message;
  }
  if (!event.reason.empty()) text += (text.empty() ? "" : "; ") + event.reason;
  return text;
}

std::string what_text(const JobEvent& event) {
  std::string text = name(event.what);
  if (event.truck) text += ", truck " + std::to_string(*event.truck);
  if (event.scanned && event.what != JobAction::scan) text += " and scan";
  return text;
}

}  // namespace

nlohmann::ordered_json to_json(const ReportJob& job) {
  const JobHistory& history = job.history;
  const ReportedCells drawn = reported_cells(history);
  const HeightMap before = drawn_of(drawn, history.before);
  const JobDesign& design = history.design;
  Json json = {
      {"origin_m", {number(before.origin.x()), number(before.origin.y())}},
      {"cell_m", number(before.cell_size)},
      {"rows", before.z.rows()},
      {"cols", before.z.cols()},
      {"before", first_codes(before.z)},
      {"target", first_codes(drawn_of(drawn, history.target).z)},
      {"seen", codes_of(steps_of(drawn_of(drawn, history.seen_at).isFinite().cast<int>()))},
      {"design_m3", history.design_volume},
      {"design", design_json(design)}};
  if (design.words) json["heading_rad"] = number(design.words->heading);
  json["machine"] = machine_json(job.machine);
  json["events"] = events_json(history);
  return json;
}

StepCoder::StepCoder(const JobHistory& history)
    : drawn_(reported_cells(history)),
      heights_(millimetres_of(drawn_of(drawn_, history.before).z)),
      seen_(drawn_of(drawn_, history.seen_at)) {}

bool StepCoder::fits(const JobHistory& history) const { return drawn_ == reported_cells(history); }

nlohmann::ordered_json StepCoder::next(const JobEvent& event, const JobHistory::Ground& after) {
  const ArrayXXi heights = millimetres_of(drawn_of(drawn_, after.surface).z);
  const ArrayXXd seen = drawn_of(drawn_, after.seen_at);
  Json json = event_json(event);
  json["ground"] = block_json(heights - heights_, false);
  json["seen"] = block_json(news(seen_, seen), true);
  heights_ = heights;
  seen_ = seen;
  return json;
}

std::string step_row(const JobEvent& event, std::size_t number) {
  const std::string text = std::to_string(number);
  return "<tr data-step=\"" + text + "\"><th scope=\"row\">" + text + "</th>" +
         cell(what_text(event)) + cell(base_text(event.base), "number") +
         cell(payload_text(event), "number") +
         cell(event.energy ? decimals(*event.energy / 1000.0, 1) : "", "number") +
         cell(decimals(event.time, 1), "number") + cell(decimals(event.left_volume, 3), "number") +
         cell(event.trustworthy ? "yes" : "no") + cell(doubts_text(event)) + "</tr>\n";
}

std::string step_rows(const JobHistory& history) {
  std::string rows;
  for (const JobEvent& event : history.events) {
    rows += step_row(event, 1 + static_cast<std::size_t>(&event - history.events.data()));
  }
  return rows;
}

}  // namespace excavplan
