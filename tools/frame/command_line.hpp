// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <excavplan/base/error.hpp>
#include <excavplan/base/warning.hpp>

#include "frame/arguments.hpp"
#include "frame/help.hpp"
#include "frame/page.hpp"
#include "frame/standard_input.hpp"

/// @file
/// The words of the command line and of a file of settings, sorted and given to their options.

namespace excavplan::tools {

/// Words of the command line by the entry they belong to.
struct ParsedWords {
  struct Given {
    std::string text;  ///< the last one
    std::vector<std::string> texts;
    std::string place = {};  ///< in the file of settings; empty: on the command line
  };
  std::vector<Given> of_entry;
  std::vector<std::string> left_over;  ///< also the first "--", behind which all words are names
};

/// CLI11 only sorts the words. Conversion and missing options come after the check for unknown
/// ones, so that "--denisty 40" is reported as misspelt rather than --density as missing.
ParsedWords sort_words(int argc, const char* const* argv,
                       const std::vector<Arguments::Entry>& entries);

/// Takes from --config what the command line does not give. @return what was taken, as a line for
/// the user; empty without --config
std::string add_settings(const std::vector<Arguments::Entry>& entries, const About& about,
                         StandardInput& input, ParsedWords& words);

/// Runs `work`; an error about the value of an option then says where in the file it stands.
template <typename Work>
auto naming_settings(const std::vector<Arguments::Entry>& entries, const ParsedWords& words,
                     const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string message = error.what();
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const std::string option = "--" + entries[i].name;
      const std::size_t end = option.size();
      const bool is_about = message.compare(0, end, option) == 0 && message.size() > end &&
                            (message[end] == ':' || message[end] == ' ');
      if (is_about && !words.of_entry[i].place.empty()) {
        throw Error(ErrorKind::bad_file, words.of_entry[i].place + message);
      }
    }
    throw;
  }
}

/// @throws Error (bad_input) if options that exclude one another are given
void refuse_excluded(const std::vector<Arguments::Entry>& entries, const ParsedWords& words);
/// @throws Error (bad_input) if a word belongs to no option
void refuse_left_over(const std::vector<std::string>& left_over,
                      const std::vector<Arguments::Entry>& entries);
/// Standard output holds one thing. @throws Error (bad_input) if that is a file too
void refuse_beside_json(const std::vector<Arguments::Entry>& entries, const ParsedWords& words);

/// Gives all words to their options, and checks that files can be written.
/// @throws Error (bad_input), (bad_file) naming the option
void assign(const std::vector<Arguments::Entry>& entries, const ParsedWords& words,
            StandardInput& input);

/// One for each reason why options that were given have no effect.
std::vector<Warning> ignored_options(const std::vector<Arguments::Entry>& entries,
                                     const ParsedWords& words);

/// The first `count` options, those of the tool itself, as far as they have a value.
std::vector<Setting> settings_of(const std::vector<Arguments::Entry>& entries,
                                 const ParsedWords& words, std::size_t count);

}  // namespace excavplan::tools
