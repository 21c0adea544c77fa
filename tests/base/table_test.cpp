// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/table.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include <excavplan/base/error.hpp>

#include "support/errors.hpp"
#include "support/run_program.hpp"
#include "support/utf16.hpp"

namespace excavplan {
namespace {

using test::error_of;
using test::TemporaryFolder;

Table table_of(const std::string& content) {
  const TemporaryFolder folder;
  return Table::read(folder.write("t.csv", content));
}

/// What is said of such a file, without the folder it lies in.
std::string refusal(const std::string& content) {
  const TemporaryFolder folder;
  const std::string path = folder.write("t.csv", content);
  const std::string message = error_of([&] { Table::read(path).column("k"); }, ErrorKind::bad_file);
  return message.rfind(path, 0) == 0 ? "t.csv" + message.substr(path.size()) : message;
}

using Column = std::vector<double>;

TEST(Table, ColumnsAreFoundByName) {
  const Table table = table_of("k,density_percent\n1.2,40\n-1e-3,50.5\n");
  EXPECT_EQ(table.names(), (std::vector<std::string>{"k", "density_percent"}));
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.column("k"), (Column{1.2, -1e-3}));
  EXPECT_EQ(table.column("density_percent"), (Column{40.0, 50.5}));
  EXPECT_TRUE(table.has("k"));
  EXPECT_FALSE(table.has("K"));
}

TEST(Table, BlanksQuotesCommentsAndLineEndsOfOtherSystemsDoNotMatter) {
  const Table table = table_of("# made by hand\r\n\"k\" , d\r\n\r\n 1 ,\t2 # first\r\n3,4");
  EXPECT_EQ(table.column("k"), (Column{1.0, 3.0}));
  EXPECT_EQ(table.column("d"), (Column{2.0, 4.0}));
}

TEST(Table, BadRowsAreNamedByLineAndColumn) {
  EXPECT_EQ(refusal("d,k\n1,2\n\n1,x\n"), "t.csv: line 4: k is 'x', expected a number");
  EXPECT_EQ(refusal("k,d\n1,2\n1\n"), "t.csv: line 3: found 1 fields, expected 2");
  EXPECT_EQ(refusal("k,d\n1,2,\n"), "t.csv: line 2: found 3 fields, expected 2");
  EXPECT_EQ(refusal("d\n1\n"), "t.csv: has no column 'k', its columns are: d");
}

TEST(Table, OnlyWholeFiniteNumbersAreNumbers) {
  for (const char* word : {"nan", "inf", "1e999", "0x10", "1 2", "1m", "", "--1", "1.2.3"}) {
    EXPECT_EQ(refusal(std::string("k,d\n") + word + ",1\n"),
              std::string("t.csv: line 2: k is '") + word + "', expected a number");
  }
}

TEST(Table, FilesWithoutRowsAreRefused) {
  for (const char* content : {"", "\n\n", "# only a comment\n", "k,d\n"}) {
    EXPECT_EQ(refusal(content), "t.csv: expected a line of column names and lines of numbers");
  }
  EXPECT_EQ(error_of([] { Table::read("/no/such.csv"); }, ErrorKind::bad_file),
            "/no/such.csv: cannot be opened: No such file or directory");
}

TEST(Table, WhatAFileHoldsIsShownShortAndSafe) {
  EXPECT_EQ(refusal("k,d\x1b[2J\n1,2\n"), "t.csv: line 1: found a control character");
  EXPECT_EQ(refusal("d,k\n1,x\xff\n"), "t.csv: line 2: k is 'x?', expected a number");
  EXPECT_EQ(refusal("a\xff,a\xff\n"), "t.csv: line 1: column 'a?' appears twice");
  const std::string huge(10000000, 'k');
  for (const std::string& content :
       {huge + "\n1\n", "k\n" + huge, huge + "," + huge, "a," + huge + "\n1,x"}) {
    EXPECT_LE(refusal(content).size(), Error::longest_message);
  }
}

// ---- What spreadsheets and loggers write ------------------------------------------------------

TEST(Table, EveryDialectReadsTheSame) {
  const std::string plain = "k,note,d\n1.25,a,40\n-3,b,0.5\n";
  const std::string semicolons = "k;note;d\n1,25;a;40\n-3;b;0,5\n";
  const std::vector<std::pair<const char*, std::string>> dialects = {
      {"comma", plain},
      {"semicolon", "k;note;d\n1.25;a;40\n-3;b;0.5\n"},
      {"tab", "k\tnote\td\n1.25\ta\t40\n-3\tb\t0.5\n"},
      {"bar", "k|note|d\n1.25|a|40\n-3|b|0.5\n"},
      {"decimal comma", semicolons},
      {"decimal comma in quotes", "k,note,d\n\"1,25\",a,40\n-3,b,\"0,5\"\n"},
      {"tabs and decimal comma", "k\tnote\td\n1,25\ta\t40\n-3\tb\t0,5\n"},
      {"byte order mark", "\xEF\xBB\xBF" + plain},
      {"UTF-16 LE", test::utf16(plain, false, true)},
      {"UTF-16 BE", test::utf16(semicolons, true, true)},
      {"UTF-16 without mark", test::utf16(plain, false, false)},
      {"CRLF", "k,note,d\r\n1.25,a,40\r\n-3,b,0.5\r\n"},
      {"CR", "k,note,d\r1.25,a,40\r-3,b,0.5"},
      {"quotes", "\"k\",\"note\",\"d\"\n\"1.25\",\"a\",\"40\"\n\"-3\",\"b\",\"0.5\"\n"},
      {"sep=", "sep=;\r\nk;note;d\r\n1,25;a;40\r\n-3;b;0,5\r\n"},
      {"plus signs", "k,note,d\n+1.25,a,+40\n-3,b,0.5\n"},
      {"columns and rows without content", "k,note,d,,\n1.25,a,40,,\n,,,,\n-3,b,0.5,,\n,,,,\n"},
  };
  for (const auto& [name, content] : dialects) {
    SCOPED_TRACE(name);
    const Table table = table_of(content);
    EXPECT_EQ(table.column("k"), (Column{1.25, -3.0}));
    EXPECT_EQ(table.column("d"), (Column{40.0, 0.5}));
    EXPECT_EQ(table.texts("note"), (std::vector<std::string>{"a", "b"}));
  }
}

TEST(Table, TextsKeepDelimitersQuotesAndLineEndsInQuotes) {
  const Table table = table_of("k,note\n1,\"a, \"\"b\"\"\n c\"\n2,5\" d # e\n");
  EXPECT_EQ(table.texts("note"), (std::vector<std::string>{"a, \"b\"\n c", "5\" d"}));
  EXPECT_EQ(table.line(1), 4U);
}

TEST(Table, ATextIsRefusedOnlyWhereANumberIsNeeded) {
  const Table table = table_of("k,d\n1,2\n2,\n3,x\n");
  EXPECT_EQ(table.column("k"), (Column{1.0, 2.0, 3.0}));
  EXPECT_EQ(refusal("d,k\n1,2\n2,\n3,x\n"), "t.csv: line 3: k is '', expected a number");
}

TEST(Table, WhatCanBeReadInTwoWaysIsRefusedUnlessItIsStated) {
  const std::string thousands = "k;d\n1,234;1\n2,345;2\n";
  EXPECT_EQ(refusal(thousands),
            "t.csv: line 2: k is '1,234', which may be a decimal or thousands: state the decimal "
            "mark");
  EXPECT_EQ(refusal("k;d\n1.234;1\n"),
            "t.csv: line 2: k is '1.234', which may be a decimal or thousands: state the decimal "
            "mark");
  for (const char* beside : {"10:00:00,5", "23.11.2026 10:00:00", "23.11.2026"}) {
    const Table settled = table_of("k;t\n1,234;" + std::string(beside) + "\n");
    EXPECT_EQ(settled.column("k")[0], 1.234) << beside;
  }
  EXPECT_EQ(table_of("k;t\n1.234;10:00:00.5\n").column("k")[0], 1.234);
  EXPECT_EQ(table_of("k;t\n2.5;10:00:00,5\n").column("k")[0], 2.5);
  EXPECT_EQ(refusal("k;d\n1,5;1\n2;2.5\n"),
            "t.csv: line 2: k is '1,5', but line 3: d is '2.5': state the decimal mark");
  EXPECT_EQ(refusal("k,e;d\n1,2;3\n"), "t.csv: has no column 'k', its columns are: k,e, d");
  const TemporaryFolder folder;
  const std::string path = folder.write("t.csv", thousands);
  EXPECT_EQ(Table::read(path, {{}, ','}).column("k"), (Column{1.234, 2.345}));
  EXPECT_EQ(error_of(
                [&] {
                  Table::read(path, {{}, '.'}).column("k");
                },
                ErrorKind::bad_file),
            path + ": line 2: k is '1,234', expected a number");
  EXPECT_EQ(Table::read(path, {{}, '.'}).column("d"), (Column{1.0, 2.0}));
}

TEST(Table, AProvenMarkDecidesTheRest) {
  EXPECT_EQ(table_of("k;d\n1,234;0,5\n").column("k"), (Column{1.234}));
  EXPECT_EQ(table_of("k;d\n0,123;1,234\n").column("d"), (Column{1.234}));
  EXPECT_EQ(table_of("k,d\n1.234,5\n").column("k"), (Column{1.234}));
  EXPECT_EQ(refusal("k;d\n1.234,5;0,5\n"), "t.csv: line 2: k is '1.234,5', expected a number");
  EXPECT_EQ(refusal("k;d\n1,234;0.5\n"), "t.csv: line 2: k is '1,234', expected a number");
}

TEST(Table, BrokenTextIsRefusedWithItsLine) {
  EXPECT_EQ(refusal("k,d\n1,\"2\n"), "t.csv: line 2: a quote is not closed");
  EXPECT_EQ(refusal("k,d\n\"1\"2,3\n"), "t.csv: line 2: found text behind the quotes of '1'");
  EXPECT_EQ(refusal("1,2\n3,4\n"), "t.csv: line 1: found numbers, expected names of columns");
  EXPECT_EQ(refusal("\xFF\xFE" + test::utf16("k,d\n1,2\n", true, false)),
            "t.csv: line 1: UTF-16 whose bytes are in the other order than its mark states");
  EXPECT_EQ(refusal("\xFE\xFF" + test::utf16("k,d\n1,2\n", false, false)),
            "t.csv: line 1: UTF-16 whose bytes are in the other order than its mark states");
  EXPECT_EQ(refusal(test::utf16("k,d\n1,2\n", false, true) + "x"),
            "t.csv: line 3: UTF-16 ends in half a character");
  EXPECT_EQ(refusal(test::utf16("k,d\n1,2\n", false, true) + std::string("\x00\xD8", 2)),
            "t.csv: line 3: UTF-16 with half a pair of characters");
  EXPECT_EQ(refusal(std::string("k,d\n1,\0\n", 8)), "t.csv: line 2: found a control character");
}

TEST(Table, MoreThan1000ColumnsAreRefused) {
  std::string names = "k";
  for (int i = 1; i < 1000; ++i) names += ",c" + std::to_string(i);
  EXPECT_EQ(refusal(names + "\n1\n"), "t.csv: line 2: found 1 fields, expected 1000");
  EXPECT_EQ(refusal(names + ",more\n"),
            "t.csv: line 1: found more than 1000 columns, expected at most that");
  EXPECT_EQ(refusal("k" + std::string(10000000, ',') + "\n"),
            "t.csv: line 1: found more than 1000 columns, expected at most that");
}

}  // namespace
}  // namespace excavplan
