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

std::string text_of(const Verification& v, const std::string& folder) {
  std::string text;
  if (v.reported_by != v.recomputed_by)
    text += "reported by " + v.reported_by + ", recomputed by " + v.recomputed_by + "\n";
  for (const Difference& d : v.comparison.differences)
    text += "  " + d.where + ": reported " + d.reported + ", recomputed " + d.recomputed + "\n";
  const std::string numbers = std::to_string(v.comparison.numbers);
  if (v.comparison.differences.empty())
    return text + folder + ": all " + numbers + " numbers of the report are reproduced\n";
  return text + folder + ": of " + numbers + " numbers, the " +
         std::to_string(v.comparison.differences.size()) + " numbers above differ from the report\n";
}

ExitCode run(const ReportOptions& options) {
  const Verification v = verify_report(options.folder, "/proc/self/exe", options.tolerance);
  if (options.json) print_verification_json(v);
  if (!v.missing.empty()) {
    for (const std::string& sentence : v.missing) fail(ExitCode::input_refused, sentence);
    return ExitCode::input_refused;
  }
  if (!options.json) std::fputs(visible_lines(text_of(v, options.folder)).c_str(), stdout);
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
