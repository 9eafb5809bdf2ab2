// softgrip tune: finds PID gains and a filter for a given model, feedforward and control rate.

#include "control/tuning/tune.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/json.h"
#include "base/numbers.h"
#include "control/feedforward/invertibility.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"
#include "tools/commands/rig_to_move.h"

namespace softgrip::tools {
namespace {

struct TuneOptions {
  std::string model;
  std::string rig;
  std::string channel;
  std::string out;
  std::optional<std::string> feedforward;
  std::optional<double> rate_hz;
  std::optional<double> pressure_max_kpa;
  double mismatch_percent = 5;
  control::TuneTask task;
  bool json = false;
};

constexpr double default_pressure_max_kpa = 60;
constexpr double default_slew_kpa_per_s = 400;
constexpr double ahead_of_any_mm = 1e4;

/// Copies the settings of the channel from the rig file to the task. Returns an exit code if the file or
/// channel is refused.
std::optional<ExitCode> take_rig(const TuneOptions& options, control::TuneTask& task) {
  const auto rig = read_rig(options.rig);
  if (!rig) return rig.error();
  const auto index =
      options.channel.empty() ? std::optional<std::size_t>(0) : channel_of(*rig, options.channel);
  if (!index) return fail(ExitCode::usage, options.rig + " has no channel '" + options.channel + "'");
  const control::ChannelSettings& channel = rig->settings.channels[*index];
  const model::Model believed = task.channel.model;
  task.channel = channel;
  task.channel.model = believed;
  task.rate_hz = rig->settings.rate_hz;
  task.exchange_s = std::min(channel.feedforward.extra_latency_s, 0.9 / task.rate_hz);
  if (channel.health.noise_mm > 0) task.noise_mm = channel.health.noise_mm;
  return std::nullopt;
}

void take_defaults(control::TuneTask& task) {
  task.channel.limits = {0,
                         default_pressure_max_kpa,
                         default_slew_kpa_per_s,
                         default_slew_kpa_per_s,
                         -ahead_of_any_mm,
                         ahead_of_any_mm,
                         0};
}

std::string snippet(const TuneOptions& options, const control::TuneTask& task, const control::Tuned& tuned,
                    const std::string& model_name) {
  std::string text;
  text += "# `softgrip tune` for " + model_name + ", " + significant(task.rate_hz) +
          " Hz; each model parameter was varied by up to " + significant(options.mismatch_percent) + " %, " +
          std::to_string(task.draws) + " fingers, seed " + std::to_string(task.seed) + ".\n";
  text += "# Worst Ms " + significant(tuned.sensitivity, 3) + " (bound " +
          significant(task.most_sensitivity, 3) + "), crossover " + significant(tuned.crossover_hz, 3) +
          " Hz; RMSE " + significant(tuned.rmse_mm, 3) + " mm on " + significant(task.mean_mm, 3) + " ± " +
          significant(task.amplitude_mm, 3) + " mm at";
  for (const double frequency : task.frequencies_hz) text += " " + significant(frequency);
  text += " Hz.\n# Limited by " + tuned.limited_by + ".\n";
  const control::PidSettings& pid = tuned.pid;
  text += "pid:\n  kp_kpa_per_mm: " + significant(pid.kp_kpa_per_mm) +
          "\n  ki_kpa_per_mm_s: " + significant(pid.ki_kpa_per_mm_s) +
          "\n  kd_kpa_s_per_mm: " + significant(pid.kd_kpa_s_per_mm) +
          "\n  derivative_filter_s: " + significant(pid.derivative_filter_s) +
          "\n  setpoint_weight: " + significant(pid.setpoint_weight) +
          "\n  anti_windup: back_calculation\n  tracking_time_s: " + significant(pid.tracking_time_s) + "\n";
  return text;
}

std::string json_of(const TuneOptions& options, const control::TuneTask& task, const control::Tuned& tuned) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["out"] = options.out;
  json["kp_kpa_per_mm"] = tuned.pid.kp_kpa_per_mm;
  json["ki_kpa_per_mm_s"] = tuned.pid.ki_kpa_per_mm_s;
  json["kd_kpa_s_per_mm"] = tuned.pid.kd_kpa_s_per_mm;
  json["derivative_filter_s"] = tuned.pid.derivative_filter_s;
  json["sensitivity"] = tuned.sensitivity;
  json["most_sensitivity"] = task.most_sensitivity;
  json["crossover_hz"] = tuned.crossover_hz;
  json["rmse_mm"] = tuned.rmse_mm;
  json["rmse_exact_mm"] = tuned.exact_mm;
  json["rmse_noise_mm"] = tuned.noisy_mm;
  json["rmse_mismatch_mm"] = tuned.mismatch_mm;
  json["limited_by"] = tuned.limited_by;
  json["rate_hz"] = task.rate_hz;
  json["mean_mm"] = task.mean_mm;
  json["amplitude_mm"] = task.amplitude_mm;
  json["seed"] = task.seed;
  return json_dump(json) + "\n";
}

ExitCode run(const TuneOptions& chosen) {
  TuneOptions options = chosen;
  if (const auto code = refuse_overwriting({options.out}, {options.model, options.rig})) return *code;
  const auto model = read_rig_model(options.model);
  if (!model) return model.error();
  control::TuneTask& task = options.task;
  task.channel.model = *model;
  task.finger = *model;
  take_defaults(task);
  if (!options.rig.empty()) {
    if (options.rate_hz)
      return fail(ExitCode::usage,
                  "--rate-hz is not permitted with --rig, because the rig file contains the rate");
    if (const auto code = take_rig(options, task)) return *code;
  }
  if (options.rate_hz) task.rate_hz = *options.rate_hz;
  if (options.pressure_max_kpa) task.channel.limits.pressure_max_kpa = *options.pressure_max_kpa;
  const control::LimitSettings& limits = task.channel.limits;
  if (!(limits.pressure_max_kpa > limits.pressure_min_kpa))
    return fail(ExitCode::usage, "--pressure-max-kpa " + significant(limits.pressure_max_kpa) +
                                     " is not above the lowest pressure of the channel, " +
                                     significant(limits.pressure_min_kpa) + " kPa");
  if (options.feedforward) {
    task.channel.feedforward.kind = control::feedforward_names.find(*options.feedforward).value();
  }
  const auto accepted =
      control::check_feedforward(*model, task.channel.feedforward, task.channel.limits, 1 / task.rate_hz);
  if (!accepted) return fail(ExitCode::input_refused, options.model + ": " + accepted.error().with_advice());
  if (const auto writable = prepare_parent(options.out); !writable)
    return fail(ExitCode::io, writable.error());
  task.channel.plausibility.max_speed_mm_per_s = 1e6;
  task.mismatch = 0.01 * options.mismatch_percent;
  control::choose_reference(task);

  const control::Tuned tuned = control::tune(task);
  const std::string text = snippet(options, task, tuned, model->name);
  if (const auto written = write_output(options.out, text); !written) {
    return fail(ExitCode::io, written.error());
  }
  std::FILE* const stream = report_stream(options.out);
  if (options.json) {
    std::fputs(json_of(options, task, tuned).c_str(), stream);
  } else if (options.out != "-") {
    std::fputs(on_screen(text).c_str(), stream);
  }
  if (tuned.sensitivity > task.most_sensitivity) {
    return fail(ExitCode::not_acceptable, "no controller gains keep the stability margin");
  }
  return ExitCode::done;
}

}  // namespace

void add_tune(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] =
      add_command<TuneOptions>(program, outcome, "tune", "Tune PID gains that tolerate model errors", run);
  command->add_option("--model", options->model, "Model file")->required();
  command->add_option("--rig", options->rig,
                      "Rig file from which rate, limits, feedforward and latency of the channel are read");
  command->add_option("--channel", options->channel, "Channel of the rig [the first channel]");
  command->add_option("--rate-hz", options->rate_hz, "Rate of the control loop, if --rig is not given [200]")
      ->check(number_between(10.0, 2000.0));
  command
      ->add_option("--feedforward", options->feedforward, "Feedforward [the feedforward of the rig, or none]")
      ->check(CLI::IsMember(control::feedforward_names.names()));
  command
      ->add_option("--pressure-max-kpa", options->pressure_max_kpa,
                   "Highest pressure [the limit in the rig file, or 60]")
      ->check(number_between(1.0, 1000.0));
  command
      ->add_option("--mismatch-percent", options->mismatch_percent,
                   "Largest relative error of each model parameter")
      ->check(number_between(0.0, 50.0))
      ->capture_default_str();
  command
      ->add_option("--max-sensitivity", options->task.most_sensitivity,
                   "Highest permitted sensitivity peak Ms of the control loop")
      ->check(number_between(1.05, 5.0))
      ->capture_default_str();
  command->add_option("--frequencies-hz", options->task.frequencies_hz, "Frequencies of the tracked sines")
      ->check(number_between(0.01, 5.0))
      ->capture_default_str();
  command
      ->add_option("--noise-mm", options->task.noise_mm,
                   "Standard deviation of the sensor noise; the value in the rig file has priority")
      ->check(number_between(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--draws", options->task.draws, "Number of simulated fingers with model errors")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--seed", options->task.seed, "Seed of fingers and noise")
      ->check(seed_number())
      ->capture_default_str();
  command
      ->add_option("--out", options->out, "File for the `pid:` block of the rig file ('-': standard output)")
      ->required();
  command->add_flag("--json", options->json, "Print the numbers as JSON");
}

}  // namespace softgrip::tools
