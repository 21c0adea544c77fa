// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/yaml.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <excavplan/base/error.hpp>

#include "base/read_double.hpp"
#include "base/text.hpp"

namespace excavplan {
namespace {

using nlohmann::json;
using std::string_view;

constexpr int most_levels = 64;

struct Line {
  std::size_t number = 0;
  std::size_t indent = 0;
  string_view text;  ///< without indent, comment and blanks at its end; not empty
};

[[noreturn]] void refuse(const std::string& name, std::size_t line, string_view found,
                         const std::string& expected) {
  throw Error(ErrorKind::bad_file, name + ": line " + std::to_string(line) + ": found " +
                                       in_quotes(found) + ", expected " + expected);
}

string_view yaml_trimmed(string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// The place behind a quoted text that begins at `at`, or behind the line.
std::size_t end_of_quote(string_view text, std::size_t at) {
  const char quote = text[at];
  for (++at; at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\') {
      ++at;
    } else if (text[at] == quote) {
      return at + 1;
    }
  }
  return text.size();
}

/// Where the first of some characters stands outside quotes that `stops` accepts.
template <typename Stops>
std::size_t find_outside_quotes(string_view text, const Stops& stops) {
  bool starts_word = true;  // an apostrophe within a word is none
  for (std::size_t at = 0; at < text.size();) {
    if (starts_word && (text[at] == '"' || text[at] == '\'')) {
      at = end_of_quote(text, at);
      starts_word = false;
      continue;
    }
    if (stops(at)) return at;
    starts_word = string_view(" \t[{,:").find(text[at]) != string_view::npos;
    ++at;
  }
  return text.npos;
}

string_view without_comment(string_view text) {
  const std::size_t at = find_outside_quotes(text, [&](std::size_t i) {
    return text[i] == '#' && (i == 0 || text[i - 1] == ' ' || text[i - 1] == '\t');
  });
  return yaml_trimmed(text.substr(0, at));
}

/// Where the colon behind the key of a map stands.
std::size_t colon_of(string_view text) {
  return find_outside_quotes(text, [&](std::size_t i) {
    return text[i] == ':' && (i + 1 == text.size() || text[i + 1] == ' ' || text[i + 1] == '\t');
  });
}

bool is_item(string_view text) {
  return text[0] == '-' && (text.size() == 1 || text[1] == ' ' || text[1] == '\t');
}

/// The lines of the first document that say something.
std::vector<Line> lines_of(const std::string& name, string_view text) {
  std::vector<Line> lines;
  bool is_over = false;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const string_view line = text.substr(0, end);
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    if (!is_printable(line)) refuse(name, number, line, "a text without control characters");
    const string_view content = without_comment(line);
    if (content.empty() || (lines.empty() && content[0] == '%')) continue;
    if (content == "---" || content == "...") {
      is_over = !lines.empty();
      continue;
    }
    if (is_over) refuse(name, number, content, "the end of the file after one document");
    const std::size_t indent = line.find_first_not_of(' ');
    if (line[indent] == '\t') refuse(name, number, "a tab", "spaces before the text");
    lines.push_back({number, indent, content});
  }
  return lines;
}

std::optional<double> number_of(string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = read_double(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size()) return std::nullopt;
  return value;
}

class YamlReader {
 public:
  YamlReader(const std::string& name, string_view text)
      : name_(name), lines_(lines_of(name, text)) {}

  json document() {
    if (lines_.empty()) refuse(name_, 1, "", "a YAML document");
    json value = block(lines_[0].indent, 0);
    if (at_ < lines_.size()) fail(lines_[at_].text, "it indented as the lines before");
    return value;
  }

 private:
  [[noreturn]] void fail(string_view found, const std::string& expected) const {
    const Line& line = lines_[at_ < lines_.size() ? at_ : lines_.size() - 1];
    refuse(name_, line.number, found, expected);
  }
  bool goes_on(std::size_t indent) const {
    return at_ < lines_.size() && lines_[at_].indent == indent;
  }

  /// What begins with the line at hand, which is indented by `indent`.
  json block(std::size_t indent, int level) {
    if (level > most_levels) fail(lines_[at_].text, "at most 64 levels");
    const string_view text = lines_[at_].text;
    if (is_item(text)) return list(indent, level);
    if (text[0] == '[' || text[0] == '{' || colon_of(text) == text.npos) {
      return value_of(text, level);
    }
    return map(indent, level);
  }

  json map(std::size_t indent, int level) {
    json object = json::object();
    while (goes_on(indent)) {
      const string_view text = lines_[at_].text;
      const std::size_t colon = is_item(text) ? text.npos : colon_of(text);
      if (colon == text.npos) fail(text, "a key and a colon");
      const std::string key = plain(yaml_trimmed(text.substr(0, colon)));
      if (object.contains(key)) fail(text, "every key once");
      const string_view rest = without_tag(yaml_trimmed(text.substr(colon + 1)));
      object[key] = rest.empty() ? below(indent, true, level) : value_of(rest, level);
    }
    return object;
  }

  json list(std::size_t indent, int level) {
    json items = json::array();
    while (goes_on(indent) && is_item(lines_[at_].text)) {
      Line& line = lines_[at_];
      const std::size_t begin = line.text.find_first_not_of(" \t", 1);
      if (begin == line.text.npos) {
        items.push_back(below(indent, false, level));
        continue;
      }
      line.indent += begin;
      line.text.remove_prefix(begin);
      items.push_back(block(line.indent, level + 1));
    }
    return items;
  }

  /// What the lines after this one hold, which has but a key or a dash.
  json below(std::size_t indent, bool is_key, int level) {
    ++at_;
    if (at_ == lines_.size()) return nullptr;
    const Line& next = lines_[at_];
    const bool is_deeper = next.indent > indent;
    const bool is_list_of_key = is_key && next.indent == indent && is_item(next.text);
    return is_deeper || is_list_of_key ? block(next.indent, level + 1) : json();
  }

  /// A scalar, or a collection in brackets that may go on for some lines.
  json value_of(string_view text, int level) {
    if (text[0] != '[' && text[0] != '{') {
      json value = scalar(text);
      ++at_;
      return value;
    }
    const std::size_t first = at_;
    std::string whole(text);
    for (int open = opened(text); open > 0; open += opened(lines_[at_].text)) {
      if (at_ + 1 == lines_.size()) {
        at_ = first;
        fail(text, "its closing bracket");
      }
      whole.append(" ").append(lines_[++at_].text);
    }
    string_view rest = whole;
    json value = flow(rest, level + 1);
    if (!yaml_trimmed(rest).empty()) fail(rest, "nothing behind the bracket");
    ++at_;
    return value;
  }

  /// Brackets that a line opens, less those that it closes.
  static int opened(string_view text) {
    int open = 0;
    find_outside_quotes(text, [&](std::size_t i) {
      if (text[i] == '[' || text[i] == '{') ++open;
      if (text[i] == ']' || text[i] == '}') --open;
      return false;
    });
    return open;
  }

  /// Takes a value off the front of what stands in brackets.
  json flow(string_view& text, int level) {
    if (level > most_levels) fail(text, "at most 64 levels");
    text = yaml_trimmed(text);
    if (text.empty()) fail("", "a value");
    const bool is_map = text[0] == '{';
    if (!is_map && text[0] != '[') return scalar(taken(text, ",]}"));
    const char closing = is_map ? '}' : ']';
    json all = is_map ? json::object() : json::array();
    text.remove_prefix(1);
    while (true) {
      text = yaml_trimmed(text);
      if (!text.empty() && text[0] == closing) break;
      if (is_map) {
        const std::string key = plain(taken(text, ":,}]"));
        if (text.empty() || text[0] != ':') fail(text, "a colon behind a key");
        text.remove_prefix(1);
        if (all.contains(key)) fail(key, "every key once");
        all[key] = flow(text, level + 1);
      } else {
        all.push_back(flow(text, level + 1));
      }
      text = yaml_trimmed(text);
      if (!text.empty() && text[0] == ',') {
        text.remove_prefix(1);
      } else if (text.empty() || text[0] != closing) {
        fail(text, std::string("a comma or ") + closing);
      }
    }
    text.remove_prefix(1);
    return all;
  }

  /// Takes the text before one of some characters off the front.
  static string_view taken(string_view& text, string_view stops) {
    const std::size_t end = std::min(text.size(), find_outside_quotes(text, [&](std::size_t i) {
                                       return stops.find(text[i]) != string_view::npos;
                                     }));
    const string_view word = yaml_trimmed(text.substr(0, end));
    text.remove_prefix(end);
    return word;
  }

  static string_view without_tag(string_view text) {
    if (text.empty() || text[0] != '!') return text;
    const std::size_t end = text.find_first_of(" \t");
    return end == text.npos ? string_view() : yaml_trimmed(text.substr(end));
  }

  json scalar(string_view text) const {
    text = without_tag(text);
    if (text.empty() || text == "~" || text == "null") return nullptr;
    if (text == "true" || text == "True") return true;
    if (text == "false" || text == "False") return false;
    if (const auto number = number_of(text)) return *number;
    return plain(text);
  }

  /// A text without its quotes.
  std::string plain(string_view text) const {
    if (text.empty()) fail("", "a text");
    if (text[0] == '"' || text[0] == '\'') {
      if (text.size() < 2 || end_of_quote(text, 0) != text.size() || text.back() != text[0]) {
        fail(text, "a text in quotes on one line");
      }
      return std::string(text.substr(1, text.size() - 2));
    }
    if (string_view("&*|>@`").find(text[0]) != string_view::npos) {
      fail(text, "plain YAML without anchors, aliases and texts of several lines");
    }
    return std::string(text);
  }

  std::string name_;
  std::vector<Line> lines_;
  std::size_t at_ = 0;
};

}  // namespace

json parse_yaml(const std::string& name, const std::string& text) {
  return YamlReader(name, text).document();
}

}  // namespace excavplan
