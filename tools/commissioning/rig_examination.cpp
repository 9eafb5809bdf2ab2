#include "tools/commissioning/examinations.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "base/numbers.h"
#include "daemon/recording/csv_row.h"
#include "rig/rig_file.h"
#include "tools/commissioning/motion.h"
#include "tools/commissioning/motion_safety.h"

namespace softgrip::tools::doctor {
namespace {

constexpr double ms_per_s = 1e3;
/// Largest tolerated difference between the pressure monitor and the command at rest, as a share of the
/// difference between the pressure limits.
constexpr double allowed_share_of_span = 0.05;

std::string advice_for_silence(const rig::RigFile& rig, drivers::BusStatus status) {
  if (std::holds_alternative<simulation::SimulatedBoardSettings>(rig.board))
    return "check `events` in the rig file";
  if (std::holds_alternative<drivers::IioSettings>(rig.board))
    return "compare `device` and `channel` in the rig file with the converters of this computer";
  return std::string(bus_advice(drivers::name_of(status)));
}

void judge_bus(const rig::RigFile& rig, const daemon::Histogram::Summary& times, Findings& findings) {
  if (times.count == 0) return;
  const double median_s = seconds(times.p50_ns);
  const double slow_s = seconds(times.p99_ns);
  const double period_s = 1 / rig.settings.rate_hz;
  const std::string text =
      fmt::format("{} exchanges: p50 {:.3g} ms, p99 {:.3g} ms, a cycle is {:.3g} ms", times.count,
                  median_s * ms_per_s, slow_s * ms_per_s, period_s * ms_per_s);
  if (median_s > period_s) {
    findings.fail("bus time", text, "the bus is slower than the control loop: lower rate_hz");
  } else if (slow_s > 0.8 * period_s) {
    findings.warn("bus time", text,
                  "some exchanges are late, so some cycles have no data: lower rate_hz, or find the cause of "
                  "the delay");
  } else {
    findings.ok("bus time", text);
  }
}

std::string sensor_advice(model::Validity why) {
  switch (why) {
    case model::Validity::out_of_range:
      return "target outside the range of the sensor, a broken wire, or a wrong range setting: check the "
             "display of the sensor";
    case model::Validity::sensor_error:
      return "the sensor or the input card reports that no measurement is possible: check the target, the "
             "window and the supply of the sensor";
    default:
      return "check the display and the wire of the sensor";
  }
}

void judge_displacement(const control::ChannelSettings& channel, const Sample& sample, Findings& findings) {
  const std::string name = "sensor " + channel.name;
  const std::size_t all = sample.count + sample.invalid;
  if (!channel.displacement_used) return tell_unused_sensor(channel.name, findings);
  if (sample.invalid > 0) {
    return findings.fail(
        name,
        fmt::format("{} of {} readings are not valid: {}", sample.invalid, all, daemon::name_of(sample.why)),
        sensor_advice(sample.why));
  }
  const std::string text =
      fmt::format("{} mm, noise {:.3f} mm, {} readings", fixed(sample.mean, 3), sample.deviation, all);
  if (control::displacement_beyond(channel.limits, sample.mean)) {
    findings.fail(name,
                  text + fmt::format("; the limits are {:g} to {:g} mm", channel.limits.displacement_min_mm,
                                     channel.limits.displacement_max_mm),
                  "the finger or the sensor has moved: inspect both, then calibrate the sensor");
  } else if (sample.lowest == sample.highest) {
    findings.warn(name, text + "; no variation",
                  "the reading does not change: either the noise is very low, or the sensor is frozen (hold "
                  "mode, blocked beam). To distinguish the two cases, run the command with --move");
  } else {
    findings.ok(name, text);
  }
}

void judge_rest(const control::ChannelSettings& channel, const drivers::ChannelWiring& wiring,
                const control::FaultSettings& faults, const ChannelSample& sample, double command_kpa,
                Findings& findings) {
  judge_displacement(channel, sample.displacement_mm, findings);
  const double off = std::abs(sample.readback_kpa.mean - command_kpa);
  if (sample.readback_kpa.count > 0 && off > faults.readback_tolerance_kpa) {
    findings.fail("output " + channel.name,
                  fmt::format("{:.2f} kPa were written, but the board outputs {:.2f} kPa", command_kpa,
                              sample.readback_kpa.mean),
                  "possible causes: another Modbus client writes to the board, the board has a latched "
                  "watchdog trip or is in manual mode, or the scaling is wrong");
  }
  if (!wiring.pressure) return;
  const Sample& pressure = sample.pressure_kpa;
  judge_monitor(
      channel.name,
      {.pressure_kpa = pressure.count > 0 ? pressure.mean : std::nan(""),
       .command_kpa = command_kpa,
       .pressure_span_kpa = channel.limits.pressure_max_kpa - channel.limits.pressure_min_kpa,
       .text = fmt::format("{} kPa at rest, noise {:.2f} kPa", fixed(pressure.mean, 2), pressure.deviation)},
      findings);
}

void failed(const MotionFailure& failure, const rig::RigFile& rig, const std::string& name,
            Findings& findings) {
  switch (failure.kind) {
    case MotionFailure::Kind::stopped:
      return findings.fail(name, failure.text, "repeat the command and do not interrupt it");
    case MotionFailure::Kind::bus:
      return findings.fail(name, failure.text, advice_for_silence(rig, failure.status));
    case MotionFailure::Kind::blind:
      return findings.fail(name, failure.text, "check the display and the wire of the sensor");
    case MotionFailure::Kind::beyond:
      return findings.fail(name, failure.text,
                           "inspect the finger, calibrate the sensor, and compare the range of the sensor "
                           "with the displacement limits");
    case MotionFailure::Kind::pressure:
      return findings.fail(name, failure.text, "calibrate the valve with a manometer");
    case MotionFailure::Kind::emergency_stop:
      return findings.fail(name, failure.text,
                           "see `gpio`; release the emergency stop, then repeat the command");
  }
}

/// Reports the number of clients that the board counts. Warns if other clients reset the board's watchdog.
void judge_clients(const drivers::Board& board, Findings& findings) {
  const unsigned clients = board.clients();
  if (clients > 1 && board.fed_by_readers()) {
    findings.warn(
        "clients",
        fmt::format(
            "the board has {} clients, one of which is this command. Requests of the other clients reset the "
            "board's watchdog, so the board does not vent while these clients send requests",
            clients),
        "find the other program and disconnect it from the board; the board may also count a connection that "
        "has been broken for some time");
  } else if (clients > 0) {
    findings.ok("clients",
                fmt::format("number of clients at the board: {}, including this command", clients));
  }
}

void leave_channels(const rig::RigFile& rig, const std::string& because, Findings& findings) {
  for (const control::ChannelSettings& channel : rig.settings.channels) {
    findings.not_judged("sensor " + channel.name, because);
  }
}

/// Returns the reasons why the motion of a channel cannot be checked. The reasons are problems that earlier
/// checks have found.
NotJudged known_of(const rig::RigFile& rig, std::span<const Crossing> crossings, const ChannelSample& rest,
                   std::size_t channel) {
  using Kind = Crossing::Kind;
  const std::string& name = rig.settings.channels[channel].name;
  const bool valves = is_crossed(crossings, Kind::valves, channel);
  NotJudged known;
  if (rig.wiring[channel].pressure && rest.pressure_kpa.count == 0)
    known.valve = "see `pressure " + name + "`";
  if (is_crossed(crossings, Kind::monitors, channel)) known.valve = "the pressure monitors are crossed";
  if (valves) known.valve = "the valves are crossed";
  if (rest.displacement_mm.invalid > 0) known.finger = "see `sensor " + name + "`";
  if (is_crossed(crossings, Kind::sensors, channel)) known.finger = "the sensors are crossed";
  if (valves) known.finger = known.valve;
  return known;
}

/// Returns the sensor that must show a motion of this channel: the displacement sensor, or the pressure
/// monitor if the channel has no displacement sensor.
Sight sight_of(const rig::RigFile& rig, std::size_t channel) {
  const bool displacement = rig.settings.channels[channel].displacement_used;
  return {channel, displacement, !displacement && rig.wiring[channel].pressure.has_value()};
}

/// Returns the name of the finding that prevents a motion of the channel, because its sensor has no valid
/// reading. Returns "" if the channel may be moved.
std::string blind_at(const rig::RigFile& rig, const ChannelSample& rest, std::size_t channel) {
  const Sight sight = sight_of(rig, channel);
  const std::string& name = rig.settings.channels[channel].name;
  if (sight.displacement && rest.displacement_mm.count == 0) return "sensor " + name;
  if (sight.pressure && rest.pressure_kpa.count == 0) return "pressure " + name;
  return {};
}

/// Moves the fingers one at a time and reads all sensors during each motion. The responses of all sensors are
/// needed to find swapped wires.
void move_all(const rig::RigFile& rig, MotionSession& session, const std::vector<ChannelSample>& rest,
              const MoveSettings& settings, Findings& findings) {
  std::vector<Motion> motions(rest.size());
  std::string ended_by;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const std::string name = "motion " + rig.settings.channels[i].name;
    const std::string because = ended_by.empty() ? blind_at(rig, rest[i], i) : ended_by;
    if (!because.empty()) {
      findings.not_judged(name, "see `" + because + "`");
      continue;
    }
    session.require(sight_of(rig, i));
    auto motion = move_and_watch(rig, session, i, rest[i], settings);
    if (motion) {
      motions[i] = std::move(*motion);
    } else {
      failed(motion.error(), rig, name, findings);
      ended_by = name;
    }
  }
  const std::vector<Crossing> crossings = find_crossings(rig, rest, motions);
  tell_crossings(rig, crossings, findings);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (!motions[i].up.empty())
      judge_motion(rig, i, rest[i], motions[i], known_of(rig, crossings, rest[i], i), findings);
  }
}

}  // namespace

void examine_description(const rig::RigFile& rig, const drivers::Board& board, Findings& findings) {
  const drivers::Board::Budget budget = board.budget();
  const double period_s = 1 / rig.settings.rate_hz;
  const std::string text = fmt::format("{}; a cycle is {:.3g} ms", budget.explanation, period_s * ms_per_s);
  if (budget.exchange_s > period_s && rig.accept_over_budget) {
    findings.warn("bus budget", text,
                  "an exchange takes longer than a cycle, so some cycles may have no exchange; the rig file "
                  "accepts this with `accept_over_budget`");
  } else if (budget.exchange_s > period_s) {
    findings.fail("bus budget", text,
                  fmt::format("lower rate_hz to {:.0f} or less", 0.9 / budget.exchange_s));
  } else if (budget.exchange_s > 0.8 * period_s) {
    findings.warn("bus budget", text, "a slow reply may arrive after the end of the cycle: lower rate_hz");
  } else {
    findings.ok("bus budget", text);
  }
  if (rig.settings.safety.board_vents_when_silent && board.fed_by_readers()) {
    findings.warn("watchdog",
                  "if communication stops, the board vents only if no Modbus client sends requests: even a "
                  "client that only reads resets the watchdog",
                  "do not connect other programs to the board, but to softgripd. If the board supports this "
                  "setting, let only writes reset the watchdog");
  } else if (rig.settings.safety.board_vents_when_silent) {
    findings.ok("watchdog", "the board vents if communication stops");
  } else {
    findings.warn(
        "watchdog",
        fmt::format(
            "the board does not vent if communication stops, and the rig file accepts this risk: \"{}\"",
            rig.accept_no_watchdog),
        "set the watchdog time and the safe value of the board, or keep a dump valve in the emergency-stop "
        "circuit");
  }
}

void examine_rig(const rig::RigFile& rig, drivers::Board& board, const Clock& clock, StopRequest stop,
                 bool move, const MoveSettings& settings, Findings& findings, drivers::GpioLines* lines,
                 const MotionSession::Warn& silent) {
  MotionSession session(rig, board, clock, std::move(stop), lines);
  if (const auto connected = session.connect(); !connected) {
    failed(connected.error(), rig, "board", findings);
    return leave_channels(rig, "the board does not respond", findings);
  }
  if (!move && may_hold_a_part(rig)) {
    findings.ok("board", board.describe() + " responds");
    return findings.warn("sensors",
                         "the board was not read, because an exchange would also write the rest pressures, "
                         "and the fingers may still hold a part",
                         "remove the part, then repeat the command with --move");
  }
  const auto rest = session.sample(settings.look_s);
  if (!rest) {
    failed(rest.error(), rig, "board", findings);
    return leave_channels(rig, "see `board`", findings);
  }
  findings.ok("board", board.describe() + " responds");
  judge_bus(rig, session.exchange_times().summary(), findings);
  judge_clients(board, findings);
  for (std::size_t i = 0; i < rest->size(); ++i) {
    judge_rest(rig.settings.channels[i], rig.wiring[i], rig.settings.faults, (*rest)[i],
               session.command_kpa(i), findings);
  }
  if (move) move_all(rig, session, *rest, settings, findings);
  if (!session.leave(silent)) {
    findings.fail("safe state", "the board did not confirm the rest pressures",
                  "vent the fingers by hand, and inspect them before you reach into the gripper");
  } else if (move) {
    findings.ok("safe state", "the board confirmed that all channels are at their rest pressure");
  }
}

void tell_unused_sensor(const std::string& channel, Findings& findings) {
  findings.ok("sensor " + channel, "not used (displacement_used: false)");
}

void judge_monitor(const std::string& channel, const MonitorReading& reading, Findings& findings) {
  const std::string name = "pressure " + channel;
  const double off_kpa = std::abs(reading.pressure_kpa - reading.command_kpa);
  if (std::isnan(reading.pressure_kpa)) {
    findings.fail(
        name, "no reading of the pressure monitor is valid",
        "check the wire and the supply of the monitor; compare `valid_v` or `valid_ma` with its signal");
  } else if (reading.at_rest && off_kpa > allowed_share_of_span * reading.pressure_span_kpa) {
    findings.warn(
        name, reading.text + fmt::format("; {:.2f} kPa were written", reading.command_kpa),
        "the monitor is wrong, or the air line does not vent: calibrate the monitor, or check the exhaust");
  } else {
    findings.ok(name, reading.text);
  }
}

std::unique_ptr<drivers::GpioLines> examine_gpio(const rig::RigFile& rig, Findings& findings) {
  if (!rig.gpio) return nullptr;
  auto lines = drivers::open_gpio_lines(rig.gpio->lines);
  if (!lines) {
    const drivers::GpioFailure& failure = lines.error();
    findings.fail("gpio", place_of(rig.gpio->places[failure.line]) + ": " + failure.message, failure.hint);
    return nullptr;
  }
  for (const drivers::GpioLineSettings& line : rig.gpio->lines) {
    const std::string name = "gpio " + std::string(drivers::name_of(line.role));
    if (!drivers::is_input(line.role)) {
      findings.ok(name, drivers::text_of(line) + ": can be driven");
      continue;
    }
    const auto active = (*lines)->read(line.role);
    const bool stop = line.role == drivers::GpioRole::emergency_stop;
    if (!active) {
      findings.fail(name, drivers::text_of(line) + ": cannot be read", "check the GPIO chip and its driver");
    } else if (stop && *active) {
      findings.warn(
          name, drivers::text_of(line) + ": pressed",
          "release the emergency stop; if the emergency stop is already released, its wire is broken");
    } else {
      findings.ok(name, drivers::text_of(line) + (stop      ? ": released"
                                                  : *active ? ": part present"
                                                            : ": no part"));
    }
  }
  return std::move(*lines);
}

}  // namespace softgrip::tools::doctor
