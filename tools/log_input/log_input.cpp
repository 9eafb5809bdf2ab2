#include "tools/log_input/log_input.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <set>
#include <span>

#include "sysid/logs/command_before.h"
#include "sysid/logs/signal_gaps.h"
#include "tools/command_line/command.h"
#include "tools/command_line/input_files.h"

namespace softgrip::tools {
sysid::RecordOptions LogInput::record_options() const {
  sysid::RecordOptions options;
  options.drive = drive == "measured" ? sysid::Drive::measured : sysid::Drive::command;
  options.start = begin == "rest"      ? sysid::Start::rest
                  : begin == "unknown" ? sysid::Start::unknown
                                       : sysid::Start::automatic;
  options.held = held;
  return options;
}

void add_log_options(CLI::App& command, LogInput& input) {
  command.add_option("--channel", input.channel, "Channel to read from a log with several channels");
  command
      .add_option("--drive", input.drive,
                  "Input of the model: the command, or the measured pressure after the valve")
      ->check(CLI::IsMember({"command", "measured"}))
      ->capture_default_str();
  command
      .add_option(
          "--begin", input.begin,
          "Initial state of the logs: at rest, unknown (the state is estimated), or determined from each log")
      ->check(CLI::IsMember({"auto", "rest", "unknown"}))
      ->capture_default_str();
  command.add_flag("--held", input.held, "Assume that the command is constant until the next sample");
}

RequiredUnit unit_of(const model::Model& model) {
  return {"the model " + model.name, model.output_unit};
}

RequiredUnit unit_of(const std::vector<sysid::Log>& logs) {
  return {logs.front().path, logs.front().output_unit};
}

RequiredUnit unit_of_rigs() {
  return {"the displacement of a rig", model::OutputUnit::mm};
}

tl::expected<std::vector<sysid::Log>, ExitCode> read_logs(const std::vector<std::string>& paths,
                                                          const LogInput& input,
                                                          const std::optional<RequiredUnit>& required) {
  document::Problems problems;
  sysid::LogOptions options;
  options.channel = input.channel;
  if (required) {
    options.output_unit = required->unit;
    options.output_unit_of = required->of;
  }
  sysid::Campaign campaign = sysid::read_campaign(paths, problems, options);
  const auto driving = input.drive == "measured" ? std::span(campaign.logs) : std::span<sysid::Log>();
  for (const sysid::Log& log : driving) {
    if (log.pressure_kpa.empty()) {
      problems.add({log.path,
                    {1, 1},
                    {},
                    "the log has no column 'pressure_kpa', but --drive measured requires this column",
                    {}});
    } else if (const auto gap = sysid::pressure_gap(log)) {
      problems.add({log.path,
                    {1, 1},
                    {},
                    sysid::gap_sentence(log, *gap),
                    "cut the log at this gap and give the two parts as two logs, or use --drive command"});
    }
  }
  if (!problems.empty()) {
    const ExitCode refused = refuse_logs(problems);
    return tl::unexpected(campaign.unreadable ? ExitCode::io : refused);
  }
  if (input.drive == "command")
    sysid::begin_before_first_command(campaign.logs, input.begins_at_measured_pressure);
  return std::move(campaign.logs);
}

ExitCode refuse_logs(const document::Problems& problems) {
  const ExitCode refused = refuse(problems);
  std::set<std::string> told;
  for (const document::Problem& problem : problems.list()) {
    if (told.insert(problem.file).second) std::fputs(import_hint(problem.file).c_str(), stderr);
  }
  return refused;
}

tl::expected<sysid::GaugeFile, ExitCode> read_gauge(const std::string& path, const RequiredUnit& required) {
  auto gauge = read_input(path, sysid::read_gauge);
  if (!gauge || gauge->output_unit == required.unit) return gauge;
  return tl::unexpected(fail(ExitCode::input_refused,
                             path + ": the gauge is in " + std::string(name_of(gauge->output_unit)) +
                                 ", and " + required.of + " is in " + std::string(name_of(required.unit))));
}

}  // namespace softgrip::tools
