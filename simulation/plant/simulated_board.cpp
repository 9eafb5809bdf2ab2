#include "simulation/plant/simulated_board.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/time.h"

namespace softgrip::simulation {
namespace {

using Kind = SimulatedEvent::Kind;

/// Returns the value that a converter with `bits` bits over the range [lower, upper] gives for `value`.
/// `value` must not be NaN.
double quantised(double value, double lower, double upper, int bits) noexcept {
  if (bits <= 0 || !(upper > lower)) return value;
  const double step = (upper - lower) / (std::exp2(bits) - 1);
  return lower + std::round((std::clamp(value, lower, upper) - lower) / step) * step;
}

bool ends_session(drivers::BusStatus status) noexcept {
  return status == drivers::BusStatus::disconnected || status == drivers::BusStatus::timed_out ||
         status == drivers::BusStatus::bad_reply;
}

}  // namespace

struct SimulatedBoard::Parts {
  Parts(const SimulatedBoardSettings& given, const Clock& its_clock) : settings(given), clock(its_clock) {
    for (const SimulatedChannel& channel : settings.channels) plants.emplace_back(channel.plant);
    std::stable_sort(settings.events.begin(), settings.events.end(),
                     [](const SimulatedEvent& a, const SimulatedEvent& b) { return a.at_s < b.at_s; });
  }

  SimulatedBoardSettings settings;
  const Clock& clock;
  std::vector<Plant> plants;
  std::size_t next_event = 0;
  bool started = false;
  Nanoseconds started_at = 0;
  Nanoseconds plants_at = 0;  ///< time up to which the plants were simulated
  Nanoseconds fed_at = 0;     ///< time of the last exchange that reached the board
  bool connected = false;
  bool tripped = false;
  bool refuses_writes = false;
  drivers::BusStatus bus = drivers::BusStatus::ok;
  const char* detail = "";
  std::array<char, 160> text{};

  drivers::BusStatus say(drivers::BusStatus status, const char* what) noexcept {
    detail = what;
    return status;
  }
  void move_to(Nanoseconds time) noexcept;
  void act_until(Nanoseconds time) noexcept;
  void happen(const SimulatedEvent& event) noexcept;
  drivers::BusStatus take_commands(std::span<const double> commands_kpa) noexcept;
  void make_reading(std::size_t channel, Nanoseconds now, model::Reading& reading) const noexcept;
};

void SimulatedBoard::Parts::move_to(Nanoseconds time) noexcept {
  if (time <= plants_at) return;
  const double duration_s = static_cast<double>(time - plants_at) * 1e-9;
  for (Plant& plant : plants) plant.advance(duration_s);
  plants_at = time;
}

/// Advances the plants to `time`. Events and a trip of the watchdog between two exchanges are applied at the
/// times at which they occur.
void SimulatedBoard::Parts::act_until(Nanoseconds time) noexcept {
  while (true) {
    constexpr Nanoseconds never = std::numeric_limits<Nanoseconds>::max();
    const bool has_event = next_event < settings.events.size();
    const Nanoseconds event_at =
        has_event ? started_at + nanoseconds(settings.events[next_event].at_s) : never;
    const bool watched = settings.watchdog_timeout_s > 0 && !tripped;
    const Nanoseconds trip_at = watched ? fed_at + nanoseconds(settings.watchdog_timeout_s) : never;
    if (std::min(event_at, trip_at) > time) break;
    if (event_at <= trip_at) {
      move_to(event_at);
      happen(settings.events[next_event++]);
    } else if (trip_at == time) {
      break;  // an exchange at exactly this time prevents the trip of the watchdog
    } else {
      move_to(trip_at);
      tripped = true;
      for (std::size_t i = 0; i < plants.size(); ++i) plants[i].command(settings.channels[i].vented_kpa);
    }
  }
  move_to(time);
}

void SimulatedBoard::Parts::happen(const SimulatedEvent& event) noexcept {
  switch (event.kind) {
    case Kind::bus_lost:
      bus = event.status;
      return;
    case Kind::bus_restored:
      bus = drivers::BusStatus::ok;
      return;
    case Kind::write_refused:
      refuses_writes = true;
      return;
    case Kind::write_taken:
      refuses_writes = false;
      return;
    default:
      break;
  }
  for (std::size_t i = 0; i < plants.size(); ++i) {
    if (event.channel != SimulatedEvent::every_channel && event.channel != i) continue;
    if (event.kind == Kind::object) plants[i].set_object(event.object);
    if (event.kind == Kind::line_fault) plants[i].set_fault(event.line);
    if (event.kind == Kind::sensor_fault) plants[i].set_fault(event.sensor);
  }
}

drivers::BusStatus SimulatedBoard::Parts::take_commands(std::span<const double> commands_kpa) noexcept {
  for (const double command : commands_kpa) {
    if (!std::isfinite(command)) {
      return say(drivers::BusStatus::write_refused, "a command that is not a number was not written");
    }
  }
  drivers::BusStatus status = drivers::BusStatus::ok;
  for (std::size_t i = 0; i < plants.size(); ++i) {
    const SimulatedChannel& channel = settings.channels[i];
    const double clamped = std::clamp(commands_kpa[i], channel.valve_min_kpa, channel.valve_max_kpa);
    const double output =
        quantised(clamped, channel.valve_min_kpa, channel.valve_max_kpa, channel.output_bits);
    if (clamped != commands_kpa[i]) {
      std::snprintf(text.data(), text.size(),
                    "channel '%s': %g kPa is outside the output's range; the limit was written",
                    channel.name.c_str(), commands_kpa[i]);
      status = say(drivers::BusStatus::write_refused, text.data());
    }
    if (!refuses_writes) {
      plants[i].command(output);
    } else if (plants[i].held_command_kpa() != output) {
      std::snprintf(text.data(), text.size(),
                    "channel '%s': the output did not change to the written command", channel.name.c_str());
      status = say(drivers::BusStatus::write_refused, text.data());
    }
  }
  return status;
}

void SimulatedBoard::Parts::make_reading(std::size_t i, Nanoseconds now,
                                         model::Reading& reading) const noexcept {
  const SimulatedChannel& channel = settings.channels[i];
  const Plant& plant = plants[i];
  const double displacement = plant.reading_mm();
  const bool outside = displacement < channel.sensor_min_mm || displacement > channel.sensor_max_mm;
  if (!plant.sees_nothing()) {
    reading.displacement_mm =
        quantised(displacement, channel.sensor_min_mm, channel.sensor_max_mm, channel.input_bits);
  }
  reading.validity = outside || plant.sees_nothing() ? model::Validity::out_of_range : model::Validity::valid;
  reading.pressure_kpa = std::numeric_limits<double>::quiet_NaN();
  if (channel.measures_pressure) {
    reading.pressure_kpa = quantised(plant.measured_pressure_kpa(), channel.valve_min_kpa,
                                     channel.valve_max_kpa, channel.input_bits);
  }
  reading.temperature_c = channel.measures_temperature ? plant.measured_temperature_c()
                                                       : std::numeric_limits<double>::quiet_NaN();
  reading.command_readback_kpa = plant.held_command_kpa();
  reading.sampled_at = now;
  ++reading.sequence;
}

SimulatedBoard::SimulatedBoard(const SimulatedBoardSettings& settings, const Clock& clock)
    : parts_(std::make_unique<Parts>(settings, clock)) {}

SimulatedBoard::~SimulatedBoard() = default;

std::size_t SimulatedBoard::channels() const noexcept {
  return parts_->plants.size();
}

drivers::BusStatus SimulatedBoard::connect(std::chrono::nanoseconds) noexcept {
  Parts& parts = *parts_;
  // The plants also move while the connection to the board is interrupted. Therefore, they are advanced
  // before the connection is checked.
  if (parts.started) parts.act_until(parts.clock.now());
  parts.connected = parts.bus != drivers::BusStatus::disconnected;
  if (!parts.connected) return parts.say(drivers::BusStatus::disconnected, "the simulated bus is down");
  parts.tripped = false;
  parts.fed_at = parts.clock.now();
  return drivers::BusStatus::ok;
}

drivers::BusStatus SimulatedBoard::exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds) noexcept {
  Parts& parts = *parts_;
  if (commands_kpa.size() != channels() || readings.size() != channels()) {
    return parts.say(drivers::BusStatus::write_refused,
                     "the numbers of commands, readings and channels are not equal");
  }
  const Nanoseconds now = parts.clock.now();
  if (!parts.started) {
    parts.started = true;
    parts.started_at = parts.plants_at = parts.fed_at = now;
  }
  parts.act_until(now);
  if (!parts.connected)
    return parts.say(drivers::BusStatus::disconnected, "no connection to the simulated board is open");
  if (parts.bus != drivers::BusStatus::ok) {
    parts.connected = !ends_session(parts.bus);
    return parts.say(parts.bus, "simulated");
  }
  parts.fed_at = now;
  if (parts.tripped) return parts.say(drivers::BusStatus::watchdog_tripped, "the simulated watchdog tripped");
  const drivers::BusStatus status = parts.take_commands(commands_kpa);
  if (status != drivers::BusStatus::ok) return status;
  for (std::size_t i = 0; i < readings.size(); ++i) parts.make_reading(i, now, readings[i]);
  return drivers::BusStatus::ok;
}

const char* SimulatedBoard::detail() const noexcept {
  return parts_->detail;
}

std::string SimulatedBoard::describe() const {
  return "simulated board with " + std::to_string(channels()) + (channels() == 1 ? " finger" : " fingers");
}

drivers::Board::Budget SimulatedBoard::budget() const {
  return {.exchange_s = 0, .explanation = "simulated in this process: an exchange takes no bus time"};
}

bool SimulatedBoard::has_watchdog() const noexcept {
  return parts_->settings.watchdog_timeout_s > 0;
}

std::chrono::nanoseconds SimulatedBoard::watchdog_time() const noexcept {
  return std::chrono::nanoseconds(nanoseconds(parts_->settings.watchdog_timeout_s));
}

Plant& SimulatedBoard::plant(std::size_t channel) {
  return parts_->plants.at(channel);
}

void SimulatedBoard::catch_up() noexcept {
  if (parts_->started) parts_->act_until(parts_->clock.now());
}

void SimulatedBoard::happen(const SimulatedEvent& event) noexcept {
  catch_up();
  parts_->happen(event);
}

}  // namespace softgrip::simulation
