#include "daemon/service/daemon.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/enum_table.h"
#include "base/sha256.h"
#include "base/text.h"
#include "base/version.h"
#include "daemon/recording/run_folder.h"
#include "daemon/service/daemon_parts.h"

namespace softgrip::daemon {

namespace {

/// Longest delay of the disk that causes no loss of rows [s]. The queue of the recorder has space for the
/// rows of this time.
constexpr double seconds_of_rows = 8;
constexpr std::size_t fewest_records = 4096;
constexpr std::size_t most_records = std::size_t{1} << 18;
constexpr std::size_t events_kept = 10'000;
/// A sampling time of 0 means that a reading was never sampled. Therefore, virtual time starts at 1 s and not
/// at 0.
constexpr Nanoseconds virtual_origin = ns_per_s;
/// Longest time to wait until the rig is idle and the sequence of the command line can start [ns].
constexpr Nanoseconds patience = 10 * ns_per_s;

bool waits_for_a_release(const control::PreparedSequence& sequence) {
  return std::any_of(sequence.steps.begin(), sequence.steps.end(),
                     [](const auto& prepared) { return std::isinf(prepared.step.hold_s); });
}

std::size_t records_of(const control::RigSettings& settings) {
  const double rows = seconds_of_rows * settings.rate_hz * static_cast<double>(settings.channels.size());
  return std::clamp(static_cast<std::size_t>(rows), fewest_records, most_records);
}

constexpr auto input_file_names = enum_names<rig::InputFile::Role>({{rig::InputFile::Role::rig, "rig"},
                                                                    {rig::InputFile::Role::board, "board"},
                                                                    {rig::InputFile::Role::model, "model"},
                                                                    {rig::InputFile::Role::plant, "plant"}});

bool measures_pressure(const rig::RigFile& rig) {
  const auto& channels = rig.settings.channels;
  return std::any_of(channels.begin(), channels.end(),
                     [](const control::ChannelSettings& channel) { return channel.pressure_measured; });
}

bool measures_temperature(const rig::RigFile& rig) {
  return std::any_of(rig.wiring.begin(), rig.wiring.end(),
                     [](const drivers::ChannelWiring& channel) { return channel.temperature.has_value(); });
}

Provenance provenance_of(const rig::RigFile& rig, const DaemonOptions& options) {
  Provenance provenance;
  provenance.software_version = software_version();
  provenance.rig = rig.name;
  for (const rig::InputFile& file : rig.inputs) {
    provenance.files.push_back({std::string(input_file_names[file.role]), file.path, sha256(file.text)});
  }
  for (const control::ChannelSettings& channel : rig.settings.channels) {
    provenance.channel_names.push_back(channel.name);
  }
  provenance.simulated = std::holds_alternative<simulation::SimulatedBoardSettings>(rig.board);
  provenance.measures_pressure = measures_pressure(rig);
  provenance.measures_temperature = measures_temperature(rig);
  provenance.rate_hz = rig.settings.rate_hz;
  provenance.decimation = rig.recorder.decimation;
  provenance.seed = rig.seed;
  provenance.virtual_time = options.virtual_time;
  return provenance;
}

/// Creates the driver of a board. This file compiles only if each alternative of RigFile::board has a
/// function.
struct BoardMaker {
  std::unique_ptr<drivers::Board> operator()(const simulation::SimulatedBoardSettings& settings) const {
    return std::make_unique<simulation::SimulatedBoard>(settings, clock);
  }
  std::unique_ptr<drivers::Board> operator()(const drivers::ModbusSettings& settings) const {
    return std::make_unique<drivers::ModbusBoard>(settings);
  }
  std::unique_ptr<drivers::Board> operator()(const drivers::IioSettings& settings) const {
    return std::make_unique<drivers::IioBoard>(settings);
  }

  const Clock& clock;
};

}  // namespace

std::unique_ptr<drivers::Board> make_board(const rig::RigFile& rig, const Clock& clock) {
  return std::visit(BoardMaker{clock}, rig.board);
}

DaemonParts::DaemonParts(rig::RigFile rig_file, DaemonOptions run_options)
    : rig(std::move(rig_file)),
      options(std::move(run_options)),
      provenance(provenance_of(rig, options)),
      clock(options.virtual_time ? static_cast<const Clock&>(virtual_clock) : system_clock),
      origin(options.virtual_time ? virtual_origin : system_clock.now()),
      board(make_board(rig, clock)),
      board_text(board->describe()),
      controller(rig.settings),
      shared(records_of(rig.settings)),
      events(events_kept),
      loader(std::make_shared<const SequenceLoader>(rig.settings, rig.socket.sequence_directory)),
      loop(controller, rig.recorder.decimation, clock, shared, loop_statistics),
      bus(*board, rig.settings, rig.loop, rig.reconnect, clock, shared, bus_statistics),
      recorder(rig.recorder, provenance, options.record_folder, origin, shared, events, sequence_store),
      service(provenance.channel_names, origin, shared, events, sequence_store) {
  if (options.sequence) one_shot_run.emplace(options.sequence, patience);
}

Nanoseconds DaemonParts::period() const noexcept {
  return nanoseconds(1 / rig.settings.rate_hz);
}

Nanoseconds DaemonParts::bus_offset() const noexcept {
  return nanoseconds(rig.loop.bus_offset_fraction / rig.settings.rate_hz);
}

void DaemonParts::deliver_events() {
  if (!options.on_event) return;
  for (const EventEntry& event : events.since(delivered, events_kept)) {
    options.on_event(event);
    delivered = event.id;
  }
}

void DaemonParts::conclude(Outcome& outcome) {
  outcome.last = service.snapshot();
  outcome.channel_names = provenance.channel_names;
  outcome.ticks = loop_statistics.ticks.value();
  outcome.overruns = loop_statistics.overruns_took_long.value() + loop_statistics.overruns_woken_late.value();
  if (!options.record_folder.empty()) outcome.recording_error = recorder.status().error;
  outcome.safe_state_confirmed = shared.safe_state_confirmed.load(std::memory_order_acquire);
  for (std::size_t i = 0; i < outcome.last.channel_count; ++i) {
    const double safe_kpa = outcome.last.channels[i].safe_kpa;
    if (control::pressed(rig.settings.channels[i].limits, safe_kpa))
      outcome.left_on.push_back({outcome.channel_names[i], safe_kpa});
  }
  if (!outcome.left_on.empty()) outcome.vents_after_s = seconds(board->watchdog_time().count());
  if (outcome.ending == Ending::asked && one_shot_run) conclude_one_shot_run(*one_shot_run, outcome);
  if (outcome.ending == Ending::not_idle && !service.bus_failure().text.empty()) {
    outcome.ending = Ending::board_unreachable;
    outcome.message = fmt::format("the board cannot be used, so the rig did not become idle within {} s: {}",
                                  patience / ns_per_s, service.bus_failure().text);
  }
}

void conclude_one_shot_run(const OneShotRun& one_shot_run, Outcome& outcome) {
  outcome.sequence_end = one_shot_run.end();
  // If the board has vented, the sequence counts as faulted. Without this rule it could count as done,
  // because its last step can end in the tick before the bus reports the vent.
  if (outcome.sequence_end == control::SequenceEnd::done && outcome.last.state == control::State::faulted)
    outcome.sequence_end = control::SequenceEnd::faulted;
  if (!one_shot_run.finished()) {
    outcome.ending = outcome.sequence_end ? Ending::sequence_ended : Ending::interrupted;
    if (!outcome.sequence_end) outcome.sequence_end = control::SequenceEnd::stopped;
    return;
  }
  switch (one_shot_run.state()) {
    case OneShotRun::State::refused:
      outcome.ending = Ending::sequence_refused;
      outcome.message = control::name_of(one_shot_run.refusal());
      break;
    case OneShotRun::State::not_idle:
      outcome.ending = Ending::not_idle;
      outcome.message =
          fmt::format("the rig did not become idle within {} s{}", patience / ns_per_s,
                      outcome.last.first_fault.code == control::FaultCode::none
                          ? ""
                          : fmt::format(": {} is latched, `softgrip acknowledge` clears this fault",
                                        title_of(outcome.last.first_fault, outcome.channel_names)));
      break;
    default:
      outcome.ending = Ending::sequence_ended;
      break;
  }
}

void DaemonParts::tell(const char* kind, Severity severity, std::string text) {
  events.add(event_of(kind, severity, seconds(clock.now() - origin), std::move(text)));
}

bool reached_the_board(Ending ending) noexcept {
  return ending != Ending::socket_failed && ending != Ending::board_taken && ending != Ending::gpio_refused &&
         ending != Ending::gpio_failed;
}

std::string left_on_sentence(const Outcome& outcome) {
  if (outcome.left_on.empty() || !outcome.safe_state_confirmed) return {};
  const std::string channels = enumerated(outcome.left_on, " and ", [](const Outcome::LeftOn& each) {
    return fmt::format("{} ({:.3g} kPa)", each.channel, each.pressure_kpa);
  });
  const char* verb = outcome.left_on.size() == 1 ? "remains" : "remain";
  if (outcome.vents_after_s <= 0)
    return fmt::format("{} {} under pressure, because the board has no watchdog that vents", channels, verb);
  return fmt::format("{} {} under pressure until the board's watchdog vents in {:g} s", channels, verb,
                     outcome.vents_after_s);
}

ExitCode exit_code_of(const Outcome& outcome) noexcept {
  const ExitCode done = !outcome.safe_state_confirmed     ? ExitCode::failed
                        : outcome.recording_error.empty() ? ExitCode::done
                                                          : ExitCode::io;
  switch (outcome.ending) {
    case Ending::asked:
      return done;
    case Ending::sequence_ended:
      if (outcome.sequence_end == control::SequenceEnd::done || !outcome.safe_state_confirmed) return done;
      return ExitCode::not_acceptable;
    case Ending::interrupted:
      return outcome.safe_state_confirmed ? ExitCode::not_acceptable : ExitCode::failed;
    case Ending::gpio_refused:
      return ExitCode::input_refused;
    case Ending::socket_failed:
    case Ending::board_taken:
    case Ending::board_unreachable:
    case Ending::gpio_failed:
      return ExitCode::io;
    case Ending::sequence_refused:
    case Ending::not_idle:
      return ExitCode::state_refused;
    case Ending::real_time_refused:
    case Ending::broken:
      return ExitCode::failed;
  }
  return ExitCode::failed;
}

tl::expected<std::unique_ptr<Daemon>, NotCreated> Daemon::create(rig::RigFile rig, DaemonOptions options) {
  const auto refused = [](std::string text, ExitCode code = ExitCode::usage) {
    return tl::unexpected(NotCreated{code, std::move(text)});
  };
  if (std::string there = recorded_already(options.record_folder); !there.empty())
    return refused(std::move(there), ExitCode::state_refused);
  if (std::string why = why_unrecordable(options.record_folder); !why.empty())
    return refused(std::move(why), ExitCode::io);
  if (options.virtual_time) {
    if (!std::holds_alternative<simulation::SimulatedBoardSettings>(rig.board))
      return refused("virtual time needs a simulated board, because a real board runs in real time");
    if (rig.gpio) return refused("virtual time does not support digital lines, but this rig file has `gpio`");
    if (!options.sequence && !options.duration_s)
      return refused("virtual time requires an end: give a sequence or a duration");
    if (options.sequence && !options.duration_s && waits_for_a_release(options.sequence->prepared)) {
      return refused(
          "this sequence would hold for ever, because in virtual time no client can request a release");
    }
  }
  return std::unique_ptr<Daemon>(
      new Daemon(std::make_unique<DaemonParts>(std::move(rig), std::move(options))));
}

Daemon::Daemon(std::unique_ptr<DaemonParts> parts) : parts_(std::move(parts)) {}
Daemon::~Daemon() = default;

Outcome Daemon::run() {
  Signals signals;
  Outcome outcome = parts_->options.virtual_time ? run_in_virtual_time(*parts_, signals)
                                                 : run_in_real_time(*parts_, signals);
  outcome.signal = signals.first();
  return outcome;
}

tl::expected<Outcome, std::string> run_daemon(rig::RigFile rig, DaemonOptions options) {
  const auto daemon = Daemon::create(std::move(rig), std::move(options));
  if (!daemon) return tl::unexpected(daemon.error().text);
  return (*daemon)->run();
}

const LoopStatistics& Daemon::loop_statistics() const noexcept {
  return parts_->loop_statistics;
}
const BusStatistics& Daemon::bus_statistics() const noexcept {
  return parts_->bus_statistics;
}

}  // namespace softgrip::daemon
