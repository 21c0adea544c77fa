// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/json.hpp"

#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>

#include "support/errors.hpp"

/// @file
/// JSON from anywhere, which may be deep, wide, double or no text at all.

namespace excavplan {
namespace {

using nlohmann::json;
using std::string;

string error(const string& text) {
  return test::error_about([&] { parse_json("a.json", text); }, "a.json");
}

string repeated(const string& piece, std::size_t times) {
  string text;
  for (std::size_t i = 0; i < times; ++i) text += piece;
  return text;
}

string nested(std::size_t levels) { return string(levels, '[') + string(levels, ']'); }

TEST(Json, ValuesAreThoseOfTheText) {
  for (const char* text :
       {"1", "-2.5e-3", "18446744073709551615", "true", "null", "\"a\\u00e4\\n\"", "[]", "{}",
        R"({"a": [1, {"b": [[], {}, "c"]}, 2], "d": {"e": {"f": null}}, "g": [{}, {"h": 1}]})"}) {
    EXPECT_EQ(parse_json("a.json", text), json::parse(text)) << text;
  }
  EXPECT_EQ(parse_ordered_json("a.json", R"({"z": {"y": 1, "b": [2, 3]}, "a": 1})").dump(),
            R"({"z":{"y":1,"b":[2,3]},"a":1})");
}

TEST(Json, MoreThan64LevelsAreRefusedHoweverMany) {
  const string expected = "found more than 64 levels of arrays and objects, expected at most that";
  EXPECT_EQ(parse_json("a.json", nested(64)), json::parse(nested(64)));
  for (const std::size_t levels : {65U, 75000U, 1000000U}) {
    EXPECT_EQ(error(nested(levels)), expected);
    EXPECT_EQ(error(repeated("{\"a\":", levels)), expected);
    EXPECT_EQ(error(string(levels, '[')), expected);
  }
}

TEST(Json, ManyValuesSideBySideAreRead) {
  const std::size_t count = 200000;  // their square is out of reach
  const json objects = parse_json("a.json", "[" + repeated("{},", count) + "{}]");
  EXPECT_EQ(objects.size(), count + 1);
  EXPECT_EQ(parse_json("a.json", "[" + repeated("[1],", count) + "2]").back(), 2);
  string keys = "{";
  for (std::size_t i = 0; i < count; ++i) keys += "\"k" + std::to_string(i) + "\":[],";
  EXPECT_EQ(parse_json("a.json", keys + "\"last\":1}").size(), count + 1);
}

TEST(Json, MoreThanHalfAMillionValuesAreRefused) {
  const auto list = [](std::size_t values) { return "[" + repeated("1,", values - 2) + "1]"; };
  EXPECT_EQ(parse_json("a.json", list(500000)).size(), 499999U);
  EXPECT_EQ(error(list(500001)), "found more than 500000 values, expected at most that");
  EXPECT_EQ(parse_json("a.json", list(600000), 600000).size(), 599999U);
}

TEST(Json, AKeyThatAppearsTwiceIsRefusedWhereverItStands) {
  for (const char* text : {R"({"a": 40, "b": 1, "a": 80})", R"([1, {"c": {"a": 1, "a": 1}}])",
                           R"({"a": {"a": 1}, "a": 2})", R"({"a": 1, "\u0061": 2})"}) {
    EXPECT_EQ(error(text), "key 'a' appears twice") << text;
  }
  EXPECT_EQ(error(R"({"a": {"b": 1}, "c": {"b": 1}})"), "no error");
}

TEST(Json, TextThatIsNotUtf8IsRefusedWithItsByte) {
  EXPECT_EQ(error("{\"name\": \"lo\xff\"}"), "byte 12: found 0xFF, expected UTF-8");
  EXPECT_EQ(error("\xff\xfe{"), "byte 0: found 0xFF, expected UTF-8");
  EXPECT_EQ(test::error_about([] { JsonObject::of_others("a.yaml", "a: \xC3\x28\n"); }, "a.yaml"),
            "byte 3: found 0xC3, expected UTF-8");
}

TEST(Json, WhatIsNoJsonIsRefused) {
  for (const string text : {"", " ", "{", "[1,]", "{\"a\"}", "1 2", "nul", "1e999", "\"\\ud800\"",
                            "{\"a\": 1}}", "[1] x"}) {
    EXPECT_EQ(error(text).rfind("not valid JSON: ", 0), 0U) << text << ": " << error(text);
  }
}

TEST(Json, MessagesStayShortAndSafe) {
  const string huge(10000000, 'k');
  const auto is_short = [](const string& text) {
    return text != "no error" && text.size() <= Error::longest_message &&
           text.find('\x1b') == text.npos && text.find('\n') == text.npos;
  };
  EXPECT_TRUE(is_short(error("{\"" + huge + "\": 1, \"" + huge + "\": 2}")));
  EXPECT_TRUE(is_short(error("{\"" + huge)));
  EXPECT_TRUE(is_short(error(huge)));
  const auto refusal = [](const string& content, const std::function<void(JsonObject&)>& read) {
    JsonObject object = JsonObject::of_others("a.json", content);
    return test::error_about([&] { read(object); }, "a.json");
  };
  const auto done = [](JsonObject& object) { object.done(); };
  EXPECT_TRUE(is_short(refusal("{\"" + huge + "\": 1}", done)));
  EXPECT_EQ(refusal(R"({"a\u001b[2J\nb": 1})", done), "a?[2J?b: is not a key of this file");
  const auto number = [](JsonObject& object) { object.number("a"); };
  EXPECT_TRUE(is_short(refusal("{\"a\": \"" + huge + "\"}", number)));
  EXPECT_EQ(refusal(R"({"a": "b\u202ec"})", number), "a: is \"b?c\", expected a number");
}

TEST(Json, NamesAreOnOneLineAndOfBoundedLength) {
  const auto text_of = [](const string& content) {
    return test::error_about([&] { JsonObject::of_others("a.json", content).text("a"); }, "a.json");
  };
  EXPECT_EQ(text_of(R"({"a": "Kanto loam, \u00e4"})"), "no error");
  EXPECT_EQ(text_of(R"({"a": "x\u001b]0;y\u0007"})"),
            "a: is 'x?]0;y?', expected a text on one line without control characters");
  EXPECT_EQ(text_of("{\"a\": \"" + string(1001, 'x') + "\"}"),
            "a: is a text of 1001 bytes, expected at most 1000");
}

TEST(Json, TextThatIsNotUtf8IsNotWritten) {
  EXPECT_EQ(json_text({{"name", "loam"}}), R"({"name":"loam"})");
  EXPECT_EQ(
      test::error_of([] {
        json_text({{"name", "lo\xff"}});
      }),
      "a name or another text in a file to write is not UTF-8: {\"name\":\"lo\xEF\xBF\xBD\"}");
}

TEST(Json, WhatIsToBeWrittenCanBeReadAgain) {
  const auto refusal = [](const nlohmann::ordered_json& value) {
    return test::error_of([&] { require_storable({{"name", value}}, "law"); });
  };
  const string fault = ", expected a text on one line without control characters";
  EXPECT_EQ(refusal("Kanto loam, \u00e4"), "no error");
  EXPECT_EQ(refusal(string(1000, 'x')), "no error");
  EXPECT_EQ(refusal("zx\n120"), "law: '/name' is 'zx?120'" + fault);
  EXPECT_EQ(refusal("zx\u202e120"), "law: '/name' is 'zx?120'" + fault);
  EXPECT_EQ(refusal(string(1001, 'x')),
            "law: '/name' is a text of 1001 bytes, expected at most 1000");
  EXPECT_EQ(refusal("lo\xff"), "law: '/name' is not UTF-8");
  EXPECT_EQ(refusal(std::nan("")), "law: '/name' is nan, must be finite");
}

TEST(Json, PartsOutliveTheWhole) {
  JsonObject part = JsonObject::of_others("a.json", R"({"a": {"b": [{"c": 3}]}})").object("a");
  EXPECT_EQ(part.objects("b").front().number("c"), 3.0);
}

}  // namespace
}  // namespace excavplan
