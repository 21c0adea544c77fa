// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "live/page_server.hpp"

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>

#include "frame/tool.hpp"
#include "live/event_stream.hpp"
#include "live/request_check.hpp"

namespace excavplan::tools {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;
using namespace std::chrono_literals;
using boost::system::error_code;

// Ours.
constexpr std::uint32_t most_head_bytes = 8192;  // of a request, its line and headers
constexpr auto longest_head = 5s;                // until they have arrived
constexpr auto longest_write = 30s;              // of an answer, or of events in between
constexpr auto linger = 1s;                      // for a client to take its answer
constexpr auto tick = 50ms;                      // between looks for what is new
constexpr std::size_t most_connections = 200;
constexpr std::size_t most_streams = 64;

class Connection;

/// What the connections of a server share. They end with `io`, so before what they count.
struct Server {
  explicit Server(LiveFeed& shown) : feed(shown) {}

  LiveFeed& feed;
  std::string token = random_token();
  std::map<std::uint64_t, std::weak_ptr<Connection>> connections = {};  ///< by age
  std::uint64_t made = 0;
  std::size_t streams = 0;
  bool is_accepting = false;
  asio::io_context io{1};
  tcp::acceptor acceptor{io};
  asio::steady_timer timer{io};
};

std::string name_of(const tcp::endpoint& endpoint) {
  std::ostringstream text;
  text << endpoint;
  return text.str();
}

/// Under which a client may have reached it.
std::vector<std::string> hosts_of(const tcp::endpoint& local) {
  std::vector<std::string> hosts = {name_of(local)};
  const std::string port = ':' + std::to_string(local.port());
  if (local.address().is_loopback()) hosts.push_back("localhost" + port);
  if (local.port() != 80) return hosts;
  for (std::string& host : hosts) host.erase(host.size() - port.size());  // as browsers say it
  return hosts;
}

/// One request of a client, and the events that answer it.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, Server& server)
      : stream_(std::move(socket)), server_(server), number_(server.made++) {
    parser_.header_limit(most_head_bytes);
  }
  ~Connection() {
    server_.connections.erase(number_);
    if (events_) --server_.streams;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void begin() {
    server_.connections[number_] = weak_from_this();
    stream_.expires_after(longest_head);
    http::async_read_header(
        stream_, buffer_, parser_,
        [self = shared_from_this()](error_code error, std::size_t) { self->on_head(error); });
  }
  bool is_stream() const { return events_.has_value(); }
  void close() {
    error_code ignored;
    stream_.socket().close(ignored);
  }
  /// Sends what is new.
  void pump() {
    if (!events_ || is_writing_) return;
    text_ = events_->take(server_.feed);
    if (text_.empty()) return;
    write([self = shared_from_this()] { self->pump(); });
  }

 private:
  void on_head(error_code error) {
    if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      return answer(431);
    }
    if (error == http::error::end_of_stream || error == http::error::partial_message) return;
    const auto& of_parser = http::make_error_code(http::error::bad_method).category();
    if (error && error.category() == of_parser) return answer(400);
    if (error) return;
    const auto& request = parser_.get();
    const auto values = [&](http::field name) {
      std::vector<std::string> list;
      const auto range = request.equal_range(name);
      for (auto at = range.first; at != range.second; ++at) list.emplace_back(at->value());
      return list;
    };
    const bool only_reads =
        request.method() == http::verb::get || request.method() == http::verb::head;
    has_body_ = request.method() != http::verb::head;
    error_code gone;
    const tcp::endpoint local = stream_.socket().local_endpoint(gone);
    if (gone) return;
    const RequestAnswer checked = check({only_reads, std::string(request.target()),
                                         values(http::field::host), values(http::field::origin)},
                                        {hosts_of(local), server_.token});
    if (checked.status != 200) return answer(checked.status);
    if (checked.path == "/") return answer_page();
    std::string last(request["Last-Event-ID"]);
    answer_events(last.empty() ? value_in(checked.query, "from") : std::move(last),
                  value_in(checked.query, "steps"));
  }

  http::response<http::string_body> head_of(int status) const {
    http::response<http::string_body> response(static_cast<http::status>(status), 11);
    response.set(http::field::cache_control, "no-store");
    response.set("Referrer-Policy", "no-referrer");  // has the token
    response.set(http::field::x_frame_options, "DENY");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Content-Security-Policy", "frame-ancestors 'none'");
    response.keep_alive(false);
    return response;
  }
  void answer(http::response<http::string_body> response) {
    response.prepare_payload();
    std::ostringstream text;
    text << response.base();
    text_ = text.str();
    if (has_body_) text_ += response.body();
    write([self = shared_from_this()] { self->end(); });
  }
  void answer(int status) {
    auto response = head_of(status);
    response.set(http::field::content_type, "text/plain; charset=utf-8");
    if (status == 405) response.set(http::field::allow, "GET, HEAD");
    response.body() = std::string(http::obsolete_reason(response.result())) + '\n';
    answer(std::move(response));
  }
  void answer_page() {
    auto response = head_of(200);
    response.set(http::field::content_type, "text/html; charset=utf-8");
    response.body() = server_.feed.page("events?token=" + server_.token +
                                        "&from=" + std::to_string(server_.feed.edition()));
    answer(std::move(response));
  }
  void answer_events(const std::string& edition, const std::string& steps) {
    if (has_body_ && server_.streams >= most_streams) return answer(503);
    auto response = head_of(200);
    response.set(http::field::content_type, "text/event-stream");
    std::ostringstream text;
    text << response.base();
    text_ = text.str();
    if (!has_body_) return write([self = shared_from_this()] { self->end(); });
    events_.emplace(edition, steps);
    ++server_.streams;
    write([self = shared_from_this()] { self->pump(); });
    await_end();
  }

  template <typename Then>
  void write(Then then) {
    is_writing_ = true;
    stream_.expires_after(longest_write);
    asio::async_write(
        stream_, asio::buffer(text_),
        [self = shared_from_this(), then = std::move(then)](error_code error, std::size_t) {
          self->is_writing_ = false;
          if (error) return self->close();
          self->stream_.expires_never();
          then();
        });
  }
  void end() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(linger);
    drain();
  }
  /// Until the client has read all: what it sent and nobody read would cut the answer off.
  void drain() {
    stream_.async_read_some(asio::buffer(dropped_),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (error) return self->close();
                              self->drain();
                            });
  }
  /// A client of events has nothing more to say: whatever comes ends them.
  void await_end() {
    stream_.socket().async_read_some(
        asio::buffer(dropped_),
        [self = shared_from_this()](error_code, std::size_t) { self->close(); });
  }

  beast::tcp_stream stream_;
  Server& server_;
  std::uint64_t number_;
  beast::flat_buffer buffer_{std::size_t{2} * most_head_bytes};
  http::request_parser<http::empty_body> parser_;
  std::string text_;  ///< that is written
  bool has_body_ = true;
  bool is_writing_ = false;
  std::optional<EventStream> events_;
  std::array<char, 4096> dropped_ = {};
};

/// Room for a new connection, in place of the oldest that has not made its request.
bool make_room(Server& server) {
  if (server.connections.size() < most_connections) return true;
  for (const auto& [number, weak] : server.connections) {
    const auto connection = weak.lock();
    if (!connection || connection->is_stream()) continue;
    connection->close();
    return true;
  }
  return false;
}

void accept(Server& server) {
  server.is_accepting = true;
  server.acceptor.async_accept([&server](error_code error, tcp::socket socket) {
    server.is_accepting = false;
    if (error) return;  // as without descriptors: again at the next tick
    if (make_room(server)) std::make_shared<Connection>(std::move(socket), server)->begin();
    accept(server);
  });
}

void listen(tcp::acceptor& acceptor, const ServeAddress& at) {
  error_code error;
  const tcp::endpoint endpoint(asio::ip::make_address(at.host), at.port);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (error) usage_error("--serve: cannot listen at " + name_of(endpoint) + ": " + error.message());
}

void watch(Server& server, const ServeHooks& hooks) {
  if (hooks.is_stopped()) return server.io.stop();
  if (!server.is_accepting) accept(server);
  server.feed.refresh();
  for (auto at = server.connections.begin(); at != server.connections.end();) {
    const auto connection = (at++)->second.lock();
    if (connection) connection->pump();
  }
  server.timer.expires_after(tick);
  server.timer.async_wait([&](error_code error) {
    if (!error) watch(server, hooks);
  });
}

}  // namespace

void serve(LiveFeed& feed, const ServeAddress& at, const ServeHooks& hooks) {
  Server server(feed);
  listen(server.acceptor, at);
  const tcp::endpoint local = server.acceptor.local_endpoint();
  const std::string host = local.address().is_unspecified()
                               ? "127.0.0.1:" + std::to_string(local.port())
                               : name_of(local);
  hooks.begun("http://" + host + "/?token=" + server.token);
  watch(server, hooks);
  server.io.run();
}

}  // namespace excavplan::tools
