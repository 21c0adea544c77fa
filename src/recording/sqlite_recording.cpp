// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/base/error.hpp>

#include "base/text.hpp"
#include "recording/byte_file.hpp"
#include "recording/container.hpp"

#ifdef EXCAVPLAN_WITH_SQLITE3

#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <new>
#include <optional>
#include <system_error>
#include <tuple>

// The tables are those of rosbag2_storage_sqlite3: topics (id, name, type, serialization_format)
// and messages (id, topic_id, timestamp, data), indexed by timestamp.

namespace excavplan {
namespace {

constexpr int longest_text = 4096;            // of a topic or type, and of other texts; ours [byte]
constexpr std::size_t most_topics = 1 << 14;  // ours
constexpr std::size_t most_rows = 1 << 23;    // at once; ours
constexpr int steps_between_checks = 1000;    // of SQLite's virtual machine

using Connection = std::unique_ptr<sqlite3, decltype(&sqlite3_close_v2)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

bool has_bytes(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && status.st_size > 0;
}

std::string absolute(const std::string& path) {
  std::error_code error;
  std::string whole = std::filesystem::absolute(path, error).string();
  if (error) throw Error(ErrorKind::bad_file, path + ": cannot be opened: " + error.message());
  return whole;
}

/// The path as a URI for SQLite: every byte that has a meaning there escaped.
std::string uri_of(const std::string& path, const std::string& query) {
  constexpr char digits[] = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : absolute(path)) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = std::isalnum(byte) != 0 || c == '/' || c == '.' || c == '_' || c == '-';
    if (is_plain) {
      uri += c;
    } else {
      uri += {'%', digits[byte >> 4], digits[byte & 15]};
    }
  }
  return uri + query;
}

/// Where a message lies.
struct MessageRow {
  std::int64_t time = 0;
  std::int64_t id = 0;
  std::size_t topic = 0;

  bool operator<(const MessageRow& other) const {
    return std::tie(time, id) < std::tie(other.time, other.id);
  }
};

class SqliteRecording : public Container {
 public:
  SqliteRecording(const std::string& path, SkippedParts& skipped);
  std::unique_ptr<MessageCursor> messages(const std::vector<std::size_t>& topics, std::int64_t from,
                                          std::int64_t to) override;

  Bytes blob(std::int64_t row);
  void require_readable(std::size_t topic) const;

 private:
  using RowVisitor = std::function<void(const MessageRow& row)>;

  void open();
  void harden();
  void require_whole() const;
  Statement prepare(const std::string& sql);
  bool step(sqlite3_stmt* statement);
  std::int64_t integer(sqlite3_stmt* statement, int column, const std::string& name);
  void require_table(const std::string& name, const std::vector<std::string>& columns);
  void read_topics();
  void read_topic(sqlite3_stmt* row);
  void each_row(const RowVisitor& visit);
  std::optional<std::int64_t> next_readable(std::int64_t row);
  void visit_row(sqlite3_stmt* row, const RowVisitor& visit);
  void count_messages();
  void add_row(const MessageRow& row, std::vector<MessageRow>& rows) const;
  std::vector<MessageRow> rows_by_index(const std::string& ids, std::int64_t from, std::int64_t to);
  std::string text(sqlite3_stmt* statement, int column, const std::string& name);
  const char* characters(sqlite3_stmt* statement, int column) const;
  [[noreturn]] void fail(const std::string& what);
  int read_fault(int code) const;

  std::string path_;
  std::uint64_t size_ = 0;        // [byte]
  bool has_lost_rows_ = false;    // a page of the messages is damaged
  bool has_lost_topics_ = false;  // a row of the topics is
  Connection connection_{nullptr, &sqlite3_close_v2};
  std::uint64_t steps_left_ = 0;  // thousands of them, that a statement may still take
  std::map<std::int64_t, std::size_t> topic_of_id_;
  std::vector<std::string> formats_;    // by topic
  std::vector<TimeRange> usual_times_;  // by topic; others bear a wrong time
};

class SqliteCursor : public MessageCursor {
 public:
  SqliteCursor(SqliteRecording& recording, std::vector<MessageRow> rows)
      : recording_(recording), rows_(std::move(rows)) {}
  bool next() override { return next_++ < rows_.size(); }
  std::int64_t time() const override { return row().time; }
  StoredMessage read() override {
    recording_.require_readable(row().topic);
    message_ = recording_.blob(row().id);
    return {row().topic, Serialization::cdr, message_.view()};
  }

 private:
  const MessageRow& row() const { return rows_[next_ - 1]; }

  SqliteRecording& recording_;
  std::vector<MessageRow> rows_;
  std::size_t next_ = 0;
  Bytes message_;
};

SqliteRecording::SqliteRecording(const std::string& path, SkippedParts& skipped)
    : Container(skipped), path_(path) {
  size_ = ByteFile(path).size();
  open();
  harden();
  require_whole();
  require_table("topics", {"id", "name", "type", "serialization_format"});
  require_table("messages", {"topic_id", "timestamp", "data"});
  read_topics();
  count_messages();
}

/// SQLite would fill what is missing with zeros, where it reads such a file at all.
void SqliteRecording::require_whole() const {
  const Bytes head = ByteFile(path_).read(0, 32, "header");
  const auto number = [&](std::size_t at, std::size_t size) {  // the higher bytes first
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value = value << 8 | static_cast<unsigned char>(head.view()[at + i]);
    }
    return value;
  };
  const std::uint64_t page = number(16, 2) == 1 ? 65536 : number(16, 2);
  const std::uint64_t whole = page * number(28, 4);
  if (has_bytes(path_ + "-wal") || whole <= size_) return;
  throw Unsupported(path_ + ": its end is missing: found " + std::to_string(size_) +
                    " bytes, expected " + std::to_string(whole) +
                    "; what is whole is saved by 'sqlite3 " + path_ +
                    " .recover | sqlite3 saved.db3'");
}

/// Leaves nothing beside the file, and loses nothing that a recorder left there.
void SqliteRecording::open() {
  if (has_bytes(path_ + "-journal")) {
    throw Error(ErrorKind::bad_file, path_ + ": its recording was cut off and left " + path_ +
                                         "-journal; repair it by 'sqlite3 " + path_ + " .schema'");
  }
  const bool has_log = has_bytes(path_ + "-wal");
  const auto folder = std::filesystem::path(absolute(path_)).parent_path().string();
  const bool may_write = ::access(folder.c_str(), W_OK) == 0;
  if (has_log && !may_write && !has_bytes(path_ + "-shm")) {
    throw Error(ErrorKind::bad_file,
                path_ + ": messages in " + path_ +
                    "-wal cannot be read in a folder that cannot be written; copy both files");
  }
  // Who writes to a file that keeps a log has left one; without one SQLite would make its own.
  const Bytes head = ByteFile(path_).read(0, 20, "header");
  const bool keeps_log = head.view()[18] == 2;
  const bool is_final = !has_log && (keeps_log || !may_write);
  const std::string uri = uri_of(path_, is_final ? "?mode=ro&immutable=1" : "?mode=ro");
  sqlite3* made = nullptr;
  const int result = sqlite3_open_v2(
      uri.c_str(), &made, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  connection_.reset(made);
  if (result != SQLITE_OK) fail("the file");
}

/// Nothing that a file brings along is run, and its size bounds memory and time.
void SqliteRecording::harden() {
  sqlite3* const db = connection_.get();
  for (const auto& [setting, value] : {std::pair{SQLITE_DBCONFIG_DEFENSIVE, 1},
                                       {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                       {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                       {SQLITE_DBCONFIG_ENABLE_VIEW, 0}}) {
    sqlite3_db_config(db, setting, value, nullptr);
  }
  const auto most = std::min<std::uint64_t>(most_bytes, std::max<std::uint64_t>(size_, 1 << 20));
  sqlite3_limit(db, SQLITE_LIMIT_LENGTH, static_cast<int>(most));
  sqlite3_limit(db, SQLITE_LIMIT_SQL_LENGTH, 1 << 20);
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_limit(db, SQLITE_LIMIT_COLUMN, 100);
  sqlite3_limit(db, SQLITE_LIMIT_EXPR_DEPTH, 50);
  sqlite3_busy_timeout(db, 1000);
  const auto count_down = [](void* left) {
    auto& steps = *static_cast<std::uint64_t*>(left);
    return steps == 0 ? 1 : (--steps, 0);
  };
  sqlite3_progress_handler(db, steps_between_checks, count_down, &steps_left_);
  for (const char* setting : {"PRAGMA cell_size_check = ON", "PRAGMA query_only = ON",
                              "PRAGMA temp_store = MEMORY", "PRAGMA mmap_size = 0"}) {
    step(prepare(setting).get());
  }
}

Statement SqliteRecording::prepare(const std::string& sql) {
  // Pages that form a loop have no end: a row takes at least 4 bytes and fewer than 40 steps; ours.
  steps_left_ = 1000 + size_ * 10 / steps_between_checks;
  sqlite3_stmt* made = nullptr;
  const int result = sqlite3_prepare_v2(connection_.get(), sql.c_str(), -1, &made, nullptr);
  Statement statement(made, &sqlite3_finalize);
  if (result != SQLITE_OK) fail("its tables");
  return statement;
}

/// @return false at the end
bool SqliteRecording::step(sqlite3_stmt* statement) {
  const int result = sqlite3_step(statement);
  if (result == SQLITE_INTERRUPT) {
    throw Unsupported(path_ +
                      ": its tables: found more rows than the file has room for, expected "
                      "pages without a loop");
  }
  if (result != SQLITE_ROW && result != SQLITE_DONE) fail("its tables");
  return result == SQLITE_ROW;
}

void SqliteRecording::fail(const std::string& what) {
  if (!connection_) throw std::bad_alloc();
  const int code = sqlite3_errcode(connection_.get());
  if (code == SQLITE_NOMEM) throw std::bad_alloc();
  const int reason = read_fault(code);
  if (reason != 0) {
    throw Unreadable(path_ + ": cannot be read: " + std::generic_category().message(reason));
  }
  fail_at(path_, what,
          in_quotes(sqlite3_errmsg(connection_.get())) + " (SQLite " + std::to_string(code) + ")",
          "a whole file of rosbag2");
}

/// Why the system could not read the file, as errno; 0 if it could. SQLite calls a file damaged
/// whose disk answers by one of these three.
int SqliteRecording::read_fault(int code) const {
  int reason = 0;
  sqlite3_file_control(connection_.get(), "main", SQLITE_FCNTL_LAST_ERRNO, &reason);
  if (code == SQLITE_IOERR) return reason != 0 ? reason : EIO;
  const bool is_of_disk = reason == EIO || reason == ENXIO || reason == ERANGE;
  return code == SQLITE_CORRUPT && is_of_disk ? reason : 0;
}

/// Of the present row; nullptr if it holds none.
const char* SqliteRecording::characters(sqlite3_stmt* statement, int column) const {
  const auto* const found = reinterpret_cast<const char*>(sqlite3_column_text(statement, column));
  if (found == nullptr && sqlite3_errcode(connection_.get()) == SQLITE_NOMEM)
    throw std::bad_alloc();
  return found;
}

std::int64_t SqliteRecording::integer(sqlite3_stmt* statement, int column,
                                      const std::string& name) {
  const std::int64_t value = sqlite3_column_int64(statement, column);
  if (sqlite3_column_type(statement, column) == SQLITE_INTEGER && value >= 0) return value;
  const char* const found = characters(statement, column);
  fail_at(path_, "column " + name, found == nullptr ? "nothing" : in_quotes(found),
          "a whole number of at least 0");
}

std::string SqliteRecording::text(sqlite3_stmt* statement, int column, const std::string& name) {
  const char* const found = characters(statement, column);
  const int size = sqlite3_column_bytes(statement, column);
  if (found == nullptr || size > longest_text) {
    fail_at(path_, "table topics, column " + name,
            found == nullptr ? "nothing" : std::to_string(size) + " bytes",
            "a text of at most " + std::to_string(longest_text) + " bytes");
  }
  return {found, static_cast<std::size_t>(size)};
}

/// A view, a virtual table or a computed column would run what the file says.
void SqliteRecording::require_table(const std::string& name,
                                    const std::vector<std::string>& columns) {
  const Statement schema = prepare(
      "SELECT type = 'table' AND sql NOT LIKE 'CREATE VIRTUAL%' "
      "AND sql NOT LIKE '%WITHOUT%ROWID%' FROM sqlite_master WHERE name = '" +
      name + "'");
  if (!step(schema.get()) || sqlite3_column_int(schema.get(), 0) != 1) {
    fail_at(path_, "table " + name, "none or another kind of table", "an ordinary one of rosbag2");
  }
  std::size_t found = 0;
  const Statement list = prepare("PRAGMA table_xinfo(" + name + ")");
  while (step(list.get())) {
    const char* const column = characters(list.get(), 1);
    const bool is_known =
        std::find(columns.begin(), columns.end(), column == nullptr ? "" : column) != columns.end();
    if (is_known && sqlite3_column_int(list.get(), 6) == 0) ++found;
  }
  if (found != columns.size()) {
    fail_at(path_, "table " + name, std::to_string(found) + " of the columns of rosbag2",
            std::to_string(columns.size()));
  }
}

void SqliteRecording::read_topics() {
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics");
  const auto next = [&] {
    bool has_row = false;
    skipped_.guard(TimeRange{}, [&] { has_row = step(rows.get()); });
    return has_row;
  };
  while (next()) {
    if (topics_.size() == most_topics) {
      throw Unsupported(path_ + ": table topics: found more rows, expected at most " +
                        std::to_string(most_topics));
    }
    if (!skipped_.guard(no_time, [&] { read_topic(rows.get()); })) has_lost_topics_ = true;
  }
  usual_times_.resize(topics_.size());
}

void SqliteRecording::read_topic(sqlite3_stmt* row) {
  const std::int64_t id = integer(row, 0, "id of topics");
  RecordedTopic topic = {text(row, 1, "name"), ros2_type(text(row, 2, "type"))};
  std::string format = text(row, 3, "serialization_format");
  if (!topic_of_id_.emplace(id, topics_.size()).second) {
    fail_at(path_, "table topics", "id " + std::to_string(id) + " twice", "each id once");
  }
  topics_.push_back(std::move(topic));
  formats_.push_back(std::move(format));
}

/// Reads the first page of each message, as rosbag2 does, in the order of the rows, past pages that
/// are damaged.
void SqliteRecording::each_row(const RowVisitor& visit) {
  constexpr int most_gaps = 100;  // ours
  std::int64_t from = std::numeric_limits<std::int64_t>::min();
  std::int64_t last = 0;
  std::int64_t last_time = earliest;
  for (int gaps = 0; gaps <= most_gaps; ++gaps) {
    const Statement rows =
        prepare("SELECT rowid, topic_id, timestamp FROM messages WHERE rowid >= ? ORDER BY rowid");
    sqlite3_bind_int64(rows.get(), 1, from);
    const bool is_whole = skipped_.guard_open(last_time, [&] {
      while (step(rows.get())) {
        last = sqlite3_column_int64(rows.get(), 0);
        visit_row(rows.get(), [&](const MessageRow& row) {
          if (row.time > last_time) skipped_.close(last_time = row.time);
          visit(row);
        });
      }
    });
    if (is_whole) return;
    has_lost_rows_ = true;
    const auto next = next_readable(last);
    if (!next) return;
    from = *next;
  }
}

/// The row behind a damaged page: looked for in steps that grow, then halved.
std::optional<std::int64_t> SqliteRecording::next_readable(std::int64_t row) {
  enum class Found { damage, nothing, message };
  std::int64_t found_row = 0;
  const auto look = [&](std::int64_t from) {
    try {
      const Statement first =
          prepare("SELECT rowid FROM messages WHERE rowid >= ? ORDER BY rowid LIMIT 1");
      sqlite3_bind_int64(first.get(), 1, from);
      if (!step(first.get())) return Found::nothing;
      found_row = sqlite3_column_int64(first.get(), 0);
      return found_row >= from ? Found::message : Found::damage;
    } catch (const Unsupported&) {
      throw;
    } catch (const Error&) {
      return Found::damage;
    }
  };
  std::int64_t damaged = std::max<std::int64_t>(row, 0);
  std::int64_t good = 0;
  std::optional<std::int64_t> next;
  for (std::int64_t step_size = 1;
       good == 0 && step_size < latest / 4 && damaged <= latest - step_size; step_size *= 2) {
    const Found found = look(damaged + step_size);
    if (found == Found::damage) damaged += step_size;
    if (found != Found::damage) good = damaged + step_size;
    if (found == Found::message) next = found_row;
  }
  while (good - damaged > 1) {
    const std::int64_t middle = damaged + (good - damaged) / 2;
    const Found found = look(middle);
    if (found == Found::message) next = found_row;
    (found == Found::damage ? damaged : good) = middle;
  }
  return next;
}

void SqliteRecording::visit_row(sqlite3_stmt* row, const RowVisitor& visit) {
  Loss loss{TimeRange{}};
  const std::int64_t time = sqlite3_column_int64(row, 2);
  if (sqlite3_column_type(row, 2) == SQLITE_INTEGER && time >= 0) loss.times = {time, time};
  skipped_.guard(loss, [&] {
    const std::int64_t id = integer(row, 1, "topic_id");
    const auto found = topic_of_id_.find(id);
    if (found == topic_of_id_.end()) {
      if (has_lost_topics_) return;
      fail_at(path_, "column topic_id", std::to_string(id), "an id of the table topics");
    }
    loss.topics = {topics_[found->second].name};
    visit({integer(row, 2, "timestamp"), sqlite3_column_int64(row, 0), found->second});
  });
}

void SqliteRecording::count_messages() {
  each_row([&](const MessageRow& row) {
    RecordedTopic& topic = topics_[row.topic];
    topic.first = topic.messages == 0 ? row.time : std::min(topic.first, row.time);
    topic.last = topic.messages == 0 ? row.time : std::max(topic.last, row.time);
    ++topic.messages;
  });
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (time_span(topics_[i]) <= longest_topic) continue;
    std::vector<std::int64_t> times;
    each_row([&](const MessageRow& row) {
      if (row.topic == i) times.push_back(row.time);
    });
    usual_times_[i] = usual_times(times);
    date_without_strays(path_, times, usual_times_[i], topics_[i], skipped_);
  }
}

void SqliteRecording::require_readable(std::size_t topic) const {
  if (formats_[topic] == "cdr") return;
  throw Unsupported(path_ + ": topic " + topics_[topic].name + ": found messages in the format " +
                    in_quotes(formats_[topic]) + ", expected 'cdr'");
}

void SqliteRecording::add_row(const MessageRow& row, std::vector<MessageRow>& rows) const {
  if (rows.size() == most_rows) {
    throw Unsupported(path_ + ": has more than " + std::to_string(most_rows) +
                      " messages of one query");
  }
  rows.push_back(row);
}

std::vector<MessageRow> SqliteRecording::rows_by_index(const std::string& ids, std::int64_t from,
                                                       std::int64_t to) {
  std::vector<MessageRow> found;
  const Statement rows = prepare(
      "SELECT rowid, topic_id, timestamp FROM messages WHERE timestamp BETWEEN ? AND ? AND "
      "typeof(timestamp) = 'integer' AND topic_id IN (" +
      ids + ") ORDER BY timestamp, rowid");
  sqlite3_bind_int64(rows.get(), 1, from);
  sqlite3_bind_int64(rows.get(), 2, to);
  while (step(rows.get())) {
    visit_row(rows.get(), [&](const MessageRow& row) { add_row(row, found); });
  }
  return found;
}

/// By the index of the times or, where that or the messages are damaged, by all rows.
std::unique_ptr<MessageCursor> SqliteRecording::messages(const std::vector<std::size_t>& topics,
                                                         std::int64_t from, std::int64_t to) {
  std::vector<bool> is_asked_for(topics_.size());
  for (const std::size_t topic : topics) is_asked_for[topic] = true;
  std::string ids;
  for (const auto& [id, topic] : topic_of_id_) {
    if (is_asked_for[topic]) ids += (ids.empty() ? "" : ",") + std::to_string(id);
  }
  from = std::max<std::int64_t>(from, 0);
  std::vector<MessageRow> rows;
  const auto by_index = [&] { rows = rows_by_index(ids, from, to); };
  if (has_lost_rows_ || !skipped_.guard(no_time, by_index)) {
    rows.clear();
    each_row([&](const MessageRow& row) {
      if (is_asked_for[row.topic] && row.time >= from && row.time <= to) add_row(row, rows);
    });
    std::sort(rows.begin(), rows.end());
  }
  const auto is_stray = [&](const MessageRow& row) {
    const TimeRange& usual = usual_times_[row.topic];
    return row.time < usual.from || row.time > usual.to;
  };
  rows.erase(std::remove_if(rows.begin(), rows.end(), is_stray), rows.end());
  return std::make_unique<SqliteCursor>(*this, std::move(rows));
}

Bytes SqliteRecording::blob(std::int64_t row) {
  sqlite3_blob* made = nullptr;
  const int opened =
      sqlite3_blob_open(connection_.get(), "main", "messages", "data", row, 0, &made);
  const std::unique_ptr<sqlite3_blob, decltype(&sqlite3_blob_close)> blob(made,
                                                                          &sqlite3_blob_close);
  const std::string place = "row " + std::to_string(row) + " of the table messages";
  if (opened != SQLITE_OK) fail(place);
  const auto size = static_cast<std::uint64_t>(sqlite3_blob_bytes(made));
  if (size > size_ || size > most_bytes) {
    fail_at(path_, place, "a message of " + std::to_string(size) + " bytes",
            "at most the size of the file and " + std::to_string(most_bytes));
  }
  Bytes bytes(size);
  if (sqlite3_blob_read(made, bytes.data(), static_cast<int>(size), 0) != SQLITE_OK) fail(place);
  return bytes;
}

}  // namespace

std::unique_ptr<Container> open_sqlite_recording(const std::string& path, SkippedParts& skipped) {
  return std::make_unique<SqliteRecording>(path, skipped);
}

}  // namespace excavplan

#else

namespace excavplan {

std::unique_ptr<Container> open_sqlite_recording(const std::string& path, SkippedParts&) {
  throw Unsupported(
      path +
      ": is a rosbag2 recording of SQLite, which this build is without; build it anew "
      "with Debian's libsqlite3-dev");
}

}  // namespace excavplan

#endif
