// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include <excavplan/recording/recording.hpp>

#include "base/check.hpp"
#include "clouds/file_stream.hpp"
#include "recording/recording_file.hpp"

namespace excavplan {
namespace {

constexpr double longest = 1e9;  // [s]

/// Of one text.
class SpecParser {
 public:
  explicit SpecParser(const std::string& text) : text_(text) {}

  std::optional<RecordingQuery> parse() const {
    std::error_code ignored;
    if (std::filesystem::exists(text_, ignored)) return std::nullopt;
    const std::size_t colon = text_.rfind(":/");
    if (colon == text_.npos || colon == 0) return without_topic();
    RecordingQuery query;
    query.path = text_.substr(0, colon);
    std::string_view rest = std::string_view(text_).substr(colon + 1);
    const bool is_address = rest.substr(0, 2) == "//";
    const bool is_drive = query.path.size() == 1 && !is_recording(query.path);
    if (is_address || is_drive) return std::nullopt;
    query.topic = take_until(rest, "@+");
    if (query.topic.size() == 1)
      refuse("the topic " + in_quotes(query.topic), "a name behind the /");
    if (!rest.empty() && rest.front() == '@') {
      rest.remove_prefix(1);
      query.time = seconds_of(take_until(rest, "+"), "time");
    }
    if (!rest.empty()) query.span = seconds_of(std::string(rest.substr(1)), "span");
    return query;
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    excavplan::refuse("'" + text_ + "': found " + found + ", expected " + expected +
                      ": FILE:TOPIC@TIME+SPAN, such as run.db3:/livox/lidar@12.5s+2s");
  }
  /// A recording's name with something behind it that is no topic.
  std::optional<RecordingQuery> without_topic() const {
    for (auto end = text_.find_first_of(":@+", 1); end != text_.npos;
         end = text_.find_first_of(":@+", end + 1)) {
      if (!is_recording(text_.substr(0, end))) continue;
      refuse(in_quotes(text_.substr(end)) + " behind a recording",
             "a topic that begins with /, which inspect-cloud " + text_.substr(0, end) + " lists");
    }
    return std::nullopt;
  }
  static std::string take_until(std::string_view& rest, std::string_view ends) {
    const std::string_view taken = rest.substr(0, rest.find_first_of(ends));
    rest.remove_prefix(taken.size());
    return std::string(taken);
  }
  double seconds_of(const std::string& word, const std::string& what) const {
    constexpr std::array<std::pair<std::string_view, double>, 4> units = {
        {{"ms", 0.001}, {"min", 60.0}, {"s", 1.0}, {"", 1.0}}};
    for (const auto& [unit, factor] : units) {
      if (word.size() < unit.size() || word.substr(word.size() - unit.size()) != unit) continue;
      const auto value = parse_number(word.substr(0, word.size() - unit.size()));
      if (!value) break;
      if (!(*value >= 0.0 && *value * factor <= longest)) {
        refuse(what + " " + in_quotes(word), "0 to 1e9 s");
      }
      return *value * factor;
    }
    refuse(what + " " + in_quotes(word), "a number with s, ms or min");
  }

  const std::string& text_;
};

}  // namespace

std::optional<RecordingQuery> parse_recording_spec(const std::string& text) {
  return SpecParser(text).parse();
}

}  // namespace excavplan
