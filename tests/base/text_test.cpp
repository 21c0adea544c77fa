// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/text.hpp"

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <excavplan/base/error.hpp>
#include "base/random.hpp"

/// @file
/// What text of unknown origin becomes before it is shown.

namespace excavplan {
namespace {

using std::string;

TEST(SafeText, WhatATerminalObeysIsReplaced) {
  const auto safe = [](const string& text) { return safe_text(text, 100); };
  EXPECT_EQ(safe("loam, 40 % \xC3\xA4 \xE2\x82\xAC \xF0\x9F\x9A\x9C"),
            "loam, 40 % \xC3\xA4 \xE2\x82\xAC \xF0\x9F\x9A\x9C");
  EXPECT_EQ(safe("a\x1b[31mb\nc\td\x7f" + string(1, '\0') + "e"), "a?[31mb?c?d??e");
  EXPECT_EQ(safe("\xC2\x9B"
                 "2J"),
            "?2J")
      << "C1, which some terminals take for an escape";
  for (const char* turning : {"\xE2\x80\xAE", "\xE2\x80\xAA", "\xE2\x81\xA6", "\xE2\x81\xA9",
                              "\xE2\x80\x8E", "\xE2\x80\x8F", "\xD8\x9C", "\xE2\x80\xA8"}) {
    EXPECT_EQ(safe(string("a") + turning + "b"), "a?b");
  }
  EXPECT_EQ(safe("\xE2\x80\xAF"), "\xE2\x80\xAF") << "a narrow blank";
}

TEST(SafeText, BytesThatAreNotUtf8AreReplacedOneByOne) {
  const auto safe = [](const string& text) { return safe_text(text, 100); };
  EXPECT_EQ(safe("a\xff"
                 "b\x80"),
            "a?b?");
  EXPECT_EQ(safe("\xC0\xAF"), "??") << "longer than it need be";
  EXPECT_EQ(safe("\xED\xA0\x80"), "???") << "a surrogate";
  EXPECT_EQ(safe("\xF4\x90\x80\x80"), "????") << "beyond U+10FFFF";
  EXPECT_EQ(safe("\xE2\x82"), "??") << "cut short";
}

TEST(SafeText, LongTextsLoseTheirMiddle) {
  const string text = "begin" + string(100000, '-') + "end";
  const string cut = safe_text(text, 200);
  EXPECT_EQ(cut.size(), 200U);
  EXPECT_EQ(cut.substr(0, 6), "begin-");
  EXPECT_EQ(cut.substr(196), "-end");
  EXPECT_NE(cut.find(" ... "), string::npos);
  EXPECT_EQ(safe_text(text, text.size()), text);
  string umlauts;
  for (int i = 0; i < 1000; ++i) umlauts += "\xC3\xA4";
  for (std::size_t most = 20; most < 30; ++most) {
    const string part = safe_text(umlauts, most);
    EXPECT_LE(part.size(), most);
    EXPECT_FALSE(first_not_utf8(part));
  }
}

TEST(CsvField, DoublesItsQuotes) { EXPECT_EQ(csv_field("a \"b\", c"), "\"a \"\"b\"\", c\""); }

TEST(SafeText, QuotedShowsTheBeginning) {
  EXPECT_EQ(in_quotes("a\nb"), "'a?b'");
  EXPECT_EQ(in_quotes(string(40, 'a')), "'" + string(40, 'a') + "'");
  EXPECT_EQ(in_quotes(string(41, 'a')), "'" + string(40, 'a') + "...'");
  EXPECT_EQ(in_quotes(string(39, 'a') + "\xC3\xA4 and more"), "'" + string(39, 'a') + "...'");
}

TEST(SafeText, ErrorsAreShortAndSafe) {
  const Error error(ErrorKind::bad_file, "file: \x1b]0;x\a" + string(5000, 'k') + ": the reason");
  const string text = error.what();
  EXPECT_EQ(text.size(), Error::longest_message);
  EXPECT_EQ(text.rfind("file: ?]0;x?kkk", 0), 0U);
  EXPECT_EQ(text.substr(text.size() - 12), ": the reason");
}

/// nlohmann's writer decodes by another method, and refuses what is not UTF-8.
bool is_utf8(const string& text) {
  try {
    nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

TEST(SafeText, Utf8IsWhatAnotherDecoderSays) {
  Random random(8);
  const string likely = "a\x7f\x80\x8f\x90\x9f\xa0\xbf\xc0\xc2\xdf\xe0\xed\xef\xf0\xf4\xf5\xff";
  for (int i = 0; i < 20000; ++i) {
    string text;
    for (auto size = 1 + random.index(5); size > 0; --size) {
      text += likely[random.index(likely.size())];
    }
    ASSERT_EQ(!first_not_utf8(text), is_utf8(text));
    ASSERT_TRUE(is_utf8(safe_text(text, 100)));
    ASSERT_TRUE(is_utf8(in_quotes(text)));
  }
}

TEST(Readable, LongNumbersHaveAnExponent) {
  EXPECT_EQ(readable(999e12), "999000000000000");
  EXPECT_EQ(readable(1.234e15), "1.23e+15");
  EXPECT_EQ(readable(-1e308, 2), "-1.0e+308");
  EXPECT_EQ(readable(0.4, 1e308), "0.400 ± 1.0e+308");
}

TEST(NearestWord, OfAWordOfAnyLengthIsNoneAtOnce) {
  const std::vector<string> words(100, string(256, 'x'));
  EXPECT_EQ(nearest_word(string(256, 'x'), words), words.front());
  EXPECT_EQ(nearest_word(string(10000000, 'x'), words), std::nullopt);
}

TEST(SmallLetters, OnlyThoseOfAsciiChange) {
  EXPECT_EQ(small_letters("Az[@`{ \xC3\x84Z9"), "az[@`{ \xC3\x84z9");
}

}  // namespace
}  // namespace excavplan
