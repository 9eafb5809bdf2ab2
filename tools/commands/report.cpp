// softgrip report: recomputes the numbers of a report from the logs of the report.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "base/json.h"
#include "tools/command_line/command.h"
#include "tools/command_line/options.h"
#include "tools/commands/commands.h"
#include "tools/verification/verification.h"

namespace softgrip::tools {
namespace {

struct ReportOptions {
  std::string folder;
  double tolerance = 1e-6;
  bool json = false;
};

void print_verification_json(const Verification& v) {
  nlohmann::ordered_json json{{"same", v.missing.empty() && v.comparison.differences.empty()},
                              {"missing", v.missing},
                              {"reported_by", v.reported_by},
                              {"recomputed_by", v.recomputed_by},
                              {"numbers", v.comparison.numbers}};
  json["differences"] = nlohmann::ordered_json::array();
  for (const Difference& d : v.comparison.differences)
    json["differences"].push_back(
        {{"where", d.where}, {"reported", d.reported}, {"recomputed", d.recomputed}});
  std::printf("%s\n", json_dump(json, 2).c_str());
}

void print_verification(const Verification& v, const std::string& folder) {
  if (v.reported_by != v.recomputed_by)
    std::printf("reported by %s, recomputed by %s\n", v.reported_by.c_str(), v.recomputed_by.c_str());
  for (const Difference& d : v.comparison.differences)
    std::printf("  %s: reported %s, recomputed %s\n", d.where.c_str(), d.reported.c_str(),
                d.recomputed.c_str());
  if (v.comparison.differences.empty()) {
    std::printf("%s: all %zu numbers of the report are reproduced\n", folder.c_str(), v.comparison.numbers);
  } else {
    std::printf("%s: of %zu numbers, the %zu numbers above differ from the report\n", folder.c_str(),
                v.comparison.numbers, v.comparison.differences.size());
  }
}

ExitCode run(const ReportOptions& options) {
  const Verification v = verify_report(options.folder, "/proc/self/exe", options.tolerance);
  if (options.json) print_verification_json(v);
  if (!v.missing.empty()) {
    for (const std::string& sentence : v.missing) fail(ExitCode::input_refused, sentence);
    return ExitCode::input_refused;
  }
  if (!options.json) print_verification(v, options.folder);
  return v.comparison.differences.empty() ? ExitCode::done : ExitCode::not_acceptable;
}

}  // namespace

void add_report(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<ReportOptions>(
      program, outcome, "report", "Recompute a report from its logs and compare the numbers", run);
  command
      ->add_option("--verify", options->folder,
                   "Folder that identify, validate or diagnose wrote; the command is run again and the "
                   "results are compared")
      ->required();
  command
      ->add_option("--tolerance", options->tolerance,
                   "Largest relative difference at which two numbers count as equal")
      ->check(number_between(0.0, 1.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print the differences as JSON");
}

}  // namespace softgrip::tools
