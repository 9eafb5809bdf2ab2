// softgrip validate: compares a model's prediction with logs to which it was not fitted.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/numbers.h"
#include "sysid/identification/validate.h"
#include "sysid/instrument/identified_logs.h"
#include "tools/client/styled_line.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"
#include "tools/commands/series_output.h"
#include "tools/figures/figure_files.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

struct ValidateOptions {
  std::string model;
  std::vector<std::string> data;
  std::string out;
  std::string figures;
  LogInput logs;
  std::optional<double> at_most_percent;
  bool json = false;
};

std::string summary_line(const sysid::Validation& v, const sysid::Score& s) {
  const std::string unit = " " + std::string(name_of(s.output_unit));
  std::string line = "  " + s.name + std::string(s.name.size() < 24 ? 24 - s.name.size() : 0, ' ') +
                     " RMSE " + significant(s.rmse_mm) + unit + ", " +
                     significant(s.rmse_percent_of_span, 3) + " % of span, largest error " +
                     significant(s.largest_error_mm, 3) + unit + "; ";
  line += std::isfinite(s.settled_rmse_mm) ? "first cycle " + significant(s.first_cycle_rmse_mm) + unit +
                                                 ", settled " + significant(s.settled_rmse_mm) + unit
                                           : "no settled cycle, because the command does not repeat";
  line += "; driven by the " + name_of(s.drive);
  if (s.diverges)
    line += "; FAILED: the prediction diverges";
  else if (!is_acceptable(v, s))
    line += "; FAILED: above " + significant(*v.at_most_percent) + " %";
  return line;
}

void print_summary(const sysid::Validation& v) {
  constexpr std::size_t uncut = 1000;
  const ViewStyle style{uncut, wants_colour(), false};
  const bool failed = !std::all_of(v.scores.begin(), v.scores.end(),
                                   [&](const sysid::Score& s) { return is_acceptable(v, s); });
  std::printf("%s\n\n",
              Line(style).add(visible_lines(verdict_of(v)), failed ? Tone::bad : Tone::plain).text().c_str());
  for (const sysid::Score& s : v.scores) {
    const Tone tone = is_acceptable(v, s) ? Tone::plain : Tone::bad;
    std::printf("%s\n", Line(style).add(visible_lines(summary_line(v, s)), tone).text().c_str());
  }
  for (const std::string& warning : v.warnings) std::printf("warning: %s\n", visible_lines(warning).c_str());
}

ExitCode run(const ValidateOptions& options, const std::vector<std::string>& call) {
  std::vector<std::string> inputs = options.data;
  inputs.push_back(options.model);
  if (const auto code = refuse_report(options.out, options.figures, {"validate.json"}, inputs)) return *code;
  const auto model = read_model(options.model);
  if (!model) return model.error();
  auto logs = read_logs(options.data, options.logs, unit_of(*model));
  if (!logs) return logs.error();
  sysid::Validation v = sysid::validate_given_logs(*model, *logs, options.logs.record_options());
  v.at_most_percent = options.at_most_percent;
  v.call = call;
  const std::string json = sysid::validate_json(v, *logs);
  if (!options.figures.empty() || !options.out.empty()) {
    const sysid::Page page = sysid::validate_page(v, *logs);
    if (const auto written = write_report(options.out, {{"validate.json", json}}, page, options.figures);
        !written)
      return fail(ExitCode::io, written.error());
  }
  if (!options.out.empty()) {
    if (const auto written = write_series(options.out, series_of(*logs, v.records, v.scores, "given", true));
        !written)
      return fail(ExitCode::io, written.error());
  }
  if (options.json) {
    std::fputs(json.c_str(), stdout);
  } else {
    print_summary(v);
  }
  const bool acceptable = std::all_of(v.scores.begin(), v.scores.end(),
                                      [&](const sysid::Score& s) { return is_acceptable(v, s); });
  return acceptable ? ExitCode::done : ExitCode::not_acceptable;
}

}  // namespace

void add_validate(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<ValidateOptions>(
      program, outcome, "validate", "Report the prediction error of a model on logs", run);
  command->add_option("--model", options->model, "Model file")->required();
  command->add_option("--data", options->data, "Logs to predict (CSV, or a recording's folder)")->required();
  command->add_option("--out", options->out, "Folder for validate.json, report.html, and series.csv per log");
  add_figures_option(*command, options->figures);
  command
      ->add_option(
          "--at-most-percent", options->at_most_percent,
          "End with exit code 6 if the RMSE of a log exceeds this share of the log's displacement span")
      ->check(number_between(0.0, 100.0));
  add_log_options(*command, options->logs);
  command->add_flag("--json", options->json, "Print validate.json");
}

}  // namespace softgrip::tools
