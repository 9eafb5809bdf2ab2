#pragma once
// Simulates a rig in this process: a board to which several simulated fingers (plants) are connected. The
// simulation is deterministic. Equal settings, clock readings and commands give results that are identical in
// every bit.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/clock.h"
#include "drivers/board/board.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// An event that occurs at a given time of the simulation.
struct SimulatedEvent {
  enum class Kind : std::uint8_t {
    object,         ///< places `object` so that the finger can touch it; nullopt: removes the object
    line_fault,     ///< sets the line fault of the finger to `line`
    sensor_fault,   ///< sets the sensor fault of the finger to `sensor`
    bus_lost,       ///< from this event on, every exchange returns `status`; if `status` is `disconnected`,
                    ///< connect() fails too
    bus_restored,   ///< from this event on, exchanges succeed again; if an exchange returned `disconnected`,
                    ///< `timed_out` or `bad_reply`, connect() must be called first
    write_refused,  ///< from this event on, outputs keep their values, and an exchange with a new value
                    ///< reports `write_refused`
    write_taken,    ///< from this event on, the outputs follow the commands again
  };
  /// Value of `channel` for an event that affects all channels.
  static constexpr std::size_t every_channel = static_cast<std::size_t>(-1);

  double at_s = 0;  ///< time of the event since the first exchange
  Kind kind = Kind::object;
  std::size_t channel = every_channel;
  std::optional<PlantObject> object = std::nullopt;
  LineFault line = {};
  SensorFault sensor = {};
  drivers::BusStatus status = drivers::BusStatus::disconnected;
};

struct SimulatedChannel {
  std::string name;
  PlantSettings plant;
  bool measures_pressure = false;
  bool measures_temperature = false;
  double valve_min_kpa = 0;  ///< lowest pressure of the valve; below 0 for vacuum
  double valve_max_kpa = 0;  ///< highest pressure of the valve; a command outside the range of the valve is
                             ///< limited, and the exchange reports this
  double vented_kpa = 0;     ///< output of the valve after the watchdog has tripped
  double sensor_min_mm = 0;  ///< lower end of the measuring range; readings outside the measuring range are
                             ///< not valid
  double sensor_max_mm = 0;
  int output_bits = 0;  ///< resolution over the valve's range; 0: no quantisation
  int input_bits = 0;   ///< resolution over the measuring range and over the pressure range; 0: no
                        ///< quantisation
};

struct SimulatedBoardSettings {
  std::vector<SimulatedChannel> channels;
  std::vector<SimulatedEvent> events;  ///< events of the simulation, in any order
  /// Time without an exchange after which the outputs change to `vented_kpa` [s]. The outputs keep this value
  /// until connect() is called. 0: the board has no watchdog.
  double watchdog_timeout_s = 0;
};

/// A simulated board. An exchange at time t first advances the plants to t with the commands of the previous
/// exchange. The new commands have an effect only after t. Therefore, a reading never depends on the command
/// of the exchange that returns it.
class SimulatedBoard final : public drivers::Board {
 public:
  /// `clock` must exist longer than the board.
  SimulatedBoard(const SimulatedBoardSettings& settings, const Clock& clock);
  ~SimulatedBoard() override;

  [[nodiscard]] std::size_t channels() const noexcept override;
  [[nodiscard]] drivers::BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] const char* detail() const noexcept override;
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] Budget budget() const override;
  [[nodiscard]] bool has_watchdog() const noexcept override;
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override;

  /// Returns the simulated finger of a channel, so that tests and scripts can change the finger. Only the
  /// thread that calls exchange() may use the finger.
  [[nodiscard]] Plant& plant(std::size_t channel);
  /// Advances the fingers to the present time of the clock.
  void catch_up() noexcept;
  /// Applies an event at the present time.
  void happen(const SimulatedEvent& event) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::simulation
