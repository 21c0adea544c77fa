// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "live/event_stream.hpp"

#include <charconv>

namespace excavplan::tools {
namespace {

// Ours.
constexpr std::size_t most_bytes = std::size_t{1} << 20;  // of events at once
constexpr std::chrono::seconds silence{10};               // after which a sign of life is sent

template <typename Number>
bool read_number(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string event_text(const char* name, const std::string& id, const std::string& data) {
  return std::string("event: ") + name + (id.empty() ? "" : "\nid: " + id) + "\ndata: " + data +
         "\n\n";
}

}  // namespace

EventStream::EventStream(const std::string& from, const std::string& steps) {
  const std::size_t point = from.find('.');
  const bool tells_steps = point != std::string::npos;
  const bool is_read =
      read_number(std::string_view(from).substr(0, point), edition_) &&
      read_number(tells_steps ? std::string_view(from).substr(point + 1) : std::string_view(steps),
                  steps_);
  if (!is_read) edition_ = -1;
}

std::string EventStream::take(const LiveFeed& feed) {
  if (is_over_) return {};
  std::string text;
  if (edition_ != feed.edition() || steps_ > feed.steps()) {
    is_over_ = true;
    return event_text("reload", {}, "{}");
  }
  while (steps_ < feed.steps() && text.size() < most_bytes) {
    const std::string& step = feed.step(steps_++);
    text += event_text("step", std::to_string(edition_) + '.' + std::to_string(steps_), step);
  }
  if (state_version_ != feed.state_version()) {
    state_version_ = feed.state_version();
    text += event_text("state", {}, feed.state());
  }
  if (text.empty() && Clock::now() - last_ > silence) text = ":\n\n";
  if (!text.empty()) last_ = Clock::now();
  return text;
}

}  // namespace excavplan::tools
