// softgrip validate: what a model predicts for logs that it was not fitted to.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/numbers.h"
#include "sysid/identification/validate.h"
#include "tools/command_line/log_input.h"
#include "tools/command_line/model_input.h"
#include "tools/command_line/option_check.h"
#include "tools/commands/commands.h"
#include "tools/commands/series_output.h"

namespace softgrip::tools {
namespace {

struct Options {
  std::string model;
  std::vector<std::string> data;
  std::string out;
  LogInput logs;
  std::optional<double> at_most_percent;
  bool json = false;
};

void print_summary(const sysid::Validation& v) {
  std::printf("%s\n\n", sysid::verdict_of(v).c_str());
  for (const sysid::Score& s : v.scores) {
    std::printf("  %-24s RMSE %8s mm  %6s %% of span  first cycle %8s mm  settled %8s mm  largest %8s mm\n",
                s.name.c_str(), significant(s.rmse_mm, 4).c_str(),
                significant(s.rmse_percent_of_span, 3).c_str(), significant(s.first_cycle_rmse_mm, 4).c_str(),
                significant(s.settled_rmse_mm, 4).c_str(), significant(s.largest_error_mm, 3).c_str());
  }
}

ExitCode run(const Options& options) {
  const auto model = read_model(options.model);
  if (!model) return model.error();
  const auto logs = read_logs(options.data, options.logs);
  if (!logs) return logs.error();
  const sysid::Validation v = sysid::validate_logs(*model, *logs, options.logs.record_options());
  const std::string json = sysid::validate_json(v, *logs);
  if (!options.out.empty()) {
    const std::filesystem::path out(options.out);
    for (const auto& [name, text] : {std::pair<const char*, std::string>{"validate.json", json},
                                     {"report.html", sysid::validate_html(v, *logs)}}) {
      if (const auto written = write_file((out / name).string(), text); !written) {
        return fail(ExitCode::io, written.error());
      }
    }
    if (const auto written = write_series(options.out, series_of(*logs, v.records, v.scores, "given", true));
        !written)
      return fail(ExitCode::io, written.error());
  }
  if (options.json) {
    std::fputs(json.c_str(), stdout);
  } else {
    print_summary(v);
  }
  bool acceptable = true;
  for (const sysid::Score& s : v.scores) {
    acceptable = acceptable && s.rmse_percent_of_span <= options.at_most_percent.value_or(1e300);
  }
  return acceptable ? ExitCode::done : ExitCode::not_acceptable;
}

}  // namespace

void add_validate(CLI::App& program, ExitCode& outcome) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("validate", "How well a model predicts logs");
  command->add_option("--model", options->model, "Model file")->required();
  command->add_option("--data", options->data, "Logs to predict (CSV, or a recording's folder)")->required();
  command->add_option("--out", options->out, "Folder for validate.json, report.html, and series.csv per log");
  command
      ->add_option("--at-most-percent", options->at_most_percent,
                   "Exit with 6 if the RMSE of a log is a larger share of its span")
      ->check(number_between(0.0, 100.0));
  add_log_options(*command, options->logs);
  command->add_flag("--json", options->json, "Print validate.json");
  command->callback([options, &outcome] { outcome = run(*options); });
}

}  // namespace softgrip::tools
