// SPDX-FileCopyrightText: 2026 The excavplan authors
// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cctype>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

/// @file
/// main() of the benchmarks: the one of google-benchmark, which also names the machine and, with
/// --csv_folder=DIR, writes DIR/<machine>.csv (docs/bench).

namespace {

/// "Intel(R) Xeon(R) Processor"; Linux on x86 tells it.
std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown processor";
}

std::string machine_name() {
  const int cores = benchmark::CPUInfo::Get().num_cpus;
  return cpu_model() + ", " + std::to_string(cores) + (cores == 1 ? " core" : " cores");
}

/// "intel-xeon-2-cores": lower case, without trade marks, what all processors are called, and
/// the clock.
std::string file_name_of(std::string machine) {
  const auto remove = [&machine](const std::string& word) {
    const std::size_t at = machine.find(word);
    if (at != std::string::npos) machine.erase(at, word.size());
  };
  if (const std::size_t clock = machine.find(" @ "); clock != std::string::npos) {
    machine.erase(clock, machine.find(',', clock) - clock);
  }
  for (const char* word : {"(R)", "(R)", "(TM)", "(TM)", "Processor", "processor", "CPU"}) {
    remove(word);
  }
  std::string name;
  for (const char c : machine) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!name.empty() && name.back() != '-') {
      name += '-';
    }
  }
  return name;
}

/// Prints as usual and keeps the time of each benchmark: of repetitions, their median.
class TableReporter : public benchmark::ConsoleReporter {
 public:
  TableReporter() : ConsoleReporter(::isatty(STDOUT_FILENO) != 0 ? OO_Color : OO_None) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      failed_ = failed_ || run.error_occurred;
      const bool wanted =
          run.run_type == Run::RT_Aggregate ? run.aggregate_name == "median" : run.repetitions <= 1;
      if (!wanted || run.error_occurred) continue;
      const double seconds =
          run.GetAdjustedRealTime() / benchmark::GetTimeUnitMultiplier(run.time_unit);
      rows_.push_back({run.run_name.str(), seconds});
    }
  }

  /// @return whether all went well, the file included
  bool write(const std::string& path) const {
    std::ofstream csv(path);
    csv << "benchmark,time_us,per_second\n" << std::fixed;
    for (const Row& row : rows_) {
      csv << row.name << ',' << std::setprecision(3) << 1e6 * row.seconds << ','
          << std::setprecision(0) << 1.0 / row.seconds << '\n';
    }
    csv.close();
    return csv.good() && !rows_.empty() && !failed_;
  }

 private:
  struct Row {
    std::string name;
    double seconds = 0.0;  ///< wall clock per iteration
  };
  std::vector<Row> rows_;
  bool failed_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  const std::string option = "--csv_folder=";
  std::string folder;
  benchmark::Initialize(&argc, argv);
  if (argc == 2 && std::string(argv[1]).rfind(option, 0) == 0) {
    folder = std::string(argv[1]).substr(option.size());
    argc = 1;
  }
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;

  const std::string machine = machine_name();
  benchmark::AddCustomContext("machine", machine);
  TableReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  if (folder.empty()) return 0;
  const std::string path = folder + "/" + file_name_of(machine) + ".csv";
  const bool written = reporter.write(path);
  (written ? std::cout : std::cerr) << (written ? "written: " : "failed: ") << path << '\n';
  return written ? 0 : 1;
}
