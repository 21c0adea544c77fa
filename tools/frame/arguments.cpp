// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/arguments.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan::tools {
namespace {

template <typename Integer>
Integer parse_integer(const std::string& what, const std::string& text) {
  Integer value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc::result_out_of_range) usage_error(what + ": " + text + " is too large");
  if (error != std::errc{} || stop != end) {
    const char* kind = std::is_signed_v<Integer> ? "a whole number" : "a whole number, 0 or more";
    usage_error(what + ": '" + text + "' is not " + kind);
  }
  return value;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

bool names_file(const std::string& placeholder) {
  return placeholder.find("FILE") != placeholder.npos ||
         placeholder.find("FRAME") != placeholder.npos;
}

}  // namespace

void usage_error(const std::string& message) { throw Error(ErrorKind::bad_input, message); }

std::string with_option_names(std::string message, const OptionNames& names) {
  for (const auto& [words, option] : names) {
    if (const std::size_t at = message.find(words); at != std::string::npos) {
      message.replace(at, words.size(), option);
    }
  }
  return message;
}

std::string with_options(std::string text, const std::vector<Arguments::Entry>& entries) {
  for (std::size_t at = text.find('`'); at != text.npos; at = text.find('`', at + 1)) {
    const std::size_t end = text.find('`', at + 1);
    if (end == text.npos) break;
    std::string name = text.substr(at + 1, end - at - 1);
    std::replace(name.begin(), name.end(), '_', '-');
    const bool is_option = std::any_of(entries.begin(), entries.end(), [&](const auto& entry) {
      return !entry.positional && entry.name == name;
    });
    if (is_option) text.replace(at, end + 1 - at, "--" + name);
  }
  return text;
}

void Arguments::add(Entry entry) { entries_.push_back(std::move(entry)); }

void Arguments::positional(const std::string& name, std::string& value, const std::string& help) {
  add({name, name, help, "", true, true, [&value](const std::string& text) { value = text; }});
  entries_.back().input = true;
}

void Arguments::positional(const std::string& name, std::optional<std::string>& value,
                           const std::string& help) {
  add({name, name, help, "", true, false, [&value](const std::string& text) { value = text; }});
  entries_.back().input = true;
}

void Arguments::flag(const std::string& name, bool& value, const std::string& help) {
  add({name, "", help, "", false, false, [&value](const std::string&) { value = true; }});
}

void Arguments::option(const std::string& name, double& value, Quantity quantity,
                       const std::string& help) {
  add({name, placeholder(quantity), help + " [" + unit(quantity) + "]", number_text(value), false,
       false, [&value, name, quantity](const std::string& text) {
         value = parse_quantity("--" + name, text, quantity);
       }});
}

void Arguments::option(const std::string& name, std::optional<double>& value, Quantity quantity,
                       const std::string& help) {
  add({name, placeholder(quantity), help + " [" + unit(quantity) + "]",
       value ? number_text(*value) : "", false, false,
       [&value, name, quantity](const std::string& text) {
         value = parse_quantity("--" + name, text, quantity);
       }});
}

void Arguments::option(const std::string& name, int& value, const std::string& help) {
  add({name, "N", help, std::to_string(value), false, false,
       [&value, name](const std::string& text) { value = parse_integer<int>("--" + name, text); }});
}

void Arguments::option(const std::string& name, std::optional<int>& value,
                       const std::string& help) {
  add({name, "N", help, value ? std::to_string(*value) : "", false, false,
       [&value, name](const std::string& text) { value = parse_integer<int>("--" + name, text); }});
}

void Arguments::option(const std::string& name, std::uint64_t& value, const std::string& help) {
  add({name, "N", help, std::to_string(value), false, false,
       [&value, name](const std::string& text) {
         value = parse_integer<std::uint64_t>("--" + name, text);
         if (value > most_exact) {
           usage_error("--" + name + ": " + text + " must be at most " +
                       std::to_string(most_exact));
         }
       }});
}

void Arguments::option(const std::string& name, std::optional<Rectangle>& value,
                       const std::string& help) {
  add({name, "XMIN,YMIN,XMAX,YMAX", help + " [m]", "", false, false,
       [&value, name](const std::string& text) { value = parse_rectangle("--" + name, text); }});
}

void Arguments::option(const std::string& name, std::optional<DigParameters>& value,
                       const std::string& help) {
  const DigPathForm form = dig_path_form();
  add({name, form.placeholder, help + " [" + form.units + "]", "", false, false,
       [&value, name](const std::string& text) { value = parse_dig_path("--" + name, text); }});
}

void Arguments::option(const std::string& name, DigParameters& value, const std::string& help) {
  const DigPathForm form = dig_path_form();
  add({name, form.placeholder, help + ": " + form.names + " [" + form.units + "]",
       dig_path_argument(value), false, false,
       [&value, name](const std::string& text) { value = parse_dig_path("--" + name, text); }});
}

void Arguments::option(const std::string& name, Eigen::Vector2d& value, const std::string& help) {
  add({name, "X,Y", help + " [m]", number_text(value.x()) + "," + number_text(value.y()), false,
       false, [&value, name](const std::string& text) { value = parse_point("--" + name, text); }});
}

void Arguments::option(const std::string& name, std::optional<Eigen::Vector2d>& value,
                       const std::string& help) {
  add({name, "X,Y", help + " [m]", "", false, false,
       [&value, name](const std::string& text) { value = parse_point("--" + name, text); }});
}

void Arguments::option(const std::string& name, std::vector<CameraPlace>& value,
                       const std::string& help) {
  add({name, "X,Y,Z,TX,TY,TZ", help + " [m]", "", false, false,
       [&value, name](const std::string& text) {
         const auto at = parse_lengths("--" + name, text, 6, "a place and a target X,Y,Z,TX,TY,TZ");
         value.push_back({{at[0], at[1], at[2]}, {at[3], at[4], at[5]}});
       }});
  entries_.back().repeated = true;
}

void Arguments::option(const std::string& name, std::optional<Eigen::Vector3d>& value,
                       const std::string& help) {
  add({name, "X,Y,Z", help + " [m]", "", false, false,
       [&value, name](const std::string& text) { value = parse_place("--" + name, text); }});
}

void Arguments::option(const std::string& name, std::optional<Eigen::Matrix4d>& value,
                       const std::string& help) {
  add({name, "X,Y,Z,QX,QY,QZ,QW", help, "", false, false,
       [&value, name](const std::string& text) { value = parse_pose("--" + name, text); }});
}

void Arguments::option(const std::string& name, std::optional<MachinePosture>& value,
                       const std::string& help) {
  add({name, "SWING,BOOM,ARM,BUCKET", help + " [rad]", "", false, false,
       [&value, name](const std::string& text) { value = parse_posture("--" + name, text); }});
}

void Arguments::choice(const std::string& name, std::string& value,
                       const std::vector<std::string>& words, const std::string& help) {
  add({name, joined(words, "|"), help, value, false, false,
       [&value, name, words](const std::string& text) {
         if (std::find(words.begin(), words.end(), text) == words.end()) {
           usage_error("--" + name + ": '" + text + "' is not one of " + joined(words, ", "));
         }
         value = text;
       }});
}

void Arguments::file(const std::string& name, std::string& value, const std::string& help) {
  add({name, "FILE", help, value, false, false,
       [&value](const std::string& text) { value = text; }});
  entries_.back().input = true;
}

void Arguments::file(const std::string& name, std::optional<std::string>& value,
                     const std::string& help) {
  add({name, "FILE", help, value.value_or(""), false, false,
       [&value](const std::string& text) { value = text; }});
  entries_.back().input = true;
}

void Arguments::output(const std::string& name, std::string& value, const std::string& help) {
  file(name, value, help);
  entries_.back().input = false;
  entries_.back().output = true;
}

void Arguments::output(const std::string& name, std::optional<std::string>& value,
                       const std::string& help, const Beside& beside) {
  file(name, value, help);
  entries_.back().input = false;
  entries_.back().output = true;
  entries_.back().beside = beside;
}

void Arguments::place(const std::string& name, std::string& value, const std::string& help) {
  file(name, value, help);
  entries_.back().input = false;
  entries_.back().place = true;
}

void Arguments::folder(const std::string& name, std::optional<std::string>& value,
                       const std::string& help, const Beside& files) {
  file(name, value, help);
  entries_.back().placeholder = "FOLDER";
  entries_.back().input = false;
  entries_.back().place = true;
  entries_.back().beside = files;
}

void Arguments::text(const std::string& name, const std::string& placeholder, std::string& value,
                     const std::string& help) {
  add({name, placeholder, help, value, false, false,
       [&value](const std::string& text) { value = text; }});
  entries_.back().input = names_file(placeholder);
}

void Arguments::text(const std::string& name, const std::string& placeholder,
                     std::optional<std::string>& value, const std::string& help) {
  add({name, placeholder, help, value.value_or(""), false, false,
       [&value](const std::string& text) { value = text; }});
  entries_.back().input = names_file(placeholder);
}

void Arguments::texts(const std::string& name, const std::string& placeholder,
                      std::vector<std::string>& values, const std::string& help) {
  add({name, placeholder, help, "", false, false,
       [&values](const std::string& text) { values.push_back(text); }});
  entries_.back().repeated = true;
  entries_.back().input = names_file(placeholder);
}

void Arguments::soil(std::string& name) {
  text("soil", "loam|sand|clay|gravel|FILE", name, "soil: a shipped one, or a soil file");
}

void Arguments::report(std::optional<std::string>& path) {
  add({"report", "FILE.html",
       "write a page that shows result, ground and machine in a browser, offline, into this file",
       "", false, false, [&path](const std::string& text) { path = text; }});
  entries_.back().output = true;
}

void Arguments::threads(std::uint64_t& count, const std::string& note) {
  add({"threads", "N",
       "threads, 0 for one per core, at most " + std::to_string(most_threads) + note,
       std::to_string(count), false, false, [&count](const std::string& text) {
         count = parse_integer<std::uint64_t>("--threads", text);
         if (count > most_threads) {
           usage_error("--threads: " + text + " must be at most " + std::to_string(most_threads));
         }
       }});
}

void Arguments::machine(std::string& name) {
  text("machine", "zx120|zx200|generic-20t|generic-mini|FILE", name,
       "excavator: a shipped one, a machine file, a URDF, or a folder of machine-kit");
}

void Arguments::require_ending(const std::vector<std::string>& endings,
                               const std::function<bool()>& if_so) {
  entries_.back().endings = endings;
  entries_.back().by_ending = if_so;
}

void Arguments::allow_standard_output() { entries_.back().standard_output = true; }

void Arguments::only_if(const Use& use, const std::function<void()>& declare) {
  const std::size_t first = entries_.size();
  declare();
  for (std::size_t i = first; i < entries_.size(); ++i) {
    std::vector<Use>& uses = entries_[i].uses;
    uses.insert(uses.begin(), use);  // the outer before the inner
  }
}

void Arguments::require(const std::string& name) { entry(name).required = true; }

void Arguments::exclude(const std::string& name, const std::vector<std::string>& others) {
  std::vector<std::string>& excludes = entry(name).excludes;
  excludes.insert(excludes.end(), others.begin(), others.end());
}

Arguments::Entry& Arguments::entry(const std::string& name) {
  return *std::find_if(entries_.begin(), entries_.end(),
                       [&](const Entry& each) { return each.name == name; });
}

}  // namespace excavplan::tools
