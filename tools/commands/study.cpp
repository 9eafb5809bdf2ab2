// softgrip study: reproduces the studies of the project, one per command.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "bench/studies/control_study.h"
#include "bench/studies/published.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/progress_line.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"
#include "tools/commands/series_output.h"
#include "tools/figures/figure_files.h"

namespace softgrip::tools {
namespace {

struct Output {
  std::string out;
  std::string figures;
  bool json = false;
};

ExitCode write_all(const Output& output, const std::string& json_name, const std::string& json,
                   const sysid::Page& page, const std::string& text) {
  if (const auto written = write_report(output.out, {{json_name, json}}, page, output.figures); !written)
    return fail(ExitCode::io, written.error());
  std::fputs(output.json ? json.c_str() : on_screen(text).c_str(), stdout);
  if (!output.json) std::printf("report: %s\n", (std::filesystem::path(output.out) / "report.html").c_str());
  return ExitCode::done;
}

/// Runs a study, shows the progress and writes the results.
template <class Options, class Result>
ExitCode run_study(const Output& output, Options options, Result (*study)(const Options&),
                   const std::string& json_name, std::string (*json)(const Result&),
                   sysid::Page (*page)(const Result&), std::string (*text)(const Result&)) {
  if (const auto writable = prepare_folder(output.out); !writable)
    return fail(ExitCode::io, writable.error());
  const Result result = [&] {
    ProgressLine line;
    options.progress = line.show();
    return study(options);
  }();
  return write_all(output, json_name, json(result), page(result), text(result));
}

void add_output(CLI::App& command, Output& output) {
  command.add_option("--out", output.out, "Folder for the report and the numbers")->required();
  add_figures_option(command, output.figures);
  command.add_flag("--json", output.json, "Print the numbers as JSON");
}

void add_published(CLI::App& study, ExitCode& outcome) {
  struct Options {
    Output output;
    studies::PublishedOptions study;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = study.add_subcommand(
      "published",
      "Show that the published hysteresis parameters absorb a latency that the model does not contain");
  add_output(*command, options->output);
  command->add_option("--seed", options->study.seed, "Seed of noise and start points")
      ->check(seed_number())
      ->capture_default_str();
  command->add_option("--starts", options->study.starts, "Number of start points of each identification")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->callback([options, &outcome] {
    outcome = run_study(options->output, options->study, studies::study_published, "published.json",
                        studies::published_json, studies::published_page, studies::published_text);
  });
}

void add_control(CLI::App& study, ExitCode& outcome) {
  struct Options {
    Output output;
    studies::ControlStudyOptions study;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = study.add_subcommand("control",
                                           "Compare how accurately the control schemes track references on "
                                           "simulated fingers with model errors and noise");
  add_output(*command, options->output);
  command->add_option("--draws", options->study.draws, "Number of simulated fingers for each result")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--seed", options->study.seed, "Seed of fingers, noise and logs")
      ->check(seed_number())
      ->capture_default_str();
  command->add_option("--frequencies-hz", options->study.frequencies_hz, "Frequencies of the references")
      ->check(number_between(0.01, 2.0))
      ->capture_default_str();
  command
      ->add_option("--max-sensitivity", options->study.most_sensitivity,
                   "Highest permitted sensitivity peak Ms of each control loop")
      ->check(number_between(1.05, 5.0))
      ->capture_default_str();
  command->callback([options, &outcome] {
    outcome = run_study(options->output, options->study, studies::study_control, "control.json",
                        studies::control_json, studies::control_page, studies::control_text);
  });
}

}  // namespace

void add_study(CLI::App& program, ExitCode& outcome) {
  CLI::App* study = program.add_subcommand("study", "Reproduce the studies of the paper");
  study->require_subcommand(1);
  add_published(*study, outcome);
  add_control(*study, outcome);
}

}  // namespace softgrip::tools
