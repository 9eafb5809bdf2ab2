// The program softgripd: reads its command line and runs the daemon.

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "base/exit_code.h"
#include "base/files.h"
#include "base/option_checks.h"
#include "base/version.h"
#include "daemon/service/daemon.h"
#include "daemon/service/event_printer.h"
#include "daemon/service/named_device.h"
#include "daemon/service/runtime_folder.h"
#include "daemon/service/safe_outputs.h"
#include "rig/check.h"

namespace {

using namespace softgrip;

struct Arguments {
  std::string config;
  std::string sequence;
  std::string record;
  std::string histograms;
  std::string device;
  bool check = false;
  bool safe_outputs = false;
  bool virtual_time = false;
  bool no_socket = false;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s;
};

/// Limits of --duration-s. The clock cannot represent a time after some 290 years.
constexpr double shortest_run_s = 0.001, longest_run_s = 1e8;

void declare(CLI::App& program, Arguments& arguments) {
  program.add_option("--config", arguments.config, "the rig file")->required()->type_name("RIG");
  program.add_flag("--check", arguments.check,
                   "check the rig file and the sequence, report their problems, and exit");
  program.add_flag("--safe-outputs", arguments.safe_outputs,
                   "vent and exit: write the rest pressure of every channel until the board confirms these "
                   "pressures. If $SERVICE_RESULT is success (ExecStopPost= of the unit), do nothing");
  program
      .add_option(
          "--device", arguments.device,
          "for the udev rule: exit with code 0 if the rig file names this device of the computer, otherwise "
          "with code 6. For an analog converter, also print the attributes that the daemon writes")
      ->type_name("gpiochipN|iio:deviceN");
  program.add_flag("--virtual-time", arguments.virtual_time,
                   "run as fast as possible on a simulated board, with identical results in every run; "
                   "requires --sequence or --duration-s");
  program.add_option("--seed", arguments.seed, "seed of a simulated board; overrides the rig file")
      ->type_name("N")
      ->check(seed_number());
  program
      .add_option("--sequence", arguments.sequence,
                  "start this sequence when the rig is idle, and exit after the sequence")
      ->type_name("FILE");
  program.add_option("--duration-s", arguments.duration_s, "exit after S seconds")
      ->type_name("S")
      ->check(number_between(shortest_run_s, longest_run_s));
  program.add_option("--record", arguments.record, "write one recording of the whole run into this folder")
      ->type_name("DIR");
  program
      .add_option("--histograms", arguments.histograms,
                  "at the end, write the timing histograms of the control loop and the bus to this file, in "
                  "the format of cyclictest")
      ->type_name("FILE");
  program.add_flag("--no-socket", arguments.no_socket,
                   "do not open the socket of the rig file, so that no client can connect");
  program.set_version_flag("--version", "softgripd " + std::string(software_version()));
  program.footer(
      "Exit codes: 0 done, 1 failed, 2 usage, 3 configuration or sequence refused, 4 I/O, 5 the rig's state "
      "does not\n"
      "allow the sequence, 6 the sequence was not completed.\n"
      "If a signal such as SIGINT or SIGTERM ends softgripd, softgripd first writes and confirms the\n"
      "safe outputs and closes the recording. It then ends with exit code 0. With --sequence or\n"
      "--duration-s, it ends by the received signal and not with exit code 0.\n"
      "softgripd reads the configuration only when it starts. Restart softgripd after each change of\n"
      "the configuration.");
}

/// Writes a message to the standard error. If the standard error cannot be written, the message is lost.
/// fmt::print() is not used, because it would throw an exception in this case.
void complain(const std::string& sentence) {
  std::fputs(("softgripd: " + sentence + "\n").c_str(), stderr);
}

ExitCode refuse(const document::Problems& problems) {
  std::fputs(problems.format().c_str(), stderr);
  return ExitCode::input_refused;
}

/// Returns nullopt if the file can be read. Otherwise prints a sentence and returns ExitCode::io.
std::optional<ExitCode> unreadable(const std::string& path) {
  const auto file = open_regular(path);
  if (file) return std::nullopt;
  complain(fmt::format("cannot read {}: {}", path, file.error()));
  return ExitCode::io;
}

/// Returns an exit code if the rig file or the sequence file cannot be read, otherwise nullopt.
std::optional<ExitCode> any_unreadable(const Arguments& arguments) {
  if (const auto code = unreadable(arguments.config)) return code;
  return arguments.sequence.empty() ? std::nullopt : unreadable(arguments.sequence);
}

/// Returns false and prints a sentence if the file of an option is of another kind than the option requires.
bool has_kind(const rig::CheckReport& report, const std::string& path, rig::FileKind kind,
              std::string_view option) {
  for (const rig::CheckedFile& file : report.files) {
    // The problems of the report name a file of an unknown kind.
    if (file.path != path || file.kind == kind || file.kind == rig::FileKind::unknown) continue;
    complain(fmt::format("{} is a {}, but {} requires a {}", path, rig::name_of(file.kind), option,
                         rig::name_of(kind)));
    return false;
  }
  return true;
}

ExitCode check(const Arguments& arguments) {
  if (const auto code = any_unreadable(arguments)) return *code;
  std::vector<std::string> files{arguments.config};
  if (!arguments.sequence.empty()) files.push_back(arguments.sequence);
  const rig::CheckReport report = rig::check_files(files);
  std::fputs(report.problems.format().c_str(), stderr);
  const bool has_kinds = has_kind(report, arguments.config, rig::FileKind::rig, "--config") &&
                         (arguments.sequence.empty() ||
                          has_kind(report, arguments.sequence, rig::FileKind::sequence, "--sequence"));
  if (!has_kinds || !report.accepted()) return ExitCode::input_refused;
  document::Problems problems;  // its warnings are not printed, because the report contains them
  const auto rig = rig::load_rig(arguments.config, problems);
  if (!rig) return refuse(problems);
  const MonotonicClock clock;
  fmt::print("{}{}: fit to run\n",
             daemon::startup_report(*rig, *daemon::make_board(*rig, clock), nullptr, "softgripd"),
             arguments.config);
  return ExitCode::done;
}

ExitCode say_whether_named(const Arguments& arguments) {
  if (const auto code = unreadable(arguments.config)) return *code;
  document::Problems problems;
  const auto rig = rig::load_rig(arguments.config, problems);
  if (!rig) return refuse(problems);
  const auto named = daemon::named_device(*rig, arguments.device);
  if (!named) return ExitCode::not_acceptable;
  fmt::print("{}\n", fmt::join(named->written, " "));
  return ExitCode::done;
}

ExitCode end_of_safe_outputs(const daemon::SafeOutputsReport& report) {
  fmt::print("safe outputs: {}\n", report.text);
  return daemon::exit_code_of(report.end);
}

/// Writes the safe outputs. If there is a copy of the rig file that the last softgripd read, uses this copy.
/// The rig file could be incomplete, because a user may be editing it.
ExitCode safe_outputs(const Arguments& arguments) {
  const char* result = std::getenv("SERVICE_RESULT");
  if (!daemon::safe_outputs_needed(result == nullptr ? "" : result)) {
    return end_of_safe_outputs(
        {daemon::SafeOutputsEnd::not_needed, "softgripd ended normally; the board keeps its last outputs"});
  }
  document::Problems problems;
  const auto kept = daemon::kept_rig(arguments.config);
  if (!kept) {
    if (const auto code = unreadable(arguments.config)) return *code;
  }
  const auto rig = kept ? kept : rig::load_rig(arguments.config, problems);
  if (!rig || !problems.empty()) return refuse(problems);
  daemon::SafeOutputsReport report = daemon::vent_rig(*rig);
  if (kept) report.text += "; the rig file was used as the last softgripd had read it";
  const bool safe = daemon::exit_code_of(report.end) == ExitCode::done;
  if (kept && safe) daemon::forget_rig(arguments.config);
  return end_of_safe_outputs(report);
}

/// Longest wait for the last lines if the process ends because a thread hangs.
constexpr std::chrono::milliseconds longest_last_output{500};

tl::expected<void, std::string> write_histograms(const std::string& path, const daemon::Daemon& daemon) {
  const daemon::LoopStatistics& loop = daemon.loop_statistics();
  const daemon::BusStatistics& bus = daemon.bus_statistics();
  return write_file(path, fmt::format("{}{}{}{}{}# Ticks: {}\n"
                                      "# Overruns, woken late: {}\n"
                                      "# Overruns, took long: {}\n"
                                      "# Slips, woken late: {}\n"  // words-ok: deprecated name
                                      "# Slips, took long: {}\n"   // words-ok: deprecated name
                                      "# Exchanges: {}\n# Failed exchanges: {}\n",
                                      loop.wake_up.cyclictest_text("loop wake-up, us"),
                                      loop.compute.cyclictest_text("loop compute, us"),
                                      loop.reading_age.cyclictest_text("reading age, us"),
                                      bus.wake_up.cyclictest_text("bus wake-up, us"),
                                      bus.exchange.cyclictest_text("exchange, us"), loop.ticks.value(),
                                      loop.overruns_woken_late.value(), loop.overruns_took_long.value(),
                                      loop.overruns_woken_late.value(), loop.overruns_took_long.value(),
                                      bus.exchanges.value(), bus.failures.value()));
}

ExitCode run(const Arguments& arguments) {
  if (same_file(arguments.config, arguments.histograms)) {
    complain(fmt::format("{} is the rig file, which is never overwritten: give the name of another file",
                         arguments.histograms));
    return ExitCode::usage;
  }
  if (const auto code = any_unreadable(arguments)) return *code;
  document::Problems problems;
  auto rig = rig::load_rig(arguments.config, problems);
  if (!rig || !problems.empty()) return refuse(problems);
  std::fputs(problems.format().c_str(), stderr);  // the rig is valid, so these problems are warnings
  if (arguments.seed && !rig::reseed(*rig, *arguments.seed)) {
    complain("--seed needs a simulated board");
    return ExitCode::usage;
  }

  daemon::DaemonOptions options;
  options.virtual_time = arguments.virtual_time;
  options.duration_s = arguments.duration_s;
  options.record_folder = arguments.record;
  options.listen = !arguments.no_socket;
  if (!arguments.sequence.empty()) {
    auto sequence = daemon::SequenceLoader(rig->settings, "").load_file(arguments.sequence);
    if (!sequence) return refuse(sequence.error());
    std::fputs((*sequence)->remarks.format().c_str(), stderr);
    options.sequence = std::move(*sequence);
  }
  daemon::EventPrinter printer(!arguments.virtual_time);
  options.on_event = [&printer](const daemon::EventEntry& event) { printer.print(event); };
  options.before_sudden_end = [&printer] { printer.wait_until_written(longest_last_output); };
  options.on_start = [&printer](const std::string& report) { printer.print_report(report); };

  auto daemon = daemon::Daemon::create(std::move(*rig), std::move(options));
  if (!daemon) {
    complain(daemon.error().text);
    return daemon.error().code;
  }
  const daemon::Outcome outcome = (*daemon)->run();
  printer.print_end(outcome);
  ExitCode code = daemon::exit_code_of(outcome);
  if (arguments.histograms.empty()) return code;
  if (const auto written = write_histograms(arguments.histograms, **daemon); !written) {
    complain(written.error());
    if (code == ExitCode::done)
      code = ExitCode::io;  // the result of the run is more important than the error of its output
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Arguments arguments;
    CLI::App program("softgripd: drives a soft gripper from a rig file", "softgripd");
    declare(program, arguments);
    try {
      program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return program.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::usage);
    }
    // The mode --check writes its result to the standard output. All other modes report their result by the
    // exit code.
    const ExitCode code = arguments.safe_outputs      ? safe_outputs(arguments)
                          : arguments.check           ? with_output_checked(check(arguments), "softgripd")
                          : !arguments.device.empty() ? say_whether_named(arguments)
                                                      : run(arguments);
    // If the daemon has no sequence and no duration, a signal is its usual end. Otherwise, a signal
    // interrupts the run.
    const bool has_an_end = !arguments.sequence.empty() || arguments.duration_s;
    if (has_an_end && ending_signal() != 0) end_by_signal(ending_signal());
    return static_cast<int>(code);
  } catch (const std::exception& error) {
    complain(error.what());
    return static_cast<int>(ExitCode::failed);
  }
}
