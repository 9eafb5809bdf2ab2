#include "tools/investigation/experiment_rig.h"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <variant>

#include "base/exit_code.h"
#include "base/files.h"
#include "base/numbers.h"
#include "base/random.h"
#include "base/text.h"
#include "daemon/socket/sequence_loader.h"

namespace softgrip::tools {
namespace {

namespace fs = std::filesystem;

/// Largest share of the displacement range that the finger may use. The displacement is predicted with the
/// gain of the finger in the logs. The first value applies to pressures that the logs contain. The second
/// value applies to higher pressures, at which creep and softening may increase the displacement.
constexpr double known_range_share = 0.95;
constexpr double predicted_range_share = 0.85;

tl::unexpected<NotPlayed> failed(std::string why, ExitCode code = ExitCode::failed) {
  return tl::unexpected(NotPlayed{false, std::move(why), code});
}
tl::unexpected<NotPlayed> stopped(std::string why) {
  return tl::unexpected(NotPlayed{true, std::move(why)});
}

std::string what_moves(const sysid::NextExperiment& experiment, const std::string& rig) {
  const sysid::JudgedWaveform& best = experiment.best.value();
  double largest_kpa = 0;
  for (const sysid::Corner& corner : best.waveform.corners)
    largest_kpa = std::max(largest_kpa, corner.pressure_kpa);
  return rig + " will move: " + best.waveform.name + ", up to " + significant(largest_kpa, 3) + " kPa, " +
         significant(best.minutes, 2) + " minutes";
}

tl::expected<sysid::Log, NotPlayed> log_of(const std::string& path, const std::string& channel) {
  document::Problems problems;
  sysid::LogOptions options;
  options.channel = channel;
  options.output_unit = model::OutputUnit::mm;
  options.output_unit_of = "the investigation";
  sysid::Campaign campaign = sysid::read_campaign({path}, problems, options);
  if (campaign.logs.empty()) return failed("the log of the experiment was refused:\n" + problems.format());
  return std::move(campaign.logs.front());
}

/// Runs `command IN OUT` in a shell and waits until it ends. Removes an existing file OUT before, so that a
/// result of an earlier call cannot be read as the result of this call.
tl::expected<void, NotPlayed> call(const std::string& command, const std::string& in,
                                   const std::string& out) {
  std::error_code error;
  fs::remove(out, error);
  if (error) return failed("cannot remove the earlier result " + out + ": " + error.message());
  std::fflush(nullptr);
  const int status = std::system((command + " " + shell_word(in) + " " + shell_word(out)).c_str());
  const bool by_signal = WIFSIGNALED(status) || (WIFEXITED(status) && WEXITSTATUS(status) == 128 + SIGINT);
  // Ctrl-C also sends a signal to this process, but system() ignores this signal until the command ends.
  const bool by_user =
      (WIFEXITED(status) && by_signal) || (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT);
  if (by_user) note_ending_signal(SIGINT);
  if (by_signal) return stopped("the command '" + command + "' was stopped by a signal");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return failed("the command '" + command + "' failed with exit code " +
                  std::to_string(WEXITSTATUS(status)));
  return {};
}

tl::expected<sysid::GaugeFile, NotPlayed> gauge_at(const std::string& path) {
  document::Problems problems;
  auto gauge = sysid::read_gauge(path, problems);
  if (!gauge) return failed("the gauge file was refused:\n" + problems.format());
  return std::move(*gauge);
}

std::string command_csv(const sysid::Waveform& waveform, double interval_s) {
  std::string csv = "time_s,pressure_command_kpa\n";
  const std::vector<double> samples = sysid::sampled_kpa(waveform, interval_s);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    // Times are rounded to 1 µs, so that programs that print six decimals write equal times.
    const double time_s = std::round(1e6 * static_cast<double>(i) * interval_s) / 1e6;
    csv += shortest(time_s) + "," + shortest(samples[i]) + "\n";
  }
  return csv;
}

}  // namespace

sysid::RigLimits ExperimentRig::limits(double gain_mm_per_kpa, double known_kpa) const {
  const control::LimitSettings& own = rig.settings.channels[channel].limits;
  double largest_kpa = std::min(own.pressure_max_kpa, rig.valves[channel].range_max_kpa);
  if (gain_mm_per_kpa > 0) {
    const double range_kpa = own.displacement_max_mm / gain_mm_per_kpa;
    const double known_share_kpa = std::min(known_kpa, known_range_share * range_kpa);
    largest_kpa = std::min(largest_kpa, std::max(known_share_kpa, predicted_range_share * range_kpa));
  }
  return {largest_kpa, std::min(own.slew_up_kpa_per_s, own.slew_down_kpa_per_s)};
}

ExperimentRig ExperimentRig::at(std::uint64_t occasion) const {
  ExperimentRig other = *this;
  rig::reseed(other.rig, derived_seed(rig.seed.value_or(0), occasion));
  return other;
}

std::optional<std::size_t> channel_of(const rig::RigFile& rig, const std::string& name) {
  const auto& channels = rig.settings.channels;
  if (name.empty() && channels.size() == 1) return 0;
  const auto found = std::ranges::find(channels, name, &control::ChannelSettings::name);
  if (found == channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - channels.begin());
}

tl::expected<ExperimentRig, std::string> experiment_rig(rig::RigFile rig, const std::string& channel) {
  const auto& channels = rig.settings.channels;
  const auto at = channel_of(rig, channel);
  if (!at && channel.empty())
    return tl::unexpected("the rig has " + std::to_string(channels.size()) +
                          " channels: select one with --channel");
  if (!at) return tl::unexpected("the rig has no channel '" + channel + "'");
  ExperimentRig result{std::move(rig), *at, false};
  const control::LimitSettings& limits = result.rig.settings.channels[result.channel].limits;
  if (control::resting_kpa(limits) != 0) {
    return tl::unexpected("channel '" + result.channel_name() + "' never " +
                          (limits.pressure_min_kpa > 0 ? "goes down to" : "rests at") +
                          " 0 kPa, but experiments begin and end at 0 kPa");
  }
  if (limits.pressure_max_kpa <= 0) {
    return tl::unexpected("channel '" + result.channel_name() +
                          "' permits no pressure above 0 kPa (pressure_max_kpa: " +
                          written(limits.pressure_max_kpa) + "), but experiments raise the pressure");
  }
  result.simulated = std::holds_alternative<simulation::SimulatedBoardSettings>(result.rig.board);
  return result;
}

tl::expected<std::string, NotPlayed> run_on(const ExperimentRig& rig, const std::string& name,
                                            const std::string& sequence_yaml, const std::string& folder) {
  auto sequence = daemon::SequenceLoader(rig.rig.settings, "").load_text(name + ".yaml", sequence_yaml);
  if (!sequence) return failed("the rig refused the sequence:\n" + sequence.error().format());
  daemon::DaemonOptions options;
  options.virtual_time = rig.simulated;
  options.sequence = std::move(*sequence);
  options.record_folder = (fs::path(folder) / name).string();
  options.listen = false;
  std::string fault;  // the first fault of the run; empty: there was no fault
  options.on_event = [&fault](const daemon::EventEntry& event) {
    if (fault.empty() && event.severity == daemon::Severity::error) fault = event.text;
  };
  const auto outcome = rig.run(rig.rig, options);
  if (!outcome) return failed(outcome.error());
  // A signal at the very end of an experiment does not stop this experiment, but it must prevent the next
  // experiment.
  if (outcome->signal != 0) {
    if (!outcome->safe_state_confirmed)
      return failed("stopped by the user, but the board did NOT confirm the safe outputs",
                    daemon::exit_code_of(*outcome));
    const std::string left_on = daemon::left_on_sentence(*outcome);
    return stopped("stopped by the user; " + (left_on.empty() ? "the rig is vented" : left_on));
  }
  if (outcome->ending != daemon::Ending::sequence_ended || !outcome->sequence_end ||
      *outcome->sequence_end != control::SequenceEnd::done) {
    const std::string& why = outcome->message.empty() ? fault : outcome->message;
    return failed("the experiment did not run to its end" + (why.empty() ? std::string() : ": " + why),
                  daemon::exit_code_of(*outcome));
  }
  if (!outcome->safe_state_confirmed)
    return failed("the board did not confirm the safe outputs", ExitCode::io);
  return options.record_folder;
}

tl::expected<sysid::Log, NotPlayed> played_on(const ExperimentRig& rig, const std::string& name,
                                              const std::string& sequence_yaml, const std::string& folder) {
  const auto recording = run_on(rig, name, sequence_yaml, folder);
  if (!recording) return tl::unexpected(recording.error());
  return log_of(*recording, rig.channel_name());
}

Player rig_player(ExperimentRig rig, Consent consent) {
  return [rig = std::move(rig), consent = std::move(consent)](
             const sysid::NextExperiment& experiment,
             const std::string& folder) -> tl::expected<sysid::Log, NotPlayed> {
    if (!rig.simulated &&
        !consent(what_moves(experiment, "channel '" + rig.channel_name() + "' of " + rig.rig.name)))
      return stopped("softgrip was not allowed to move the rig");
    return played_on(rig, "recording", sysid::sequence_yaml(experiment, rig.channel_name()), folder);
  };
}

Player command_player(std::string command, double interval_s, Consent consent) {
  return [command = std::move(command), interval_s, consent = std::move(consent)](
             const sysid::NextExperiment& experiment,
             const std::string& folder) -> tl::expected<sysid::Log, NotPlayed> {
    if (!consent(what_moves(experiment, "the rig behind '" + command + "'")))
      return stopped("softgrip was not allowed to move the rig");
    const std::string in = (fs::path(folder) / "command.csv").string();
    const std::string out = (fs::path(folder) / "log.csv").string();
    if (const auto written = write_file(in, command_csv(experiment.best->waveform, interval_s)); !written)
      return failed(written.error());
    if (const auto called = call(command, in, out); !called) return tl::unexpected(called.error());
    return log_of(out, "");
  };
}

tl::expected<sysid::GaugeFile, NotPlayed> gauge_file_of(const std::vector<sysid::GaugeReading>& readings,
                                                        const std::string& folder) {
  const std::string path = (fs::path(folder) / "gauge.csv").string();
  if (const auto written = write_file(path, sysid::format_gauge(readings)); !written)
    return failed(written.error());
  return gauge_at(path);
}

GaugeTaker command_gauge(std::string command, Consent consent) {
  return [command = std::move(command), consent = std::move(consent)](
             const std::vector<double>& positions_mm,
             const std::string& folder) -> tl::expected<sysid::GaugeFile, NotPlayed> {
    if (!consent("'" + command + "' will put the sensor's target at " + std::to_string(positions_mm.size()) +
                 " positions"))
      return stopped("softgrip was not allowed to check the sensor");
    const std::string in = (fs::path(folder) / "gauge_asked.csv").string();
    const std::string out = (fs::path(folder) / "gauge.csv").string();
    if (const auto written = write_file(in, sysid::positions_csv(positions_mm)); !written)
      return failed(written.error());
    if (const auto called = call(command, in, out); !called) return tl::unexpected(called.error());
    return gauge_at(out);
  };
}

}  // namespace softgrip::tools
