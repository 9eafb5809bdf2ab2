// softgrip simulate: simulates a model with a test signal or the command of a log.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include <fmt/ranges.h>

#include "base/json.h"
#include "base/numbers.h"
#include "sysid/logs/simulated_log.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/commands/commands.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

constexpr double default_rate_hz = 100;

struct SimulateOptions {
  std::string model;
  std::string input;
  std::string out;
  std::string channel;
  std::optional<double> rate_hz;
  sysid::SimulationSettings settings;
  bool json = false;
};

std::string listed_signals() {
  return fmt::format("{}", fmt::join(model::signal_names.names(), " "));
}

/// Returns a log with the command to simulate, or an exit code.
tl::expected<sysid::Log, ExitCode> input_of(const SimulateOptions& options) {
  if (const auto signal = model::signal_names.find(options.input)) {
    return sysid::sampled_signal(*signal, options.rate_hz.value_or(default_rate_hz));
  }
  if (options.rate_hz) {
    return tl::unexpected{
        fail(ExitCode::usage,
             "--rate-hz is permitted only with a SIGNAL, because a log contains the times of its samples")};
  }
  document::Problems problems;
  sysid::LogOptions log_options;
  log_options.channel = options.channel;
  log_options.require_motion = false;
  log_options.need_readings = false;
  sysid::Campaign campaign = sysid::read_campaign({options.input}, problems, log_options);
  if (campaign.unreadable) {
    return tl::unexpected{
        fail(ExitCode::io, problems.list().front().message + " (signals are " + listed_signals() + ")")};
  }
  if (campaign.logs.empty()) return tl::unexpected{refuse_logs(problems)};
  sysid::Log log = std::move(campaign.logs.front());
  // Remove the measured signals, because a reader would mistake them for results of the model.
  log.pressure_kpa.clear();
  log.others.clear();
  return log;
}

void report(const SimulateOptions& options, const model::Model& model, const sysid::Log& log) {
  std::FILE* const stream = report_stream(options.out);
  const std::string unit(model::name_of(log.output_unit));
  const double span_mm = sysid::span_mm(log);
  const double duration_s = log.time_s.back() - log.time_s.front();
  if (options.json) {
    nlohmann::ordered_json json;
    json["out"] = options.out;
    json["model"] = model.name;
    json["input"] = options.input;
    json["output_unit"] = unit;
    json["samples"] = log.size();
    json["duration_s"] = duration_s;
    json["span_mm"] = span_mm;
    json["noise_mm"] = options.settings.noise_mm;
    json["seed"] = options.settings.seed;
    std::fprintf(stream, "%s\n", json_dump(json).c_str());
    return;
  }
  const std::string text = model.name + ", response to " + options.input + ": " + std::to_string(log.size()) +
                           " samples, " + significant(duration_s) + " s, span " + significant(span_mm) + " " +
                           unit + ", noise " + significant(options.settings.noise_mm) + " " + unit +
                           ", seed " + std::to_string(options.settings.seed) + " -> " + options.out;
  std::fprintf(stream, "%s\n", visible_lines(text).c_str());
}

ExitCode run(const SimulateOptions& options) {
  if (const auto code = refuse_overwriting({options.out}, {options.model, options.input})) return *code;
  const auto model = read_model(options.model);
  if (!model) return model.error();
  auto log = input_of(options);
  if (!log) return log.error();
  simulate(*model, options.settings, *log);
  if (const auto written = write_output(options.out, sysid::format_log(*log)); !written) {
    return fail(ExitCode::io, written.error());
  }
  report(options, *model, *log);
  return ExitCode::done;
}

}  // namespace

void add_simulate(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<SimulateOptions>(
      program, outcome, "simulate", "Simulate a model with a test signal or the command of a log", run);
  command->add_option("--model", options->model, "Model file")->required();
  command
      ->add_option("--input", options->input,
                   "SIGNAL (" + listed_signals() + ") or a log (CSV, or a recording's folder)")
      ->required();
  command->add_option("--out", options->out, "Log to write ('-': standard output)")->required();
  command
      ->add_option("--noise-mm", options->settings.noise_mm,
                   "Standard deviation of white noise on the reading, in the unit of the model's output")
      ->capture_default_str()
      ->check(number_between(0, 1000));
  command->add_option("--seed", options->settings.seed, "Seed of all noise")
      ->check(seed_number())
      ->capture_default_str();
  command->add_option("--rate-hz", options->rate_hz, "Samples per second of a SIGNAL [100]")
      ->check(number_between(0.1, 100000));
  command->add_option("--channel", options->channel, "Channel to use from a log with several channels");
  command->add_flag("--json", options->json, "Print a summary as JSON");
}

}  // namespace softgrip::tools
