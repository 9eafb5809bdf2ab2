// softgrip check: reports all errors of configuration files at once.

#include "rig/check.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "tools/client/set_option.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/commands/commands.h"

namespace softgrip::tools {
namespace {

struct CheckOptions {
  std::vector<std::string> files;
  std::vector<std::string> settings;
  bool json = false;
};

nlohmann::ordered_json to_json(const document::Problem& problem, const char* severity) {
  nlohmann::ordered_json json;
  json["file"] = problem.file;
  json["line"] = problem.at.line;
  json["column"] = problem.at.column;
  json["severity"] = severity;
  json["message"] = problem.message;
  json["hint"] = problem.hint;
  json["line_text"] = problem.line_text;
  return json;
}

void print_report_json(const rig::CheckReport& report) {
  nlohmann::ordered_json json;
  json["accepted"] = report.accepted();
  json["files"] = nlohmann::ordered_json::array();
  for (const rig::CheckedFile& file : report.files) {
    nlohmann::ordered_json entry;
    entry["path"] = file.path;
    entry["kind"] = rig::name_of(file.kind);
    entry["name"] = file.name;
    entry["errors"] = file.errors;
    entry["warnings"] = file.warnings;
    entry["passed_over"] = file.passed_over;
    json["files"].push_back(std::move(entry));
  }
  json["problems"] = nlohmann::ordered_json::array();
  for (const auto& problem : report.problems.list()) json["problems"].push_back(to_json(problem, "error"));
  for (const auto& problem : report.problems.warnings())
    json["problems"].push_back(to_json(problem, "warning"));
  std::printf("%s\n", json_dump(json).c_str());
}

void print_report_text(const rig::CheckReport& report) {
  std::fputs(report.problems.format().c_str(), stderr);
  for (const rig::CheckedFile& file : report.files) {
    std::printf("%s: %s", document::shown(file.path, 400).c_str(),
                std::string(rig::name_of(file.kind)).c_str());
    if (!file.name.empty()) std::printf(" '%s'", document::shown(file.name).c_str());
    const bool unfitted = file.kind == rig::FileKind::sequence && !report.has_rig;
    if (file.passed_over) {
      std::printf(": skipped\n");
    } else if (file.errors > 0) {
      std::printf(": %zu %s\n", file.errors, file.errors == 1 ? "error" : "errors");
    } else {
      std::printf(": ok%s%s\n", file.warnings > 0 ? ", with warnings" : "",
                  unfitted
                      ? ", but the sequence was not checked with a rig: also give a rig file for this check"
                      : "");
    }
  }
}

ExitCode run(const CheckOptions& options) {
  const auto arguments = arguments_of(options.settings);
  if (!arguments) return arguments.error();
  const rig::CheckReport report = rig::check_files(options.files, *arguments);
  options.json ? print_report_json(report) : print_report_text(report);
  const bool all_there = std::all_of(options.files.begin(), options.files.end(),
                                     [](const std::string& path) { return why_unreadable(path).empty(); });
  if (!all_there) return ExitCode::io;
  return report.accepted() ? ExitCode::done : ExitCode::input_refused;
}

}  // namespace

void add_check(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<CheckOptions>(
      program, outcome, "check", "Validate rig, board, model and sequence files", run);
  command
      ->add_option("FILE", options->files,
                   "Rig, board, model and sequence files, or folders that contain such files; sequences are "
                   "also checked with the given rig files")
      ->required();
  add_set_option(*command, options->settings);
  command->add_flag("--json", options->json, "Print the findings as JSON");
}

}  // namespace softgrip::tools
