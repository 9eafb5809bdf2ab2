// softgrip init: creates a rig file from questions or options.

#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/numbers.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/commands/commands.h"
#include "tools/commissioning/procedure.h"
#include "tools/commissioning/rig_draft.h"

namespace softgrip::tools {
namespace {

struct InitOptions {
  std::string file = "my_rig.yaml";
  std::string name;
  double rate_hz = 0;
  bool service = false;
  std::map<std::string, std::vector<std::string>> facts;  ///< values from the command-line options, by name
                                                          ///< of the option
};

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Waits for a line of the user. Returns nullopt at the end of the input.
std::optional<std::string> wait_for_line(calibrate::TerminalOperator& person) {
  for (;;) {
    if (auto line = person.answer()) return line;
    if (person.gone()) return std::nullopt;
    pollfd input{STDIN_FILENO, POLLIN, 0};
    ::poll(&input, 1, -1);
  }
}

/// Repeats the question about a value until the answer is valid. Returns false at the end of the input.
bool ask(const Fact& fact, const Fact::Question& question, RigDraft& draft,
         calibrate::TerminalOperator& person) {
  for (;;) {
    person.ask(question.text + (question.otherwise.empty() ? "" : " [" + question.otherwise + "]"));
    auto line = wait_for_line(person);
    if (!line) return false;
    const bool blank = line->find_first_not_of(" \t\r") == std::string::npos;
    const std::string complaint = fact.take(blank ? question.otherwise : *line, draft);
    if (complaint.empty()) return true;
    person.tell(complaint);
  }
}

/// Takes the value of one entry of the rig file from its option, from the user's answer or from its default.
/// Returns an exit code if there is no value.
std::optional<ExitCode> settle(const Fact& fact, const InitOptions& options, RigDraft& draft,
                               calibrate::TerminalOperator& person) {
  const auto given = options.facts.find(fact.key);
  if (given != options.facts.end() && !given->second.empty()) {
    const std::string complaint = fact.take(joined(given->second), draft);
    if (complaint.empty()) return std::nullopt;
    return fail(ExitCode::usage, "--" + fact.key + ": " + complaint);
  }
  const auto question = fact.question(draft);
  if (!question) {
    if (fact.key == "monitor") draft.monitor = false;
    return std::nullopt;
  }
  if (person.patient()) {
    if (ask(fact, *question, draft, person)) return std::nullopt;
    return fail(ExitCode::failed, "stopped: nothing was written");
  }
  if (question->otherwise.empty()) {
    return fail(ExitCode::usage,
                "without a terminal, the option --" + fact.key + " is required (" + question->text + ")");
  }
  const std::string complaint = fact.take(question->otherwise, draft);
  if (complaint.empty()) return std::nullopt;
  return fail(ExitCode::usage, "--" + fact.key + " is required: " + complaint);
}

/// Reports why the options give no valid rig file. The file was not written, so the problems are printed
/// without their locations in the file.
ExitCode refuse_draft(const InitOptions& options, RigDraft draft, const document::Problems& problems) {
  std::string why;
  for (const document::Problem& problem : problems.list()) why += "\n  " + problem.message;
  draft.rate_hz.reset();
  if (options.rate_hz > 0 && draft_text(draft, options.file))
    return fail(ExitCode::input_refused, "--rate-hz " + significant(options.rate_hz, 6) +
                                             ": the rig cannot be used at this rate, so nothing was "
                                             "written. Without --rate-hz, init selects a rate" +
                                             why);
  return fail(ExitCode::input_refused,
              "these options give no valid rig file, so nothing was written. Check --pressure-max-kpa, "
              "--valve-kpa, --sensor-mm and --model" +
                  why);
}

ExitCode run(const InitOptions& options) {
  std::error_code error;
  if (std::filesystem::exists(options.file, error)) {
    return fail(ExitCode::state_refused,
                options.file + " already exists and is not changed: give the name of another file");
  }
  RigDraft draft;
  draft.name = options.name.empty() ? std::filesystem::path(options.file).stem().string() : options.name;
  if (options.rate_hz > 0) draft.rate_hz = options.rate_hz;
  draft.service = options.service;
  draft.sequences_path = configuration_path("sequences");
  calibrate::TerminalOperator person;
  for (const Fact& fact : draft_facts()) {
    if (const auto code = settle(fact, options, draft, person)) return *code;
  }
  const auto text = draft_text(draft, options.file);
  if (!text) return refuse_draft(options, draft, text.error());
  if (const auto written = create_file(options.file, *text); !written)
    return fail(ExitCode::io, written.error());
  std::printf("%s was written. Next:\n  softgrip check %s\n  softgrip doctor --rig %s\n",
              options.file.c_str(), options.file.c_str(), options.file.c_str());
  return ExitCode::done;
}

}  // namespace

void add_init(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<InitOptions>(
      program, outcome, "init", "Create a commented rig file, interactively or from options", run);
  command->add_option("FILE", options->file, "Rig file to create; an existing file is never overwritten")
      ->capture_default_str();
  command->add_option("--name", options->name, "Name of the rig [the name of the file]");
  command
      ->add_option("--rate-hz", options->rate_hz,
                   "Rate of the control loop and the bus [the highest of the usual rates at which the board "
                   "can be used]")
      ->check(number_between(1, 10000));
  command->add_flag("--service", options->service, "Use the folders of the system service instead of /tmp");
  for (const Fact& fact : draft_facts()) {
    CLI::Option* const option = command->add_option("--" + fact.key, options->facts[fact.key], fact.about);
    if (fact.words > 1) {
      option->expected(fact.words);
    } else {
      option->allow_extra_args(false);
    }
  }
  command->footer(
      "On a terminal, init asks a question for each missing option. Without a terminal, init uses the "
      "defaults,\nand options without a default are required. Exit codes: 0 written, 1 stopped, 2 usage,\n3 "
      "the resulting rig file is refused, 4 the file cannot be written, 5 the file already exists.");
}

}  // namespace softgrip::tools
