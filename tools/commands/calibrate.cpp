// softgrip calibrate: calibrates sensor and valve at two points against a gauge and a manometer.

#include <unistd.h>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/text.h"
#include "tools/client/daemon_client.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/options.h"
#include "tools/command_line/output.h"
#include "tools/command_line/terminal.h"
#include "tools/commands/commands.h"
#include "tools/commands/rig_to_move.h"
#include "tools/commissioning/calibration_results.h"
#include "tools/commissioning/motion_safety.h"
#include "tools/commissioning/procedure.h"

namespace softgrip::tools {
namespace {

struct CalibrateOptions {
  std::string rig;
  std::string channel;
  std::string socket;
  bool sensor = false;
  bool valve = false;
  bool dead_zone = false;
  bool move = false;
  bool manometer = false;
  std::vector<double> at_kpa;
  std::vector<std::string> gauge_mm;
  std::vector<std::string> manometer_kpa;
  double settle_s = 2;
  double average_s = 2;
  double ramp_s = 10;
  std::size_t repeats = 1;
  std::string date;
  std::string out = "-";
  bool write = false;
  bool yes = false;
};

/// Shortest ramp for the dead zone, as a multiple of the longest delay of the valve that the rig file
/// permits. During this delay, the command then rises by at most 10 % of the ramp.
constexpr double delays_per_ramp = 10;

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm date{};
  ::localtime_r(&now, &date);
  char text[16] = "";
  std::strftime(text, sizeof text, "%Y-%m-%d", &date);
  return text;
}

std::string names_of(const rig::RigFile& rig) {
  return with_commas(rig.settings.channels, &control::ChannelSettings::name);
}

/// Sets the pressures of the two calibration points to the values of --at-kpa, or to default values if the
/// option is absent. Refuses values outside the limits.
std::optional<ExitCode> set_pressures(const CalibrateOptions& options, const control::LimitSettings& limits,
                                      calibrate::Settings& settings) {
  calibrate::set_places(settings, limits);
  if (!options.at_kpa.empty()) {
    settings.low_kpa = options.at_kpa[0];
    settings.high_kpa = options.at_kpa[1];
  }
  const bool inside =
      settings.low_kpa >= limits.pressure_min_kpa && settings.high_kpa <= limits.pressure_max_kpa;
  if (inside && settings.low_kpa < settings.high_kpa) return std::nullopt;
  return fail(
      ExitCode::input_refused,
      "--at-kpa LOW HIGH: LOW must be below HIGH, and both must be within the limits of the rig file");
}

/// Returns the prepared answers, one for each visit to a position. If the user gave two answers, the pair is
/// repeated for all visits.
std::vector<std::string> spread(const std::vector<std::string>& answers, std::size_t repeats) {
  std::vector<std::string> all;
  if (answers.size() != 2) return answers;
  for (std::size_t i = 0; i < repeats; ++i) all.insert(all.end(), answers.begin(), answers.end());
  return all;
}

/// Returns an exit code if a daemon uses the board of the rig, or if the user does not allow that a held part
/// drops. Otherwise returns nullopt.
std::optional<ExitCode> refuse_state(const CalibrateOptions& options, const rig::RigFile& rig) {
  if (daemon_runs(options.socket.empty() ? rig.socket.path : options.socket))
    return fail(ExitCode::state_refused, stop_the_daemon);
  if (options.move || options.yes || !may_hold_a_part(rig)) return std::nullopt;
  if (::isatty(STDIN_FILENO) == 1 &&
      confirmed("the calibration writes the rest pressures to all fingers, so a held part drops. Continue?"))
    return std::nullopt;
  return fail(ExitCode::state_refused,
              "the board was not used, because the calibration also writes the rest pressures, and the "
              "fingers may still hold a part: remove the part, then repeat the command with --yes");
}

calibrate::Expected<calibrate::Results> measure(const rig::RigFile& rig, const CalibrateOptions& options,
                                                const calibrate::Settings& settings, MotionSession& session,
                                                calibrate::TerminalOperator& terminal) {
  calibrate::Results results;
  results.channel = settings.channel;
  results.date = options.date.empty() ? today() : options.date;
  if (options.valve) {
    terminal.prepare(spread(options.manometer_kpa, settings.repeats));
    const bool by_monitor = !options.manometer && options.manometer_kpa.empty() &&
                            rig.settings.channels[settings.channel].pressure_measured;
    auto valve = calibrate::calibrate_valve(rig, session, terminal, settings, by_monitor);
    if (!valve) return tl::unexpected(valve.error());
    results.valve = std::move(*valve);
  }
  if (options.dead_zone) {
    auto zone = calibrate::search_dead_zone(rig, session, terminal, settings);
    if (!zone) return tl::unexpected(zone.error());
    results.dead_zone = *zone;
  }
  if (options.sensor) {
    terminal.prepare(spread(options.gauge_mm, settings.repeats));
    auto sensor = calibrate::calibrate_sensor(rig, session, terminal, settings);
    if (!sensor) return tl::unexpected(sensor.error());
    results.sensor = std::move(*sensor);
    if (settings.may_move) {
      results.motion =
          calibrate::Motion{settings.low_kpa, settings.high_kpa, settings.settle_s + settings.average_s / 2,
                            calibrate::ramp_speed_kpa_per_s(rig, settings.channel)};
    }
  }
  return results;
}

/// Repeats the question until the answer is yes or no.
bool confirmed(calibrate::TerminalOperator& terminal, ManualRig& manual, const std::string& question) {
  constexpr Nanoseconds look_ns = 50'000'000;
  for (;;) {
    terminal.ask(question + " [yes/no]");
    std::optional<std::string> answer;
    while (!(answer = terminal.answer()) && !terminal.gone() && !manual.stopped()) {
      manual.clock().sleep_until(manual.clock().now() + look_ns);
    }
    if (!answer) return false;
    if (*answer == "yes" || *answer == "y") return true;
    if (*answer == "no" || *answer == "n") return false;
    terminal.tell("`" + *answer + "` is neither yes nor no");
  }
}

/// Prints the warnings about the results. Returns true if the results may be written to the files.
bool accepted(const rig::RigFile& rig, const calibrate::Results& results, const CalibrateOptions& options,
              calibrate::TerminalOperator& terminal, ManualRig& manual) {
  const std::vector<std::string> warnings = calibrate::plausibility_warnings(rig, results);
  for (const std::string& sentence : warnings) std::fprintf(stderr, "doubtful: %s\n", sentence.c_str());
  if (warnings.empty() || !options.write || options.yes) return true;
  return confirmed(terminal, manual, "write the points into " + rig.path + " nevertheless?");
}

ExitCode write_into_rig(const rig::RigFile& rig, const calibrate::Results& results) {
  const std::string& channel = rig.settings.channels[results.channel].name;
  const auto changed = calibrate::updated_rig(rig.inputs.front().text, rig, results);
  if (!changed) return fail(ExitCode::not_acceptable, "not written: " + changed.error());
  const auto backup = calibrate::write_rig(rig, *changed);
  if (!backup) return fail(ExitCode::io, "not written: " + backup.error());
  std::fprintf(stderr,
               "%s: the new calibration points were written into channel `%s`; the previous version of the "
               "file is %s\n",
               rig.path.c_str(), channel.c_str(), backup->c_str());
  return ExitCode::done;
}

ExitCode write_results(const rig::RigFile& rig, const calibrate::Results& results,
                       const CalibrateOptions& options) {
  const std::string text = calibrate::snippet(rig, results);
  if (const auto written = write_output(options.out, text); !written)
    return fail(ExitCode::io, written.error());
  if (options.out != "-" && !options.write) {
    std::fprintf(report_stream(options.out),
                 "%s: copy the lines of this file into channel `%s` of %s, then run softgrip check\n",
                 options.out.c_str(), rig.settings.channels[results.channel].name.c_str(), rig.path.c_str());
  }
  return ExitCode::done;
}

/// Checks the options before any motion. Returns the settings of the calibration or an exit code.
tl::expected<calibrate::Settings, ExitCode> prepare(CalibrateOptions& options, const rig::RigFile& rig) {
  const auto channel = channel_of(rig, options.channel);
  if (!channel) {
    const std::string wrong = options.channel.empty() ? "the rig has several channels"
                                                      : "the rig has no channel `" + options.channel + "`";
    return tl::unexpected(
        fail(ExitCode::usage, wrong + "; give one of its channels with --channel: " + names_of(rig)));
  }
  if (!options.sensor && !options.valve && !options.dead_zone) {
    options.sensor = true;
    options.valve = options.dead_zone = options.move;
  }
  if ((options.valve || options.dead_zone) && !options.move) {
    return tl::unexpected(fail(
        ExitCode::usage, "the calibration of valve and dead zone moves the finger, so it requires --move"));
  }
  for (const auto& [option, answers] :
       {std::pair("--gauge-mm", &options.gauge_mm), std::pair("--manometer-kpa", &options.manometer_kpa)}) {
    for (const std::string& answer : *answers) {
      if (!calibrate::typed_number(answer)) {
        return tl::unexpected(fail(ExitCode::input_refused, "`" + answer + "` is not a number"));
      }
    }
    const std::size_t count = answers->size(), visits = 2 * options.repeats;
    if (count == 0 || count == 2 || count == visits) continue;
    return tl::unexpected(
        fail(ExitCode::usage, std::string(option) + " has " + std::to_string(count) + " readings, but " +
                                  (visits == 2 ? "2" : "2 or " + std::to_string(visits)) + " are necessary"));
  }
  if (options.dead_zone && options.ramp_s < delays_per_ramp * rig.settings.faults.pressure_delay_s) {
    return tl::unexpected(
        fail(ExitCode::usage, "--ramp-s " + significant(options.ramp_s) + " is too short: state at least " +
                                  significant(delays_per_ramp * rig.settings.faults.pressure_delay_s) + " (" +
                                  significant(delays_per_ramp) +
                                  " times pressure_delay_s of the rig file); during a shorter ramp, the "
                                  "delay of the valve looks like a dead zone"));
  }
  calibrate::Settings settings;
  settings.channel = *channel;
  settings.may_move = options.move;
  settings.settle_s = options.settle_s;
  settings.average_s = options.average_s;
  settings.ramp_s = options.ramp_s;
  settings.repeats = options.repeats;
  if (const auto code = set_pressures(options, rig.settings.channels[*channel].limits, settings)) {
    return tl::unexpected(*code);
  }
  std::vector<std::string> inputs;
  for (const auto& input : rig.inputs) inputs.push_back(input.path);
  if (const auto code = refuse_overwriting({options.out}, inputs)) return tl::unexpected(*code);
  for (const std::string& path : {options.out, options.write ? rig.path : std::string("-")}) {
    if (const auto ready = prepare_parent(path); !ready)
      return tl::unexpected(fail(ExitCode::io, ready.error()));
  }
  return settings;
}

/// Connects to the rig, measures, sets the channels to their rest pressures and writes the results.
ExitCode carry_out(const rig::RigFile& rig, const CalibrateOptions& options,
                   const calibrate::Settings& settings) {
  const auto manual = ManualRig::open(rig, options.move);
  if (!manual) return fail(manual.error().code, manual.error().text);
  MotionSession& session = (*manual)->session();
  std::fprintf(stderr, "%s\nchannel `%s`; Ctrl-C stops and vents\n", (*manual)->board().describe().c_str(),
               rig.settings.channels[settings.channel].name.c_str());
  calibrate::TerminalOperator terminal;
  const auto results = measure(rig, options, settings, session, terminal);
  const bool safe = session.leave(tell_silence);
  if (!safe)
    std::fprintf(stderr,
                 "the board did NOT confirm the rest pressures: check the pressures before you reach into "
                 "the gripper\n");
  if (!results) return fail(results.error().code, results.error().text);
  ExitCode code = write_results(rig, *results, options);
  if (!accepted(rig, *results, options, terminal, **manual)) {
    return fail(ExitCode::not_acceptable,
                "not written: " + rig.path +
                    " is unchanged; with --yes, the command writes the file without a confirmation question");
  }
  if (code == ExitCode::done && options.write) code = write_into_rig(rig, *results);
  return code == ExitCode::done && !safe ? ExitCode::io : code;
}

ExitCode run(const CalibrateOptions& chosen) {
  CalibrateOptions options = chosen;
  const std::string path = options.rig.empty() ? configuration_path("rig.yaml") : options.rig;
  const auto rig = read_rig(path);
  if (!rig) return rig.error();
  const auto settings = prepare(options, *rig);
  if (!settings) return settings.error();
  if (const auto code = refuse_state(options, *rig)) return *code;
  return carry_out(*rig, options, *settings);
}

void add_measuring_options(CLI::App& command, CalibrateOptions& options) {
  command
      .add_option("--at-kpa", options.at_kpa,
                  "Pressures of the two calibration points [1/6 and 2/3 of the permitted pressure range]")
      ->expected(2);
  command.add_option("--settle-s", options.settle_s, "Waiting time between a motion and the measurement")
      ->check(number_between(0, 600))
      ->capture_default_str();
  command.add_option("--average-s", options.average_s, "Duration over which each reading is averaged")
      ->check(number_between(0.1, 600))
      ->capture_default_str();
  command.add_option("--ramp-s", options.ramp_s, "Duration of the pressure ramp that finds the dead zone")
      ->check(number_between(1, 600))
      ->capture_default_str();
  command
      .add_option("--repeats", options.repeats,
                  "Number of measurements at each point; with 2 or more, the repeatability is computed")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
}

}  // namespace

void add_calibrate(CLI::App& program, ExitCode& outcome) {
  const auto [command, options] = add_command<CalibrateOptions>(
      program, outcome, "calibrate", "Calibrate sensor and valve against a gauge and a manometer", run);
  command->add_option("--rig", options->rig, "Rig file [config/rig.yaml, or the installed rig file]");
  command->add_option("--channel", options->channel,
                      "Channel to calibrate; required if the rig has more than one channel");
  command->add_flag("--sensor", options->sensor, "Calibrate the displacement sensor against a gauge");
  command->add_flag("--valve", options->valve,
                    "Calibrate the valve against the pressure monitor or a manometer; needs --move");
  command->add_flag("--dead-zone", options->dead_zone,
                    "Find the lowest command to which the valve responds; needs --move");
  command->add_flag("--move", options->move,
                    "Allow softgrip to move the finger within its limits; without this option, you place the "
                    "target of the sensor by hand");
  command->add_flag("--manometer", options->manometer,
                    "Use a manometer, even if the channel has a pressure monitor");
  command
      ->add_option(
          "--gauge-mm", options->gauge_mm,
          "Readings of the gauge; the command then does not request readings at the terminal. Give one "
          "reading for each of the 2 positions, or 2 readings for each repetition (--repeats)")
      ->expected(2, 40);
  command
      ->add_option(
          "--manometer-kpa", options->manometer_kpa,
          "Readings of the manometer; the command then does not request readings at the terminal. Give "
          "one reading for each of the 2 pressures, or 2 readings for each repetition (--repeats)")
      ->expected(2, 40);
  add_measuring_options(*command, *options);
  command->add_option("--date", options->date, "Date of the calibration [today]");
  command->add_option(
      "--socket", options->socket,
      "Socket of the daemon, which must not run during the calibration [the socket in the rig file]");
  command
      ->add_option("--out", options->out,
                   "File for the calibrated lines of the rig file; - is the standard output")
      ->capture_default_str();
  command->add_flag(
      "--write", options->write,
      "Write the calibration points into the rig file, and keep the previous file next to the new file");
  command->add_flag(
      "--yes", options->yes,
      "Ask no confirmation questions: write doubtful results, and vent all fingers although they may hold "
      "a part");
  command->footer(
      "Questions go to the standard error. Answers are read line by line from the standard input.\nExit "
      "codes: 0 done, 2 usage, 3 input refused, 4 the board or a file failed, 5 the daemon runs, or the "
      "fingers may hold a part,\n6 no calibration can be computed from the measurements, a required sensor "
      "gave no valid readings, a pressure left its limits, the emergency stop is pressed, or doubtful "
      "results were not written.");
}

}  // namespace softgrip::tools
