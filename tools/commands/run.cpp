// softgrip run: runs one sequence on a rig in the foreground.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/exit_code.h"
#include "base/files.h"
#include "base/numbers.h"
#include "daemon/service/daemon.h"
#include "daemon/socket/sequence_loader.h"
#include "daemon/socket/status_json.h"
#include "tools/client/daemon_client.h"
#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/client/set_option.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/commands/commands.h"
#include "tools/commands/rig_to_move.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

struct RunOptions {
  std::string sequence;
  std::vector<std::string> settings;
  std::string rig;
  std::string record;
  std::optional<std::uint64_t> seed;
  bool virtual_time = false;
  bool no_socket = false;
  bool quiet = false;
  bool json = false;
};

/// Prints the result. `reason` states why the sequence failed; it may be empty.
void report(const RunOptions& options, const daemon::Outcome& outcome, const std::string& reason) {
  const std::vector<std::string>& channels = outcome.channel_names;
  const std::string end =
      outcome.sequence_end ? std::string(control::name_of(*outcome.sequence_end)) : std::string("not run");
  const auto title = [&](std::size_t i) {
    return std::string(control::title_of(outcome.last.channels[i].result));
  };
  const bool began = daemon::reached_the_board(outcome.ending);
  if (options.json) {
    const Json safe_state_confirmed = began ? Json(outcome.safe_state_confirmed) : Json(nullptr);
    Json json{{"sequence_end", end},       {"left_safely", safe_state_confirmed},
              {"ticks", outcome.ticks},    {"overruns", outcome.overruns},
              {"slips", outcome.overruns}, {"wall_s", outcome.wall_s},
              {"results", Json::object()}};
    json["pressure_left_on_kpa"] = Json::object();
    for (const daemon::Outcome::LeftOn& each : outcome.left_on)
      json["pressure_left_on_kpa"][each.channel] = each.pressure_kpa;
    if (outcome.vents_after_s > 0) json["vents_after_s"] = outcome.vents_after_s;
    if (!reason.empty()) json["reason"] = reason;
    for (std::size_t i = 0; i < channels.size(); ++i) json["results"][channels[i]] = title(i);
    print_json(json);
    return;
  }
  if (!began) {
    std::printf("sequence not run; nothing was written to the board\n");
    return;
  }
  for (std::size_t i = 0; i < channels.size(); ++i)
    std::printf("%s: %s\n", channels[i].c_str(), title(i).c_str());
  const bool by_signal = outcome.ending == daemon::Ending::interrupted && outcome.signal != 0;
  std::printf("sequence %s%s; %s ticks, %s overruns in %s s; %s\n", end.c_str(),
              by_signal ? (" by " + name_of_signal(outcome.signal)).c_str() : "",
              std::to_string(outcome.ticks).c_str(), std::to_string(outcome.overruns).c_str(),
              significant(outcome.wall_s, 4).c_str(),
              outcome.safe_state_confirmed ? "the board confirmed the safe outputs"
                                           : "the board did NOT confirm the safe outputs");
  if (const std::string sentence = daemon::left_on_sentence(outcome); !sentence.empty())
    std::printf("warning: %s\n", sentence.c_str());
  if (!reason.empty()) std::printf("%s\n", reason.c_str());
}

/// Reports that the sequence file cannot be read. SEQUENCE may be the name of a sequence, as for `start`.
ExitCode no_sequence_file(const std::string& sequence, const std::string& why) {
  std::string message = "cannot read " + sequence + ": " + why;
  const std::string named = configuration_path("sequences/" + sequence + ".yaml");
  if (is_there(named))
    message += ". `softgrip run` needs the path of a sequence file: " + named;
  else if (sequence.find('/') == std::string::npos && !sequence.ends_with(".yaml"))
    message +=
        ". `softgrip run` needs the path of a sequence file; `softgrip start` also accepts the name of "
        "a sequence of the daemon";
  return fail(ExitCode::io, message);
}

/// Returns an exit code if softgripd listens on the socket of the rig, else nullopt. A simulated board can
/// run beside softgripd if `run` opens no socket.
std::optional<ExitCode> refuse_beside_daemon(const RunOptions& options, const rig::RigFile& rig) {
  const bool simulated = std::holds_alternative<simulation::SimulatedBoardSettings>(rig.board);
  if (options.virtual_time || (simulated && options.no_socket) || rig.socket.path.empty())
    return std::nullopt;
  if (!daemon_runs(rig.socket.path)) return std::nullopt;
  daemon::Outcome outcome;
  outcome.ending = daemon::Ending::board_taken;
  fail(ExitCode::state_refused, stop_the_daemon);
  report(options, outcome, {});
  return ExitCode::state_refused;
}

ExitCode run(const RunOptions& options) {
  const std::string path = options.rig.empty() ? configuration_path("rig.yaml") : options.rig;
  if (const std::string why = why_unreadable(options.sequence); !why.empty())
    return no_sequence_file(options.sequence, why);
  if (is_folder(options.sequence)) return no_sequence_file(options.sequence, "it is a folder");
  const auto arguments = arguments_of(options.settings);
  if (!arguments) return arguments.error();
  auto rig = read_rig(path);
  if (!rig) return rig.error();
  if (options.seed && !rig::reseed(*rig, *options.seed))
    return fail(ExitCode::usage, "--seed needs a simulated board");
  auto sequence = daemon::SequenceLoader(rig->settings, "").load_file(options.sequence, *arguments);
  if (!sequence) return refuse(sequence.error());
  std::fputs((*sequence)->remarks.format().c_str(), stderr);
  if (const auto code = refuse_beside_daemon(options, *rig)) return *code;

  daemon::DaemonOptions daemon_options;
  daemon_options.program = "softgrip run";
  daemon_options.virtual_time = options.virtual_time;
  daemon_options.sequence = std::move(*sequence);
  daemon_options.record_folder = options.record;
  daemon_options.listen = !options.no_socket;
  std::string reason;
  daemon_options.on_event = [&options, &reason](const daemon::EventEntry& event) {
    if (reason.empty()) reason = failure_reason(daemon::event_json(event));
    if (options.quiet) return;
    if (options.json) {
      print_json(daemon::event_json(event));
    } else {
      std::printf("%s\n", line_of_event(daemon::event_json(event)).c_str());
      std::fflush(stdout);
    }
  };
  daemon_options.on_start = [&options](const std::string& text) {
    if (!options.quiet) std::fprintf(stderr, "%s\n", text.c_str());
  };
  auto daemon = daemon::Daemon::create(std::move(*rig), std::move(daemon_options));
  if (!daemon) return fail(daemon.error().code, daemon.error().text);
  const daemon::Outcome outcome = (*daemon)->run();
  if (!outcome.message.empty()) fail(ExitCode::failed, outcome.message);
  if (!outcome.recording_error.empty())
    fail(ExitCode::io, "the recording is incomplete: " + outcome.recording_error);
  const bool completed = outcome.sequence_end == control::SequenceEnd::done;
  report(options, outcome, completed ? std::string() : reason);
  return daemon::exit_code_of(outcome);
}

}  // namespace

void add_run(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<RunOptions>(
      program, outcome, "run", "Run one sequence on a rig in the foreground, without a daemon", run);
  command->add_option("SEQUENCE", options->sequence, "Sequence file")->required();
  add_set_option(*command, options->settings);
  command->add_option("--rig", options->rig, "Rig file [config/rig.yaml, or the installed rig file]");
  command->add_option("--record", options->record, "Record into this folder; overrides the rig file");
  command->add_flag(
      "--virtual-time", options->virtual_time,
      "Run as fast as possible, with identical results in every run; only for simulated boards");
  command->add_option("--seed", options->seed, "Seed of a simulated board; overrides the rig file")
      ->check(seed_number());
  command->add_flag("--no-socket", options->no_socket,
                    "Do not open the socket of the rig file, so that no client can connect");
  command->add_flag("--quiet", options->quiet, "Print only the results");
  command->add_flag("--json", options->json, "Print events and results as JSON, one per line");
  command->footer(
      "After Ctrl-C or another ending signal, the command writes the safe outputs and then ends by the same "
      "signal,\nso that a loop of a shell does not start the next sequence.");
}

}  // namespace softgrip::tools
