#include "tools/commissioning/procedure.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "daemon/recording/csv_row.h"
#include "rig/rig_file.h"
#include "tools/commissioning/motion_safety.h"

namespace softgrip::tools::calibrate {
namespace {

/// Smallest distance between the two positions, as a share of the span between the limits. At a smaller
/// distance, the line would have a large error outside the two positions.
constexpr double least_share_of_span = 0.1;
constexpr double least_share_of_signal = 0.02;
/// Largest number of times that the program asks a script the same question. After an invalid answer, the
/// script may give its next answer, or it may have no answer left.
constexpr int questions_at_most = 5;
/// A signal counts as saturated if its distance to an end of its valid electrical range is smaller than this
/// share of the range.
constexpr double share_of_end = 0.002;
/// Speed of a motion, as a share of the pressure range per second [1/s]. It is so low that the line pressure
/// follows the command.
constexpr double share_per_s = 0.2;
/// Pressure at the end of the ramp with which the dead zone is searched, as a share of the pressure range.
constexpr double ramp_share = 0.3;

Refusal nonsense(std::string text) {
  return {ExitCode::not_acceptable, std::move(text)};
}

Refusal refusal_of(const MotionFailure& failure) {
  switch (failure.kind) {
    case MotionFailure::Kind::stopped:
      return {ExitCode::failed, failure.text};
    case MotionFailure::Kind::bus:
      return {ExitCode::io, failure.text};
    case MotionFailure::Kind::beyond:
    case MotionFailure::Kind::pressure:
    case MotionFailure::Kind::blind:
    case MotionFailure::Kind::emergency_stop:
      return {ExitCode::not_acceptable, failure.text};
  }
  return {};
}

/// Asks a question. Until the answer arrives, exchanges data with the board, so that the board's watchdog
/// does not trip.
Expected<std::string> ask(MotionSession& session, Operator& person, const std::string& question) {
  person.ask(question);
  std::optional<std::string> answer;
  const auto waited = session.wait([&] { return (answer = person.answer()).has_value() || person.gone(); });
  if (!waited) return tl::unexpected(refusal_of(waited.error()));
  if (!answer) return tl::unexpected(Refusal{ExitCode::input_refused, "no answer to: " + question});
  return *answer;
}

/// Asks a question, and repeats it until the answer is a number.
Expected<double> ask_number(MotionSession& session, Operator& person, const std::string& question) {
  for (int i = 0; person.patient() || i < questions_at_most; ++i) {
    const auto answer = ask(session, person, question);
    if (!answer) return tl::unexpected(answer.error());
    if (const auto value = typed_number(*answer)) return *value;
    person.tell("`" + *answer + "` is not a number. Please enter a number such as 12.34");
  }
  return tl::unexpected(Refusal{ExitCode::input_refused, "no number was entered: " + question});
}

/// Asks a question about a position. Enter confirms the requested position, a number states the actual
/// position, and `-` skips the position.
Expected<std::optional<double>> ask_position(MotionSession& session, Operator& person,
                                             const std::string& question, double asked_mm) {
  for (int i = 0; person.patient() || i < questions_at_most; ++i) {
    const auto answer = ask(session, person, question);
    if (!answer) return tl::unexpected(answer.error());
    const auto first = answer->find_first_not_of(" \t\r");
    if (first == std::string::npos) return std::optional<double>(asked_mm);
    if (answer->substr(first) == "-") return std::optional<double>();
    if (const auto value = typed_number(*answer)) return std::optional<double>(*value);
    person.tell("`" + *answer +
                "` is not a position. Press Enter if the target is at the position, enter the actual "
                "position of the target (mm), or enter - to skip the position");
  }
  return tl::unexpected(Refusal{ExitCode::input_refused, "no position was entered: " + question});
}

Expected<void> move_to(const rig::RigFile& rig, MotionSession& session, Operator& person,
                       const Settings& settings, double kpa) {
  if (session.command_kpa(settings.channel) == kpa) return {};  // the channel is already at this pressure
  const double speed = ramp_speed_kpa_per_s(rig, settings.channel);
  person.tell(fmt::format("moving `{}` to {:.4g} kPa", rig.settings.channels[settings.channel].name, kpa));
  if (const auto moved = session.ramp(settings.channel, kpa, speed); !moved) {
    return tl::unexpected(refusal_of(moved.error()));
  }
  if (const auto settled = session.sample(settings.settle_s); !settled) {
    return tl::unexpected(refusal_of(settled.error()));
  }
  return {};
}

/// The readings of the first half and of the second half of an averaging interval. The drift is the
/// difference between the means of the two halves.
struct Halves {
  ChannelSample first;
  ChannelSample second;
};

Expected<Halves> average(MotionSession& session, const Settings& settings) {
  const auto first = session.sample(settings.average_s / 2);
  if (!first) return tl::unexpected(refusal_of(first.error()));
  const auto second = session.sample(settings.average_s / 2);
  if (!second) return tl::unexpected(refusal_of(second.error()));
  return Halves{(*first)[settings.channel], (*second)[settings.channel]};
}

/// Combines the two halves of an averaging interval to a visit. Converts the readings to electrical units
/// with the inverse of the board's scaling.
Visit visit_of(const Sample& first, const Sample& second, const drivers::TwoPoints& scaling, bool upper) {
  Visit visit;
  visit.upper = upper;
  visit.electrical = scaling.x_at((first.mean + second.mean) / 2);
  const double per_unit = std::abs(scaling.x_at(1) - scaling.x_at(0));
  visit.noise = std::hypot(first.deviation, second.deviation) / std::sqrt(2.0) * per_unit;
  visit.drift = std::abs(second.mean - first.mean) * per_unit;
  visit.count = first.count + second.count;
  return visit;
}

std::optional<std::string> invalid(const Sample& sample) {
  if (sample.invalid == 0 && sample.count == 0)
    return "the board sent no valid reading in half of the averaging time: increase --average-s";
  if (sample.invalid == 0) return std::nullopt;
  return fmt::format(
      "{} of {} readings are not valid ({}): the signal is outside its valid range, or the sensor reports "
      "that no measurement is possible",
      sample.invalid, sample.invalid + sample.count, daemon::name_of(sample.why));
}

std::optional<std::string> at_an_end(const Visit& visit, const drivers::InputWiring& wiring) {
  const double slack = share_of_end * (wiring.valid_max - wiring.valid_min);
  if (visit.electrical > wiring.valid_min + slack && visit.electrical < wiring.valid_max - slack)
    return std::nullopt;
  return fmt::format("saturated: the signal is at {:.4g} {}, the limit of its valid range ({:g} to {:g})",
                     visit.electrical, drivers::name_of(wiring.unit), wiring.valid_min, wiring.valid_max);
}

Expected<Visit> visit_sensor(const rig::RigFile& rig, MotionSession& session, Operator& person,
                             const Settings& settings, bool upper) {
  const drivers::InputWiring& wiring = rig.wiring[settings.channel].displacement;
  if (settings.may_move) {
    // Each visit starts from rest. Otherwise, the hysteresis of the finger would look like hysteresis of the
    // sensor.
    for (const double kpa : {control::resting_kpa(rig.settings.channels[settings.channel].limits),
                             upper ? settings.high_kpa : settings.low_kpa}) {
      if (const auto moved = move_to(rig, session, person, settings, kpa); !moved)
        return tl::unexpected(moved.error());
    }
  }
  const std::string place = upper ? "second" : "first";
  const auto reference = ask_number(
      session, person,
      settings.may_move
          ? fmt::format("gauge reading at the {} position, mm", place)
          : fmt::format("put the target of the sensor at the {} position, and enter the gauge reading, mm",
                        place));
  if (!reference) return tl::unexpected(reference.error());
  const auto halves = average(session, settings);
  if (!halves) return tl::unexpected(halves.error());
  for (const Sample* half : {&halves->first.displacement_mm, &halves->second.displacement_mm}) {
    if (const auto why = invalid(*half)) return tl::unexpected(nonsense(*why));
  }
  Visit visit =
      visit_of(halves->first.displacement_mm, halves->second.displacement_mm, wiring.scaling, upper);
  visit.reference = *reference;
  if (const auto why = at_an_end(visit, wiring)) return tl::unexpected(nonsense(*why));
  person.tell(fmt::format("{:.5g} {}, noise {:.2g}, at {:.5g} mm", visit.electrical,
                          drivers::name_of(wiring.unit), visit.noise, visit.reference));
  return visit;
}

Demands demands_of(const rig::RigFile& rig, std::size_t channel, const drivers::InputWiring& wiring,
                   bool displacement) {
  const control::LimitSettings& limits = rig.settings.channels[channel].limits;
  const double span = displacement ? limits.displacement_max_mm - limits.displacement_min_mm
                                   : limits.pressure_max_kpa - limits.pressure_min_kpa;
  return {least_share_of_span * span, least_share_of_signal * (wiring.valid_max - wiring.valid_min)};
}

/// The measurements of a valve at one commanded pressure.
struct ValveVisit {
  Visit valve;
  std::optional<Visit> monitor;
};

Expected<ValveVisit> visit_valve(const rig::RigFile& rig, MotionSession& session, Operator& person,
                                 const Settings& settings, bool by_monitor, bool upper) {
  const drivers::ChannelWiring& wiring = rig.wiring[settings.channel];
  const double rest_kpa = control::resting_kpa(rig.settings.channels[settings.channel].limits);
  for (const double kpa : {rest_kpa, upper ? settings.high_kpa : settings.low_kpa}) {
    if (const auto moved = move_to(rig, session, person, settings, kpa); !moved)
      return tl::unexpected(moved.error());
  }
  double reference = 0;
  if (!by_monitor) {
    const auto shown =
        ask_number(session, person,
                   fmt::format("manometer reading at the {} pressure, kPa", upper ? "second" : "first"));
    if (!shown) return tl::unexpected(shown.error());
    reference = *shown;
    const auto why = tools::refusal_of(
        rig, settings.channel,
        {session.command_kpa(settings.channel), reference, upper ? settings.low_kpa : settings.high_kpa});
    if (why) return tl::unexpected(nonsense(*why));
  }
  const auto halves = average(session, settings);
  if (!halves) return tl::unexpected(halves.error());
  ValveVisit visit;
  const Sample& first = halves->first.pressure_kpa;
  const Sample& second = halves->second.pressure_kpa;
  for (const Sample* half : {&first, &second}) {
    const auto why = by_monitor ? invalid(*half) : std::nullopt;
    if (why) return tl::unexpected(nonsense("pressure monitor: " + *why));
  }
  if (wiring.pressure && first.count > 0 && second.count > 0) {
    visit.monitor = visit_of(first, second, wiring.pressure->scaling, upper);
    visit.monitor->reference = reference;
  }
  visit.valve.upper = upper;
  visit.valve.electrical = wiring.valve.scaling.x_at(session.command_kpa(settings.channel));
  visit.valve.reference = by_monitor ? (first.mean + second.mean) / 2 : reference;
  visit.valve.count = 1;
  if (by_monitor) {
    // Converts the noise of the pressure monitor from kPa to electrical units of the valve.
    const double per_unit = std::abs(wiring.valve.scaling.x_at(1) - wiring.valve.scaling.x_at(0));
    visit.valve.noise = std::hypot(first.deviation, second.deviation) / std::sqrt(2.0) * per_unit;
    visit.valve.drift = std::abs(second.mean - first.mean) * per_unit;
    visit.valve.count = first.count + second.count;
  }
  person.tell(fmt::format("{:.5g} {} give {:.5g} kPa", visit.valve.electrical,
                          drivers::name_of(wiring.valve.unit), visit.valve.reference));
  return visit;
}

}  // namespace

void set_places(Settings& settings, const control::LimitSettings& limits) {
  const double rest_kpa = control::resting_kpa(limits);
  const double span_kpa = control::far_end_kpa(limits) - rest_kpa;
  std::tie(settings.low_kpa, settings.high_kpa) =
      std::minmax({rest_kpa + span_kpa / 6, rest_kpa + 2 * span_kpa / 3});
}

Expected<Line> calibrate_sensor(const rig::RigFile& rig, MotionSession& session, Operator& person,
                                const Settings& settings) {
  // If a person moves the target by hand, the target may leave the sensor's range. In this case, valid
  // readings are not required.
  if (settings.may_move) session.require({settings.channel, true, false});
  std::vector<Visit> visits;
  for (std::size_t i = 0; i < settings.repeats; ++i) {
    for (const bool upper : {false, true}) {
      auto visit = visit_sensor(rig, session, person, settings, upper);
      if (!visit) return tl::unexpected(visit.error());
      visits.push_back(*visit);
    }
  }
  const drivers::InputWiring& wiring = rig.wiring[settings.channel].displacement;
  auto line = fit_line(visits, demands_of(rig, settings.channel, wiring, true), "mm",
                       std::string(drivers::name_of(wiring.unit)));
  if (!line) return tl::unexpected(nonsense("sensor: " + line.error()));
  return *line;
}

Expected<std::vector<GaugeVisit>> read_positions(MotionSession& session, Operator& person,
                                                 const Settings& settings,
                                                 const std::vector<double>& positions_mm) {
  std::vector<GaugeVisit> visits;
  for (std::size_t i = 0; i < positions_mm.size(); ++i) {
    const auto where =
        ask_position(session, person,
                     fmt::format("{} of {}: put the target of the sensor at {:g} mm, then press Enter", i + 1,
                                 positions_mm.size(), positions_mm[i]),
                     positions_mm[i]);
    if (!where) return tl::unexpected(where.error());
    if (!*where) continue;
    const auto halves = average(session, settings);
    if (!halves) return tl::unexpected(halves.error());
    const Sample& first = halves->first.displacement_mm;
    const Sample& second = halves->second.displacement_mm;
    const auto why = invalid(first.invalid > 0 || first.count == 0 ? first : second);
    if (why) {
      person.tell("skipped: " + *why);
      continue;
    }
    const auto count = static_cast<double>(first.count + second.count);
    const double mean =
        (first.mean * static_cast<double>(first.count) + second.mean * static_cast<double>(second.count)) /
        count;
    visits.push_back({**where, mean, first.count + second.count});
    person.tell(fmt::format("the sensor reads {:.5g} mm at the position {:.5g} mm", mean, **where));
  }
  return visits;
}

Expected<ValveResult> calibrate_valve(const rig::RigFile& rig, MotionSession& session, Operator& person,
                                      const Settings& settings, bool by_monitor) {
  const drivers::ChannelWiring& wiring = rig.wiring[settings.channel];
  session.require({settings.channel, rig.settings.channels[settings.channel].displacement_used, by_monitor});
  std::vector<Visit> of_valve;
  std::vector<Visit> of_monitor;
  for (std::size_t i = 0; i < settings.repeats; ++i) {
    for (const bool upper : {false, true}) {
      const auto visit = visit_valve(rig, session, person, settings, by_monitor, upper);
      if (!visit) return tl::unexpected(visit.error());
      of_valve.push_back(visit->valve);
      if (visit->monitor) of_monitor.push_back(*visit->monitor);
    }
  }
  ValveResult result;
  result.by_monitor = by_monitor;
  Demands demands;
  const control::LimitSettings& limits = rig.settings.channels[settings.channel].limits;
  demands.least_span = least_share_of_span * (limits.pressure_max_kpa - limits.pressure_min_kpa);
  const auto valve = fit_line(of_valve, demands, "kPa", std::string(drivers::name_of(wiring.valve.unit)));
  if (!valve) return tl::unexpected(nonsense("valve: " + valve.error()));
  result.valve = *valve;
  if (by_monitor || of_monitor.size() != of_valve.size()) return result;
  const auto monitor = fit_line(of_monitor, demands_of(rig, settings.channel, *wiring.pressure, false), "kPa",
                                std::string(drivers::name_of(wiring.pressure->unit)));
  if (!monitor) return tl::unexpected(nonsense("pressure monitor: " + monitor.error()));
  result.monitor = *monitor;
  return result;
}

Expected<DeadZoneResult> search_dead_zone(const rig::RigFile& rig, MotionSession& session, Operator& person,
                                          const Settings& settings) {
  const control::ChannelSettings& channel = rig.settings.channels[settings.channel];
  const double rest_kpa = control::resting_kpa(channel.limits);
  const double span_kpa = control::far_end_kpa(channel.limits) - rest_kpa;
  const double side = std::copysign(1.0, span_kpa);  // 1: the ramp raises the pressure above rest; -1: the
                                                     // ramp lowers it below rest
  session.require({settings.channel, channel.displacement_used, channel.pressure_measured});
  if (const auto moved = move_to(rig, session, person, settings, rest_kpa); !moved)
    return tl::unexpected(moved.error());
  DeadZoneResult result;
  result.by_pressure = channel.pressure_measured;
  result.highest_kpa = rest_kpa + ramp_share * span_kpa;
  person.tell(fmt::format("a slow ramp to {:.4g} kPa in {:g} s", result.highest_kpa, settings.ramp_s));
  std::vector<double> command;
  std::vector<double> response;
  const auto watch = [&](const std::vector<double>& commands, const std::vector<model::Reading>& readings) {
    const model::Reading& reading = readings[settings.channel];
    const double value = result.by_pressure ? reading.pressure_kpa : reading.displacement_mm;
    const bool good = result.by_pressure || reading.validity == model::Validity::valid;
    if (!good || !std::isfinite(value)) return;
    command.push_back(side * commands[settings.channel]);
    response.push_back(side * value);
  };
  const double speed = std::abs(result.highest_kpa - rest_kpa) / settings.ramp_s;
  if (const auto up = session.ramp(settings.channel, result.highest_kpa, speed, watch); !up) {
    return tl::unexpected(refusal_of(up.error()));
  }
  result.zone = find_dead_zone(command, response);
  // If a sensor has a negative slope, its signal falls when the displacement rises. The search is therefore
  // repeated with the inverted signal.
  if (!result.zone && !result.by_pressure) {
    for (double& value : response) value = -value;
    result.zone = find_dead_zone(command, response);
  }
  if (!result.zone)
    return tl::unexpected(nonsense(
        "dead zone: no signal followed the pressure ramp. Check the supply, the air line and the sensor"));
  result.zone->end *= side;
  return result;
}

double ramp_speed_kpa_per_s(const rig::RigFile& rig, std::size_t channel) {
  const control::LimitSettings& limits = rig.settings.channels[channel].limits;
  return share_per_s * (limits.pressure_max_kpa - limits.pressure_min_kpa);
}

double share_of_valve(const rig::RigFile& rig, std::size_t channel) {
  const control::LimitSettings& limits = rig.settings.channels[channel].limits;
  const rig::ValveFacts& valve = rig.valves[channel];
  return (limits.pressure_max_kpa - limits.pressure_min_kpa) / (valve.range_max_kpa - valve.range_min_kpa);
}

}  // namespace softgrip::tools::calibrate
