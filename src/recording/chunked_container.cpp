// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "recording/chunked_container.hpp"

#include <algorithm>
#include <numeric>
#include <queue>
#include <tuple>

#include "base/text.hpp"

namespace excavplan {
namespace {

// Of chunks that overlap in time [byte]; ours.
constexpr std::uint64_t kept_bytes = std::uint64_t{1} << 28;
constexpr int most_loads = 16;  // of one chunk, by one cursor; ours

bool is_later(const MessagePlace& a, const MessagePlace& b) {
  return std::tie(a.time, a.chunk, a.offset) > std::tie(b.time, b.chunk, b.offset);
}

bool has_any(const RecordedChunk& chunk, const std::vector<bool>& wanted) {
  return std::any_of(chunk.channels.begin(), chunk.channels.end(),
                     [&](const auto& channel) { return wanted[channel.first]; });
}

}  // namespace

/// Opens chunks in the order of their starts, each when the messages before it are through.
class ChunkedCursor : public MessageCursor {
 public:
  ChunkedCursor(ChunkedContainer& container, std::vector<bool> wanted, std::int64_t from,
                std::int64_t to)
      : container_(container), wanted_(std::move(wanted)), from_(from), to_(to) {}

  bool next() override {
    if (!ahead_.empty()) ahead_.pop();
    const auto& chunks = container_.chunks_;
    while (chunk_ < chunks.size() && chunks[chunk_].start <= to_ &&
           (ahead_.empty() || chunks[chunk_].start <= ahead_.top().time)) {
      open(chunk_++);
    }
    return !ahead_.empty();
  }
  std::int64_t time() const override { return ahead_.top().time; }
  StoredMessage read() override {
    const RecordedChannel& channel = container_.channels_[ahead_.top().channel];
    if (!channel.unreadable.empty()) {
      container_.file_.refuse("topic " + channel.topic + ": " + channel.unreadable);
    }
    return {channel.topic_index, channel.serialization, container_.message_at(ahead_.top())};
  }

 private:
  void open(std::uint32_t chunk) {
    const RecordedChunk& opened = container_.chunks_[chunk];
    if (opened.end < from_ || !has_any(opened, wanted_)) return;
    for (const MessagePlace& place : container_.places_of(chunk, wanted_)) {
      if (place.time >= from_ && place.time <= to_) ahead_.push(place);
    }
    if (ahead_.size() > most_places) {
      container_.file_.refuse("has more than " + std::to_string(most_places) +
                              " messages in chunks that overlap in time");
    }
  }

  ChunkedContainer& container_;
  std::vector<bool> wanted_;  // by channel
  std::int64_t from_;
  std::int64_t to_;
  std::uint32_t chunk_ = 0;  // the next one to open
  std::priority_queue<MessagePlace, std::vector<MessagePlace>, decltype(&is_later)> ahead_{
      &is_later};
};

std::unique_ptr<MessageCursor> ChunkedContainer::messages(const std::vector<std::size_t>& topics,
                                                          std::int64_t from, std::int64_t to) {
  loads_.clear();
  std::vector<bool> is_asked_for(topics_.size());
  for (const std::size_t topic : topics) is_asked_for[topic] = true;
  std::vector<bool> wanted;
  for (const auto& channel : channels_) wanted.push_back(is_asked_for[channel.topic_index]);
  return std::make_unique<ChunkedCursor>(*this, std::move(wanted), from, to);
}

/// By the index or, where that is damaged, by the chunk itself.
std::vector<MessagePlace> ChunkedContainer::listed_places(std::uint32_t chunk,
                                                          const std::vector<bool>& wanted) {
  RecordedChunk& listed = chunks_[chunk];
  std::vector<MessagePlace> places = listed.places;
  if (!places.empty() || !listed.lost.empty()) return places;
  if (skipped_.guard(no_time, [&] { list(chunk, wanted, places); })) return places;
  try {
    scan_content(listed, load(listed).view(), listed.places);
    if (listed.places.empty()) file_.fail(listed.offset, "a chunk without a message", "some");
  } catch (const Unsupported&) {
    throw;
  } catch (const Error& error) {
    listed.lost = error.what();
    skipped_.add(listed.lost, loss_of(listed));
  }
  return listed.places;
}

std::vector<MessagePlace> ChunkedContainer::places_of(std::uint32_t chunk,
                                                      const std::vector<bool>& wanted) {
  std::vector<MessagePlace> places = listed_places(chunk, wanted);
  const RecordedChunk& listed = chunks_[chunk];
  const auto is_left_out = [&](const MessagePlace& place) {
    if (!wanted[place.channel]) return true;
    const TimeRange& usual = usual_times_[channels_[place.channel].topic_index];
    if (place.time < usual.from || place.time > usual.to) return true;
    if (place.time >= listed.start && place.time <= listed.end) return false;
    const Loss loss = {{place.time, place.time}, {channels_[place.channel].topic}};
    skipped_.guard(loss, [&] {
      file_.fail(listed.offset, "a chunk with a message at " + std::to_string(place.time) + " ns",
                 "messages at " + std::to_string(listed.start) + " to " +
                     std::to_string(listed.end) + " ns, as the index of the file says");
    });
    return true;
  };
  places.erase(std::remove_if(places.begin(), places.end(), is_left_out), places.end());
  for (MessagePlace& place : places) place.chunk = chunk;
  return places;
}

void ChunkedContainer::check() {
  const std::vector<bool> all(channels_.size(), true);
  for (std::uint32_t i = 0; i < chunks_.size(); ++i) {
    RecordedChunk& chunk = chunks_[i];
    if (chunk.offset == 0) continue;  // messages outside of chunks
    try {
      load(chunk);
      listed_places(i, all);
    } catch (const Unreadable&) {
      throw;
    } catch (const Unsupported&) {  // whole, for all that is known
    } catch (const Error& error) {
      chunk.lost = error.what();
      skipped_.add(chunk.lost, loss_of(chunk));
    }
  }
}

Loss ChunkedContainer::loss_of(const RecordedChunk& chunk) const {
  Loss loss{chunk.times()};
  for (const auto& [channel, offset] : chunk.channels) loss.topics.insert(channels_[channel].topic);
  return loss;
}

std::uint32_t ChunkedContainer::channel_of(std::uint32_t id) const {
  const auto found = channel_of_id_.find(id);
  return found == channel_of_id_.end() ? static_cast<std::uint32_t>(channels_.size())
                                       : found->second;
}

void ChunkedContainer::add_channel(RecordedChannel channel, const ByteReader& reader) {
  if (is_finished_) return;
  const auto number = static_cast<std::uint32_t>(channels_.size());
  const auto [entry, is_new] = channel_of_id_.try_emplace(channel.id, number);
  if (is_new) {
    channels_.push_back(std::move(channel));
    return;
  }
  RecordedChannel& known = channels_[entry->second];
  if (known.is_doubtful) {
    known = std::move(channel);
  } else if (!channel.is_doubtful && (known.topic != channel.topic || known.type != channel.type)) {
    reader.fail("channel " + std::to_string(channel.id) + " of " + in_quotes(channel.topic) +
                    " and of " + in_quotes(known.topic),
                "one topic and one type a channel");
  }
}

void ChunkedContainer::require_order(const RecordedChunk& chunk, const ByteReader& reader) {
  if (chunk.start <= chunk.end) return;
  reader.fail(
      "a chunk from " + std::to_string(chunk.start) + " to " + std::to_string(chunk.end) + " ns",
      "one that ends after its start");
}

void ChunkedContainer::forget_index() {
  channels_.clear();
  channel_of_id_.clear();
  chunks_.clear();
}

std::uint64_t ChunkedContainer::next_chunk(std::uint64_t offset, std::uint64_t end) const {
  constexpr std::uint64_t block = std::uint64_t{1} << 20;
  while (offset < end) {
    const std::uint64_t size = std::min(block + longest_chunk_head, end - offset);
    const Bytes bytes = file_.read(offset, size, "records");
    const std::uint64_t places = std::min(block, size);
    for (std::uint64_t at = 0; at < places; ++at) {
      if (begins_chunk(bytes.view().substr(at), end - offset - at)) return offset + at;
    }
    offset += places;
  }
  return end;
}

void ChunkedContainer::keep_chunk(RecordedChunk chunk) {
  if (chunk.places.empty()) return;
  const auto is_earlier = [](const MessagePlace& a, const MessagePlace& b) {
    return a.time < b.time;
  };
  const auto [first, last] =
      std::minmax_element(chunk.places.begin(), chunk.places.end(), is_earlier);
  chunk.start = first->time;
  chunk.end = last->time;
  std::vector<bool> is_listed(channels_.size());
  for (const MessagePlace& place : chunk.places) {
    ++channels_[place.channel].messages;
    if (!is_listed[place.channel]) chunk.channels.emplace_back(place.channel, 0);
    is_listed[place.channel] = true;
  }
  chunks_.push_back(std::move(chunk));
}

std::string_view ChunkedContainer::chunk_of(const MessagePlace& place) {
  const auto found = std::find_if(kept_.begin(), kept_.end(),
                                  [&](const auto& kept) { return kept.first == place.chunk; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().second.view();
  }
  if (++loads_[place.chunk] > most_loads) {
    file_.refuse("byte " + std::to_string(chunks_[place.chunk].offset) +
                 ": found a chunk that overlaps in time with more than can be kept in memory, "
                 "expected chunks that follow each other");
  }
  // Messages come in the order of their times.
  kept_.remove_if([&](const auto& kept) { return chunks_[kept.first].end < place.time; });
  std::uint64_t held = 0;
  for (const auto& kept : kept_) held += kept.second.size();
  while (!kept_.empty() && held > kept_bytes) {
    held -= kept_.back().second.size();
    kept_.pop_back();
  }
  RecordedChunk& chunk = chunks_[place.chunk];
  if (chunk.lost.empty()) {
    try {
      kept_.emplace_front(place.chunk, load(chunk));
      return kept_.front().second.view();
    } catch (const Unsupported&) {
      throw;
    } catch (const Error& error) {
      chunk.lost = error.what();
      skipped_.add(chunk.lost, loss_of(chunk));
    }
  }
  throw Error(ErrorKind::bad_file, chunk.lost);
}

void ChunkedContainer::finish() {
  const auto is_earlier = [](const RecordedChunk& a, const RecordedChunk& b) {
    return std::tie(a.start, a.offset) < std::tie(b.start, b.offset);
  };
  std::sort(chunks_.begin(), chunks_.end(), is_earlier);
  make_topics();
  is_finished_ = true;
  date_topics();
}

void ChunkedContainer::make_topics() {
  std::map<std::string, std::size_t> numbers;
  for (RecordedChannel& channel : channels_) {
    const auto [entry, is_new] = numbers.try_emplace(channel.topic, topics_.size());
    channel.topic_index = entry->second;
    if (is_new) topics_.push_back({channel.topic, channel.type});
    RecordedTopic& topic = topics_[channel.topic_index];
    topic.messages += channel.messages;
    usual_times_.resize(topics_.size());
    if (topic.type != channel.type) {
      channel.unreadable = "found messages of " + in_quotes(channel.type) + " and of " +
                           in_quotes(topic.type) + ", expected one type";
    }
  }
}

/// The search for the first or the last message of each topic.
struct ChunkedContainer::Dating {
  bool first;
  std::vector<bool> dated;   // by topic
  std::vector<bool> wanted;  // by channel; all false between chunks
};

void ChunkedContainer::date_topics() {
  std::vector<std::uint32_t> order(chunks_.size());
  std::iota(order.begin(), order.end(), 0u);
  const std::vector<bool> none(topics_.size()), no_channel(channels_.size());
  Dating first{true, none, no_channel};
  for (const std::uint32_t chunk : order) date_by(chunk, first);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(chunks_[a].end, a) > std::tie(chunks_[b].end, b);
  });
  Dating last{false, none, no_channel};
  for (const std::uint32_t chunk : order) date_by(chunk, last);
  for (std::size_t topic = 0; topic < topics_.size(); ++topic) {
    if (!first.dated[topic]) topics_[topic].messages = 0;
    if (time_span(topics_[topic]) > longest_topic) leave_out_strays(topic);
  }
}

/// By the middle one of its messages.
void ChunkedContainer::leave_out_strays(std::size_t topic) {
  std::vector<bool> wanted;
  for (const RecordedChannel& channel : channels_) wanted.push_back(channel.topic_index == topic);
  std::vector<std::int64_t> times;
  for (std::uint32_t chunk = 0; chunk < chunks_.size() && times.size() < most_places; ++chunk) {
    if (!has_any(chunks_[chunk], wanted)) continue;
    for (const MessagePlace& place : places_of(chunk, wanted)) times.push_back(place.time);
  }
  usual_times_[topic] = usual_times(times);
  date_without_strays(file_.path(), times, usual_times_[topic], topics_[topic], skipped_);
}

// Lists a chunk only if it may hold a first (last) message of a topic.
void ChunkedContainer::date_by(std::uint32_t chunk, Dating& dating) {
  const RecordedChunk& asked = chunks_[chunk];
  std::vector<std::uint32_t> open;
  for (const auto& [channel, offset] : asked.channels) {
    const std::size_t index = channels_[channel].topic_index;
    const RecordedTopic& topic = topics_[index];
    const bool may_extend = dating.first ? asked.start < topic.first : asked.end > topic.last;
    if (!dating.dated[index] || may_extend) open.push_back(channel);
  }
  if (open.empty()) return;
  for (const std::uint32_t channel : open) dating.wanted[channel] = true;
  for (const MessagePlace& place : places_of(chunk, dating.wanted)) {
    const std::size_t index = channels_[place.channel].topic_index;
    std::int64_t& time = dating.first ? topics_[index].first : topics_[index].last;
    const bool extends = dating.first ? place.time < time : place.time > time;
    if (!dating.dated[index] || extends) time = place.time;
    dating.dated[index] = true;
  }
  for (const std::uint32_t channel : open) dating.wanted[channel] = false;
}

}  // namespace excavplan
