// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <excavplan/base/error.hpp>

/// @file
/// Arguments that no careful caller gives, and what a function may do with them: refuse them by an
/// Error with a text, or answer with a result that is sound. Anything else, above all under the
/// sanitizers, is a finding.

namespace excavplan::test {

inline const std::vector<double> hostile_numbers = {std::numeric_limits<double>::quiet_NaN(),
                                                    std::numeric_limits<double>::infinity(),
                                                    -std::numeric_limits<double>::infinity(),
                                                    -1.0,
                                                    0.0,
                                                    -0.0,
                                                    1e300,
                                                    -1e300,
                                                    std::numeric_limits<double>::denorm_min()};

inline const std::vector<int> hostile_counts = {0, -1, std::numeric_limits<int>::max(),
                                                std::numeric_limits<int>::min()};

/// The text of the Error (bad_input) that a call throws, which must hold `part`.
template <typename Call>
testing::AssertionResult refuses(const Call& call, const std::string& part = "") {
  try {
    call();
  } catch (const Error& error) {
    const std::string text = error.what();
    if (error.kind() != ErrorKind::bad_input) {
      return testing::AssertionFailure() << "is a bad file: " << text;
    }
    if (text.empty() || text.find(part) == std::string::npos) {
      return testing::AssertionFailure() << "says '" << text << "', not '" << part << "'";
    }
    return testing::AssertionSuccess();
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << "throws what is no Error: " << error.what();
  }
  return testing::AssertionFailure() << "is accepted";
}

/// A call refuses by an Error, or returns true: its result is sound.
template <typename Call>
testing::AssertionResult answers(const Call& call) {
  try {
    if (call()) return testing::AssertionSuccess();
  } catch (const Error& error) {
    if (*error.what() != '\0') return testing::AssertionSuccess();
    return testing::AssertionFailure() << "an Error without a text";
  } catch (const std::exception& error) {
    return testing::AssertionFailure() << "throws what is no Error: " << error.what();
  }
  return testing::AssertionFailure() << "gives a result that is not sound";
}

inline bool finite(double value) { return std::isfinite(value); }
template <typename Derived>
bool finite(const Eigen::DenseBase<Derived>& values) {
  return values.derived().allFinite();
}

/// A number of an argument, by name.
template <typename Argument>
struct Member {
  std::string name;
  std::function<double&(Argument&)> of;
};

/// A function of an argument: true if its result is sound.
template <typename Argument>
using Function = std::pair<std::string, std::function<bool(const Argument&)>>;

/// Gives every function the argument with one number after the other made hostile.
template <typename Argument>
void make_hostile(const Argument& good, const std::vector<Member<Argument>>& members,
                  const std::vector<Function<Argument>>& functions) {
  for (const auto& [name, call] : functions) {
    ASSERT_TRUE(call(good)) << name << " of the good argument";
    for (const Member<Argument>& member : members) {
      for (const double value : hostile_numbers) {
        Argument bad = good;
        member.of(bad) = value;
        EXPECT_TRUE(answers([&, &call = call] { return call(bad); }))
            << name << ", " << member.name << " = " << value;
      }
    }
  }
}

}  // namespace excavplan::test
