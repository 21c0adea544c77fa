// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/yaml.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>
#include "base/random.hpp"

#include "support/errors.hpp"

namespace excavplan {
namespace {

using nlohmann::json;
using std::string;

json parsed(const string& text) { return parse_yaml("a.yaml", text); }
json as_json(const string& text) { return json::parse(text); }

// The expected values are what the same text means in JSON.

TEST(Yaml, MapsAndListsInBlocks) {
  EXPECT_EQ(parsed("a: 1\nb:\n  c: -2.5e-3\n  d:\n    e: x y\nf: true\n"),
            as_json(R"({"a": 1, "b": {"c": -2.5e-3, "d": {"e": "x y"}}, "f": true})"));
  EXPECT_EQ(parsed("k:\n- 1\n- 2.5\n- +3\nnext: ~\n"),
            as_json(R"({"k": [1, 2.5, 3], "next": null})"));
  EXPECT_EQ(parsed("k:\n  - a: 1\n    b: 2\n  -\n    a: 3\n  - - 4\n    - 5\n"),
            as_json(R"({"k": [{"a": 1, "b": 2}, {"a": 3}, [4, 5]]})"));
  EXPECT_EQ(parsed("- 1\n- {a: 2}\n"), as_json(R"([1, {"a": 2}])"));
}

TEST(Yaml, MapsAndListsInBrackets) {
  EXPECT_EQ(parsed("k: [1, 2,3 ]\nm: {a: 1, b: [x, 'y, z']}\ne: []\nn: {}\n"),
            as_json(R"({"k": [1, 2, 3], "m": {"a": 1, "b": ["x", "y, z"]}, "e": [], "n": {}})"));
  EXPECT_EQ(parsed("D: [0.015, -0.043,\n-0.001, 0.008]\nK: [\n  1,\n    2 # two\n  ]\nend: 1\n"),
            as_json(R"({"D": [0.015, -0.043, -0.001, 0.008], "K": [1, 2], "end": 1})"));
}

TEST(Yaml, TextsCommentsTagsAndMarks) {
  EXPECT_EQ(parsed("%YAML:1.0\n---\n# c\na: \"x: # y\"  # c\r\nb: it's # c\n'c d': ''\n---\n"),
            as_json(R"({"a": "x: # y", "b": "it's", "c d": ""})"));
  EXPECT_EQ(parsed("m: !!opencv-matrix\n   rows: 1\n   data: [ 5. ]\n"),
            as_json(R"({"m": {"rows": 1, "data": [5]}})"));
  EXPECT_EQ(parsed("at: 12:30\nurl: http://x\n"), as_json(R"({"at": "12:30", "url": "http://x"})"));
  EXPECT_EQ(parsed("42"), as_json("42"));
}

TEST(Yaml, TheRestIsRefusedWithItsLine) {
  const auto error = [](const string& text) {
    return test::error_about([&] { parsed(text); }, "a.yaml");
  };
  EXPECT_EQ(error(""), "line 1: found '', expected a YAML document");
  EXPECT_EQ(error("a: 1\n---\na: 2\n"),
            "line 3: found 'a: 2', expected the end of the file after one document");
  EXPECT_EQ(error("a: 1\na: 2\n"), "line 2: found 'a: 2', expected every key once");
  EXPECT_EQ(error("{a: 1, a: 2}"), "line 1: found 'a', expected every key once");
  EXPECT_EQ(error("a: 1\nb\n"), "line 2: found 'b', expected a key and a colon");
  EXPECT_EQ(error("a: 1\n  b: 2\n"),
            "line 2: found 'b: 2', expected it indented as the lines "
            "before");
  EXPECT_EQ(error("a:\n\tb: 2\n"), "line 2: found 'a tab', expected spaces before the text");
  EXPECT_EQ(error("a: [1, 2\nb: 3\n"), "line 1: found '[1, 2', expected its closing bracket");
  EXPECT_EQ(error("a: [1 2] 3\n"), "line 1: found ' 3', expected nothing behind the bracket");
  EXPECT_EQ(error("a: [1, {b}]\n"), "line 1: found '}]', expected a colon behind a key");
  EXPECT_EQ(error("a: &x 1\n").substr(0, 42), "line 1: found '&x 1', expected plain YAML ");
  EXPECT_EQ(error("a: *x\n").substr(0, 19), "line 1: found '*x',");
  EXPECT_EQ(error("a: |\n  text\n").substr(0, 18), "line 1: found '|',");
  EXPECT_EQ(error("a: \"x\n").substr(0, 21), "line 1: found '\"x', e");
  EXPECT_EQ(error("a: 1\nb: \x1F\n"),
            "line 2: found 'b: ?', expected a text without control characters");
  EXPECT_NE(error(string(1, '\0')).find("without control characters"), string::npos);
  EXPECT_NE(error(string(100, '[') + string(100, ']')).find("expected at most 64 levels"),
            string::npos);
  string deep;
  for (std::size_t i = 0; i < 100; ++i) deep += string(i, ' ') + "a:\n";
  EXPECT_NE(error(deep + string(100, ' ') + "b: 1").find("expected at most 64 levels"),
            string::npos);
  string dashes;
  for (int i = 0; i < 100; ++i) dashes += "- ";
  EXPECT_NE(error(dashes + "1").find("expected at most 64 levels"), string::npos);
}

TEST(Yaml, AMegabyteOfAnythingEnds) {
  const std::size_t size = std::size_t{1} << 20;
  for (const string piece : {"[", "a: [\n", "- ", "-\n", "a:\n", "'", "\n", "{a: ", "1,\n", "#"}) {
    string text;
    while (text.size() < size) text += piece;
    EXPECT_NO_FATAL_FAILURE(test::error_about([&] { parsed(text); }, "a.yaml"));
    EXPECT_NO_FATAL_FAILURE(test::error_about([&] { parsed("k: [" + text); }, "a.yaml"));
  }
}

TEST(Yaml, MutationsAreReadOrRefusedButNeverCrash) {
  const std::vector<string> seeds = {
      "transforms:\n- header:\n    frame_id: map\n  transform:\n    translation:\n      x: 1.0\n",
      "k: [1, 2,\n 3]\nm: {a: 'b', c: [\"d\"]}\n---\n", "%YAML:1.0\na: !!t\n  - - x\n    - y\n"};
  Random random(3);
  const string alphabet = "[]{}:,-#'\"!&*|> \n\t%.ax1\\\xff";
  for (const string& seed : seeds) {
    for (int i = 0; i < 5000; ++i) {
      string text = seed;
      for (auto changes = 1 + random.index(5); changes > 0 && !text.empty(); --changes) {
        const std::size_t at = random.index(text.size());
        const char c = alphabet[random.index(alphabet.size())];
        switch (random.index(3)) {
          case 0:
            text[at] = c;
            break;
          case 1:
            text.insert(at, 1, c);
            break;
          default:
            text.erase(at, 1 + random.index(4));
        }
      }
      try {
        parsed(text);
      } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::bad_file);
      }
    }
  }
}

}  // namespace
}  // namespace excavplan
