// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include "plan_site/job_inputs.hpp"

#include <algorithm>
#include <vector>

namespace excavplan::tools {
namespace {

void declare_words(Arguments& arguments, JobInputs& inputs, const std::string& words) {
  Arguments::Entry command;
  command.name = command.placeholder = "COMMAND";
  command.help = words;
  command.positional = command.required = true;
  command.assign = [&inputs, words](const std::string& text) {
    const std::vector<std::string> known = split(words, '|');
    if (std::find(known.begin(), known.end(), text) == known.end()) {
      usage_error("COMMAND: '" + text + "' is not one of " + words);
    }
    inputs.command = text;
  };
  arguments.add(command);
  Arguments::Entry folder;
  folder.name = folder.placeholder = "FOLDER";
  folder.help = "folder of the job; an estimate needs none";
  folder.positional = folder.place = true;
  folder.assign = [&inputs](const std::string& text) { inputs.folder = text; };
  arguments.add(folder);
}

/// With a price there is a cost.
void add_price(Arguments& arguments, const std::string& name, std::optional<double>& price,
               const std::string& help) {
  Arguments::Entry entry;
  entry.name = name;
  entry.placeholder = "NUMBER";
  entry.help = help;
  entry.assign = [&price, name](const std::string& text) {
    price = parse_quantity("--" + name, text, Quantity::ratio);
    if (!(*price >= 0.0)) usage_error("--" + name + ": " + text + " must be at least 0");
  };
  arguments.add(entry);
}

void declare_estimate(Arguments& arguments, EstimateInputs& inputs) {
  arguments.option("density-sd", inputs.density_sd, Quantity::percent,
                   "standard deviation of --density (default: 10; 25 where no density is told, or "
                   "as the site says)");
  arguments.option("truck-mass", inputs.truck_mass, Quantity::mass,
                   "of a load of a truck (default: that of --truck, the job or the site, else "
                   "15000)");
  arguments.text("fuel-model", "NAME|FILE", inputs.fuel,
                 "engine: zx120, scaled to the power of another machine, or a fuel model file");
  add_price(arguments, "fuel-price", inputs.prices.fuel,
            "of a litre of fuel, in the currency of the others");
  add_price(arguments, "hour-price", inputs.prices.hour,
            "of an hour of the machine with its operator, without fuel");
  add_price(arguments, "truckload-price", inputs.prices.truckload,
            "of a truckload hauled and tipped");
}

void declare_done(Arguments& arguments, JobInputs& inputs) {
  arguments.option("step", inputs.step, "the step that was done, as next names it");
  arguments.option("payload-mass", inputs.payload_mass, Quantity::mass,
                   "that the dig lifted, by the scale");
  Arguments::Entry energy;
  energy.name = "energy-kj";
  energy.placeholder = "NUMBER";
  energy.help = "work of the joints over the whole cycle [kJ]";
  energy.assign = [&inputs](const std::string& text) {
    inputs.energy = 1000.0 * parse_quantity("--energy-kj", text, Quantity::ratio);
  };
  arguments.add(energy);
  arguments.file("loads", inputs.loads,
                 "instead a log of the joints over the whole cycle, CSV: torques and rates, "
                 "pressures and piston speeds, or powers");
  arguments.flag("stalled", inputs.stalled, "the machine could not finish the dig");
}

}  // namespace

void declare(Arguments& arguments, JobInputs& inputs, const std::string& words) {
  const auto is = [&inputs](const std::vector<std::string>& some) {
    return [&inputs, some] {
      return std::find(some.begin(), some.end(), inputs.command) != some.end();
    };
  };
  declare_words(arguments, inputs, words);
  const auto tells_order = [&inputs] {
    return inputs.command == "new" || (inputs.command == "estimate" && inputs.folder.empty());
  };
  arguments.only_if({tells_order, "it is of plan-site new, and of estimate without a folder"},
                    [&] { declare_order(arguments, inputs.order); });
  arguments.only_if({is({"new", "estimate"}), "it is of plan-site new and estimate"}, [&] {
    arguments.option("density", inputs.order.density, Quantity::percent,
                     "relative density of the ground, with which plans begin (default: 50, or as "
                     "the site says)");
  });
  arguments.only_if({is({"estimate"}), "it is of plan-site estimate"},
                    [&] { declare_estimate(arguments, inputs.estimate); });
  arguments.only_if({is({"new", "done", "scan", "estimate"}), "this command takes no scan"},
                    [&] { declare_scan(arguments, inputs.scan); });
  arguments.only_if({is({"new", "done"}), "it is of plan-site new and done"}, [&] {
    arguments.text("base", "X,Y,HEADING", inputs.base,
                   "where the machine stands: of new when the job begins, in the heading in which "
                   "it works (default: before the trench); of done if not where the step says "
                   "[m,m,rad]");
  });
  arguments.only_if({is({"show", "estimate"}), "it is of plan-site show and estimate"},
                    [&] { arguments.report(inputs.report); });
  arguments.only_if({is({"show"}), "it is of plan-site show"}, [&] {
    arguments.text("serve", "[ADDRESS:]PORT", inputs.serve,
                   "show the page of --report in a browser and keep it up to date while others go "
                   "on with the job, until interrupted; only on this computer (127.0.0.1) unless "
                   "another address is given");
  });
  arguments.only_if({is({"done"}), "it is of plan-site done"},
                    [&] { declare_done(arguments, inputs); });
}

}  // namespace excavplan::tools
