// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <excavplan/ground/ascii_grid.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include <excavplan/base/ceilings.hpp>
#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/non_finite.hpp"
#include "base/read_double.hpp"
#include "base/text.hpp"
#include "ground/map_check.hpp"

namespace excavplan {
namespace {

constexpr std::uint64_t most_grid_bytes = std::uint64_t{1} << 30;  ///< of most_cells; ours

/// The words of a file, which blanks and ends of lines part.
class Words {
 public:
  Words(const std::string& file, std::string_view text) : file_(file), left_(text) { next(); }

  bool at_end() const { return word_.empty(); }
  /// The present word, in small letters.
  std::string small() const { return small_letters(word_); }
  bool is_number() const { return number_of(word_).has_value(); }
  /// The present word as a number, before the next one. @throws Error (bad_file)
  double number(std::string_view what) {
    const auto value = number_of(word_);
    if (!value) {
      refuse(std::string(what) + " is " + (at_end() ? "not there" : in_quotes(word_)) +
             ", must be a number");
    }
    next();
    return *value;
  }
  void next() {
    std::size_t begin = 0;
    for (; begin < left_.size() && is_blank(left_[begin]); ++begin) {
      if (left_[begin] == '\n') ++line_;
    }
    std::size_t end = begin;
    while (end < left_.size() && !is_blank(left_[end])) ++end;
    word_ = left_.substr(begin, end - begin);
    left_.remove_prefix(end);
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw Error(ErrorKind::bad_file, file_ + ": line " + std::to_string(line_) + ": " + why);
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  static std::optional<double> number_of(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    double value = 0.0;
    const char* const end = word.data() + word.size();
    const auto [behind, fault] = read_double(word.data(), end, value);
    if (word.empty() || fault != std::errc{} || behind != end) return std::nullopt;
    return value;
  }

  const std::string& file_;
  std::string_view left_;
  std::string_view word_;
  std::size_t line_ = 1;
};

/// A key of the head and what was said of it.
struct Key {
  const char* name;
  std::optional<double> value = {};
};

class Head {
 public:
  /// Reads all keys; the words then stand at the first value of a cell.
  explicit Head(Words& words) {
    while (!words.at_end() && !words.is_number()) {
      Key* const key = find(words.small());
      if (key == nullptr)
        words.refuse(in_quotes(words.small()) + " is no key of an ESRI ASCII grid");
      if (key->value) words.refuse(std::string(key->name) + " is there twice");
      words.next();
      key->value = words.number(key->name);
    }
    cols_ = count(words, "ncols");
    rows_ = count(words, "nrows");
    cell_ = in(words, "cellsize", 1e-6, 1e6);
    origin_ = {corner(words, "xllcorner", "xllcenter"), corner(words, "yllcorner", "yllcenter")};
  }

  HeightMap grid() const {
    HeightMap map;
    map.origin = origin_;
    map.cell_size = cell_;
    map.z.resize(rows_, cols_);
    return map;
  }
  double cells() const { return static_cast<double>(rows_) * static_cast<double>(cols_); }
  double nodata() { return find("nodata_value")->value.value_or(-9999.0); }

 private:
  Key* find(const std::string& name) {
    for (Key& key : keys_) {
      if (name == key.name) return &key;
    }
    return nullptr;
  }
  double in(const Words& words, const char* name, double lowest, double highest) {
    const auto& value = find(name)->value;
    if (!value) words.refuse(std::string(name) + " is missing in the head");
    if (!(*value >= lowest && *value <= highest)) {
      words.refuse(std::string(name) + " is " + number_text(*value) + ", must be in " +
                   plain_number(lowest) + " .. " + plain_number(highest));
    }
    return *value;
  }
  Eigen::Index count(const Words& words, const char* name) {
    const double value = in(words, name, 1.0, most_cells);
    if (value != std::floor(value)) {
      words.refuse(std::string(name) + " is " + number_text(value) + ", must be a whole number");
    }
    return static_cast<Eigen::Index>(value);
  }
  /// Of the lower left cell, which is placed by its corner or its centre.
  double corner(const Words& words, const char* by_corner, const char* by_centre) {
    constexpr double farthest = 1e9;  // [m]
    const bool has_corner = find(by_corner)->value.has_value();
    if (has_corner == find(by_centre)->value.has_value()) {
      words.refuse(std::string("the head must have either ") + by_corner + " or " + by_centre);
    }
    if (has_corner) return in(words, by_corner, -farthest, farthest);
    return in(words, by_centre, -farthest, farthest) - 0.5 * cell_;
  }

  std::array<Key, 8> keys_ = {{{"ncols"},
                               {"nrows"},
                               {"xllcorner"},
                               {"yllcorner"},
                               {"xllcenter"},
                               {"yllcenter"},
                               {"cellsize"},
                               {"nodata_value"}}};
  Eigen::Index rows_ = 0;
  Eigen::Index cols_ = 0;
  double cell_ = 0.0;
  Eigen::Vector2d origin_;
};

/// A huge NODATA may be written with fewer digits in one place than in another.
bool is_nodata(double value, double nodata) {
  constexpr double rounding = 1e-6;
  return std::isnan(value) || value == nodata ||
         (std::abs(nodata) > farthest_height &&
          std::abs(value - nodata) <= rounding * std::abs(nodata));
}

double value_of(Words& words, double nodata) {
  if (words.at_end()) words.refuse("the values end before the last cell");
  const double value = words.number("the value of a cell");
  if (is_nodata(value, nodata)) return nan;
  if (!(std::abs(value) <= farthest_height)) {
    words.refuse("the value of a cell is " + number_text(value) + ", must be in " +
                 plain_number(-farthest_height) + " .. " + plain_number(farthest_height) +
                 " or NODATA, " + number_text(nodata));
  }
  return value;
}

}  // namespace

HeightMap read_ascii_grid(const std::string& file) {
  const std::string text = read_file(file, most_grid_bytes);
  Words words(file, text);
  Head head(words);
  if (!(head.cells() <= most_cells && 2.0 * head.cells() <= static_cast<double>(text.size()))) {
    words.refuse("the head promises " + plain_number(head.cells()) +
                 " cells, which are more than " + plain_number(most_cells) +
                 " or than the file has room for");
  }
  HeightMap map = head.grid();
  const double nodata = head.nodata();
  for (Eigen::Index row = map.z.rows() - 1; row >= 0; --row) {
    for (Eigen::Index col = 0; col < map.z.cols(); ++col) map.z(row, col) = value_of(words, nodata);
  }
  if (!words.at_end()) {
    words.refuse(in_quotes(words.small()) + " follows the value of the last cell");
  }
  return map;
}

}  // namespace excavplan
