// softgrip-rig: emulates the board and the fingers of a rig on Modbus TCP or RTU.

#include <sched.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <optional>
#include <string>

#include "base/net/listener.h"
#include "simulation/emulator/emulator.h"
#include "simulation/emulator/server.h"
#include "tools/command_line/command.h"
#include "tools/command_line/options.h"
#include "tools/command_line/program.h"
#include "tools/programs/softgrip_rig_options.h"

namespace softgrip::tools {
namespace {

void add_options(CLI::App& program, Options& options) {
  program
      .add_option("--model", options.models,
                  "Model of the fingers: one file for all channels, or one file for each channel")
      ->required();
  program
      .add_option("--board", options.boards,
                  "Board map: a file, or a name in config/boards; give the option once for each module")
      ->capture_default_str();
  auto* tcp = program
                  .add_option("--tcp", options.port,
                              "TCP port; 0 selects a free port [1502, or the port in the rig file]")
                  ->check(whole_between(0, 65535));
  program
      .add_option("--rtu", options.rtu,
                  "Use Modbus RTU on this serial device; if the path does not exist, a pseudo-terminal is "
                  "created there")
      ->excludes(tcp);
  program.add_flag("--rtu-over-tcp", options.rtu_over_tcp, "Use Modbus RTU frames on the TCP port");
  program
      .add_option("--baud", options.baud, "Baud rate of the line [9600, or the baud rate in the rig file]")
      ->check(number_between(1200, 1000000));
  program.add_option("--format", options.format,
                     "Format of the line: 8N1, 8E1, 8O1, 8N2, 8E2 [8N1, or the format in the rig file]");
  program
      .add_option("--turnaround-s", options.turnaround_s,
                  "Response time of a module on the serial line [0, or the response time in the rig file]")
      ->check(number_between(0, 10));
  program.add_option("--bind", options.bind, "Numeric address to listen on")->capture_default_str();
  program.add_flag("--allow-network", options.allow_network,
                   "Allow an address that other computers can reach");
  program.add_option("--unit", options.unit,
                     "Unit id of the first module [1, or the unit id in the rig file]");
  auto* channels =
      program.add_option("--channels", options.channels, "Number of fingers")->capture_default_str();
  program
      .add_option("--rig", options.rig,
                  "Rig file of softgripd, from which board, unit id, channels and scaling are read")
      ->excludes(channels);
  program.add_option("--object", options.object,
                     "Object between the fingers: stone, screw or POSITION_MM[:YIELDING]");
  program
      .add_option("--object-out-at", options.object_out_at_s,
                  "Time from the first command to the removal of the object")
      ->check(number_between(0, 86400));
  program.add_option("--faults", options.faults, "Schedule of faults (YAML)");
  program
      .add_option("--watchdog-s", options.watchdog_s,
                  "Timeout of the board's communication watchdog; 0: no watchdog")
      ->check(number_between(0, 86400));
  program
      .add_option("--noise-mm", options.noise_mm,
                  "Standard deviation of the noise of the displacement sensor [mm]")
      ->capture_default_str()
      ->check(number_between(0, 1000));
  program
      .add_option("--pressure-noise-kpa", options.pressure_noise_kpa,
                  "Standard deviation of the noise of the pressure monitor [kPa]")
      ->capture_default_str()
      ->check(number_between(0, 1000));
  program.add_option("--seed", options.seed, "Seed of all noise")
      ->check(seed_number())
      ->capture_default_str();
  program.add_option("--truth", options.truth, "Write the true states to this CSV file");
  program
      .add_option("--truth-rate-hz", options.truth_rate_hz,
                  "Rows per second and channel in the file of --truth")
      ->capture_default_str()
      ->check(number_between(0.1, 1000));
  program.add_option("--control", options.control,
                     "Accept control commands on this Unix socket ('-': standard input)");
  program.footer(
      "Control commands: status, fault NAME, clear NAME, object out|back|stone|screw|POSITION_MM[:YIELDING], "
      "quit.\n"
      "SIGUSR1 removes the object.\nThe emulator is ready when it has printed 'listening on ADDRESS:PORT' or "
      "'listening on DEVICE'.");
}

/// Requests real-time scheduling, because a board responds in time even if the computer is busy. Without the
/// permission, the process keeps its ordinary scheduling. The thread is bound to one processor: on a busy
/// computer, a real-time thread that was not bound waited up to 49 ms (Linux 6.18, share of the fair server),
/// a bound thread at most 1.4 ms.
void ask_for_real_time() {
  constexpr int below_the_daemon = 40;
  sched_param parameters{};
  parameters.sched_priority = below_the_daemon;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) return;
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  std::size_t first = 0;
  while (first < CPU_SETSIZE && !CPU_ISSET(first, &allowed)) ++first;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(first, &one);
  (void)::sched_setaffinity(0, sizeof one, &one);
}

/// Opens the sockets or the serial line of the modules. Appends the addresses of the sockets or the line to
/// the start-up message.
ExitCode listen(const Setup& setup, simulation::ServerSockets& sockets, std::string& told) {
  if (setup.line) {
    auto end = simulation::SerialEnd::open(*setup.line);
    if (!end) return fail(ExitCode::io, end.error());
    sockets.line = setup.line;
    sockets.end = std::move(*end);
    told += "listening on " + setup.line->device + "\n";
    return ExitCode::done;
  }
  for (const softgrip::drivers::TcpAddress& address : setup.addresses) {
    auto listener = net::listen_tcp(address.host, address.port);
    if (!listener) return fail(ExitCode::io, listener.error());
    told += "listening on " + address.host + ":" + std::to_string(listener->port) + "\n";
    sockets.modbus.push_back(std::move(listener->socket));
  }
  return ExitCode::done;
}

ExitCode serve(const Options& options, const Setup& setup, simulation::Emulator& emulator,
               simulation::TruthLog* truth) {
  simulation::ServerSockets sockets;
  std::string told;
  if (const ExitCode code = listen(setup, sockets, told); code != ExitCode::done) return code;
  sockets.signals = take_server_signals({SIGUSR1});
  sockets.standard_input = options.control == "-";
  const bool control_socket = !options.control.empty() && !sockets.standard_input;
  if (control_socket) {
    auto control = net::listen_unix(options.control);
    if (!control) return fail(ExitCode::io, control.error());
    sockets.control = std::move(*control);
  }
  simulation::Server server(emulator, std::move(sockets));
  ask_for_real_time();
  say_ready(told);
  server.run([&] {
    if (truth != nullptr) truth->flush();
  });
  if (control_socket) ::unlink(options.control.c_str());
  if (truth != nullptr && !truth->good()) return fail(ExitCode::io, "cannot write " + options.truth);
  return ExitCode::done;
}

ExitCode run(const Options& options) {
  if (!net::is_loopback(options.bind) && !options.allow_network) {
    return fail(ExitCode::usage,
                "other computers could reach " + options.bind +
                    ", and Modbus has no passwords: to use this address, add --allow-network");
  }
  auto setup = make_setup(options);
  if (!setup) return setup.error();
  simulation::Emulator emulator(setup->emulator);
  std::optional<simulation::TruthLog> truth;
  if (!options.truth.empty()) {
    const double decimation =
        std::round(1e9 / static_cast<double>(simulation::Emulator::grid) / options.truth_rate_hz);
    truth.emplace(options.truth, static_cast<std::uint32_t>(decimation));
    if (!truth->good()) return fail(ExitCode::io, "cannot write " + options.truth);
    truth->add(emulator);
    emulator.on_grid([&] { truth->add(emulator); });
  }
  return serve(options, *setup, emulator, truth ? &*truth : nullptr);
}

}  // namespace
}  // namespace softgrip::tools

int main(int argc, char** argv) {
  using namespace softgrip::tools;
  Options options;
  return run_server_program(
      {"softgrip-rig",
       "Emulate a rig in real time behind a Modbus board: valves, fingers, object, watchdog, faults.",
       [&](CLI::App& program) { add_options(program, options); }, [&] { return run(options); }},
      argc, argv);
}
