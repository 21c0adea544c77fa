// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <excavplan/base/error.hpp>

#include "live/page_server.hpp"
#include "support/errors.hpp"
#include "support/http_client.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

using tools::LiveFeed;

/// Steps that the test adds.
class Feed : public LiveFeed {
 public:
  void refresh() override {
    while (steps_.size() < wanted) steps_.push_back(std::string(length, 'x') + "!");
    edition_ = wanted_edition;
  }
  std::string page(const std::string& stream) override { return "<p>" + stream + "</p>"; }
  int edition() const override { return edition_; }
  std::size_t steps() const override { return steps_.size(); }
  const std::string& step(std::size_t i) const override { return steps_[i]; }
  int state_version() const override { return 1; }
  const std::string& state() const override { return state_; }

  std::atomic<std::size_t> wanted{2};
  std::atomic<int> wanted_edition{0};
  std::size_t length = 1;

 private:
  std::vector<std::string> steps_;
  std::string state_ = "{\"left_m3\": 3}";
  int edition_ = 0;
};

class PageServer : public testing::Test {
 protected:
  void SetUp() override {
    begin();
    if (at.port == 0) GTEST_SKIP() << "built without Boost.Beast";
  }
  void TearDown() override { end(); }

  void begin() {
    std::promise<std::string> url;
    server = std::thread([this, &url] {
      try {
        tools::serve(feed, {},
                     {[this] { return is_over.load(); },
                      [&](const std::string& begun) { url.set_value(begun); }});
      } catch (const Error& error) {
        EXPECT_TRUE(contains(error.what(), "without Boost.Beast")) << error.what();
        url.set_value("");
      }
    });
    const std::string begun = url.get_future().get();
    if (!begun.empty()) at = parts_of(begun);
  }
  void end() {
    is_over = true;
    if (server.joinable()) server.join();
  }

  std::string head(const std::string& path, const std::string& more = "") const {
    return "GET " + path + (contains(path, "?") ? "&" : "?") + at.query +
           " HTTP/1.1\r\nHost: " + at.host + more;
  }
  std::string get(const std::string& path, const std::string& more = "") const {
    return answer_to(at.port, head(path, more));
  }
  void refused(int status, const std::string& lines) const {
    const std::string answer = answer_to(at.port, lines);
    EXPECT_EQ(answer.rfind("HTTP/1.1 " + std::to_string(status), 0), 0U)
        << lines.substr(0, 200) << '\n'
        << answer;
    EXPECT_FALSE(contains(answer, "<p>")) << lines;
  }

  Feed feed;
  std::thread server;
  std::atomic<bool> is_over{false};
  ServedUrl at;
};

TEST_F(PageServer, ServesItsPageToWhoHasItsAddress) {
  const std::string page = get("/");
  EXPECT_TRUE(contains(page, "200 OK")) << page;
  EXPECT_TRUE(contains(page, "<p>events?" + at.query + "&from=0</p>")) << page;
  for (const char* const header :
       {"Cache-Control: no-store", "Referrer-Policy: no-referrer", "X-Frame-Options: DENY",
        "X-Content-Type-Options: nosniff", "Connection: close"}) {
    EXPECT_TRUE(contains(page, header)) << header;
  }
  std::string named = head("/", "\r\nOrigin: http://localhost:" + std::to_string(at.port));
  named.replace(named.find("127.0.0.1"), 9, "localhost");
  EXPECT_TRUE(contains(answer_to(at.port, named), "<p>"));
  const std::string alone = answer_to(at.port, "HEAD" + head("/").substr(3));
  EXPECT_TRUE(contains(alone, "200 OK"));
  EXPECT_TRUE(contains(alone, "Content-Length: "));
  EXPECT_FALSE(contains(alone, "<p>"));
}

TEST_F(PageServer, RefusesWhoIsNotMeant) {
  const std::string good = " HTTP/1.1\r\nHost: " + at.host;
  const std::string port = ':' + std::to_string(at.port);
  refused(403, "GET /" + good);
  refused(403, "GET /?token=" + good);
  refused(403, "GET /?token=0123456789abcdef0123456789abcdef" + good);
  refused(403, "GET /?" + at.query + "0" + good);
  refused(403, "GET /events" + good);
  const std::string query = "GET /?" + at.query + " HTTP/1.1";
  refused(403, query);
  for (const std::string& host :
       {"evil.example" + port, std::string("127.0.0.1"), "127.0.0.1.evil.example" + port,
        "10.0.0.1" + port, std::string("127.0.0.1:1")}) {
    refused(403, query + "\r\nHost: " + host);
  }
  refused(403, query + "\r\nHost: " + at.host + "\r\nHost: evil.example");
  for (const char* const origin : {"http://evil.example", "null", "https://127.0.0.1", ""}) {
    refused(403, head("/", std::string("\r\nOrigin: ") + origin));
    refused(403, head("/events", std::string("\r\nOrigin: ") + origin));
  }
}

TEST_F(PageServer, OnlyReadsAndServesNoFile) {
  for (const char* const method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"}) {
    refused(405, method + head("/").substr(3));
  }
  const std::string body(300000, 'b');
  const std::string posted = answer_to(
      at.port, "POST" + head("/").substr(3) + "\r\nContent-Length: 300004\r\n\r\n" + body);
  EXPECT_TRUE(contains(posted, "405 Method Not Allowed")) << posted;
  EXPECT_TRUE(contains(posted, "Allow: GET, HEAD")) << posted;
  for (const char* const path : {"/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd",
                                 "/events/", "/job.json", "http://evil.example/", "/\\..\\job"}) {
    refused(404, head(path));
  }
}

TEST_F(PageServer, RefusesWhatIsNoRequestOfUsualSize) {
  const std::string rest = " HTTP/1.1\r\nHost: " + at.host;
  refused(431, "GET /?" + std::string(20000, 'q') + rest);
  refused(431, head("/", "\r\nX: " + std::string(20000, 'x')));
  std::string many;
  for (int i = 0; i < 3000; ++i) many += "\r\nX" + std::to_string(i) + ": 1";
  refused(431, head("/", many));
  for (const std::string& text :
       {std::string("\x16\x03\x01\x02"), std::string("nothing"), std::string("GET / FTP/1.0"),
        std::string("GET  /"), std::string(3000, '\0'), head("/", "\r\nno colon"),
        head("/", "\r\nContent-Length: -1")}) {
    refused(400, text);
  }
  HttpClient none(at.port);
  EXPECT_TRUE(contains(get("/"), "<p>"));
}

TEST_F(PageServer, HalfRequestsStopNobodyAndEnd) {
  std::vector<std::unique_ptr<HttpClient>> half;
  for (int i = 0; i < 300; ++i) {
    half.push_back(std::make_unique<HttpClient>(at.port));
    half.back()->send("GET / HTTP/1.1\r\nHost: " + at.host);
  }
  EXPECT_TRUE(contains(get("/"), "<p>"));
  half.back()->send("\r\nX: 1");
  for (const auto& client : half) EXPECT_EQ(client->all(), "") << "ends without an answer";
  EXPECT_TRUE(contains(get("/"), "<p>"));
}

TEST_F(PageServer, EventsFollowTheFeed) {
  HttpClient client(at.port), late(at.port), again(at.port);
  client.send(head("/events?from=0&steps=0") + "\r\n\r\n");
  client.until("event: state\ndata: {\"left_m3\": 3}\n\n");
  const std::string first = client.until("id: 0.2\ndata: x!\n\n");
  EXPECT_TRUE(contains(first, "Content-Type: text/event-stream")) << first;
  EXPECT_TRUE(contains(first, "event: step\nid: 0.1\ndata: x!\n\n")) << first;
  feed.wanted = 4;
  EXPECT_TRUE(contains(client.until("id: 0.4\n"), "id: 0.3\n"));
  late.send(head("/events?from=0&steps=3") + "\r\n\r\n");
  EXPECT_FALSE(contains(late.until("id: 0.4\n"), "id: 0.3\n")) << "has three";
  again.send(head("/events?from=0&steps=0", "\r\nLast-Event-ID: 0.3") + "\r\n\r\n");
  EXPECT_FALSE(contains(again.until("id: 0.4\n"), "id: 0.3\n")) << "had three";
  feed.wanted_edition = 1;
  EXPECT_TRUE(contains(client.until("event: reload"), "event: reload"));
  for (const char* const from : {"from=0&steps=0", "from=1&steps=99", "steps=0", "from=one"}) {
    HttpClient odd(at.port);
    odd.send(head(std::string("/events?") + from) + "\r\n\r\n");
    EXPECT_TRUE(contains(odd.until("event: reload"), "event: reload")) << from;
  }
}

TEST_F(PageServer, WhoReadsNothingStopsNobody) {
  end();
  is_over = false;
  feed.length = 1000000;
  feed.wanted = 30;  // more than sockets hold
  begin();
  std::vector<std::unique_ptr<HttpClient>> idle;
  for (int i = 0; i < 20; ++i) {
    idle.push_back(std::make_unique<HttpClient>(at.port));
    idle.back()->send(head("/events?from=0&steps=0") + "\r\n\r\n");
  }
  HttpClient client(at.port);
  client.send(head("/events?from=0&steps=0") + "\r\n\r\n");
  EXPECT_TRUE(contains(client.until("id: 0.30\n"), "id: 0.30\n"));
}

TEST_F(PageServer, TooManyStreamsAreRefused) {
  std::vector<std::unique_ptr<HttpClient>> all;
  for (int i = 0; i < 64; ++i) {
    all.push_back(std::make_unique<HttpClient>(at.port));
    all.back()->send(head("/events?from=0&steps=0") + "\r\n\r\n");
    all.back()->until("event: state");
  }
  EXPECT_TRUE(contains(get("/events?from=0&steps=0"), "503 Service Unavailable"));
  EXPECT_TRUE(contains(get("/"), "<p>"));
  all.pop_back();
  HttpClient next(at.port);
  while (true) {  // until the server has seen it go
    HttpClient again(at.port);
    again.send(head("/events?from=0&steps=0") + "\r\n\r\n");
    const std::string& answer = again.until("\r\n\r\n");
    if (contains(answer, "200 OK")) break;
    ASSERT_TRUE(contains(answer, "503")) << answer;
  }
}

TEST_F(PageServer, EndsWithItsClients) {
  HttpClient client(at.port), silent(at.port);
  client.send(head("/events?from=0&steps=0") + "\r\n\r\n");
  client.until("event: state");
  end();
  EXPECT_TRUE(contains(client.all(), "event: state"));
  EXPECT_EQ(silent.all(), "");
  EXPECT_THROW(HttpClient{at.port}, std::runtime_error);
}

TEST_F(PageServer, SaysWhereItCannotListen) {
  const std::string error = error_of([&] {
    tools::serve(feed, {"127.0.0.1", at.port}, {[] { return true; }, [](auto) {}});
  });
  EXPECT_TRUE(contains(error, "--serve: cannot listen at " + at.host)) << error;
}

TEST(ServeAddress, IsTheLoopbackUnlessAnotherIsNamed) {
  for (const char* const text : {"8080", ":8080", "localhost:8080", "127.0.0.1:8080"}) {
    EXPECT_EQ(tools::parse_serve(text).host, "127.0.0.1") << text;
    EXPECT_EQ(tools::parse_serve(text).port, 8080) << text;
  }
  EXPECT_EQ(tools::parse_serve("[::1]:80").host, "::1");
  EXPECT_EQ(tools::parse_serve("0.0.0.0:80").host, "0.0.0.0");
  for (const char* const text : {"", "port", "70000", "-1", "127.0.0.1", "example.com:80",
                                 "1.2.3:80", "127.0.0.1:80x", "[]:80", "80 "}) {
    const std::string error = error_of([&] { tools::parse_serve(text); });
    EXPECT_TRUE(contains(error, "is not PORT or ADDRESS:PORT")) << text;
  }
}

}  // namespace
}  // namespace excavplan::test
