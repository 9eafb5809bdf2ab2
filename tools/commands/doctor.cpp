// softgrip doctor: checks that the rig is ready to run.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <variant>

#include "base/clock.h"
#include "daemon/service/board_lock.h"
#include "daemon/service/daemon.h"
#include "daemon/service/signals.h"
#include "tools/client/daemon_client.h"
#include "tools/client/daemon_command.h"
#include "tools/client/daemon_text.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"
#include "tools/commands/rig_to_move.h"
#include "tools/commissioning/examinations.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

/// The folder in which systemd lists the enabled units.
constexpr const char* enabled_units = "/etc/systemd/system/multi-user.target.wants";
constexpr const char* daemon_holds_the_board =
    "softgripd runs and controls the board: stop softgripd, or omit --move";

struct DoctorOptions {
  std::string rig;
  std::string socket;
  bool move = false;
  bool json = false;
};

bool is_simulated(const rig::RigFile& rig) {
  return std::holds_alternative<simulation::SimulatedBoardSettings>(rig.board);
}

/// Checks the rig with data from the daemon, and checks the gateway programs, which connect clients to the
/// daemon. Disk and clock are not checked. Returns the daemon's status, or null if the daemon does not
/// respond.
Json ask_running(DaemonClient& client, const std::string& rig, doctor::Findings& findings) {
  const auto status = client.call({{"command", "status"}});
  const auto statistics = status ? client.call({{"command", "statistics"}}) : status;
  if (!status || !statistics) {
    const ClientFailure& failure = !status ? status.error() : statistics.error();
    findings.fail("daemon", failure.message,
                  "the socket exists, but softgripd does not respond: `systemctl status softgripd`");
    return nullptr;
  }
  doctor::examine_daemon(*status, *statistics, rig, findings);
  doctor::examine_gateways(enabled_units, installed_configuration(), findings);
  return *status;
}

/// Adds the last result of `softgrip health` to the findings. Adds nothing if there is no result.
void examine_health(const rig::RigFile& rig, doctor::Findings& findings) {
  for (const HealthLine& line : health_lines(last_health(rig.recorder.directory))) {
    if (line.good)
      findings.ok("health", line.text);
    else
      findings.warn("health", line.text,
                    line.advice.empty() ? "see the page of the finger in the folder " +
                                              rig.recorder.directory + "/" + health_folder
                                        : line.advice);
  }
}

void look_myself(const rig::RigFile& rig, bool move, doctor::Findings& findings) {
  doctor::examine_machine(rig, findings);
  doctor::examine_clock(findings);
  doctor::examine_disk(rig, findings);
  examine_health(rig, findings);
  const auto lock = daemon::BoardLock::take(rig);
  if (!lock) {
    findings.fail("board", lock.error(), "stop the program that controls the board, then repeat the command");
    return;
  }
  const MonotonicClock clock;
  auto board = daemon::make_board(rig, clock);
  doctor::examine_description(rig, *board, findings);
  const auto lines = doctor::examine_gpio(rig, findings);
  daemon::Signals signals;
  doctor::examine_rig(
      rig, *board, clock, [&signals] { return signals.first() != 0; }, move, {}, findings, lines.get(),
      tell_silence);
  if (signals.first() != 0 || !doctor::wants_bus_examination(findings)) return;
  board.reset();
  doctor::examine_bus(rig, findings);
}

ExitCode conclude(const DoctorOptions& options, const doctor::Examination& examination,
                  const doctor::Findings& findings) {
  if (options.json) {
    print_json(result::json_of(doctor::fields_of(examination, findings)));
  } else {
    const std::size_t columns = on_terminal() ? terminal_columns() : 100;
    std::fputs(doctor::text_of(examination, findings, columns, wants_colour()).c_str(), stdout);
  }
  return findings.worst() == doctor::Verdict::fail ? ExitCode::not_acceptable : ExitCode::done;
}

/// Prints that the user must name the rig file. A rig file in the current folder is not used, because it may
/// belong to another rig.
ExitCode ask_for_a_name(const std::string& socket) {
  const std::string near = configuration_path("rig.yaml");
  std::string hint;
  if (::access(near.c_str(), R_OK) == 0) {
    document::Problems problems;
    const auto rig = rig::load_rig(near, problems);
    hint = "; " + near + (rig && is_simulated(*rig) ? " is the simulated rig" : " exists here");
  }
  return fail(ExitCode::usage,
              "no daemon runs on " + socket +
                  ": give the rig file with --rig RIG, or the socket of the daemon with --socket" + hint);
}

/// Checks the rig of the running daemon if the user gave no rig file.
ExitCode run_unnamed(const DoctorOptions& options) {
  const std::string socket = options.socket.empty() ? default_socket_path() : options.socket;
  auto client = DaemonClient::connect(socket);
  if (!client && client.error().no_listener) return ask_for_a_name(socket);
  if (!client) return fail(client.error().code, client.error().message);
  if (options.move) return fail(ExitCode::state_refused, daemon_holds_the_board);
  doctor::Findings findings;
  const Json status = ask_running(*client, "", findings);
  doctor::examine_clock(findings);
  doctor::Examination examination{"-", "-", true};
  if (status.is_object()) {
    examination.rig = status.value("rig", "-");
    examination.simulated = status.value("simulated", false);
    if (const auto file = status.find("rig_file"); file != status.end() && file->is_string()) {
      examination.rig_file = file->get<std::string>();
    }
  }
  document::Problems problems;
  if (::access(examination.rig_file.c_str(), R_OK) == 0) {
    if (const auto rig = rig::load_rig(examination.rig_file, problems)) {
      doctor::examine_disk(*rig, findings);
      examine_health(*rig, findings);
    }
  }
  return conclude(options, examination, findings);
}

ExitCode run(const DoctorOptions& options) {
  if (options.rig.empty()) return run_unnamed(options);
  const std::string& path = options.rig;
  const auto rig = read_rig(path);
  if (!rig) return rig.error();

  doctor::Findings findings;
  auto client = DaemonClient::connect(options.socket.empty() ? rig->socket.path : options.socket);
  const bool runs = client.has_value() || !client.error().no_listener;
  if (runs && options.move) {
    return fail(ExitCode::state_refused, daemon_holds_the_board);
  }
  if (client) {
    ask_running(*client, rig->name, findings);
    doctor::examine_clock(findings);
    doctor::examine_disk(*rig, findings);
    examine_health(*rig, findings);
  } else if (runs) {
    findings.fail("daemon", client.error().message,
                  "the board was not checked, because the daemon does not respond");
  } else {
    look_myself(*rig, options.move, findings);
  }

  return conclude(options, {rig->name, path, runs, options.move, is_simulated(*rig)}, findings);
}

}  // namespace

void add_doctor(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<DoctorOptions>(
      program, outcome, "doctor",
      "Check that the rig is ready: computer, board, sensors, disk. Each check is ok, warn or fail", run);
  command->add_option("--rig", options->rig, "Rig file [the rig file of the running daemon]");
  command->add_flag("--move", options->move,
                    "Allow softgrip to move each finger slightly, within its limits, to check that the "
                    "finger follows the command");
  command->add_option("--socket", options->socket, "Socket of a running daemon [the socket in the rig file]");
  command->add_flag("--json", options->json, "Print the findings as JSON");
  command->footer(
      "If no daemon runs, this command writes the rest pressures to the board and reads the sensors. If the "
      "daemon runs, this command instead reads the status of the daemon.\nExit codes: 0 fit to run, 6 not "
      "fit to run, 2 no "
      "rig is named and no daemon runs, 3 the rig file is refused, 4 the rig file cannot be read, 5 --move "
      "was given while the daemon runs.");
}

}  // namespace softgrip::tools
