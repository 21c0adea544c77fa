// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <cctype>
#include <cstring>
#include <fstream>

#include <excavplan/base/error.hpp>

#include "base/files.hpp"
#include "base/json.hpp"
#include "base/statistics.hpp"
#include "base/table.hpp"
#include "base/text.hpp"
#include "base/yaml.hpp"
#include "support/cases.hpp"
#include "support/run_program.hpp"

namespace excavplan::test {
namespace {

TEST(TextProperties, NumbersReadBackBitByBit) {
  for_cases([](Random& random) {
    const double value = drawn_number(random);
    const double read = std::strtod(number_text(value).c_str(), nullptr);
    EXPECT_EQ(std::memcmp(&read, &value, sizeof value), 0) << number_text(value);
  });
}

TEST(TextProperties, DecimalsAreTheNearest) {
  for_cases([](Random& random) {
    const double value = random.uniform(-1e6, 1e6);
    const int digits = drawn_int(random, 0, 6);
    const double unit = std::pow(10.0, -digits);
    EXPECT_LE(std::abs(std::stod(decimals(value, digits)) - value), 0.5 * unit + 1e-9);
  });
}

TEST(TextProperties, ReadableNumbersKeepTheirDigits) {
  for_cases([](Random& random) {
    const double size = std::pow(10.0, random.uniform(-8.0, 8.0));
    const double value = random.uniform() < 0.5 ? -size : size;
    const int digits = drawn_int(random, 1, 5);
    const std::string text = readable(value, digits);
    EXPECT_EQ(text.find_first_not_of("-0123456789."), std::string::npos) << text;
    EXPECT_LE(std::abs(std::stod(text) / value - 1.0), 0.5001 * std::pow(10.0, 1 - digits)) << text;
    // no more digits than asked for behind the point, where rounding carries too: 9.9996 is 10.0
    const std::size_t point = text.find('.');
    if (point == std::string::npos) return;
    const std::size_t first = text.find_first_not_of("-0.");
    std::size_t count = 0;
    for (std::size_t i = first; i < text.size(); ++i) count += text[i] != '.' ? 1 : 0;
    EXPECT_LE(count, static_cast<std::size_t>(digits)) << text;
  });
}

std::string drawn_word(Random& random, int least, int most) {
  std::string word(static_cast<std::size_t>(drawn_int(random, least, most)), 'a');
  for (char& letter : word) letter = static_cast<char>('a' + random.index(26));
  return word;
}

TEST(TextProperties, TheNearestWordIsTheWordItselfOrThatWithOneSlip) {
  for_cases([](Random& random) {
    std::vector<std::string> words;
    for (int i = 0; i < 5; ++i) words.push_back(drawn_word(random, 6, 12));
    const std::string& meant = words[random.index(words.size())];
    EXPECT_EQ(nearest_word(meant, words), meant);
    std::string typed = meant;
    typed[random.index(typed.size())] = '-';
    EXPECT_EQ(nearest_word(typed, words), meant);
    EXPECT_EQ(nearest_word("------------", words), std::nullopt);
  });
}

/// The limit of the edit distance, by length: a third of the word, but two.
TEST(TextProperties, AWordIsMeantUpToAThirdOfWrongLetters) {
  for_cases([](Random& random) {
    const std::string meant = drawn_word(random, 4, 15);
    const std::size_t most = std::max<std::size_t>(2, meant.size() / 3);
    const auto wrong =
        static_cast<std::size_t>(drawn_int(random, 1, static_cast<int>(meant.size())));
    std::string typed = meant;
    for (std::size_t i = 0; i < wrong; ++i) typed[i] = '-';
    EXPECT_EQ(nearest_word(typed, {meant}).has_value(), wrong <= most && wrong < meant.size())
        << typed << " for " << meant;
  });
}

TEST(TextProperties, ASealShowsEveryChangedByte) {
  for_cases([](Random& random) {
    nlohmann::ordered_json object = {{"format", "f"}, {"version", 1}};
    const double value = drawn_number(random);
    object["value"] = value;
    std::string text = sealed_text(object);
    JsonObject read = JsonObject::open_sealed("name", text, "f");
    EXPECT_EQ(read.number("value"), value);
    read.done();
    const std::size_t place = random.index(text.size());
    text[place] = static_cast<char>(text[place] ^ (1 << random.index(8)));
    EXPECT_THROW(JsonObject::open_sealed("name", text, "f"), Error) << text;
  });
}

TEST(TextProperties, NamesOfFilesAreValidEverywhereAndStay) {
  for_cases([](Random& random) {
    const std::string name = file_name_part(drawn_bytes(random, 100));
    EXPECT_LE(name.size(), 60U);
    for (const char c : name) EXPECT_TRUE(std::isalnum(c) || std::strchr("._+", c)) << name;
    EXPECT_EQ(file_name_part(name), name);
  });
}

nlohmann::json drawn_document(Random& random, int levels) {
  const double kind = random.uniform();
  if (kind < 0.1) return kind < 0.05;
  if (levels == 0 || kind < 0.3) return random.normal();
  if (kind < 0.5) return drawn_word(random, 3, 8) + " " + drawn_word(random, 1, 3);
  nlohmann::json document = kind < 0.8 ? nlohmann::json::object() : nlohmann::json::array();
  const int count = drawn_int(random, 1, 3);
  for (int i = 0; i < count; ++i) {
    const nlohmann::json part = drawn_document(random, levels - 1);
    if (document.is_array()) {
      document.push_back(part);
    } else {
      document["k" + std::to_string(i)] = part;
    }
  }
  return document;
}

/// As YAML in block form, where every level is indented by two.
std::string block_yaml(const nlohmann::json& value, const std::string& indent) {
  if (!value.is_structured()) {
    return " " + (value.is_string() ? value.get<std::string>() : value.dump()) + "\n";
  }
  std::string text = "\n";
  for (const auto& item : value.items()) {
    text += indent + (value.is_array() ? "-" : item.key() + ":") +
            block_yaml(item.value(), indent + "  ");
  }
  return text;
}

TEST(TextProperties, YamlInBlocksAndInBracketsReadsBack) {
  for_cases([](Random& random) {
    const nlohmann::json document = {{"top", drawn_document(random, 3)}};
    EXPECT_EQ(parse_yaml("name", "# comment" + block_yaml(document, "")), document);
    const std::string flow = document.dump(drawn_int(random, -1, 2));
    EXPECT_EQ(parse_yaml("name", flow), document) << flow;
  });
}

/// YAML 1.2.2, 10.3.2 and 6.6: words for true, and comments behind any blank.
TEST(TextProperties, YamlWordsAndCommentsDoNotDependOnBlanks) {
  const std::pair<const char*, nlohmann::json> words[] = {
      {"true", true}, {"True", true}, {"false", false}, {"False", false}, {"~", nullptr}};
  for_cases([&](Random& random) {
    const auto& [word, value] = words[random.index(std::size(words))];
    const std::string blanks[] = {" ", "\t", " \t", "\t\t", "   "};
    const std::string blank = blanks[random.index(std::size(blanks))];
    const std::string comment =
        random.uniform() < 0.5 ? blank + "# " + drawn_word(random, 0, 5) : "";
    EXPECT_EQ(parse_yaml("name", "a: " + std::string(word) + comment + "\n")["a"], value);
    EXPECT_EQ(parse_yaml("name", "a: x#" + std::string(word) + comment + "\n")["a"],
              "x#" + std::string(word));
  });
}

TEST(TextProperties, TablesReadBack) {
  const TemporaryFolder folder;
  std::vector<double> written;
  {
    std::ofstream file(folder.file("table.csv"));
    file << "a,b\n";
    for_cases([&](Random& random) {
      written.push_back(drawn_number(random));
      file << number_text(written.back()) << ", " << number_text(-written.back()) << "\n";
    });
  }
  const Table table = Table::read(folder.file("table.csv"));
  EXPECT_EQ(table.column("a"), written);
  for (double& number : written) number = -number;
  EXPECT_EQ(table.column("b"), written);
}

TEST(TextProperties, QuantilesHaveTheirShareBelowWhateverTheWeightsAddUpTo) {
  for_cases([](Random& random) {
    std::vector<NormalPart> parts(1 + random.index(3));
    double sum = 0.0;
    for (NormalPart& part : parts) {
      part.weight = random.uniform(0.1, 5.0);
      part.mean = random.uniform(-3.0, 3.0);
      part.sd = random.uniform(0.1, 2.0);
      sum += part.weight;
    }
    const double share = random.uniform(0.01, 0.99);
    const double quantile = quantile_of(parts, share);
    double below = 0.0;
    for (const NormalPart& part : parts) {
      below += part.weight / sum * normal_cdf((quantile - part.mean) / part.sd);
    }
    EXPECT_NEAR(below, share, 1e-9);
  });
}

}  // namespace
}  // namespace excavplan::test
