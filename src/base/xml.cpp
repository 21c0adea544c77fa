// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/xml.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include <excavplan/base/error.hpp>

#include "base/text.hpp"

namespace excavplan {
namespace {

using std::string;
using std::string_view;

constexpr string_view blanks = " \t\r\n";
constexpr string_view ends_of_name = " \t\r\n/>=<\"'&";

/// Of a character's number. @return empty if there is no such character
string utf8_of(unsigned long code) {
  if (code == 0 || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
  const auto byte = [](unsigned long bits) { return static_cast<char>(bits); };
  const auto next = [&](int shift) { return byte(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xC0U | (code >> 6)), next(0)};
  if (code < 0x10000) return {byte(0xE0U | (code >> 12)), next(6), next(0)};
  return {byte(0xF0U | (code >> 18)), next(12), next(6), next(0)};
}

/// What stands between & and ; as text; empty if it is nothing known.
string replacement_of(string_view entity) {
  constexpr std::array<std::pair<string_view, char>, 5> known = {
      {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"apos", '\''}, {"quot", '"'}}};
  for (const auto& [word, character] : known) {
    if (entity == word) return {character};
  }
  if (entity.size() < 2 || entity[0] != '#') return {};
  const bool is_hexadecimal = entity[1] == 'x';
  const string_view digits = entity.substr(is_hexadecimal ? 2 : 1);
  unsigned long code = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), code, is_hexadecimal ? 16 : 10);
  if (error != std::errc() || end != digits.data() + digits.size()) return {};
  return utf8_of(code);
}

class XmlReader {
 public:
  XmlReader(const string& name, string_view text) : name_(name), text_(text) {}

  XmlElement document() {
    if (const auto bad = first_not_utf8(text_)) {
      move_to(*bad);
      refuse("a byte that is not UTF-8", "UTF-8");
    }
    if (starts("\xEF\xBB\xBF")) at_ += 3;
    XmlElement root;
    bool has_root = false;
    while (next_markup(!has_root)) {
      if (has_root) refuse(shown(), "nothing after the first element");
      root = element();
      has_root = true;
    }
    if (!has_root) refuse("the end of the file", "an element");
    return root;
  }

 private:
  [[noreturn]] void refuse(const string& found, const string& expected) const {
    throw Error(ErrorKind::bad_file, name_ + ": line " + std::to_string(line_) + ": found " +
                                         found + ", expected " + expected);
  }
  string shown() const {
    if (at_ >= text_.size()) return "the end of the file";
    const string_view rest = text_.substr(at_);
    return in_quotes(rest.substr(0, std::min<std::size_t>(rest.find('\n'), 100)));
  }
  bool starts(string_view with) const { return text_.substr(at_, with.size()) == with; }

  void move_to(std::size_t place) {
    line_ += static_cast<std::size_t>(std::count(text_.begin() + static_cast<std::ptrdiff_t>(at_),
                                                 text_.begin() + static_cast<std::ptrdiff_t>(place),
                                                 '\n'));
    at_ = place;
  }
  void skip_blanks() { move_to(std::min(text_.find_first_not_of(blanks, at_), text_.size())); }

  void skip_past(string_view end, const string& what) {
    const std::size_t found = text_.find(end, at_);
    if (found == text_.npos) refuse(what + " without an end", in_quotes(end));
    move_to(found + end.size());
  }

  /// To the next '<' that begins or ends an element. @return false at the end of the file
  bool next_markup(bool outside) {
    while (true) {
      if (outside) skip_blanks();
      const std::size_t found = std::min(text_.find('<', at_), text_.size());
      if (outside && found != at_) refuse(shown(), "'<'");
      move_to(found);
      if (at_ == text_.size()) return false;
      if (starts("<!--")) {
        skip_past("-->", "a comment");
      } else if (starts("<?")) {
        skip_past("?>", "a processing instruction");
      } else if (starts("<![CDATA[")) {
        skip_past("]]>", "a CDATA section");
      } else if (starts("<!")) {
        refuse(shown(), "no document type and no entities of its own");
      } else {
        return true;
      }
    }
  }

  string word() {
    const std::size_t end = std::min(text_.find_first_of(ends_of_name, at_), text_.size());
    if (end == at_) refuse(shown(), "a name");
    const string_view found = text_.substr(at_, end - at_);
    move_to(end);
    return string(found);
  }

  string value() {
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '"' && quote != '\'') refuse(shown(), "a value in quotes");
    const std::size_t end = text_.find(quote, at_ + 1);
    if (end == text_.npos) refuse(shown(), "a value that ends in a quote");
    const string_view raw = text_.substr(at_ + 1, end - at_ - 1);
    if (raw.find('<') != raw.npos) refuse(shown(), "a value without '<'");
    string plain = without_entities(raw);
    move_to(end + 1);
    return plain;
  }

  string without_entities(string_view raw) const {
    string plain;
    for (std::size_t at = 0; at < raw.size(); ++at) {
      if (raw[at] != '&') {
        plain += raw[at];
        continue;
      }
      const std::size_t end = std::min(raw.find(';', at), raw.size());
      const string text = replacement_of(raw.substr(at + 1, end - at - 1));
      if (end == raw.size() || text.empty()) {
        refuse(in_quotes(raw.substr(at)), "one of the entities of XML, such as '&amp;'");
      }
      plain += text;
      at = end;
    }
    return plain;
  }

  /// @return whether it has an end of its own
  bool read_tag(XmlElement& element) {
    element.line = line_;
    ++at_;
    element.name = word();
    while (true) {
      skip_blanks();
      if (starts("/>")) {
        at_ += 2;
        return false;
      }
      if (starts(">")) {
        ++at_;
        return true;
      }
      string key = word();
      if (element.attribute(key)) refuse("the attribute " + in_quotes(key) + " twice", "it once");
      if (element.attributes.size() == most_xml_attributes) {
        refuse("more than " + std::to_string(most_xml_attributes) + " attributes", "at most that");
      }
      skip_blanks();
      if (!starts("=")) refuse(shown(), "'='");
      ++at_;
      skip_blanks();
      element.attributes.emplace_back(std::move(key), value());
    }
  }

  void read_end(const string& of) {
    at_ += 2;
    const string name = word();
    skip_blanks();
    if (name != of || !starts(">")) {
      refuse("the end of " + in_quotes(name), "the end of " + in_quotes(of));
    }
    ++at_;
  }

  XmlElement element() {
    std::vector<XmlElement> open;  // from the outermost on
    do {
      if (++elements_ > most_xml_elements) {
        refuse("more than " + std::to_string(most_xml_elements) + " elements", "at most that");
      }
      if (open.size() == most_xml_levels) {
        refuse("more than " + std::to_string(most_xml_levels) + " levels of elements",
               "at most that");
      }
      XmlElement next;
      const bool has_end = read_tag(next);
      open.push_back(std::move(next));
      if (!has_end && open.size() == 1) break;
      if (!has_end) close(open);
      while (next_markup(false) && starts("</")) {
        read_end(open.back().name);
        if (open.size() == 1) return std::move(open.front());
        close(open);
      }
      if (at_ == text_.size())
        refuse("the end of the file", "the end of " + in_quotes(open.back().name));
    } while (true);
    return std::move(open.front());
  }

  static void close(std::vector<XmlElement>& open) {
    XmlElement last = std::move(open.back());
    open.pop_back();
    open.back().children.push_back(std::move(last));
  }

  const string& name_;
  string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  std::size_t elements_ = 0;
};

}  // namespace

const string* XmlElement::attribute(const string& key) const {
  for (const auto& [name_of, value] : attributes) {
    if (name_of == key) return &value;
  }
  return nullptr;
}

const XmlElement* XmlElement::child(const string& of_name) const {
  for (const XmlElement& each : children) {
    if (each.name == of_name) return &each;
  }
  return nullptr;
}

XmlElement parse_xml(const string& name, const string& text) {
  return XmlReader(name, text).document();
}

}  // namespace excavplan
