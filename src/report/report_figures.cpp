// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "report/report_figures.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "base/json.hpp"
#include "base/text.hpp"
#include "drawing/drawing.hpp"

namespace excavplan {
namespace {

using Json = nlohmann::ordered_json;

struct Unit {
  const char* suffix;  ///< of a key
  const char* shown;
};

/// The longest first.
constexpr std::array<Unit, 24> units = {{{"_kj_per_design_m3", "kJ/m³"},
                                         {"_kg_per_kj", "kg/kJ"},
                                         {"_kg_per_m3", "kg/m³"},
                                         {"_rad_per_s", "rad/s"},
                                         {"_m3_per_s", "m³/s"},
                                         {"_t_per_h", "t/h"},
                                         {"_percent", "%"},
                                         {"_kn_m", "kN m"},
                                         {"_n_m", "N m"},
                                         {"_min", "min"},
                                         {"_rad", "rad"},
                                         {"_deg", "°"},
                                         {"_m3", "m³"},
                                         {"_m2", "m²"},
                                         {"_mm", "mm"},
                                         {"_kg", "kg"},
                                         {"_kj", "kJ"},
                                         {"_kn", "kN"},
                                         {"_kw", "kW"},
                                         {"_nm", "N m"},
                                         {"_w", "W"},
                                         {"_l", "L"},
                                         {"_s", "s"},
                                         {"_m", "m"}}};

const Unit* unit_of(const std::string& key) {
  const auto ends = [&](const std::string& suffix) {
    return key.size() > suffix.size() &&
           key.compare(key.size() - suffix.size(), suffix.size(), suffix) == 0;
  };
  const auto* unit =
      std::find_if(units.begin(), units.end(), [&](const Unit& each) { return ends(each.suffix); });
  return unit == units.end() ? nullptr : unit;
}

std::string suffix_of(const std::string& key) {
  const Unit* unit = unit_of(key);
  return unit == nullptr ? "" : unit->suffix;
}

std::string shown_unit(const std::string& key) {
  const Unit* unit = unit_of(key);
  return unit == nullptr ? "" : unit->shown;
}

std::string stem_of(const std::string& key) {
  return key.substr(0, key.size() - suffix_of(key).size());
}

/// What a page calls a figure whose key is short.
const std::map<std::string, std::string> plain_names = {
    {"rms", "rms error"},
    {"p95", "95 % of errors are below"},
    {"beyond_twice", "beyond twice the tolerance"},
    {"seen", "seen by scans"},
    {"left", "still to dig"},
    {"overdig", "dug too deep"},
    {"keep_out", "changed in keep-outs"}};

/// "payload_mass" -> "payload mass"
std::string words_of(std::string stem) {
  const auto plain = plain_names.find(stem);
  if (plain != plain_names.end()) return plain->second;
  std::replace(stem.begin(), stem.end(), '_', ' ');
  return stem;
}

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + '.' + key;
}

std::string capital(std::string text) {
  if (!text.empty()) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  }
  return text;
}

std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return value.dump();
  return readable(value.get<double>() + 0.0);  // no minus zero
}

/// A number with what is known about its error.
struct Entry {
  std::string key;  ///< the last part of its path
  const Json* value = nullptr;
  std::optional<double> sd = {};
  const Json* interval = nullptr;
};

std::string sd_key(const std::string& key) { return stem_of(key) + "_sd" + suffix_of(key); }

/// As results of digs and those of jobs call it.
std::array<std::string, 2> interval_keys(const std::string& key) {
  return {stem_of(key) + "_interval" + suffix_of(key), key + "_interval"};
}

Entry entry_of(const Json& object, const std::string& key) {
  Entry figure = {key, &object.at(key)};
  if (const auto sd = object.find(sd_key(key)); sd != object.end() && sd->is_number()) {
    figure.sd = sd->get<double>();
  }
  for (const std::string& name : interval_keys(key)) {
    if (const auto range = object.find(name); range != object.end() && range->is_array())
      figure.interval = &*range;
  }
  return figure;
}

std::string value_text(const Entry& figure) {
  if (!figure.value->is_number_float()) return text_of(*figure.value);
  const double value = figure.value->get<double>();
  return figure.sd ? readable(value, *figure.sd) : readable(value);
}

/// "35.4 .. 47.6"
std::string list_text(const Json& list, const std::string& between) {
  std::string text;
  for (const Json& each : list) text += (text.empty() ? "" : between) + text_of(each);
  return text;
}

std::string attribute(const std::string& name, const std::string& value) {
  return ' ' + name + "=\"" + xml_escaped(value) + '"';
}

/// The exact numbers, for whom the rounded ones do not do.
std::string exact(const std::string& path, const Entry& figure) {
  std::string text = attribute("data-key", path) + attribute("data-value", figure.value->dump());
  if (figure.sd) text += attribute("data-sd", Json(*figure.sd).dump());
  return text;
}

/// Angles in degrees too.
std::string unit_text(const Entry& figure) {
  std::string unit = shown_unit(figure.key);
  if (unit == "rad" && figure.value->is_number()) {
    constexpr double per_radian = 57.29577951308232;
    unit += " (" + readable(figure.value->get<double>() * per_radian) + "°)";
  }
  return unit;
}

std::string cell(const std::string& attributes, const std::string& text) {
  return "<td" + attributes + '>' + xml_escaped(text) + "</td>";
}

// ---- Tables -----------------------------------------------------------------------------------

bool is_flat(const Json& list) {
  return std::none_of(list.begin(), list.end(),
                      [](const Json& each) { return each.is_structured() || each.is_null(); });
}

/// Keys that are shown with another one.
std::set<std::string> companions(const Json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) {
    if (!value.is_number()) continue;
    const auto intervals = interval_keys(key);
    keys.insert({sd_key(key), intervals[0], intervals[1]});
  }
  return keys;
}

/// Rows of numbers and texts; objects in the object follow with their names before those of theirs.
class Rows {
 public:
  void add(const std::string& path, const std::string& before, const Json& object) {
    const std::set<std::string> shown_with = companions(object);
    const std::string unit_of_all = shown_unit(path);
    for (const auto& [key, value] : object.items()) {
      const std::string here = joined(path, key);
      const std::string label = before + words_of(stem_of(key));
      if (value.is_null() || shown_with.count(key) > 0) continue;
      if (value.is_object()) {
        add(here, label + ", ", value);
      } else if (!value.is_array()) {
        const Entry entry = entry_of(object, key);
        const std::string unit = unit_text(entry);
        add_row(here, label, entry, unit.empty() && value.is_number() ? unit_of_all : unit);
      } else if (!value.empty() && is_flat(value)) {
        rows_ += "<tr><th scope=\"row\">" + xml_escaped(capital(label)) + "</th>" +
                 cell(attribute("data-key", here) + attribute("data-value", value.dump()) +
                          attribute("class", "value list"),
                      list_text(value, "; ")) +
                 cell("", shown_unit(key)) + "<td></td></tr>\n";
      }
    }
  }

  const std::string& text() const { return rows_; }

 private:
  void add_row(const std::string& path, const std::string& label, const Entry& figure,
               const std::string& unit) {
    rows_ += "<tr><th scope=\"row\">" + xml_escaped(capital(label)) + "</th>" +
             cell(exact(path, figure) +
                      attribute("class", figure.value->is_string() ? "value list" : "value"),
                  value_text(figure)) +
             cell("", unit) + cell("", figure.interval ? list_text(*figure.interval, " .. ") : "") +
             "</tr>\n";
  }

  std::string rows_;
};

std::string table(const std::string& title, const std::string& head, const std::string& rows,
                  bool wide = false) {
  if (rows.empty()) return "";
  return std::string("<section class=\"figures") + (wide ? " wide" : "") + "\"><h3>" +
         xml_escaped(capital(title)) + "</h3>\n<div class=\"scroll\"><table>\n<thead><tr>" + head +
         "</tr></thead>\n<tbody>\n" + rows + "</tbody></table></div></section>\n";
}

std::string head_cell(const std::string& text) {
  return "<th scope=\"col\">" + xml_escaped(text) + "</th>";
}

std::string figure_table(const std::string& title, const std::string& path, const Json& object) {
  Rows rows;
  rows.add(path, "", object);
  const auto have = [&](const char* text) { return rows.text().find(text) != std::string::npos; };
  return table(title,
               head_cell("figure") + head_cell(have(" ± ") ? "value ± sd" : "value") +
                   head_cell("unit") + head_cell(have(" .. ") ? "95 % interval" : ""),
               rows.text());
}

/// Keys of a list of objects that can be columns.
std::vector<std::string> columns_of(const Json& list) {
  std::vector<std::string> columns;
  for (const Json& object : list) {
    const std::set<std::string> shown_with = companions(object);
    for (const auto& [key, value] : object.items()) {
      const bool fits = !value.is_null() && !value.is_object() &&
                        (!value.is_array() || (!value.empty() && is_flat(value)));
      if (!fits || shown_with.count(key) > 0) continue;
      if (std::find(columns.begin(), columns.end(), key) == columns.end()) columns.push_back(key);
    }
  }
  return columns;
}

/// "gain [%]"
std::string column_name(const std::string& key) {
  const std::string unit = shown_unit(key);
  return words_of(stem_of(key)) + (unit.empty() ? "" : " [" + unit + "]");
}

std::string list_cell(const std::string& path, const Json& object, const std::string& key) {
  const std::string label = attribute("data-label", column_name(key));
  const auto value = object.find(key);
  if (value == object.end() || value->is_null() || value->is_object()) return "<td></td>";
  if (value->is_array()) {
    return cell(label + attribute("data-key", path) + attribute("data-value", value->dump()),
                list_text(*value, "; "));
  }
  const Entry figure = entry_of(object, key);
  return cell(
      label + exact(path, figure) + attribute("class", value->is_number() ? "number" : "text"),
      value_text(figure));
}

/// A row for each object of a list. Objects in them get a table of their own.
std::string list_table(const std::string& name, const Json& list) {
  const std::vector<std::string> columns = columns_of(list);
  std::string head;
  for (const std::string& key : columns) head += head_cell(column_name(key));
  std::string rows;
  std::string below;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string path = joined(name, std::to_string(i));
    rows += "<tr>";
    for (const std::string& key : columns) rows += list_cell(joined(path, key), list[i], key);
    rows += "</tr>\n";
    for (const auto& [key, value] : list[i].items()) {
      if (!value.is_object()) continue;
      std::string title = list[i].value("name", std::to_string(i + 1));
      title += ": " + words_of(stem_of(key));
      below += figure_table(title, joined(path, key), value);
    }
  }
  return table(words_of(name), head, rows, columns.size() > 5) + below;  // ours
}

/// Objects of numbers that have the same names.
bool is_matrix(const Json& value) {
  if (!value.is_object() || value.size() < 2 || !value.front().is_object()) return false;
  const auto fits = [&](const Json& row) {
    if (!row.is_object() || row.size() < 2 || row.size() != value.front().size()) return false;
    for (const auto& [key, number] : row.items()) {
      if (!number.is_number() || !value.front().contains(key)) return false;
    }
    return true;
  };
  return std::all_of(value.begin(), value.end(), fits);
}

/// A row for each of its objects; the unit is that of the whole.
std::string matrix_table(const std::string& name, const Json& matrix) {
  const std::string unit = shown_unit(name);
  std::string head = head_cell("");
  for (const auto& [key, value] : matrix.front().items()) head += head_cell(words_of(key));
  std::string rows;
  for (const auto& [of, row] : matrix.items()) {
    rows += "<tr><th scope=\"row\">" + xml_escaped(capital(words_of(stem_of(of)))) + "</th>";
    for (const auto& [key, value] : matrix.front().items()) {
      const Entry figure = entry_of(row, key);
      rows += cell(attribute("data-label", words_of(key)) +
                       exact(joined(joined(name, of), key), figure) + attribute("class", "number"),
                   readable(row.at(key).get<double>(), 2));
    }
    rows += "</tr>\n";
  }
  return table(words_of(stem_of(name)) + (unit.empty() ? "" : " [" + unit + "]"), head, rows,
               matrix.front().size() > 3);  // ours
}

bool is_list_of_objects(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& each) { return each.is_object(); });
}

/// A figure with its label.
struct Headline {
  std::string label;
  Entry figure;
};

/// "volume.excavated_m3" is "Volume excavated"; of "conditions.0.gain_percent" the condition names
/// itself: "Gain, soft".
std::optional<Headline> found(const Json& result, const std::string& path) {
  const Json* object = &result;
  std::string before;
  std::string after;
  std::size_t start = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', start)) {
    const auto at = Json::json_pointer("/" + path.substr(start, dot - start));
    if (!object->contains(at)) return std::nullopt;
    const bool in_list = object->is_array();
    object = &object->at(at);
    if (in_list) {
      before.clear();
      after = ", " + object->value("name", "");
    } else {
      before += words_of(path.substr(start, dot - start)) + ' ';
    }
    start = dot + 1;
  }
  const std::string key = path.substr(start);
  if (!object->is_object() || !object->contains(key) || !object->at(key).is_number()) {
    return std::nullopt;
  }
  return Headline{capital(before + words_of(stem_of(key))) + after, entry_of(*object, key)};
}

}  // namespace

std::string figure_tables(const Json& result) {
  Json single = Json::object();
  std::string tables;
  for (const auto& [key, value] : result.items()) {
    if (key == "tool" || key == "version" || key == "warnings") continue;
    if (is_matrix(value)) {
      tables += matrix_table(key, value);
    } else if (value.is_object()) {
      tables += figure_table(words_of(key), key, value);
    } else if (is_list_of_objects(value)) {
      tables += list_table(key, value);
    } else {
      single[key] = value;
    }
  }
  return figure_table("result", "", single) + tables;
}

std::string headline_tiles(const Json& result, const std::vector<std::string>& keys) {
  std::string tiles;
  for (const std::string& path : keys) {
    const std::optional<Headline> headline = found(result, path);
    if (!headline) continue;
    const auto& [label, figure] = *headline;
    const std::string text = value_text(figure);
    const std::size_t error = text.find(" ± ");
    tiles += "<div class=\"tile\"><dt>" + xml_escaped(label) + "</dt><dd" + exact(path, figure) +
             "><span class=\"number\">" + xml_escaped(text.substr(0, error)) + "</span>" +
             (error == std::string::npos
                  ? ""
                  : "<span class=\"sd\">" + xml_escaped(text.substr(error)) + "</span>") +
             " <span class=\"unit\">" + xml_escaped(shown_unit(figure.key)) + "</span>" +
             (figure.interval ? "<span class=\"interval\">95 % interval " +
                                    xml_escaped(list_text(*figure.interval, " .. ")) + "</span>"
                              : "") +
             "</dd></div>\n";
  }
  return tiles;
}

}  // namespace excavplan
