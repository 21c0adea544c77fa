// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "frame/help.hpp"

#include <sstream>

namespace excavplan::tools {
namespace {

constexpr std::size_t help_width = 96;

/// `text` broken at blanks, the lines after the first indented.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = indent;
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > help_width) {
      result += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string help_row(const std::string& left, const std::string& right) {
  constexpr std::size_t indent = 30;
  const std::string start = "  " + left;
  const std::string gap = start.size() + 2 > indent ? '\n' + std::string(indent, ' ')
                                                    : std::string(indent - start.size(), ' ');
  return start + gap + wrapped(right, indent) + '\n';
}

}  // namespace

std::string help_text(const About& about, const std::vector<Arguments::Entry>& entries) {
  std::string usage = "Usage: " + about.name;
  std::string positionals;
  std::string options;
  for (const Arguments::Entry& entry : entries) {
    if (entry.positional) {
      usage += entry.required ? " " + entry.name : " [" + entry.name + "]";
      positionals += help_row(entry.name, entry.help);
      continue;
    }
    std::string help = entry.help;
    if (entry.required) {
      help += " (required)";
    } else if (!entry.default_text.empty()) {
      help += " (default: " + entry.default_text + ")";
    }
    const std::string value = entry.placeholder.empty() ? "" : " " + entry.placeholder;
    options += help_row((entry.name == "help" ? "-h, --" : "--") + entry.name + value, help);
  }
  std::string text =
      wrapped(about.name + ": " + about.summary, 0) + "\n\n" + usage + " [OPTIONS]\n";
  if (!positionals.empty()) text += '\n' + positionals;
  text += "\nOptions:\n" + options;
  text +=
      "\nA bare number is in the unit in brackets; 45deg, 5cm, 50mm are understood as well. One "
      "FILE "
      "that\nis read may be -, standard input.\n";
  if (!about.examples.empty()) text += "\nExamples:\n";
  for (const Example& example : about.examples) {
    text += "  " + example.command + "\n      " + wrapped(example.meaning, 6) + '\n';
  }
  std::string codes =
      "Exit codes: 0 done; 1 internal error, or not enough memory; 2 wrong usage; 3 a file cannot "
      "be read or written, or has the wrong format or content, or a simulator fails";
  if (about.can_be_untrustworthy) codes += "; 4 result not trustworthy, with --strict";
  if (!about.own_codes.empty()) codes += "; " + about.own_codes;
  if (about.can_stop_early) codes += "; 75 stopped early, can be resumed";
  return text + '\n' + wrapped(codes + ".", 0) + '\n';
}

}  // namespace excavplan::tools
