// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "base/table.hpp"

#include <gtest/gtest.h>

#include <excavplan/error.hpp>

#include "support/errors.hpp"
#include "support/run_program.hpp"

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
  EXPECT_EQ(refusal("k,d\n1,2\n\n1,x\n"), "t.csv: line 4: d is 'x', expected a number");
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
  EXPECT_EQ(refusal("k,d\n1,x\xff\n"), "t.csv: line 2: d is 'x?', expected a number");
  EXPECT_EQ(refusal("a\xff,a\xff\n"), "t.csv: line 1: column 'a?' appears twice");
  const std::string huge(10000000, 'k');
  for (const std::string& content :
       {huge + "\n1\n", "k\n" + huge, huge + "," + huge, "a," + huge + "\n1,x"}) {
    EXPECT_LE(refusal(content).size(), Error::longest_message);
  }
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
