// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <excavplan/ground/height_map.hpp>
#include <excavplan/machine/dig_parameters.hpp>
#include <excavplan/sensing/scene.hpp>

#include "frame/option_names.hpp"
#include "frame/quantity.hpp"

namespace excavplan::tools {

/// @throws Error (bad_input)
[[noreturn]] void usage_error(const std::string& message);

/// The options of a tool. Each is bound to a variable that holds its default, which the help
/// shows. Names are without the dashes.
class Arguments {
 public:
  using Assign = std::function<void(const std::string& text)>;
  /// The names of the files that are written with one.
  using Beside = std::function<std::vector<std::string>(const std::string& name)>;
  /// When an option has an effect, asked once all are read, and the reason why else not.
  struct Use {
    std::function<bool()> holds;
    std::string otherwise;
  };
  struct Entry {
    std::string name;
    std::string placeholder;  ///< "LENGTH"; empty for a flag
    std::string help;
    std::string default_text;
    bool positional = false;
    bool required = false;
    Assign assign;
    bool output = false;           ///< a file to write
    bool standard_output = false;  ///< "-" is standard output, of a file to write
    bool input = false;            ///< a file to read, or "-" for standard input
    bool place = false;            ///< a file or folder to write, which the tool checks
    bool repeated = false;         ///< may be given several times, `assign` is called for each
    Beside beside = {};
    std::vector<Use> uses = {};             ///< all must hold
    std::vector<std::string> endings = {};  ///< of the name of a file to write; empty: any
    std::function<bool()> by_ending = {};   ///< whether these matter; empty: always
    /// The name of the file in the text; empty: it is the text.
    std::function<std::string(const std::string& text)> file_in = {};
    Assign check = {};  ///< called for each text once all are assigned
    /// Called for each text of a file of settings. @throws Error (bad_input) if the command line
    /// alone may say so
    Assign check_in_file = {};
    std::vector<std::string> excludes = {};  ///< names of options that may not stand beside it
  };

  void positional(const std::string& name, std::string& value, const std::string& help);
  void positional(const std::string& name, std::optional<std::string>& value,
                  const std::string& help);

  void flag(const std::string& name, bool& value, const std::string& help);
  void option(const std::string& name, double& value, Quantity quantity, const std::string& help);
  void option(const std::string& name, std::optional<double>& value, Quantity quantity,
              const std::string& help);
  void option(const std::string& name, int& value, const std::string& help);
  void option(const std::string& name, std::optional<int>& value, const std::string& help);
  void option(const std::string& name, std::uint64_t& value, const std::string& help);
  void option(const std::string& name, std::optional<Rectangle>& value, const std::string& help);
  /// The help of the second names the parameters of a path too.
  void option(const std::string& name, std::optional<DigParameters>& value,
              const std::string& help);
  void option(const std::string& name, DigParameters& value, const std::string& help);
  /// "x,y"
  void option(const std::string& name, Eigen::Vector2d& value, const std::string& help);
  void option(const std::string& name, std::optional<Eigen::Vector2d>& value,
              const std::string& help);
  /// Places of cameras, "x,y,z,tx,ty,tz"; may be given several times.
  void option(const std::string& name, std::vector<CameraPlace>& value, const std::string& help);
  /// "x,y,z"
  void option(const std::string& name, std::optional<Eigen::Vector3d>& value,
              const std::string& help);
  /// "x,y,z,qx,qy,qz,qw", as 4 x 4 matrix
  void option(const std::string& name, std::optional<Eigen::Matrix4d>& value,
              const std::string& help);
  /// "swing,boom,arm,bucket"
  void option(const std::string& name, std::optional<MachinePosture>& value,
              const std::string& help);
  /// One of `words`.
  void choice(const std::string& name, std::string& value, const std::vector<std::string>& words,
              const std::string& help);
  /// A file to read.
  void file(const std::string& name, std::string& value, const std::string& help);
  void file(const std::string& name, std::optional<std::string>& value, const std::string& help);
  /// A file to write; whether it can be written is checked before the work.
  void output(const std::string& name, std::string& value, const std::string& help);
  void output(const std::string& name, std::optional<std::string>& value, const std::string& help,
              const Beside& beside = {});
  /// A file, or a folder and its files, to write; whether that can be done the tool checks.
  void place(const std::string& name, std::string& value, const std::string& help);
  void folder(const std::string& name, std::optional<std::string>& value, const std::string& help,
              const Beside& files = {});
  /// A text of its own syntax; a file to read too if the placeholder has FILE or FRAME in it.
  void text(const std::string& name, const std::string& placeholder, std::string& value,
            const std::string& help);
  void text(const std::string& name, const std::string& placeholder,
            std::optional<std::string>& value, const std::string& help);
  /// The same, given several times.
  void texts(const std::string& name, const std::string& placeholder,
             std::vector<std::string>& values, const std::string& help);

  /// These are the same in every tool; see soil_named(), machine_named().
  void soil(std::string& name);
  void machine(std::string& name);
  void report(std::optional<std::string>& path);
  void threads(std::uint64_t& count, const std::string& note);

  void require(const std::string& name);  ///< the option must be given
  /// No two of an option and one of the others are given; both were declared. In a file of settings
  /// the command line wins.
  void exclude(const std::string& name, const std::vector<std::string>& others);
  /// The file of the last option must end so, in letters of either size; "" is no ending.
  /// @param if_so  whether the ending tells the format; without it, always
  void require_ending(const std::vector<std::string>& endings,
                      const std::function<bool()>& if_so = {});
  void allow_standard_output();  ///< "-" as the file of the last option, without --json

  /// Those that `declare` declares have an effect only if this holds. May be nested.
  void only_if(const Use& use, const std::function<void()>& declare);

  /// An option of a kind of its own.
  void add(Entry entry);

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  Entry& entry(const std::string& name);

  std::vector<Entry> entries_;
};

/// A text of the library with "--dig-area" for `dig_area`, an input by its name, where the tool has
/// an option of that name.
std::string with_options(std::string text, const std::vector<Arguments::Entry>& entries);

}  // namespace excavplan::tools
