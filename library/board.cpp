#include "library/include/softgrip/board.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/clock.h"
#include "base/numbers.h"
#include "control/feedforward/running_model.h"
#include "drivers/board/board.h"
#include "library/model_parts.h"
#include "simulation/plant/simulated_board.h"

namespace softgrip {
namespace {

constexpr std::size_t most_fingers = 16;
/// Largest dead time of a finger in ticks. The delay line of a finger then needs at most 13 MB from the
/// start. A line of more than a million ticks would grow in exchange(), which must not allocate memory.
constexpr double most_delay_ticks = 100'000;
/// Initial time of the clock of a simulated board [ns]. The initial time is not 0, because a reading with the
/// time 0 counts as missing.
constexpr Nanoseconds board_begins_at = 1'000'000'000;
/// Measuring range of a simulated sensor, in the unit of the model.
constexpr double sensor_range = 1e6;

std::optional<simulation::PlantObject> object_of(const std::optional<SimulatedObject>& object) {
  if (!object) return std::nullopt;
  return simulation::PlantObject{object->position, object->yielding};
}

bool is_valid(const SimulatedObject& object) noexcept {
  return std::isfinite(object.position) && object.yielding >= 0 && object.yielding <= 1;
}

/// The conversions between the public and the internal enumeration require that both enumerations list their
/// values in the same order.
static_assert(static_cast<int>(BusStatus::closed_at_once) ==
              static_cast<int>(drivers::BusStatus::closed_at_once));
static_assert(static_cast<int>(Validity::stale) == static_cast<int>(model::Validity::stale));

BusStatus status_of(drivers::BusStatus status) noexcept {
  return static_cast<BusStatus>(status);
}

}  // namespace

namespace library {

Validity validity_of(model::Validity validity) noexcept {
  return static_cast<Validity>(validity);
}

model::Reading reading_of(const Reading& reading) noexcept {
  model::Reading result;
  result.displacement_mm = reading.displacement;
  result.pressure_kpa = reading.pressure_kpa;
  result.temperature_c = reading.temperature_c;
  result.sampled_at = reading.sampled_at.count();
  result.sequence = reading.sequence;
  result.validity = static_cast<model::Validity>(reading.validity);
  return result;
}

Reading reading_of(const model::Reading& reading) noexcept {
  return {reading.displacement_mm, reading.pressure_kpa,
          reading.temperature_c,   std::chrono::nanoseconds(reading.sampled_at),
          reading.sequence,        validity_of(reading.validity)};
}

}  // namespace library

std::string name_of(BusStatus status) {
  return std::string(drivers::name_of(static_cast<drivers::BusStatus>(status)));
}

Board::~Board() = default;

std::string Board::detail() const {
  return "";
}

struct SimulatedBoard::Parts {
  Parts(const simulation::SimulatedBoardSettings& settings, Nanoseconds begin)
      : board(settings, clock), readings(settings.channels.size()) {
    clock.set(begin);
  }

  VirtualClock clock;
  simulation::SimulatedBoard board;
  std::vector<model::Reading> readings;
};

SimulatedBoard::SimulatedBoard(std::vector<SimulatedFinger> fingers, double tick_s) {
  if (fingers.empty() || fingers.size() > most_fingers)
    throw InvalidArgument("fingers", std::to_string(fingers.size()) + " fingers; 1 to " +
                                         std::to_string(most_fingers) + " are possible");
  library::require_between("tick_s", tick_s, library::shortest_simulated_step_s,
                           std::numeric_limits<double>::max(), "s");
  simulation::SimulatedBoardSettings settings;
  for (std::size_t i = 0; i < fingers.size(); ++i) {
    const SimulatedFinger& finger = fingers[i];
    const std::string unit = name_of(finger.model.unit());
    library::require_between("noise", finger.noise, 0, sensor_range, unit);
    library::require_between("pressure_min_kpa", finger.pressure_min_kpa, -sensor_range, sensor_range, "kPa");
    library::require_between("pressure_max_kpa", finger.pressure_max_kpa, -sensor_range, sensor_range, "kPa");
    if (!(finger.pressure_max_kpa > finger.pressure_min_kpa))
      throw InvalidArgument("pressure_max_kpa", "the value must be above pressure_min_kpa (both in kPa)");
    const double delay_s = control::dead_time_s(finger.model.parts().value);
    if (delay_s > most_delay_ticks * tick_s)
      throw InvalidArgument("tick_s", significant(tick_s) + " s is below 1/100000 of the dead time of " +
                                          finger.model.name() + ", which is " + significant(delay_s) + " s");
    if (finger.object && !is_valid(*finger.object))
      throw InvalidArgument("object", "the position must be finite, in " + unit +
                                          ", and the share by which the object yields must be from 0 to 1");
    simulation::SimulatedChannel channel;
    channel.name = "finger " + std::to_string(i);
    channel.plant.model = finger.model.parts().value;
    channel.plant.object = object_of(finger.object);
    channel.plant.sample_time_s = tick_s;
    channel.plant.displacement_noise_mm = finger.noise;
    channel.plant.seed = finger.seed;
    channel.measures_pressure = true;
    channel.valve_min_kpa = finger.pressure_min_kpa;
    channel.valve_max_kpa = finger.pressure_max_kpa;
    channel.sensor_min_mm = -sensor_range;
    channel.sensor_max_mm = sensor_range;
    settings.channels.push_back(std::move(channel));
  }
  parts_ = std::make_unique<Parts>(settings, board_begins_at);
}
SimulatedBoard::~SimulatedBoard() = default;

std::size_t SimulatedBoard::channels() const noexcept {
  return parts_->board.channels();
}

BusStatus SimulatedBoard::connect(std::chrono::nanoseconds deadline) noexcept {
  return status_of(parts_->board.connect(deadline));
}

BusStatus SimulatedBoard::exchange(std::span<const double> commands_kpa, std::span<Reading> readings,
                                   std::chrono::nanoseconds deadline) noexcept {
  if (readings.size() != channels()) return BusStatus::write_refused;
  const BusStatus status = status_of(parts_->board.exchange(commands_kpa, parts_->readings, deadline));
  if (status != BusStatus::ok) return status;
  for (std::size_t i = 0; i < readings.size(); ++i) readings[i] = library::reading_of(parts_->readings[i]);
  return status;
}

std::string SimulatedBoard::detail() const {
  return parts_->board.detail();
}

std::string SimulatedBoard::describe() const {
  return parts_->board.describe();
}

std::chrono::nanoseconds SimulatedBoard::now() const noexcept {
  return std::chrono::nanoseconds(parts_->clock.now());
}

void SimulatedBoard::advance(std::chrono::nanoseconds duration) noexcept {
  if (duration.count() > 0) parts_->clock.advance(duration.count());
}

void SimulatedBoard::set_object(std::size_t channel, const std::optional<SimulatedObject>& object) noexcept {
  if (channel >= channels() || (object && !is_valid(*object))) return;
  parts_->board.catch_up();
  parts_->board.plant(channel).set_object(object_of(object));
}

double SimulatedBoard::displacement(std::size_t channel) const noexcept {
  if (channel >= channels()) return std::numeric_limits<double>::quiet_NaN();
  parts_->board.catch_up();
  return parts_->board.plant(channel).displacement_mm();
}

}  // namespace softgrip
